"""Values of expressions over three truth values, and what simplification and printing must not change."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product

from hypothesis import given

from sequence_planner.language.evaluator import evaluate, holds
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse
from sequence_planner.language.printer import print_expression
from sequence_planner.language.resolver import resolve_predicate
from sequence_planner.language.simplifier import simplify, simplify_assignment
from sequence_planner.language.syntax import (
    FALSE,
    TRUE,
    Assignment,
    Constant,
    Expression,
    Variable,
    children,
    occurrences,
    variables,
)
from sequence_planner.language.types import BOOLEAN, Value

from .trees import VARIABLES, predicates, predicates_with_parameters, valuations

Valuation = dict[str, Value | None]


@given(predicates_with_parameters, valuations)
def test_simplification_keeps_the_value_in_every_state(tree: Expression, valuation: Valuation) -> None:
    assert evaluate(simplify(tree), valuation) is evaluate(tree, valuation)


@given(predicates_with_parameters)
def test_what_is_simplified_is_as_simple_as_it_gets(tree: Expression) -> None:
    simple = simplify(tree)
    assert simplify(simple) == simple
    assert set(variables(simple)) <= set(variables(tree))
    if not list(occurrences(simple)):
        assert simple in (TRUE, FALSE)
    assert size(simple) <= size(tree)


@given(predicates_with_parameters, predicates_with_parameters, valuations)
def test_a_simplified_action_writes_the_same_where_it_did(
    value: Expression, condition: Expression, valuation: Valuation
) -> None:
    action = Assignment(Variable("idle", BOOLEAN), value, condition)
    simple = simplify_assignment(action)
    before = evaluate(condition, valuation)
    after = True if simple.condition is None else evaluate(simple.condition, valuation)
    assert after is before
    assert evaluate(simple.value, valuation) is evaluate(value, valuation)


@given(predicates, valuations)
def test_a_determined_value_is_that_of_every_completion(tree: Expression, valuation: Valuation) -> None:
    value = evaluate(tree, valuation)
    if value is not None:
        assert all(evaluate(tree, complete) is value for complete in completions(valuation, set(variables(tree))))


@given(predicates, valuations)
def test_without_unknown_variables_nothing_is_undetermined(tree: Expression, valuation: Valuation) -> None:
    complete = next(iter(completions(valuation, set(VARIABLES))))
    assert isinstance(evaluate(tree, complete), bool)
    assert holds(tree, complete) is evaluate(tree, complete)


@given(predicates)
def test_a_resolved_predicate_prints_as_what_resolves_to_it(tree: Expression) -> None:
    assert resolve_predicate(parse(print_expression(tree)), NameScope(VARIABLES)) == tree


def test_what_one_side_decides_needs_no_other() -> None:
    valuation: Valuation = dict.fromkeys(VARIABLES)
    valuation["idle"] = True

    def value(text: str) -> object:
        return evaluate(resolve_predicate(parse(text), NameScope(VARIABLES)), valuation)

    assert value("idle or robot.pose == home") is True
    assert value("not idle and robot.pose == home") is False
    assert value("not idle implies robot.pose == home") is True
    assert value("robot.pose == home implies idle") is True
    assert value("idle in {robot.move(home).executing, true}") is True
    assert value("idle and robot.pose == home") is None
    assert value("robot.pose == robot.pose") is None
    assert value("count + 1 > balance") is None


def test_what_parameters_decide_is_gone() -> None:
    for text, simple in (
        ("idle and true", "idle"),
        ("idle and false", "false"),
        ("idle or true", "true"),
        ("false or idle", "idle"),
        ("idle implies true", "true"),
        ("false implies idle", "true"),
        ("true implies idle", "idle"),
        ("not (1 == 1)", "false"),
        ("not (1 in {1}) or idle", "idle"),
        ("count + 1 - 1 == 2 - 1", "count + 1 - 1 == 1"),
    ):
        assert print_expression(simplify(resolve_predicate(parse(text), NameScope(VARIABLES)))) == simple


def test_truth_values_and_integers_are_different_values() -> None:
    assert evaluate(simplify(parse("1 == 1")), {}) is True
    assert simplify(Constant(1)) == Constant(1)
    assert isinstance(evaluate(Constant(1), {}), int)


def size(tree: Expression) -> int:
    return 1 + sum(map(size, children(tree)))


def completions(valuation: Mapping[str, Value | None], read: set[str]) -> Iterator[Valuation]:
    """Every choice of values for the unknown variables that are read."""
    open_ = sorted(name for name in read if valuation[name] is None)
    for values in product(*(VARIABLES[name].domain for name in open_)):
        yield {**valuation, **dict(zip(open_, values, strict=True))}
