"""Variables without a use, or without an origin: nothing feeds, carries, writes or reads them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

from sequence_planner.analysis.checks.relaxed_reachability import every_move
from sequence_planner.analysis.checks.warning import ModelWarning, families, listed, place
from sequence_planner.automaton.automaton import Automaton, Kind, VariableDeclaration, target
from sequence_planner.language.syntax import variables
from sequence_planner.language.types import Place
from sequence_planner.texts.message import Message, message


@dataclass(frozen=True)
class Connections:
    """The measured variables that topics feed, and the variables of any kind that outgoing messages depend on."""

    fed: frozenset[str]
    carried: frozenset[str]


def check_connections(automaton: Automaton, connections: Connections) -> Iterator[ModelWarning]:
    """Variables that no message, action or condition has to do with. A variable with indices is looked at as one."""
    humans = [ability for ability in automaton.abilities.values() if ability.human is not None]
    acknowledged = {a.human.acknowledgement for a in humans if a.human is not None}
    called = {target(action) for ability in humans for action in ability.start_actions}
    written, read = {name for move in every_move(automaton) for name in move.writes}, _read(automaton) | acknowledged
    idle: dict[Place, list[str]] = defaultdict(list)
    for family, members in families(automaton.variables).items():
        variable = automaton.variables[members[0]]

        def none(names: frozenset[str] | set[str], members: tuple[str, ...] = members) -> bool:
            return names.isdisjoint(members)

        where = place(automaton, *members)
        match variable.kind:
            case Kind.MEASURED if none(connections.fed | acknowledged):
                yield ModelWarning(where, "nothing-feeds", message("found.nothing-feeds", variable=family))
            case Kind.OUTPUT if none(connections.carried | called):
                yield ModelWarning(where, "carried-nowhere", message("found.carried-nowhere", variable=family))
            case Kind.OUTPUT | Kind.ESTIMATED if none(written) and not none(read):
                yield ModelWarning(where, "never-written", _unwritten(family, variable))
        if variable.kind in (Kind.MEASURED, Kind.ESTIMATED) and none(read | connections.carried):
            idle[where].append(family)
    for where, names in idle.items():
        yield ModelWarning(where, "never-read", message("found.never-read", names=listed(names), count=len(names)))


def _read(automaton: Automaton) -> set[str]:
    """Return what conditions and actions read; that an effect writes a variable is no use of it."""
    found: set[str] = set()
    for move in every_move(automaton):
        found |= move.reads
    conditions = [flag.predicate for flag in automaton.flags]
    conditions += [specification.forbidden for specification in automaton.specifications.values()]
    for operation in automaton.operations.values():
        local = () if operation.local is None else (operation.local,)
        conditions += [operation.precondition, operation.goal, *local]
    if automaton.rest is not None:
        conditions.append(automaton.rest)
    return found.union(*(variables(condition) for condition in conditions))


def _unwritten(name: str, variable: VariableDeclaration) -> Message:
    always = str(variable.initial)
    value = always.lower() if isinstance(variable.initial, bool) else always
    return message("found.never-written", variable=name, value=value)
