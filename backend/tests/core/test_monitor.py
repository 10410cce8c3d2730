"""Formulas as automata: they accept the runs that satisfy the formula, by the definition over whole traces."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from hypothesis import given

from language.trees import formulas, traces
from sequence_planner.language.evaluator import Valuation
from sequence_planner.language.ltl import satisfies
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse_formula
from sequence_planner.language.resolver import resolve_formula
from sequence_planner.language.syntax import TRUE, BinaryTemporal, Expression, UnaryTemporal, conjunction
from sequence_planner.language.types import BOOLEAN, Value
from sequence_planner.planning.goals.monitor import MOST_STATES, Monitor, TooManyStatesError, monitor_of
from sequence_planner.planning.goals.pursuit import moved, settled
from sequence_planner.planning.problem import Goal
from support.examples import examples

SCOPE = NameScope(dict.fromkeys("pqr", BOOLEAN))


def formula(text: str) -> Expression:
    return resolve_formula(parse_formula(text), SCOPE)


def after(monitor: Monitor, run: Sequence[Valuation]) -> int:
    state = 0
    for position in run:
        state = monitor.step(state, position)
    return state


@examples(600)
@given(formulas, traces)
def test_the_automaton_accepts_what_satisfies_the_formula(
    any_formula: Expression, trace: list[dict[str, Value | None]]
) -> None:
    """Also where values are unknown: then only what is satisfied for certain."""
    monitor = monitor_of(any_formula)
    *run, last = trace
    assert monitor.satisfied(after(monitor, run), last) is (satisfies(any_formula, trace) is True)


@examples(300)
@given(formulas, traces, traces)
def test_nothing_satisfies_what_is_hopeless(
    any_formula: Expression, trace: list[dict[str, Value | None]], rest: list[dict[str, Value | None]]
) -> None:
    monitor = monitor_of(any_formula)
    if after(monitor, trace) in monitor.hopeless:
        assert satisfies(any_formula, trace + rest) is not True


@pytest.mark.parametrize(
    ("text", "states"),
    [("true", 1), ("G p", 2), ("not q U r", 3), ("F p and F q", 4), ("G (p implies F q)", 3), ("X X p", 5)],
)
def test_automata_are_small(text: str, states: int) -> None:
    assert len(monitor_of(formula(text)).steps) <= states


def test_an_automaton_that_would_be_too_large_is_refused() -> None:
    """Somewhere a p, and so many positions behind it a q: all positions on the way must be remembered."""
    distant: Expression = formula("q")
    for _ in range(MOST_STATES.bit_length()):
        distant = UnaryTemporal("X", distant)
    some = UnaryTemporal("F", conjunction(formula("p"), distant))
    with pytest.raises(TooManyStatesError, match=f"takes more than {MOST_STATES} states"):
        monitor_of(some)


def test_a_goal_is_followed_along_a_run() -> None:
    """`not q U r` is kept until the goal, and then asked for at the very position that satisfies it."""
    (goal,) = goals = (Goal("done", formula("p"), formula("not q U r")),)
    nothing = {"p": False, "q": False, "r": False}
    waiting = settled(goals, nothing)
    assert waiting is not None
    assert moved(waiting, {**nothing, "q": True}) is None
    assert settled(waiting, {**nothing, "p": True}) is None  # r has not come
    assert settled(waiting, {**nothing, "p": True, "r": True}) == ()
    met = moved(waiting, {**nothing, "r": True})
    assert met is not None
    assert settled(met, {**nothing, "p": True, "q": True}) == ()
    assert moved(waiting, {**nothing, "p": True}) is not None  # goals are met after step 3 only
    assert settled((Goal("free", goal.predicate),), nothing) == (Goal("free", goal.predicate, TRUE),)


def test_weak_until_is_satisfied_by_a_run_that_ends() -> None:
    run = [{"p": True, "q": False}] * 3
    weak, strong = (monitor_of(BinaryTemporal(operator, formula("p"), formula("q"))) for operator in ("W", "U"))
    assert weak.satisfied(after(weak, run), run[-1])
    assert not strong.satisfied(after(strong, run), run[-1])
