"""One language, three readers: evaluation is the reference for the planner's circuits and the supervisor's diagrams."""

from __future__ import annotations

from hypothesis import given
from pysat.solvers import Solver

from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import Assignment, Expression, Variable
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value
from sequence_planner.planning.sat.solver import Circuit
from sequence_planner.planning.sat.symbolic import Reading, Symbol
from sequence_planner.synthesis.bdd import Diagrams
from sequence_planner.synthesis.transition_relation import ExpressionReader
from support.examples import examples

from .choices import Choices, made_by
from .random_expressions import actions, predicate

TYPES: dict[str, Type] = {
    "a": BOOLEAN,
    "b": BOOLEAN,
    "low": IntegerRange(-1, 1),
    "bit": IntegerRange(0, 1),
    "side": EnumerationType(("left", "right")),
    "place": EnumerationType(("right", "top", "bottom")),
}
SCOPE = [Variable(name, type_) for name, type_ in TYPES.items()]
Values = dict[str, Value | None]


def values_of(choices: Choices, unknown: bool) -> Values:
    return {
        name: None if unknown and choices.chance(3) else choices.pick(type_.domain) for name, type_ in TYPES.items()
    }


def symbols(values: Values) -> dict[str, Symbol]:
    """Values as the planner has them once a solver has decided all of them."""
    symbolic: dict[str, Symbol] = {}
    for name, type_ in TYPES.items():
        value = values[name]
        if value is None:
            symbolic[name] = Symbol({}, Circuit.FALSE)
        else:
            symbolic[name] = Symbol({v: Circuit.TRUE if v == value else Circuit.FALSE for v in type_.domain})
    return symbolic


def a_predicate(choices: Choices) -> tuple[Expression, Values]:
    return predicate(choices, SCOPE, depth=3), values_of(choices, unknown=True)


@examples(500)
@given(made_by(a_predicate))
def test_a_circuit_says_true_and_false_for_certain_as_evaluation_does(given_: tuple[Expression, Values]) -> None:
    expression, values = given_
    with Solver("minisat22") as solver:
        truth = Reading(Circuit(solver)).truth(expression, symbols(values))
    expected = evaluate(expression, values)
    assert (truth.yes == Circuit.TRUE, truth.no == Circuit.TRUE) == (expected is True, expected is False)
    assert {truth.yes, truth.no} <= {Circuit.TRUE, Circuit.FALSE}


def some_actions(choices: Choices) -> tuple[tuple[Assignment, ...], Values]:
    return actions(choices, SCOPE, SCOPE, least=1), values_of(choices, unknown=True)


@examples(300)
@given(made_by(some_actions))
def test_a_circuit_computes_the_value_that_an_action_writes(given_: tuple[tuple[Assignment, ...], Values]) -> None:
    written, values = given_
    for action in written:
        with Solver("minisat22") as solver:
            symbol = Reading(Circuit(solver)).symbol(action.value, symbols(values))
        expected = evaluate(action.value, values)
        assert (symbol.known == Circuit.TRUE) == (expected is not None)
        true = [value for value, literal in symbol.literals.items() if literal == Circuit.TRUE]
        assert true == ([] if expected is None else [expected])


def a_predicate_and_states(choices: Choices) -> tuple[Expression, list[Values]]:
    return predicate(choices, SCOPE, depth=3), [values_of(choices, unknown=False) for _ in range(4)]


@examples(400)
@given(made_by(a_predicate_and_states))
def test_a_diagram_holds_where_evaluation_says_so(given_: tuple[Expression, list[Values]]) -> None:
    expression, states = given_
    diagrams = Diagrams({variable.name: variable.type.domain for variable in SCOPE})
    holds = ExpressionReader(diagrams, diagrams.values).predicate(expression)
    for state in states:
        assert (diagrams.states(state) & holds).satisfiable() == evaluate(expression, state)
