"""Verdicts on a revision by people other than the one who saved it (dual approval, the four-eyes principle)."""

from __future__ import annotations

from collections.abc import Iterable

from sequence_planner.editor.revision import Revision
from sequence_planner.editor.talk.comments import Comment, Verdict


def standing_verdicts(revision: Revision, said: Iterable[Comment]) -> list[Comment]:
    """Return what counts of `said`, which is in the order in which it was said: of each person the last verdict on
    `revision`, unless it was withdrawn. None of who saved the revision does.
    """
    last = dict[str, Comment]()
    for each in said:
        if each.revision == revision.id and each.verdict is not None and not revision.is_by(each.by_id):
            last.pop(each.by_id, None)  # the last to speak is the last to be named
            if each.verdict is not Verdict.WITHDRAWN:
                last[each.by_id] = each
    return list(last.values())
