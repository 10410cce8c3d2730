"""The order in which a planned tick tries its starts.

Several abilities can start in one tick, in any order. One fixed order suffices as long as each pair whose order matters
stands in it the right way round: adjacent starts that commute can be exchanged until the fixed order is reached. Pairs
are told apart by what they write and ask for; where these demand a large circle, the solver is asked of each pair in
it, over all safe states, whether its order matters indeed. The members of a circle that is left are repeated.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Set
from functools import cached_property

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Ability, Automaton, target
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.demands import Starts
from sequence_planner.planning.sat.circles import Before, circles, linear
from sequence_planner.planning.sat.pairs import Pairs

_AS_LONG_AS_IT_TAKES = 1e7  # seconds
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
        """Whether the texts alone show that there is no need to take the second after the first rather than before."""
        one, other = (starts[name] for name in pair)
        if one.excludes(other) or (self._known and one.undone_by(other)):
            return True
        free = not any(name in self._supervisor.guards or self._automaton.abilities[name].restart for name in pair)
        return free and one.commutes_with(other)

    @cached_property
    def _pairs(self) -> Pairs:
        return Pairs(self._automaton, self._supervisor, self._known)


def _read(automaton: Automaton, ability: Ability) -> frozenset[str]:
    """The variables that a start of `ability` reads."""
    actions = ability.start_actions
    conditions = [action.condition for action in actions if action.condition is not None]
    values = [action.value for action in actions]
    return read_variables(automaton, (ability.enabled, ability.start_guard, *conditions, *values))
