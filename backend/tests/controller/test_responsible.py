"""Which variables keep a condition from being true: enough of them, none too many, and what they would have to be."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import islice, product

import pytest
from hypothesis import given

from core.choices import Choices, made_by
from core.random_expressions import predicate
from core.random_stations import automaton as random_station
from core.random_stations import state_of
from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.tick import initial_state, synchronise
from sequence_planner.controller.recovery.explain import changers, helpful, responsible, wanted
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import Expression, Variable
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Value
from support.automata import Does, automaton, predicate_of

BOLT = EnumerationType(("empty", "placed", "tightened"))
STATION = automaton(
    {
        "place": Does(start=("bolt := placed",), enabled="bolt == empty and ready"),
        "tighten": Does(
            start=("go := true",), executing="turns", finish="turns", finally_=("go := false", "bolt := tightened")
        ),
    },
    measured={"ready": (BOOLEAN, True), "turns": (BOOLEAN, False)},
    output={"go": (BOOLEAN, False)},
    estimated={"bolt": (BOLT, "empty")},
    effects={"tighten.begins": ("go", ("turns := true",)), "tighten.fails": ("go", ("ready := false",))},
    faults=("tighten.fails",),
)


@dataclass(frozen=True)
class Asked:
    station: Automaton
    condition: Expression
    state: State


def asked(choices: Choices, unknown: bool = False) -> Asked:
    station = random_station(choices)
    scope = [Variable(name, type_) for name, type_ in station.types.items()]
    return Asked(station, predicate(choices, scope, depth=3), state_of(choices, station, unknown))


def others(station: Automaton, condition: Expression, fixed: Mapping[str, Value | None]) -> Iterator[State]:
    """All states in which those variables are as they are, as far as the condition can see."""
    read = [name for name in station.variables if name in read_variables(station, (condition,))]
    domains = [(fixed[name],) if name in fixed else station.variables[name].type.domain for name in read]
    for values in islice(product(*domains), 4000):
        yield synchronise(station, {**station.initial_valuation, **dict(zip(read, values, strict=True))})


@given(made_by(asked))
def test_whatever_all_others_are_the_condition_is_not_true(question: Asked) -> None:
    station, condition, state = question.station, question.condition, question.state
    names = responsible(station, condition, state)
    if evaluate(condition, state) is True:
        assert names == ()
        return
    fixed = {name: state[name] for name in names}
    assert all(evaluate(condition, other) is False for other in others(station, condition, fixed))
    for spared in names:
        fewer = {name: value for name, value in fixed.items() if name != spared}
        open_still = {**dict.fromkeys(station.types), **fewer}
        assert evaluate(condition, synchronise(station, open_still)) is not False


@given(made_by(asked))
def test_with_a_value_that_is_wanted_it_is_true(question: Asked) -> None:
    station, condition, state = question.station, question.condition, question.state
    for name in responsible(station, condition, state):
        for value in station.variables[name].type.domain:
            after = synchronise(station, {**state, name: value})
            assert (value in wanted(station, condition, state, name)) == (evaluate(condition, after) is True)


def test_unknown_values_that_leave_it_open_are_named() -> None:
    state = synchronise(STATION, {**initial_state(STATION), "ready": None})
    assert responsible(STATION, predicate_of(STATION, "ready and bolt == empty"), state) == ("ready",)
    assert responsible(STATION, predicate_of(STATION, "ready and bolt == placed"), state) == ("bolt",)


def test_abilities_that_could_change_it_are_those_that_write_such_a_value() -> None:
    def found(name: str, *values: Value) -> list[tuple[str, str]]:
        return [(each.how, each.ability.name) for each in changers(STATION, initial_state(STATION), name, values)]

    assert found("bolt", "placed") == [("start", "place")]
    assert found("bolt", "tightened") == [("finish", "tighten")]
    assert found("bolt", "placed", "tightened") == [("start", "place"), ("finish", "tighten")]
    assert found("bolt", "empty") == []
    assert found("turns", True) == [("effect", "tighten")]
    assert found("ready", False) == [], "a fault is never counted on"


@given(made_by(asked))
def test_a_value_helps_if_it_makes_true_what_cannot_be_true_with_the_present(question: Asked) -> None:
    station, condition, state = question.station, question.condition, question.state
    decisive = responsible(station, condition, state)
    for name in decisive:
        values = helpful(station, condition, state, name, decisive)
        assert state[name] not in values
        if alone := wanted(station, condition, state, name):
            assert values == alone
            continue
        beside = [station.variables[each].type.domain for each in decisive if each != name]
        rest = [each for each in decisive if each != name]

        def can_be_true(value: Value | None, others_are: Mapping[str, Value], name: str = name) -> bool:
            fixed = {**others_are, name: value}
            return any(evaluate(condition, other) is True for other in others(station, condition, fixed))

        for value in station.variables[name].type.domain:
            brings = any(
                can_be_true(value, fixed) and not can_be_true(state[name], fixed)
                for fixed in (dict(zip(rest, each, strict=True)) for each in product(*beside))
            )
            assert value in values or not brings


COUNT = IntegerRange(0, 5)
BOX = automaton(
    {
        "add": Does(start=("full := full + 1 if full < 5",)),
        "remove": Does(start=("full := full - 1 if full > 0",)),
        "empty": Does(start=("full := 0",)),
        "fill": Does(start=("full := 5",)),
        "bring": Does(start=("spare := spare + 1 if spare < 5", "left := true")),
        "take": Does(start=("spare := 0", "left := false")),
    },
    estimated={"full": (COUNT, 1), "spare": (COUNT, 1), "left": (BOOLEAN, False), "right": (BOOLEAN, False)},
)


@pytest.mark.parametrize(
    ("condition", "name", "who"),
    [
        ("full >= 3", "full", ["add", "fill"]),
        ("full == 0", "full", ["remove", "empty"]),
        # one alone does not do, so no value of one alone is wanted
        ("full + spare >= 9", "full", ["add", "fill"]),
        ("full + spare >= 9", "spare", ["bring"]),
        ("left and right or full == 5", "left", ["bring"]),
        ("full + spare == 0", "full", ["remove", "empty"]),
        ("full + spare == 0", "spare", ["take"]),
    ],
)
def test_whoever_would_only_make_it_worse_is_not_named(condition: str, name: str, who: list[str]) -> None:
    state, asked_for = initial_state(BOX), predicate_of(BOX, condition)
    decisive = responsible(BOX, asked_for, state)
    values = helpful(BOX, asked_for, state, name, decisive)
    assert [each.ability.name for each in changers(BOX, state, name, values)] == who


def test_flags_are_followed_to_what_they_are_made_of() -> None:
    state = initial_state(STATION)
    flag = Variable("tighten.executing", BOOLEAN)
    assert responsible(STATION, flag, state) == ("turns",)
    assert wanted(STATION, flag, state, "turns") == (True,)
