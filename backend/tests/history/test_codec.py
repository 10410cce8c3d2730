"""What happens is written to the journal and read back as it was."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from history.happened import HAPPENINGS, happening, value
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.events import ModeChanged, OperatorPlanStarted, Ticked
from sequence_planner.execution.record.codec import KINDS, TICKED, Codec, Senses, TickBook, UnreadableError, kind_of
from sequence_planner.execution.state import OperatorPlan, OperatorPlanKind
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.journal.run_journal import LONGEST_KIND
from sequence_planner.language.syntax import Comparison, Constant, Variable
from sequence_planner.language.types import BOOLEAN, EnumerationType
from sequence_planner.planning.problem import Plan, PlanTick
from support.automata import Does, automaton
from support.examples import examples

STATION = automaton({"go": Does(start=("bell := true",))}, output={"bell": (BOOLEAN, False)})
NOW = Timestamp(1_700_000_000.25, 12.5)


@examples(300)
@given(happening())
def test_what_is_written_is_read_back(both: tuple[Automaton, Any]) -> None:
    station, happened = both
    codec = Codec(station)
    if isinstance(happened, Ticked):
        return
    document = json.loads(json.dumps(codec.content(happened)))
    again = codec.happening(kind_of(type(happened)), document)
    assert again == happened
    assert json.dumps(codec.content(again)) == json.dumps(document)


@examples(100)
@given(st.lists(value(Ticked, STATION), max_size=6))
def test_ticks_are_read_back_one_after_the_other(ticks: list[Ticked]) -> None:
    writing, reading = TickBook(), TickBook()
    for tick in ticks:
        assert reading.tick(json.loads(json.dumps(writing.content(tick)))) == tick


def test_a_tick_says_no_more_than_what_is_new() -> None:
    book = TickBook(Senses({"a": 1, "b": True, "c": None}, (), frozenset({"robot"})))
    tick = Ticked({"a": 1, "b": 1, "c": None}, (), frozenset({"robot"}), NOW)
    assert book.content(tick) == {"now": [NOW.epoch, NOW.monotonic], "measured": {"b": 1}}, "true is not 1"
    assert book.content(tick) == {"now": [NOW.epoch, NOW.monotonic]}


def test_each_kind_of_happening_has_a_kind_of_record() -> None:
    assert set(KINDS.values()) == set(HAPPENINGS)
    assert kind_of(ModeChanged) == "mode-changed"
    assert TICKED == "ticked"
    assert max(map(len, KINDS)) <= LONGEST_KIND


def test_predicates_are_written_as_in_the_model() -> None:
    errand = OperatorPlan(
        OperatorPlanKind.GOAL, "ring", Plan((PlanTick((), ("go",)),), False, False), Variable("bell", BOOLEAN)
    )
    content = Codec(STATION).content(OperatorPlanStarted(errand, NOW))
    assert content["what"]["errand"]["goal"] == "bell"


def test_a_value_with_the_name_of_a_variable_stays_a_value() -> None:
    places = EnumerationType(("bell", "home"))
    station = automaton(
        {"go": Does(start=("bell := true",))}, output={"bell": (BOOLEAN, False), "at": (places, "home")}
    )
    goal = Comparison("==", Variable("at", places), Constant("bell"))
    errand = OperatorPlan(OperatorPlanKind.GOAL, "go there", Plan((), False, False), goal)
    codec = Codec(station)
    document = json.loads(json.dumps(codec.content(OperatorPlanStarted(errand, NOW))))
    assert codec.happening("errand-taken", document) == OperatorPlanStarted(errand, NOW)


@pytest.mark.parametrize(
    "content",
    [
        {},
        {"what": []},
        {"what": {"mode": "quick", "by": "Eva", "now": {"epoch": 1.0, "monotonic": 1.0}}},
        {"what": {"mode": "paused", "by": 3, "now": {"epoch": 1.0, "monotonic": 1.0}}},
        {"what": {"mode": "paused", "by": "Eva", "now": {"epoch": 1.0, "monotonic": 1.0}, "why": "new"}},
        {"what": {"mode": "paused", "by": "Eva", "now": [1.0]}},
    ],
)
def test_what_nobody_wrote_is_not_read(content: dict[str, Any]) -> None:
    with pytest.raises(UnreadableError):
        Codec(STATION).happening("mode-changed", content)
    with pytest.raises(UnreadableError):
        TickBook().tick(content)


def test_the_mode_is_read_as_a_mode() -> None:
    codec = Codec(STATION)
    assert codec.happening("mode-changed", codec.content(ModeChanged(Mode.HOLD, "Eva", NOW))).mode is Mode.HOLD  # type: ignore[union-attr]
