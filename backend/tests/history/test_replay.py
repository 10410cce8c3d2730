"""The same happenings lead to the same state, bit for bit; so does going on from any snapshot."""

from __future__ import annotations

import json

from hypothesis import given

from core.choices import made_by
from history.lives import Life, life
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.plan_tracker import PlanCursor, PlanTracker
from sequence_planner.execution.record.codec import BEGUN, KINDS, SNAPSHOT, Codec
from sequence_planner.execution.record.recorder import DERIVED, EXECUTION, ORDER, PLAN, Memory
from sequence_planner.execution.record.replay import Player
from support.examples import examples


def played(lived: Life, first: int = 0) -> Player:
    """A player that has come to the end of what was recorded, from a record that says everything."""
    player = Player(lived.execution.automaton, lived.execution.supervisor)
    for record in lived.records[first:]:
        assert player.play(record) is None
    return player


@examples(60)
@given(made_by(life))
def test_a_run_is_replayed_bit_for_bit(lived: Life) -> None:
    again = played(lived).execution
    memory = Memory(again.automaton, Codec(again.automaton))
    assert json.dumps(memory.document(again)) == json.dumps(memory.document(lived.execution))
    assert again.state == lived.execution.state
    assert again.circumstances == lived.execution.circumstances


@examples(60)
@given(made_by(life))
def test_it_goes_on_from_each_snapshot_as_it_went_on(lived: Life) -> None:
    for number, record in enumerate(lived.records):
        if record.kind == SNAPSHOT:
            again = played(lived, number).execution
            assert again.state == lived.execution.state
            assert again.plan.order == lived.execution.plan.order
            assert again.conduct == lived.execution.conduct


@examples(20)
@given(made_by(life))
def test_nothing_that_an_execution_remembers_is_forgotten(lived: Life) -> None:
    execution = lived.execution
    for owner, table in ((execution, EXECUTION), (execution.plan, PLAN), (execution.plan.order, ORDER)):
        assert isinstance(owner, Executor | PlanTracker | PlanCursor)
        known = table.keys() | DERIVED
        assert not vars(owner).keys() - known, "put it into a table of history/memory.py, or say that it is derived"
        assert not {name for name in table if not hasattr(owner, name)}


@examples(15)
@given(made_by(life))
def test_each_happening_is_one_record(lived: Life) -> None:
    assert lived.records[0].kind == BEGUN
    assert {record.kind for record in lived.records[1:]} <= {*KINDS, SNAPSHOT}
    assert [record.number for record in lived.records] == list(range(1, len(lived.records) + 1))
