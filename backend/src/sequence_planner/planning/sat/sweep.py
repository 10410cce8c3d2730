"""The order in which a planned tick tries its starts.

Several abilities can start in one tick, in any order. One fixed order suffices as long as each pair whose order matters
stands in it the right way round: adjacent starts that commute can be exchanged until the fixed order is reached. Which
pairs do not commute is asked of the solver, over all safe states. Where they demand a circle, its members are repeated.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Set
from functools import cached_property
from graphlib import TopologicalSorter

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Ability, Automaton, State, target
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import Constant
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.sat.circuit import Circuit
from sequence_planner.planning.sat.encoding import Encoding
from sequence_planner.planning.sat.solver import Solver
from sequence_planner.planning.sat.symbolic import SymbolicState

_AS_LONG_AS_IT_TAKES = 1e7  # seconds

Order = tuple[Ability, ...]


def sweep_order(automaton: Automaton, supervisor: Supervisor) -> Order:
    """An order of the abilities, with repetitions if need be, of which every possible order of starts is a part."""
    return Sweep(automaton, supervisor).complete(Budget.seconds(_AS_LONG_AS_IT_TAKES))


class Sweep:
    """Orders of the abilities of one automaton under one supervisor; what is found out about pairs is kept."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._before: dict[str, set[str]] = {name: set() for name in automaton.abilities}
        self._written = {a.name: frozenset(map(target, a.start_actions)) for a in automaton.abilities.values()}
        self._left: dict[str, State] = {}  # by what has started, values that are known then
        self._undecided: list[tuple[str, str]] | None = None

    def complete(self, budget: Budget, seen: Set[str] = frozenset()) -> Order:
        """An order, with repetitions if need be, of which every possible order of starts is a part.

        Of the abilities `seen` every state between two starts matters, so that none of them commute. Raises
        `SpentError` when the budget is spent before it is known; what is known by then is not asked again.
        """
        if self._undecided is None:
            self._undecided = self._interfering()
        while self._undecided:
            budget.require()
            one, other = self._undecided[-1]
            if not self._excludes(one, other) and self._pairs.order_matters(one, other):
                self._before[other].add(one)
            self._undecided.pop()
        before = {name: earlier | seen - {name} if name in seen else earlier for name, earlier in self._before.items()}
        return tuple(self._automaton.abilities[name] for name in _linear(before))

    def writers(self, names: Set[str]) -> frozenset[str]:
        """The abilities whose starts write one of the variables."""
        return frozenset(name for name, written in self._written.items() if not written.isdisjoint(names))

    def quick(self) -> Order:
        """Each ability once, as far as possible after those that write what it reads."""
        writers: dict[str, list[str]] = defaultdict(list)
        for name, written in self._written.items():
            for variable in written:
                writers[variable].append(name)
        ordered: dict[str, None] = {}
        visited: set[str] = set()

        def visit(name: str) -> None:
            pending = [(name, False)]
            while pending:
                current, done = pending.pop()
                if done:
                    ordered[current] = None
                elif current not in visited:
                    visited.add(current)
                    pending.append((current, True))
                    read = _read(self._automaton, self._automaton.abilities[current])
                    pending += [(writer, False) for variable in sorted(read) for writer in writers[variable]]

        for name in self._automaton.abilities:
            visit(name)
        return tuple(self._automaton.abilities[name] for name in ordered)

    def _excludes(self, one: str, other: str) -> bool:
        """Whether what `one` writes alone shows that `other` cannot start after it."""
        if one not in self._left:
            actions = self._automaton.abilities[one].start_actions
            constants = {
                target(each): each.value.value
                for each in actions
                if each.condition is None and isinstance(each.value, Constant)
            }
            self._left[one] = {**dict.fromkeys(self._automaton.types), **constants}
        ability = self._automaton.abilities[other]
        return any(evaluate(each, self._left[one]) is False for each in (ability.enabled, ability.start_guard))

    def _interfering(self) -> list[tuple[str, str]]:
        """The pairs, either way round, of which one writes what the other reads, writes or is kept by."""
        users: dict[str, list[str]] = defaultdict(list)
        for name, ability in self._automaton.abilities.items():
            used = _read(self._automaton, ability) | self._written[name]
            if (guard := self._supervisor.guards.get(name)) is not None:
                used |= frozenset(guard.names)
            for variable in used:
                users[variable].append(name)
        found: dict[tuple[str, str], None] = {}
        for name, written in self._written.items():
            for variable in sorted(written):
                for other in users[variable]:
                    if other != name:
                        found |= {(name, other): None, (other, name): None}
        return list(found)

    @cached_property
    def _pairs(self) -> _Pairs:
        return _Pairs(self._automaton, self._supervisor)


class _Pairs:
    """All safe states in one solver, with the starts of pairs of abilities from them."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._abilities = automaton.abilities
        self._solver = Solver()
        self._circuit = Circuit(self._solver)
        self._encoding = Encoding(automaton, supervisor, self._circuit, frozenset(), lazily=True)
        self._state = self._encoding.initial(frozenset(), synchronised=True)
        self._published = self._encoding.initial(frozenset(), determined=automaton.flag_predicates.keys())
        self._circuit.require(self._encoding.safe(self._state))
        self._first: dict[str, tuple[int, SymbolicState]] = {}

    def order_matters(self, one: str, other: str) -> bool:
        """Whether in some safe state `one` then `other` can start, and the other way round not, or differently."""
        first_now, between = self._started(one)
        second_then, end = self._start(other, between)
        if Circuit.FALSE in (first_now, second_then):
            return False
        second_now, between_other = self._started(other)
        first_then, end_other = self._start(one, between_other)
        names = {target(action) for name in (one, other) for action in self._abilities[name].start_actions}
        same = [self._encoding.reading.same(end[name], end_other[name]) for name in sorted(names)]
        exchangeable = self._circuit.conjunction((second_now, first_then, *same))
        if exchangeable == Circuit.TRUE or -first_now in (second_then, exchangeable):
            return False
        budget = Budget.seconds(_AS_LONG_AS_IT_TAKES)
        return bool(self._solver.solve([first_now, second_then, -exchangeable], budget))

    def _started(self, name: str) -> tuple[int, SymbolicState]:
        if name not in self._first:
            self._first[name] = self._start(name, self._state)
        return self._first[name]

    def _start(self, name: str, state: SymbolicState) -> tuple[int, SymbolicState]:
        return self._encoding.start(self._abilities[name], state, self._published, Circuit.TRUE)


def _linear(before: Mapping[str, Set[str]]) -> Iterator[str]:
    """Every name after those that must stand before it; the n members of a circle are repeated.

    Any order of n different starts is a part of n - 1 repetitions of them all and another of the first: only the
    reverse order takes n, and ends with the first.
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
        yield from (*circle * (len(circle) - 1), circle[0])


def _above(name: str, before: Mapping[str, Set[str]]) -> Set[str]:
    """All that must stand before `name`, directly or not."""
    found: set[str] = set()
    pending = [name]
    while pending:
        new = before[pending.pop()] - found
        found |= new
        pending.extend(new)
    return found


def _read(automaton: Automaton, ability: Ability) -> frozenset[str]:
    """The variables that a start of `ability` reads."""
    actions = ability.start_actions
    conditions = [action.condition for action in actions if action.condition is not None]
    values = [action.value for action in actions]
    return read_variables(automaton, (ability.enabled, ability.start_guard, *conditions, *values))
