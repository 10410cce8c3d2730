"""What a supervisor may allow where variables have gathered values: what it never allows from there never starts."""

from __future__ import annotations

from collections.abc import Mapping, Set
from functools import cached_property

from sequence_planner.automaton.state_set import EVERYTHING, FIRST_NODE, NOTHING, StateSet, Supervisor
from sequence_planner.automaton.structure import target
from sequence_planner.automaton.transitions import Phase, Transition
from sequence_planner.expressions.syntax import Constant
from sequence_planner.expressions.types import Value

_MOST_NODES = 80_000  # of safe states that are looked at in all: a fifth of a second

_Branches = tuple[bool, list[int]]  # whether every one of them must be safe, as nobody knows, and their places


class Permission:
    """Looks up a supervisor's safe states, as far as that takes little time; from then on it says yes.

    It says so too often and never too seldom. Of one relaxation: what is possible there only grows.
    """

    def __init__(self, supervisor: Supervisor) -> None:
        self._safe: StateSet = supervisor.safe
        self._left = _MOST_NODES
        self._kept: tuple[int, list[_Branches], dict[int, bool]] | None = None

    def may(self, move: Transition, possible: Mapping[str, set[Value | None]]) -> bool:
        """Whether `move` may be taken from a safe state and lead to one, as far as `possible` values tell."""
        if move.phase is not Phase.START or self._safe.root == EVERYTHING or self._left < 0:
            return True
        return self._may_be_safe(possible, self._written(move, possible)) and self._may_be_safe(possible, {})

    def _written(self, move: Transition, possible: Mapping[str, set[Value | None]]) -> Mapping[str, Set[Value | None]]:
        """The values that what `move` writes may have then: any, where that depends on the state."""
        written: dict[str, Set[Value | None]] = {}
        for action in move.actions:
            name = target(action)
            if name not in self._domains or possible[name] == {None}:  # what is unknown stays so
                continue
            may: Set[Value | None] = {action.value.value} if isinstance(action.value, Constant) else self._domains[name]
            otherwise = frozenset() if action.condition is None else possible[name]
            written[name] = may | otherwise | written.get(name, frozenset())
        return written

    def _may_be_safe(self, possible: Mapping[str, set[Value | None]], written: Mapping[str, Set[Value | None]]) -> bool:
        """Whether a safe state may have `written` values, or else `possible` ones; of an unknown variable every one."""
        possibly, known = self._at_hand(possible)
        axes = list(possibly)
        deepest = -1  # below it nothing is written, so that it is as it was for other moves
        for name in written.keys() & self._axes.keys():
            deepest = max(deepest, axis := self._axes[name])
            axes[axis] = self._branches(axis, written[name], unknown=False)
        may = {NOTHING: False, EVERYTHING: True}
        children: dict[int, tuple[bool, list[int]]] = {}  # whether every one of them must be, and which
        pending = [self._safe.root]
        while pending:
            reference = pending.pop()
            if reference in children or reference in may:
                continue
            axis, branches = self._safe.nodes[reference - FIRST_NODE]
            if axis > deepest and reference in known:
                may[reference] = known[reference]
                continue
            every, places = axes[axis]
            below = [branches[place] for place in places]
            children[reference] = every, below
            pending += below
        self._left -= len(children)
        for reference in sorted(children):  # a node comes after those it refers to
            every, below = children[reference]
            may[reference] = (all if every else any)([may[each] for each in below])
            if self._safe.nodes[reference - FIRST_NODE][0] > deepest:
                known[reference] = may[reference]
        return may[self._safe.root]

    def _at_hand(self, possible: Mapping[str, set[Value | None]]) -> tuple[list[_Branches], dict[int, bool]]:
        """The branches of each axis for `possible` values, and what is known of nodes until one more is possible."""
        size = sum(map(len, possible.values()))  # no value is ever lost
        if self._kept is None or self._kept[0] != size:
            sets = [possible[name] for name in self._safe.names]
            axes = [self._branches(axis, values, unknown=values == {None}) for axis, values in enumerate(sets)]
            self._kept = size, axes, {}
        return self._kept[1:]

    def _branches(self, axis: int, values: Set[Value | None], *, unknown: bool) -> _Branches:
        if unknown:
            return True, list(range(len(self._safe.domains[axis])))
        positions = self._positions[axis]
        return False, [positions[value] for value in values if value is not None]

    @cached_property
    def _axes(self) -> Mapping[str, int]:
        return {name: axis for axis, name in enumerate(self._safe.names)}

    @cached_property
    def _domains(self) -> Mapping[str, frozenset[Value | None]]:
        return dict(zip(self._safe.names, map(frozenset, self._safe.domains), strict=True))

    @cached_property
    def _positions(self) -> tuple[dict[Value, int], ...]:
        return tuple({value: place for place, value in enumerate(domain)} for domain in self._safe.domains)
