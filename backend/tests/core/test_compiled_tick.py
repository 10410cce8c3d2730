"""The compiled tick means what the reference means: on random automata, and where Python cannot compile."""

from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import given

from sequence_planner.automaton.automaton import State
from sequence_planner.automaton.compiled_tick import CompiledRun
from sequence_planner.automaton.compiler import Closures, CompiledTick, Compiler
from sequence_planner.automaton.tick import initial_state
from sequence_planner.language.evaluator import RELATIONS, evaluate, holds
from sequence_planner.language.syntax import (
    And,
    Arithmetic,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    Variable,
)
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange
from support.automata import Does, automaton
from support.examples import examples, rounds

from .choices import made_by
from .random_ticks import compare, compare_by_seed

OFF = (BOOLEAN, False)
A, B = Variable("a", BOOLEAN), Variable("b", BOOLEAN)
NUMBER = Variable("n", IntegerRange(0, 9))
ALL_THAT_HAPPENS = (
    "finishes",
    "conflicts",
    "activations",
    "completions",
    "starts",
    "undetermined starts",
    "undetermined flags",
)
STATES: tuple[State, ...] = tuple(
    {"a": a, "b": b, "n": n} for a in (None, False, True) for b in (None, False, True) for n in (None, 0, 5)
)


@examples(200)
@given(made_by(lambda choices: compare(choices, ticks=3)))
def test_it_is_the_reference_on_random_automata(_: object) -> None:
    """The comparison is part of making the example, so that hypothesis shrinks automaton and run together."""


@pytest.mark.parametrize("part", range(4))
def test_it_is_the_reference_on_thousands_of_random_automata(part: int) -> None:
    seen = Counter[str]()
    for number in range(rounds(500, 300)):
        seen += compare_by_seed(f"{part}.{number}", ticks=6)
    # What was never met would not have been compared.
    assert all(seen[what] > 10 for what in ALL_THAT_HAPPENS), seen


def negated(depth: int) -> Expression:
    expression: Expression = And((A, B))
    for _ in range(depth):
        expression = Not(expression)
    return expression


def equal_predicates(depth: int) -> Expression:
    expression: Expression = Or((A, B))
    for _ in range(depth):
        expression = Comparison("==", expression, Not(A))
    return expression


def summed(depth: int) -> Expression:
    total: Expression = NUMBER
    for _ in range(depth):
        total = Arithmetic("+", total, Constant(1))
    return Comparison(">", total, Constant(depth + 3))


@pytest.mark.parametrize("compiler", [Compiler(("a", "b", "n")), Closures()], ids=("compiled", "closures"))
@pytest.mark.parametrize(
    "expression",
    [
        negated(150),
        equal_predicates(40),
        summed(150),
        And((A,) * 3000),
        Or(tuple(Comparison("==", NUMBER, Constant(number)) for number in range(2000))),
        Membership(NUMBER, tuple(Constant(number) for number in range(2000))),
        Membership(Arithmetic("-", NUMBER, Constant(5)), (Constant(0), NUMBER)),
        Membership(And((A, B)), (Constant(True),)),
        Membership(NUMBER, (Constant(0), Constant(7))),
        *(Comparison(relation, Constant(5), NUMBER) for relation in RELATIONS),
        *(Comparison(relation, NUMBER, Constant(5)) for relation in RELATIONS),
        *(Comparison(relation, A, B) for relation in ("==", "!=")),
        Implies(A, B),
        Comparison("<", Constant(1), Constant(2)),
    ],
    ids=lambda _: "",
)
def test_an_expression_of_any_size_and_shape_means_what_it_meant(
    expression: Expression, compiler: Compiler | Closures
) -> None:
    [predicate], [truth], [value] = (
        make([expression]) for make in (compiler.predicates, compiler.truths, compiler.values)
    )
    for state in STATES:
        expected = evaluate(expression, state)
        assert truth(state) is expected
        assert value(state) is expected
        assert bool(predicate(state)) is holds(expression, state)


def test_names_and_values_cannot_be_mistaken_for_code() -> None:
    name, text = "x'] or s[\"y\\", "'); raise SystemExit #"
    expression = Comparison("==", Variable(name, EnumerationType((text, "other"))), Constant(text))
    [truth] = Compiler((name,)).truths([expression])
    assert [truth({name: value}) for value in (text, "other", None)] == [True, False, None]


def test_a_state_handed_out_is_not_changed_by_later_ticks() -> None:
    station = automaton({}, measured={"x": OFF})
    run = CompiledRun(CompiledTick(station), initial_state(station))
    before = run.state
    run.sense({"x": True})
    assert (before["x"], run.state["x"]) == (False, True)


def test_while_nothing_changes_the_state_stays_the_same_object() -> None:
    station = automaton({"go": Does(start=(), enabled="x")}, measured={"x": OFF})
    run = CompiledRun(CompiledTick(station), initial_state(station))
    before = run.state
    run.sense({"x": False})
    run.finish()
    run.synchronise()
    assert run.state is before


def test_runs_of_one_automaton_do_not_disturb_each_other() -> None:
    station = automaton(
        {"go": Does(start=("y := true",), enabled="x and not y")}, measured={"x": OFF}, output={"y": OFF}
    )
    compiled = CompiledTick(station)
    one, other = (CompiledRun(compiled, initial_state(station)) for _ in range(2))
    one.sense({"x": True})
    one.synchronise()
    assert (set(one.startable()), set(other.startable())) == ({"go"}, set())
    assert one.start("go")
    assert (one.state["y"], other.state["y"]) == (True, False)
