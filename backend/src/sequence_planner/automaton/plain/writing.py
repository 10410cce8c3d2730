"""The document of a plain automaton, for other tools: reading it gives the same automaton again."""

from __future__ import annotations

import json
from collections.abc import Mapping

from sequence_planner.automaton.plain.meaning import event_of
from sequence_planner.automaton.plain.steps import plain_transitions
from sequence_planner.automaton.structure import Automaton, VariableDeclaration, target
from sequence_planner.automaton.transitions import Transition
from sequence_planner.expressions.printing import print_expression
from sequence_planner.expressions.syntax import Comparison, Constant, Expression, Not, Variable, conjunction
from sequence_planner.expressions.types import BooleanType, IntegerRange, Type, Value


def write_plain(automaton: Automaton) -> str:
    """The JSON text of a plain automaton, with its invariant as part of the guards and of `initial`.

    Raises ValueError for the automaton of a station, which goes by the tick.
    """
    if not automaton.one_at_a_time:
        raise ValueError("the automaton of a station goes by the tick: it cannot be written as a plain one")
    document: dict[str, object] = {
        "name": automaton.name,
        "variables": {name: _domain(variable.type) for name, variable in automaton.variables.items()},
        "initial": print_expression(automaton.initial or _declared(automaton.variables)),
        "transitions": [_transition(transition) for transition in plain_transitions(automaton).values()],
        "forbidden": [print_expression(each.forbidden) for each in automaton.specifications.values()],
    }
    if automaton.rest is not None:
        document["marked"] = print_expression(automaton.rest)
    if automaton.goals:
        document["goal"] = [print_expression(goal) for goal in automaton.goals]
    return json.dumps(document, indent=2) + "\n"


def _domain(type_: Type) -> object:
    if isinstance(type_, IntegerRange):
        return {"min": type_.minimum, "max": type_.maximum}
    return "bool" if isinstance(type_, BooleanType) else list(type_.values)


def _transition(transition: Transition) -> dict[str, object]:
    return {
        "event": event_of(transition.name),
        "controllable": transition.controllable,
        "guard": print_expression(transition.guard),
        "set": {target(action): _update(action.value) for action in transition.actions},
    }


def _update(value: Expression) -> Value:
    return value.value if isinstance(value, Constant) else print_expression(value)


def _declared(variables: Mapping[str, VariableDeclaration]) -> Expression:
    """That each variable has its declared initial value."""
    return conjunction(*(_has(Variable(v.name, v.type), v.initial) for v in variables.values()))


def _has(variable: Variable, value: Value) -> Expression:
    if isinstance(value, bool):
        return variable if value else Not(variable)
    return Comparison("==", variable, Constant(value))
