"""Random small stations, directly as automata, and states of them.

They are so small that the plain implementations in `explicit` and `breadth_first` can look at every state; and yet
flags read flags, finish guards read `executing`, effects and finishes dispute variables, some effects are faults, some
abilities are for restart only, and some predicates read which operations are active.
"""

from __future__ import annotations

from collections.abc import Sequence

from sequence_planner.automaton.automaton import (
    Ability,
    Automaton,
    Effect,
    Flag,
    Kind,
    Operation,
    Specification,
    State,
    VariableDeclaration,
)
from sequence_planner.automaton.tick import synchronise
from sequence_planner.language.syntax import FALSE, TRUE, And, Expression, Variable
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value

from .choices import Choices
from .random_expressions import Scope, actions, atom, equality, guard, predicate, rare

TYPES: tuple[Type, ...] = (
    BOOLEAN,
    EnumerationType(("p", "q")),
    IntegerRange(0, 1),
    EnumerationType(("q", "r", "s")),
    IntegerRange(-1, 1),
)
KINDS = (Kind.MEASURED, Kind.OUTPUT, Kind.ESTIMATED)
FLAGS = ("enabled", "executing", "finished")
_MOST_STATES = 108


def declarations(choices: Choices) -> dict[str, VariableDeclaration]:
    """Two to five variables, at least one of them measured and one an output."""
    kinds = [Kind.MEASURED, Kind.OUTPUT, *(choices.pick(KINDS) for _ in range(choices.number(0, 3)))]
    declared: dict[str, VariableDeclaration] = {}
    states = 1
    for number, kind in enumerate(kinds):
        type_ = choices.pick(TYPES)
        states *= len(type_.domain)
        if states > _MOST_STATES:
            break
        name = f"{kind.value[0]}{number}"
        declared[name] = VariableDeclaration(name, type_, kind, choices.pick(type_.domain), None)
    return declared


def automaton(choices: Choices) -> Automaton:
    """A station of one to four abilities, up to four effects and up to two specifications."""
    operations = {name: Operation(name, name, TRUE, FALSE) for name in ("g0",) if choices.chance(2)}
    declared = declarations(choices)
    for each in operations.values():
        declared[each.activity] = VariableDeclaration(each.activity, BOOLEAN, Kind.ACTIVITY, False, None)
    plain = [Variable(name, variable.type) for name, variable in declared.items()]
    of_kind = {kind: [v for v in plain if declared[v.name].kind is kind] for kind in Kind}
    names = [f"a{number}" for number in range(choices.number(1, 4))]
    flags = [Variable(f"{name}.{which}", BOOLEAN) for name in names for which in FLAGS]
    written = [*of_kind[Kind.OUTPUT], *of_kind[Kind.ESTIMATED]]
    abilities = {
        name: _ability(choices, name, plain, written, flags, number * len(FLAGS)) for number, name in enumerate(names)
    }
    seen = [*of_kind[Kind.MEASURED], *of_kind[Kind.OUTPUT]]
    everything = [*plain, *flags]
    return Automaton(
        name="random",
        title="random",
        description="",
        resources={"station": "station"},
        variables=declared,
        abilities=abilities,
        flags=tuple(Flag(a.flag(which), getattr(a, which)) for a in abilities.values() for which in FLAGS),
        effects=tuple(_effect(choices, f"e{i}", of_kind[Kind.MEASURED], seen) for i in range(choices.number(0, 4))),
        specifications={
            f"s{i}": Specification(f"s{i}", f"s{i}", rare(choices, everything)) for i in range(choices.number(0, 2))
        },
        rest=predicate(choices, everything, 1) if choices.chance(2) else None,
        operations=operations,
    )


def _ability(choices: Choices, name: str, plain: Scope, written: Scope, flags: Scope, first: int) -> Ability:
    """The flags from number `first` on are its own; its flags read those before."""
    everything = [*plain, *flags]
    enabled, executing, _ = flags[first : first + len(FLAGS)]
    finish: Expression | None = equality(choices, everything)
    if choices.chance(2):
        finish = And((executing, atom(choices, everything)))
    elif choices.chance(3):
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
        finish_actions=actions(choices, written, everything, least=0),
        restart=choices.chance(8),
    )


def _effect(choices: Choices, name: str, measured: Scope, seen: Scope) -> Effect:
    writes = actions(choices, measured, seen, least=1)
    return Effect(name, "station", "executing", guard(choices, seen), writes, fault=choices.chance(6))


def state_of(choices: Choices, automaton: Automaton, unknown: bool = False) -> State:
    """A state after step 3, reachable or not; with `unknown`, some measured values are unknown.

    Flags that are undetermined then have whatever value they had before, or none.
    """
    values: dict[str, Value | None] = {}
    for name, variable in automaton.variables.items():
        missing = unknown and variable.kind is Kind.MEASURED and choices.chance(3)
        values[name] = None if missing else choices.pick(variable.type.domain)
    before: Sequence[bool | None] = (None, False, True) if unknown else (None,)
    for flag in automaton.flags:
        values[flag.name] = choices.pick(before)
    return synchronise(automaton, values)
