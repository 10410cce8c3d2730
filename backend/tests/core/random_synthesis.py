"""Random automata and stations for supervisors: larger and more entangled than those that other tests enumerate.

The documents have updates of many variables at once, exchanges, sums, copies between different domains, invariants and
several initial states. The stations have effects that read flags and estimates and dispute variables with each other,
finishes that do, faults, restart abilities and operations whose activity is read.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import prod
from typing import Any

from sequence_planner.automaton.automaton import (
    Ability,
    Automaton,
    Effect,
    Flag,
    Kind,
    Operation,
    Specification,
    VariableDeclaration,
)
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import (
    FALSE,
    TRUE,
    And,
    Arithmetic,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Not,
    Or,
    Variable,
    conjunction,
)
from sequence_planner.language.types import BOOLEAN, BooleanType, EnumerationType, IntegerRange, Type

from .choices import Choices
from .random_expressions import Scope, actions, atom, equality, guard, predicate, rare

_TYPES: tuple[Type, ...] = (
    BOOLEAN,
    EnumerationType(("p", "q")),
    EnumerationType(("q", "r", "s")),
    EnumerationType(("p", "q", "r", "s", "t")),
    IntegerRange(0, 1),
    IntegerRange(-1, 1),
    IntegerRange(0, 4),
    EnumerationType(("only",)),
)
_STATION_TYPES = _TYPES[:3] + _TYPES[4:6]
_KINDS = (Kind.MEASURED, Kind.OUTPUT, Kind.ESTIMATED)
_FLAGS = ("enabled", "executing", "finished")
_MOST_STATES = 600
_MOST_STATES_OF_A_STATION = 324


def large_document(choices: Choices) -> dict[str, Any]:
    """Two to six variables, up to twelve transitions of up to six events, up to three forbidden predicates."""
    types = _few_states([choices.pick(_TYPES) for _ in range(choices.number(2, 6))], _MOST_STATES)
    scope = [Variable(f"v{number}", type_) for number, type_ in enumerate(types)]
    events = [(f"e{number}", not choices.chance(4)) for number in range(choices.number(1, 6))]
    initial = _initial(choices, scope)
    return {
        "name": "random",
        "variables": {variable.name: _domain(variable.type) for variable in scope},
        "initial": print_expression(initial),
        "transitions": [_transition(choices, scope, *choices.pick(events)) for _ in range(choices.number(3, 12))],
        "forbidden": [print_expression(_forbidden(choices, scope, initial)) for _ in range(choices.number(0, 3))],
        "marked": print_expression(initial if choices.chance(3) else _marked(choices, scope)),
        "invariant": print_expression(predicate(choices, scope) if choices.chance(3) else TRUE),
        "goal": [],
    }


def _few_states(types: list[Type], most: int) -> list[Type]:
    """As many of `types` as do not have more states than that together."""
    while prod(len(type_.domain) for type_ in types) > most:
        types = types[:-1]
    return types


def _domain(type_: Type) -> object:
    match type_:
        case BooleanType():
            return "bool"
        case IntegerRange(minimum, maximum):
            return {"min": minimum, "max": maximum}
        case EnumerationType(values):
            return list(values)


def _initial(choices: Choices, scope: Scope) -> Expression:
    """One state, those that differ in a variable or two, or anything."""
    if choices.chance(6):
        return predicate(choices, scope)
    each = [Comparison("==", variable, Constant(choices.pick(variable.type.domain))) for variable in scope]
    return conjunction(*each[choices.number(1, 2) if choices.chance(3) else 0 :])


def _forbidden(choices: Choices, scope: Scope, initial: Expression) -> Expression:
    """Mostly no initial state, which would leave no supervisor."""
    forbidden = rare(choices, scope)
    return forbidden if choices.chance(6) else And((forbidden, Not(initial)))


def _marked(choices: Choices, scope: Scope) -> Expression:
    if choices.chance(4):
        return TRUE
    return conjunction(*(equality(choices, scope) for _ in range(choices.number(1, 2))))


def _transition(choices: Choices, scope: Scope, event: str, controllable: bool) -> dict[str, Any]:
    written = choices.different(scope, 0 if choices.chance(6) else 1, 4 if choices.chance(3) else 2)
    updates = {variable.name: _update(choices, variable, scope) for variable in written}
    if choices.chance(6) and (pair := _exchange(choices, scope)):
        updates |= pair
    return {
        "event": event,
        "controllable": controllable,
        "guard": print_expression(guard(choices, scope)),
        "set": updates,
    }


def _exchange(choices: Choices, scope: Scope) -> dict[str, bool | int | str]:
    one = choices.pick(scope)
    others = [other for other in scope if other != one and other.type == one.type]
    if not others:
        return {}
    other = choices.pick(others)
    return {one.name: other.name, other.name: one.name}


def _update(choices: Choices, target: Variable, scope: Scope) -> bool | int | str:
    numbers = [variable for variable in scope if isinstance(variable.type, IntegerRange)]
    if isinstance(target.type, IntegerRange) and not choices.chance(3):
        one, sign = choices.pick(numbers), choices.pick(("+", "-"))
        other = choices.pick(numbers) if choices.chance(2) else Constant(choices.number(1, 2))
        if _within_reach(target, one, sign, other):
            return print_expression(Arithmetic(sign, one, other))
    if choices.chance(3):
        alike = [v for v in scope if set(v.type.domain) & set(target.type.domain) and type(v.type) is type(target.type)]
        return choices.pick(alike).name
    if isinstance(target.type, BooleanType) and choices.chance(2):
        return print_expression(predicate(choices, scope))
    return choices.pick(target.type.domain)


def _within_reach(target: Variable, one: Variable, sign: str, other: Variable | Constant) -> bool:
    """Whether the sum can be a value of `target` at all."""
    values = (other.value,) if isinstance(other, Constant) else other.type.domain
    sums = {int(a) + int(b) if sign == "+" else int(a) - int(b) for a in one.type.domain for b in values}
    return not sums.isdisjoint(target.type.domain)


def large_station(choices: Choices) -> Automaton:
    """Three to seven variables, one to five abilities, up to six effects, up to three specifications."""
    operations = {name: Operation(name, name, TRUE, FALSE) for name in ("g0", "g1")[: choices.number(0, 2)]}
    declared = _declared(choices)
    for each in operations.values():
        declared[each.activity] = VariableDeclaration(each.activity, BOOLEAN, Kind.ACTIVITY, False, None)
    plain = [Variable(name, variable.type) for name, variable in declared.items()]
    of_kind = {kind: [v for v in plain if declared[v.name].kind is kind] for kind in Kind}
    names = [f"a{number}" for number in range(choices.number(1, 5))]
    flags = [Variable(f"{name}.{which}", BOOLEAN) for name in names for which in _FLAGS]
    written = [*of_kind[Kind.OUTPUT], *of_kind[Kind.ESTIMATED]]
    abilities = {
        name: _ability(choices, name, plain, written, flags, number * len(_FLAGS)) for number, name in enumerate(names)
    }
    everything = [*plain, *flags]
    initial = _as_begun(declared, choices.different(written, 1, 2))
    seen = everything if choices.chance(2) else plain
    return Automaton(
        name="random",
        title="random",
        description="",
        resources={"station": "station"},
        variables=declared,
        abilities=abilities,
        flags=tuple(Flag(a.flag(which), getattr(a, which)) for a in abilities.values() for which in _FLAGS),
        effects=tuple(_effect(choices, f"e{i}", of_kind[Kind.MEASURED], seen) for i in range(choices.number(0, 6))),
        specifications={
            f"s{i}": Specification(f"s{i}", f"s{i}", _forbidden(choices, everything, initial))
            for i in range(choices.number(0, 3))
        },
        rest=choices.pick((None, initial, _marked(choices, everything))),
        operations=operations,
    )


def _as_begun(declared: Mapping[str, VariableDeclaration], written: Scope) -> Expression:
    """What the station writes is as initially."""
    return conjunction(*(Comparison("==", each, Constant(declared[each.name].initial)) for each in written))


def _declared(choices: Choices) -> dict[str, VariableDeclaration]:
    kinds = [Kind.MEASURED, Kind.OUTPUT, Kind.MEASURED, *(choices.pick(_KINDS) for _ in range(choices.number(0, 4)))]
    types = _few_states([choices.pick(_STATION_TYPES) for _ in kinds], _MOST_STATES_OF_A_STATION)
    return {
        (name := f"{kind.value[0]}{number}"): VariableDeclaration(name, type_, kind, choices.pick(type_.domain), None)
        for number, (kind, type_) in enumerate(zip(kinds, types, strict=False))
    }


def _ability(choices: Choices, name: str, plain: Scope, written: Scope, flags: Scope, first: int) -> Ability:
    """The flags from number `first` on are its own; its flags read those before. Half of the finishes are disputed."""
    everything = [*plain, *flags]
    enabled, executing, _ = flags[first : first + len(_FLAGS)]
    finish: Expression | None = equality(choices, everything)
    if choices.chance(2):
        finish = And((executing, atom(choices, everything)))
    elif choices.chance(4):
        finish = None
    return Ability(
        name=name,
        resource="station",
        title=name,
        enabled=guard(choices, [*plain, *flags[:first]]),
        start_guard=TRUE if choices.chance(2) else guard(choices, everything),
        start_actions=actions(choices, written, everything, least=1),
        executing=guard(choices, [*plain, *flags[:first], enabled]),
        finished=predicate(choices, [*plain, *flags[:first], enabled, executing], 1),
        finish_guard=finish,
        finish_actions=actions(choices, written, everything, least=0 if choices.chance(3) else 1),
        restart=choices.chance(4),
    )


def _effect(choices: Choices, name: str, measured: Scope, seen: Scope) -> Effect:
    """It writes up to three variables, some only under a condition, some from others."""
    writes: tuple[Assignment, ...] = actions(choices, measured, seen, least=1)
    if choices.chance(3):
        more = actions(choices, measured, seen, least=1)
        writes += tuple(action for action in more if action.target not in {each.target for each in writes})
    when: Expression = guard(choices, seen)
    if choices.chance(3):
        when = Or((when, equality(choices, seen)))
    return Effect(name, "station", "executing", when, writes, fault=choices.chance(4))
