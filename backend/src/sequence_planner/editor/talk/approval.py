"""Verdicts on a revision by people other than the one who saved it (dual approval, the four-eyes principle)."""

from __future__ import annotations

from collections.abc import Collection, Iterable

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


def approvals_for(revision: Revision, said: Iterable[Comment], deployer: str, people: Collection[str]) -> list[Comment]:
    """Return the approvals of `revision` that count where `deployer` deploys it; both are ids, as are `people`.

    Two persons have to stand for it. Where none of the people of this station has saved it, as the program itself did
    when the station began, who deploys it is not one who approves it, too.
    """
    by_person = any(revision.is_by(person) for person in people)
    approvals = (each for each in standing_verdicts(revision, said) if each.verdict is Verdict.APPROVED)
    return [each for each in approvals if by_person or each.by_id != deployer]
