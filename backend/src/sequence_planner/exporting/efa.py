"""The document of a plain automaton, `*.efa.json`, which `read_plain` reads back."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from sequence_planner.automaton.plain.events import event_of
from sequence_planner.automaton.plain.steps import plain_transitions
from sequence_planner.automaton.structure import Automaton, target
from sequence_planner.exporting.names import different, dotted
from sequence_planner.expressions.printing import print_expression
from sequence_planner.expressions.replacing import Replacements, replaced
from sequence_planner.expressions.syntax import (
    TRUE,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Not,
    Variable,
    conjunction,
)
from sequence_planner.expressions.types import BooleanType, EnumerationType, IntegerRange, Type, Value


def names_in_document(automaton: Automaton) -> Mapping[str, str]:
    """How each variable is called in the document: as it is, if expressions can read that and mean no value by it."""
    types = {name: variable.type for name, variable in automaton.variables.items()}
    ambiguous = {n for n, type_ in types.items() if isinstance(type_, EnumerationType) and n in type_.values}
    return different(types, dotted, ambiguous)


def efa_document(automaton: Automaton) -> dict[str, Any]:
    """The document of a plain automaton; what is empty is left out. The invariant is part of its guards."""
    names = names_in_document(automaton)
    renamed = {n: Variable(names[n], v.type) for n, v in automaton.variables.items() if names[n] != n}
    document: dict[str, Any] = {
        "name": automaton.name,
        "variables": {names[name]: _domain(variable.type) for name, variable in automaton.variables.items()},
        "initial": _written(_initial(automaton), renamed),
        "transitions": list(_transitions(automaton, renamed)),
    }
    forbidden = [_written(s.forbidden, renamed) for s in automaton.specifications.values()]
    goals = [print_expression(replaced(goal, renamed)) for goal in automaton.goals]
    if forbidden:
        document["forbidden"] = forbidden
    if automaton.rest is not None:
        document["marked"] = _written(automaton.rest, renamed)
    if goals:
        document["goal"] = goals
    return document


def efa_text(automaton: Automaton) -> str:
    """The same as text, a transition on each line."""
    entries = (f"{json.dumps(key)}: {_laid_out(value)}" for key, value in efa_document(automaton).items())
    return "{\n" + ",\n".join(f"  {entry}" for entry in entries) + "\n}\n"


def _laid_out(value: object) -> str:
    if isinstance(value, list) and value:
        return "[\n" + ",\n".join(f"    {json.dumps(each, ensure_ascii=False)}" for each in value) + "\n  ]"
    if isinstance(value, dict) and value:
        parts = (f"    {json.dumps(key)}: {json.dumps(each)}" for key, each in value.items())
        return "{\n" + ",\n".join(parts) + "\n  }"
    return json.dumps(value, ensure_ascii=False)


def _initial(automaton: Automaton) -> Expression:
    if automaton.initial is not None:
        return automaton.initial
    return conjunction(*(_has(Variable(n, v.type), v.initial) for n, v in automaton.variables.items()))


def _has(variable: Variable, value: Value) -> Expression:
    if isinstance(value, bool):
        return variable if value else Not(variable)
    return Comparison("==", variable, Constant(value))


def _transitions(automaton: Automaton, renamed: Replacements) -> Iterator[dict[str, Any]]:
    for name, transition in plain_transitions(automaton).items():
        entry: dict[str, Any] = {"event": event_of(name), "controllable": transition.controllable}
        if transition.guard != TRUE:
            entry["guard"] = _written(transition.guard, renamed)
        if transition.actions:
            entry["set"] = dict(_updates(transition.actions, renamed))
        yield entry


def _updates(actions: Iterable[Assignment], renamed: Replacements) -> Iterator[tuple[str, bool | int | str]]:
    for action in actions:
        name = print_expression(renamed.get(target(action), action.target))
        yield name, action.value.value if isinstance(action.value, Constant) else _text(action.value, renamed)


def _domain(type_: Type) -> object:
    match type_:
        case BooleanType():
            return "bool"
        case IntegerRange(minimum, maximum):
            return {"min": minimum, "max": maximum}
        case EnumerationType(values):
            return list(values)


def _written(predicate: Expression, renamed: Replacements) -> bool | str:
    return predicate.value is True if isinstance(predicate, Constant) else _text(predicate, renamed)


def _text(expression: Expression, renamed: Replacements) -> str:
    return print_expression(replaced(expression, renamed))
