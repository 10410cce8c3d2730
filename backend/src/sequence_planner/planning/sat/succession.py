"""The order of single starts: of runs that differ only in the order of starts that do not matter to each other, one.

Two starts that follow one another, of which neither reads or writes what the other writes, can change places. Done as
long as the second comes first in the order of the automaton, this ends in a run in which no start comes right after
such a one (partial order reduction: Valmari 1990, Godefroid and Wolper 1991). So these runs are enough to look at,
where only the end counts.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Ability, Automaton, target
from sequence_planner.expressions.syntax import Constant, conjunction
from sequence_planner.expressions.types import Value
from sequence_planner.planning.known import equalities
from sequence_planner.planning.sat.encoding import SymbolicTick

# Of each start, by its place, those places from its own on that it may come right after; None where it may any.
Succession = Sequence[Sequence[int] | None]

_MOST = 120  # places that a start may come after: beyond, to say so takes longer than it spares


def in_order(succession: Succession, before: SymbolicTick, tick: SymbolicTick) -> Iterator[list[int]]:
    """The clauses that say a start of `tick` comes right after one of `before` that it may come after."""
    yield [-tick.earlier[-1], before.earlier[-1]]  # who has come to rest stays there
    for place, after in enumerate(succession):
        if after is not None:
            own = [-tick.starts[place][1], *(before.starts[other][1] for other in after)]
            yield [*own, before.earlier[place - 1]] if place else own


def succession(automaton: Automaton, supervisor: Supervisor, order: Sequence[Ability]) -> Succession:
    """For starts that are taken one at a time, in any `order`."""
    each = [_Start(automaton, supervisor, ability) for ability in order]
    touching: dict[str, set[int]] = defaultdict(set)
    leaving: dict[tuple[str, Value], set[int]] = defaultdict(set)
    for place, start in enumerate(each):
        for name in start.touched:
            touching[name].add(place)
            leaving[name, start.left.get(name, _ANY)].add(place)
    found: list[list[int] | None] = []
    for place, start in enumerate(each):
        related: set[int] = set()
        for name in start.touched:
            asked = start.asked.get(name)
            others = touching[name] if asked is None else leaving[name, asked] | leaving[name, _ANY]
            related |= others if name in start.written else {other for other in others if name in each[other].written}
        after = sorted(other for other in related if other >= place and not each[other].excludes(start))
        found.append(after if len(after) <= _MOST else None)
    return found


_ANY = "\0"  # no value of a model


class _Start:
    """What a start reads and writes, the values that it asks for, and those that are there after it."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, ability: Ability) -> None:
        guard = conjunction(ability.enabled, ability.start_guard)
        actions = ability.start_actions
        conditions = [action.condition for action in actions if action.condition is not None]
        kept = supervisor.guards.get(ability.name)
        self.written = frozenset(map(target, actions))
        read = read_variables(automaton, (guard, *conditions, *(action.value for action in actions)))
        self.touched = self.written | read | frozenset(() if kept is None else kept.names)
        self.asked = {name: value for name, value in equalities(guard) if name in automaton.variables}
        self.left = {name: value for name, value in self.asked.items() if name not in self.written}
        for action in actions:
            if action.condition is None and isinstance(action.value, Constant):
                self.left[target(action)] = action.value.value

    def excludes(self, other: _Start) -> bool:
        """Whether `other` cannot come right after it."""
        left = self.left
        return any(left.get(name, value) != value for name, value in other.asked.items())
