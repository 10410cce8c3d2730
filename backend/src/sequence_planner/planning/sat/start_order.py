"""Start order of a planned tick: the solver's sweep order, and non-commuting pairs of starts."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, MutableMapping, Set
from functools import cached_property

from sequence_planner.automaton.automaton import Ability, Automaton, target
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.planning.demands import Starts
from sequence_planner.planning.sat.encoding import Encoding
from sequence_planner.planning.sat.solver import Circuit, Solver
from sequence_planner.planning.sat.symbolic import SymbolicState
from sequence_planner.process.budget import Budget

# Orders of names some of which must stand before others, also where these demands form circles.

Before = MutableMapping[str, dict[str, None]]  # for each name those that must stand before it


def linear(before: Mapping[str, Collection[str]]) -> Iterator[str]:
    """Every name after those that must stand before it, where each occurs once; the members of a circle are repeated.

    Without some of its members a circle is none. In an order of starts, each of which is taken once, at most all of
    these occur, one by one, and between two of them there is a part of an order of the others: so all others, in order,
    and those by turns are enough.
    """
    for circle in circles(before):
        if len(circle) == 1:
            yield circle[0]
            continue
        breaking = _breaking(before, circle)
        rest = [name for (name,) in circles(_within(before, [name for name in circle if name not in breaking]))]
        for _ in breaking:
            yield from rest
            yield from breaking
        yield from rest


def circles(before: Mapping[str, Collection[str]]) -> list[tuple[str, ...]]:
    """The sets of names that must each stand before all the others of it, in order; most are of one name.

    The strongly connected components of Tarjan (1972).
    """
    numbers: dict[str, int] = {}
    lowest: dict[str, int] = {}
    open_: dict[str, None] = {}
    found: list[tuple[str, ...]] = []
    for root in before:
        pending = [] if root in numbers else [(root, iter(before[root]))]
        while pending:
            name, earlier = pending[-1]
            if name not in numbers:
                numbers[name] = lowest[name] = len(numbers)
                open_[name] = None
            for other in earlier:
                if other not in numbers:
                    pending.append((other, iter(before[other])))
                    break
                if other in open_:
                    lowest[name] = min(lowest[name], numbers[other])
            else:
                pending.pop()
                if pending:
                    parent = pending[-1][0]
                    lowest[parent] = min(lowest[parent], lowest[name])
                if lowest[name] == numbers[name]:
                    members = [each for each in open_ if numbers[each] >= numbers[name]]
                    for each in members:
                        del open_[each]
                    found.append(tuple(members))
    return found


def _breaking(before: Mapping[str, Collection[str]], circle: Collection[str]) -> list[str]:
    """Members of a circle without which the others are in none: by turns the one with the most demands."""
    breaking: list[str] = []
    left = _within(before, circle)
    while caught := [each for each in circles(left) if len(each) > 1]:
        breaking += [_busiest(_within(left, members)) for members in caught]
        left = _within(before, [name for name in circle if name not in breaking])
    return breaking


def _busiest(before: Mapping[str, Collection[str]]) -> str:
    later = {name: sum(name in earlier for earlier in before.values()) for name in before}
    return max(before, key=lambda name: len(before[name]) * later[name])


def _within(before: Mapping[str, Collection[str]], names: Collection[str]) -> dict[str, list[str]]:
    inside = frozenset(names)
    return {name: [other for other in before[name] if other in inside] for name in names}


# Whether the order of two starts in one tick matters, over all safe states.

_AS_LONG_AS_IT_TAKES = 1e7  # seconds


class StartPairs:
    """All safe states in one solver, with the starts of pairs of abilities from them."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, known: bool) -> None:
        """With `known`, two starts of which the second undoes the first need not be told from none: where every
        variable has a value, a tick with no needless starts has them one after the other only around a third, whose
        order with both matters.
        """
        self._abilities = automaton.abilities
        self._known = known
        self._solver = Solver()
        self._circuit = Circuit(self._solver)
        self._encoding = Encoding(automaton, supervisor, self._circuit, frozenset(), lazily=True)
        self._state = self._encoding.initial(frozenset(), synchronised=True)
        self._published = self._encoding.initial(frozenset(), determined=automaton.flag_predicates.keys())
        self._circuit.require(self._encoding.safe(self._state))
        self._first: dict[str, tuple[int, SymbolicState]] = {}
        self._second: dict[tuple[str, str], tuple[int, SymbolicState]] = {}

    def order_matters(self, one: str, other: str) -> bool:
        """Return whether in some safe state `one` then `other` can start, and the other way round not, or
        differently.
        """
        first_now, _ = self._started(one)
        second_then, end = self._both(one, other)
        if Circuit.FALSE in (first_now, second_then):
            return False
        second_now, _ = self._started(other)
        first_then, end_other = self._both(other, one)
        names = self._written(one, other)
        exchangeable = self._circuit.conjunction((second_now, first_then, *self._same(names, end, end_other)))
        undone = self._circuit.conjunction(self._same(names, end, self._state)) if self._known else Circuit.FALSE
        if Circuit.TRUE in (exchangeable, undone) or -first_now in (second_then, -exchangeable):
            return False
        budget = Budget.seconds(_AS_LONG_AS_IT_TAKES)
        return bool(self._solver.solve([first_now, second_then, -exchangeable, -undone], budget))

    def _same(self, names: list[str], one: SymbolicState, other: SymbolicState) -> list[int]:
        return [self._encoding.reading.same(one[name], other[name]) for name in names]

    def _started(self, name: str) -> tuple[int, SymbolicState]:
        if name not in self._first:
            self._first[name] = self._start(name, self._state)
        return self._first[name]

    def _both(self, one: str, other: str) -> tuple[int, SymbolicState]:
        """Return whether `other` can start after `one`, and what they have written then; either order of a pair needs
        both.
        """
        if (one, other) not in self._second:
            then, end = self._start(other, self._started(one)[1])
            self._second[one, other] = then, {name: end[name] for name in self._written(one, other)}
        return self._second[one, other]

    def _written(self, one: str, other: str) -> list[str]:
        return sorted({target(action) for name in (one, other) for action in self._abilities[name].start_actions})

    def _start(self, name: str, state: SymbolicState) -> tuple[int, SymbolicState]:
        return self._encoding.start(self._abilities[name], state, self._published, Circuit.TRUE)


