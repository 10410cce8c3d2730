"""What counts of the verdicts on a revision, whatever people have said in which order, and what is kept of it."""

from __future__ import annotations

import contextlib
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.db.database import Database
from sequence_planner.editor.revision import Revision
from sequence_planner.editor.talk.approval import approvals_for, standing_verdicts
from sequence_planner.editor.talk.comments import (
    MOST_KEPT,
    Comment,
    Verdict,
    append_comment,
    append_verdict,
    read_comments,
    read_verdicts,
)
from support.people import ADAM, EVA

PEOPLE = ("eva", "adam", "maria")
REVISIONS = ("a" * 40, "b" * 40)
REVISION = Revision(REVISIONS[0], "New", "", "Eva", 0.0, "tree", author="eva")

said = st.lists(
    st.tuples(st.sampled_from(PEOPLE), st.sampled_from(REVISIONS), st.sampled_from((*Verdict, None))), max_size=12
).map(
    lambda all_: [
        Comment(at, float(at), who, who.title(), 1, "", None if verdict is None else revision, verdict)
        for at, (who, revision, verdict) in enumerate(all_, 1)
    ]
)


@given(said)
def test_of_each_but_who_saved_it_the_last_verdict_on_it_counts(all_: list[Comment]) -> None:
    counting = standing_verdicts(REVISION, all_)
    for who in PEOPLE:
        own = [each for each in all_ if each.by_id == who and each.revision == REVISION.id]
        last = own[-1] if own and who != "eva" and own[-1].verdict is not Verdict.WITHDRAWN else None
        assert [each for each in counting if each.by_id == who] == ([] if last is None else [last])
    assert counting == sorted(counting, key=lambda each: each.number)


@given(said, st.sampled_from((*PEOPLE, "sequence-planner", "somebody else")), st.sampled_from(PEOPLE))
def test_two_persons_stand_for_what_is_deployed(all_: list[Comment], author: str, deployer: str) -> None:
    revision = Revision(REVISIONS[0], "New", "", author, 0.0, "tree", author=author)
    approvals = approvals_for(revision, all_, deployer, PEOPLE)
    assert all(each.verdict is Verdict.APPROVED and each.by_id != author for each in approvals)
    if approvals:
        assert len({each.by_id for each in approvals} | ({author} & set(PEOPLE)) | {deployer}) > 1
    others = [each for each in standing_verdicts(revision, all_) if each.by_id != deployer]
    assert [each for each in approvals if each.by_id != deployer] == [
        each for each in others if each.verdict is Verdict.APPROVED
    ]


def test_an_author_whose_id_a_commit_cannot_have_is_the_author_all_the_same() -> None:
    odd = Actor(kind=ActorKind.PERSON, id="https://works.example|<7>", name="Odd")
    revision = Revision(REVISIONS[0], "New", "", "Odd", 0.0, "tree", author="https://works.example| 7 ")
    assert revision.is_by(odd.id)
    assert not revision.is_by("https://works.example|8")


def test_verdicts_stay_where_older_comments_go(tmp_path: Path) -> None:
    with contextlib.closing(Database.open(f"sqlite:///{tmp_path / 'station.sqlite'}")) as database:
        database.upgrade()
        with database.writing() as connection:
            first = append_verdict(connection, ADAM, 1, REVISION.id, Verdict.APPROVED, "Good.", 10.0)
            append_comment(connection, EVA, 1, "the oldest", 11.0)
            for number in range(MOST_KEPT):
                append_comment(connection, EVA, 1, f"{number}", 12.0)
        with database.reading() as connection:
            assert read_verdicts(connection) == [first]
            kept = read_comments(connection, 2 * MOST_KEPT)
    assert kept[0] == first
    assert len(kept) == MOST_KEPT + 1
    assert "the oldest" not in {each.text for each in kept}
