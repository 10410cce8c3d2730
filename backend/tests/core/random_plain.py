"""Random small documents of plain automata: updates that leave their range, invariants, several initial states."""

from __future__ import annotations

from typing import Any

from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import (
    TRUE,
    Arithmetic,
    Comparison,
    Constant,
    Expression,
    Variable,
    conjunction,
)
from sequence_planner.language.types import BOOLEAN, BooleanType, EnumerationType, IntegerRange, Type

from .choices import Choices
from .random_expressions import Scope, equality, guard, predicate, rare

_TYPES: tuple[Type, ...] = (
    BOOLEAN,
    EnumerationType(("p", "q")),
    IntegerRange(0, 2),
    EnumerationType(("q", "r", "N")),
    IntegerRange(-1, 1),
)


def document(choices: Choices) -> dict[str, Any]:
    """One to three variables, up to six transitions of up to four events, up to two forbidden predicates, a goal."""
    scope = [Variable(f"v{number}", choices.pick(_TYPES)) for number in range(choices.number(1, 3))]
    events = [(f"e{number}", choices.chance(2)) for number in range(choices.number(1, 4))]
    return {
        "name": "random",
        "variables": {variable.name: _domain(variable.type) for variable in scope},
        "initial": print_expression(_initial(choices, scope)),
        "transitions": [_transition(choices, scope, choices.pick(events)) for _ in range(choices.number(1, 6))],
        "forbidden": [print_expression(rare(choices, scope)) for _ in range(choices.number(0, 2))],
        "marked": print_expression(predicate(choices, scope, 1) if choices.chance(2) else TRUE),
        "invariant": print_expression(predicate(choices, scope) if choices.chance(3) else TRUE),
        "goal": [f"F ({print_expression(rare(choices, scope))})"],
    }


def _domain(type_: Type) -> object:
    match type_:
        case BooleanType():
            return "bool"
        case IntegerRange(minimum, maximum):
            return {"min": minimum, "max": maximum}
        case EnumerationType(values):
            return list(values)


def _initial(choices: Choices, scope: Scope) -> Expression:
    """Mostly one state."""
    if choices.chance(4):
        return predicate(choices, scope, 1)
    each = [Comparison("==", variable, Constant(choices.pick(variable.type.domain))) for variable in scope]
    return conjunction(*each[choices.number(0, 3) // 3 :])


def _transition(choices: Choices, scope: Scope, event: tuple[str, bool]) -> dict[str, Any]:
    name, controllable = event
    written = guard(choices, scope) if choices.chance(2) else equality(choices, scope)
    updates = {variable.name: _update(choices, variable, scope) for variable in choices.different(scope, 1, 2)}
    return {"event": name, "controllable": controllable, "guard": print_expression(written), "set": updates}


def _update(choices: Choices, target: Variable, scope: Scope) -> bool | int | str:
    if isinstance(target.type, IntegerRange) and choices.chance(2):
        near = [v for v in scope if isinstance(v.type, IntegerRange)]
        return print_expression(Arithmetic(choices.pick(("+", "-")), choices.pick(near), Constant(1)))
    if choices.chance(3):
        alike = [v for v in scope if set(v.type.domain) & set(target.type.domain) and type(v.type) is type(target.type)]
        return choices.pick(alike).name
    if isinstance(target.type, BooleanType) and choices.chance(3):
        return print_expression(predicate(choices, scope, 1))
    return choices.pick(target.type.domain)
