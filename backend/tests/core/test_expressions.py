"""Laws of the guard and action language: unknown values, simplification, and text that means what was printed."""

from __future__ import annotations

from itertools import product

from hypothesis import given

from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse, parse_assignment
from sequence_planner.language.printer import print_assignment, print_expression
from sequence_planner.language.resolver import resolve_assignment, resolve_predicate
from sequence_planner.language.simplifier import simplify, simplify_assignment
from sequence_planner.language.syntax import (
    FALSE,
    TRUE,
    And,
    Assignment,
    Constant,
    Expression,
    Implies,
    Not,
    Or,
    Variable,
    variables,
)
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value
from support.examples import examples

from .choices import Choices, made_by
from .random_expressions import actions, predicate

TYPES: dict[str, Type] = {
    "ready": BOOLEAN,
    "robot.busy": BOOLEAN,
    "robot.move(home).executing": BOOLEAN,
    "level": IntegerRange(-1, 1),
    "count": IntegerRange(0, 1),
    "pose": EnumerationType(("home", "above", "away")),
    "bolts[left]": EnumerationType(("above", "below")),
}
SCOPE = [Variable(name, type_) for name, type_ in TYPES.items()]
Values = dict[str, Value | None]


def an_expression(choices: Choices) -> Expression:
    return predicate(choices, SCOPE, depth=3)


def an_expression_and_values(choices: Choices) -> tuple[Expression, Values]:
    """An expression, and values for what it reads, some of them unknown."""
    expression = an_expression(choices)
    return expression, {
        name: None if choices.chance(3) else choices.pick(TYPES[name].domain)
        for name in dict.fromkeys(variables(expression))
    }


@examples(400)
@given(made_by(an_expression_and_values))
def test_a_value_determined_in_spite_of_unknowns_is_the_value_whatever_they_are(
    given_: tuple[Expression, Values],
) -> None:
    expression, values = given_
    determined = evaluate(expression, values)
    options = [TYPES[name].domain if value is None else (value,) for name, value in values.items()]
    outcomes = {evaluate(expression, dict(zip(values, chosen, strict=True))) for chosen in product(*options)}
    assert None not in outcomes
    assert determined is None or outcomes == {determined}


def test_truth_tables_of_kleene() -> None:
    x = Variable("x", BOOLEAN)
    for value, negated in ((True, False), (False, True), (None, None)):
        assert evaluate(Not(x), {"x": value}) is negated
    unknown: Values = {"x": None}
    assert evaluate(And((x, FALSE)), unknown) is False
    assert evaluate(And((x, TRUE)), unknown) is None
    assert evaluate(Or((x, TRUE)), unknown) is True
    assert evaluate(Or((x, FALSE)), unknown) is None
    assert evaluate(Implies(FALSE, x), unknown) is True
    assert evaluate(Implies(x, TRUE), unknown) is True
    assert evaluate(Implies(TRUE, x), unknown) is None


def some_constants(choices: Choices, expression: Expression) -> Expression:
    """`expression` with constants in place of some of its parts, as parameters leave them behind."""
    match expression:
        case Not(operand):
            return Not(some_constants(choices, operand))
        case And(operands):
            return And(tuple(some_constants(choices, part) for part in operands))
        case Or(operands):
            return Or(tuple(some_constants(choices, part) for part in operands))
        case Implies(left, right):
            return Implies(some_constants(choices, left), some_constants(choices, right))
        case _:
            return Constant(choices.chance(2)) if choices.chance(2) else expression


def a_partly_constant_expression_and_values(choices: Choices) -> tuple[Expression, Values]:
    expression, values = an_expression_and_values(choices)
    return some_constants(choices, expression), values


@examples(400)
@given(made_by(a_partly_constant_expression_and_values))
def test_simplification_changes_no_value_not_even_an_unknown_one(given_: tuple[Expression, Values]) -> None:
    expression, values = given_
    simple = simplify(expression)
    assert evaluate(simple, values) is evaluate(expression, values)
    assert simplify(simple) == simple
    assert set(variables(simple)) <= set(variables(expression))


@examples(400)
@given(made_by(an_expression))
def test_printed_text_means_the_expression_again(expression: Expression) -> None:
    assert resolve_predicate(parse(print_expression(expression)), NameScope(TYPES)) == expression


def test_brackets_are_kept_where_they_matter_and_dropped_where_not() -> None:
    for text in (
        "level - (level - 1) == 0",
        "level - 1 - 1 == -1",
        "not (ready and robot.busy)",
        "(ready implies robot.busy) implies ready",
        "ready implies robot.busy implies ready",
        "(ready or robot.busy) and ready",
    ):
        assert print_expression(parse(text)) == text
    assert print_expression(parse("((ready) and (not (robot.busy)))")) == "ready and not robot.busy"


@examples(200)
@given(made_by(lambda choices: actions(choices, SCOPE, SCOPE, least=1)))
def test_printed_actions_mean_the_actions_again(written: tuple[Assignment, ...]) -> None:
    for action in written:
        assert resolve_assignment(parse_assignment(print_assignment(action)), NameScope(TYPES)) == action
        assert simplify_assignment(action).target == action.target
