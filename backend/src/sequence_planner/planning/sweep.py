"""The order in which a planned tick tries its starts.

Several abilities can start in one tick, in any order. One fixed order suffices as long as each pair whose order matters
stands in it the right way round: adjacent starts that commute can be exchanged until the fixed order is reached. Which
pairs do not commute is asked of the solver, over all safe states. Where they demand a circle, its members are repeated.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Set
from dataclasses import replace
from graphlib import TopologicalSorter
from itertools import permutations

from pysat.solvers import Solver

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Ability, Automaton, reads, target
from sequence_planner.expressions.syntax import variables
from sequence_planner.planning.circuit import Circuit
from sequence_planner.planning.encoding import Encoding


def sweep_order(automaton: Automaton, supervisor: Supervisor) -> tuple[Ability, ...]:
    """An order of the abilities, with repetitions if need be, of which every possible order of starts is a part."""
    abilities = list(automaton.abilities.values())
    before: dict[str, set[str]] = {ability.name: set() for ability in abilities}
    used = {ability.name: _used(automaton, supervisor, ability) for ability in abilities}
    written = {ability.name: frozenset(map(target, ability.start_actions)) for ability in abilities}
    flags = {ability.name: _flags(automaton, ability) for ability in abilities}
    for first, second in permutations(abilities, 2):
        one, other = first.name, second.name
        if written[one].isdisjoint(used[other]) and written[other].isdisjoint(used[one]):
            continue
        concerned = used[one] | used[other] | frozenset(supervisor.safe.names)
        if _order_matters(_part(automaton, concerned, flags[one] | flags[other]), supervisor, first, second):
            before[other].add(one)
    return tuple(automaton.abilities[name] for name in _linear(before))


def _part(automaton: Automaton, names: Set[str], flags: Set[str]) -> Automaton:
    """The automaton with no more than these variables and flags."""
    kept = {name: variable for name, variable in automaton.variables.items() if name in names}
    return replace(automaton, variables=kept, flags=tuple(flag for flag in automaton.flags if flag.name in flags))


def _flags(automaton: Automaton, ability: Ability) -> frozenset[str]:
    """The flags that a start of `ability` reads, and those that these read."""
    found: set[str] = set()
    pending = [ability.flag("enabled"), *variables(ability.enabled), *variables(ability.start_guard)]
    pending += [name for action in ability.start_actions for name in reads(action)]
    while pending:
        name = pending.pop()
        if name in automaton.flag_predicates and name not in found:
            found.add(name)
            pending.extend(variables(automaton.flag_predicates[name]))
    return frozenset(found)


def _linear(before: Mapping[str, Set[str]]) -> Iterator[str]:
    """Every name after those that must stand before it; the n members of a circle are repeated n times.

    Any order of n different starts is a part of n repetitions of them all.
    """
    above = {name: _above(name, before) for name in before}
    circles = {
        name: tuple(other for other in before if other == name or (other in above[name] and name in above[other]))
        for name in before
    }
    order = TopologicalSorter[tuple[str, ...]]()
    for name in before:
        earlier = (circles[other] for other in before if other in above[name] and name not in above[other])
        order.add(circles[name], *earlier)
    for circle in order.static_order():
        yield from circle * len(circle)


def _above(name: str, before: Mapping[str, Set[str]]) -> Set[str]:
    """All that must stand before `name`, directly or not."""
    found: set[str] = set()
    pending = [name]
    while pending:
        new = before[pending.pop()] - found
        found |= new
        pending.extend(new)
    return found


def _used(automaton: Automaton, supervisor: Supervisor, ability: Ability) -> frozenset[str]:
    """The variables that a start of `ability` reads or writes, and those that decide whether it is allowed."""
    used = set(read_variables(automaton, (ability.enabled, ability.start_guard)))
    for action in ability.start_actions:
        condition = () if action.condition is None else (action.condition,)
        used |= {target(action), *read_variables(automaton, (action.value, *condition))}
    if (guard := supervisor.guards.get(ability.name)) is not None:
        used |= set(guard.names)
    return frozenset(used)


def _order_matters(automaton: Automaton, supervisor: Supervisor, first: Ability, second: Ability) -> bool:
    """Whether in some safe state `first` then `second` can start, and the other way round not, or differently.

    `automaton` has at least the variables that decide it.
    """
    with Solver("minisat22") as solver:
        circuit = Circuit(solver)
        encoding = Encoding(automaton, supervisor, circuit, frozenset())
        state = encoding.initial(frozenset(), synchronised=True)
        published = encoding.initial(frozenset(), synchronised=True)
        first_now, between = encoding.start(first, state, published, circuit.TRUE)
        second_then, end = encoding.start(second, between, published, circuit.TRUE)
        second_now, between_other = encoding.start(second, state, published, circuit.TRUE)
        first_then, end_other = encoding.start(first, between_other, published, circuit.TRUE)
        same = [encoding.reading.same(end[name], end_other[name]) for name in automaton.variables]
        exchangeable = circuit.conjunction((second_now, first_then, *same))
        circuit.require(encoding.safe(state))
        for demanded in (first_now, second_then, -exchangeable):
            circuit.require(demanded)
        return bool(solver.solve())