# The order in which a planned tick tries its starts.
#
# Several abilities can start in one tick, in any order. One fixed order suffices as long as each pair whose order
# matters stands in it the right way round: adjacent starts that commute can be exchanged until the fixed order is
# reached. Pairs are told apart by what they write and ask for; where these demand a large circle, the solver is asked
# of each pair in it, over all safe states, whether its order matters indeed. The members of a circle that is left are
# repeated.

_FEW = 4  # members of a circle that are sooner repeated than asked about

Order = tuple[Ability, ...]


def sweep_order(automaton: Automaton, supervisor: Supervisor) -> Order:
    """An order of the abilities, with repetitions if need be, of which every possible order of starts is a part."""
    return Sweep(automaton, supervisor).complete(Budget.seconds(_AS_LONG_AS_IT_TAKES))


class Sweep:
    """Orders of the abilities of one automaton under one supervisor; what is found out about pairs is kept."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, known: bool = False) -> None:
        """With `known`, only for states in which every variable has a value, and for ticks with no needless starts."""
        self._automaton = automaton
        self._supervisor = supervisor
        self._known = known
        self._written = {a.name: frozenset(map(target, a.start_actions)) for a in automaton.abilities.values()}
        self._matters: dict[tuple[str, str], bool] = {}  # of pairs in circles

    def complete(self, budget: Budget, seen: Set[str] = frozenset(), restart: bool = True) -> Order:
        """An order, with repetitions if need be, of which every possible order of starts is a part.

        Without `restart` it is of starts among which there are none of restart abilities. Of the abilities `seen` every
        state between two starts matters, so that none of them commute. Raises `SpentError` when the budget is spent
        before it is known; what is known by then is not asked again.
        """
        before: dict[str, dict[str, None]] = {name: {} for name in self._offered(restart)}
        for one, other in self._candidates:
            if one in before and other in before and self._matters.get((one, other), True):
                before[other][one] = None
        together = [name for name in before if name in seen]
        for name in together:
            before[name] |= {other: None for other in together if other != name}
        for circle in circles(before):
            if len(circle) > _FEW:
                self._open(before, circle, seen, budget)
        return tuple(self._automaton.abilities[name] for name in linear(before))

    def _open(self, before: Before, circle: tuple[str, ...], seen: Set[str], budget: Budget) -> None:
        """Take out of `before` the pairs in a circle whose order does not matter, as many as it takes to open it.

        What agrees with an order in which all stand the right way round that are known to matter need not be asked.
        """
        members = frozenset(circle)
        pairs = {(one, other): None for other in circle for one in before[other] if one in members}
        while True:
            known: Before = {name: {} for name in circle}
            for one, other in pairs:
                if self._matters.get((one, other)) or (one in seen and other in seen):
                    known[other][one] = None
            order = circles(known)
            closed = len(order) < len(circle)  # by what matters indeed: then all that does not is taken out
            place = {name: number for number, (name, *_) in enumerate(order)}
            against = [
                (one, other)
                for one, other in pairs
                if one not in known[other] and (closed or place[one] > place[other])
            ]
            if not against:
                return
            for one, other in against:
                if (one, other) not in self._matters:
                    budget.require()
                    self._matters[one, other] = self._pairs.order_matters(one, other)
                if not self._matters[one, other]:
                    del before[other][one], pairs[one, other]

    def writers(self, names: Set[str]) -> frozenset[str]:
        """The abilities whose starts write one of the variables."""
        return frozenset(name for name, written in self._written.items() if not written.isdisjoint(names))

    def quick(self, restart: bool = True) -> Order:
        """Each ability once, as far as possible after those that write what it reads; `restart` as in `complete`."""
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
        offered = self._offered(restart)
        return tuple(offered[name] for name in ordered if name in offered)

    def _offered(self, restart: bool) -> Mapping[str, Ability]:
        abilities = self._automaton.abilities
        return abilities if restart else {name: each for name, each in abilities.items() if not each.restart}

    @cached_property
    def _candidates(self) -> list[tuple[str, str]]:
        """The pairs, either way round, of which one writes what the other reads, writes or is kept by, and the second
        may be able to start after the first.
        """
        users: dict[str, list[str]] = defaultdict(list)
        for name, ability in self._automaton.abilities.items():
            used = _read(self._automaton, ability) | self._written[name]
            if (guard := self._supervisor.guards.get(name)) is not None:
                used |= frozenset(guard.names)
            if ability.restart:  # which has no guard: the safe states themselves keep it
                used |= frozenset(self._supervisor.safe.names)
            for variable in used:
                users[variable].append(name)
        found: dict[tuple[str, str], None] = {}
        for name, written in self._written.items():
            for variable in sorted(written):
                for other in users[variable]:
                    if other != name:
                        found |= {(name, other): None, (other, name): None}
        starts = Starts(self._automaton, self._supervisor)
        return [pair for pair in found if not self._shown(pair, starts)]

    def _shown(self, pair: tuple[str, str], starts: Starts) -> bool:
        """Return whether the texts alone show that there is no need to take the second after the first rather than
        before.
        """
        one, other = (starts[name] for name in pair)
        if one.excludes(other) or (self._known and one.undone_by(other)):
            return True
        free = not any(name in self._supervisor.guards or self._automaton.abilities[name].restart for name in pair)
        return free and one.commutes_with(other)

    @cached_property
    def _pairs(self) -> StartPairs:
        return StartPairs(self._automaton, self._supervisor, self._known)


def _read(automaton: Automaton, ability: Ability) -> frozenset[str]:
    """The variables that a start of `ability` reads."""
    actions = ability.start_actions
    conditions = [action.condition for action in actions if action.condition is not None]
    values = [action.value for action in actions]
    return read_variables(automaton, (ability.enabled, ability.start_guard, *conditions, *values))
