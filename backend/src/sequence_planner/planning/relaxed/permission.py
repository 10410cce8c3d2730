"""What a supervisor may allow where variables have gathered values: what it never allows from there never starts."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

from sequence_planner.automaton.state_set import EVERYTHING, FIRST_NODE, NOTHING, StateSet, Supervisor
from sequence_planner.automaton.structure import target
from sequence_planner.automaton.transitions import Phase, Transition
from sequence_planner.expressions.syntax import Constant
from sequence_planner.expressions.types import Value

_MOST_NODES = 80_000  # of safe states that are looked at in all: a fifth of a second


class Permission:
    """Looks up a supervisor's safe states, as far as that takes little time; from then on it says yes.

    It says so too often and never too seldom.
    """

    def __init__(self, supervisor: Supervisor) -> None:
        self._safe: StateSet = supervisor.safe
        self._left = _MOST_NODES

    def may(self, move: Transition, possible: Mapping[str, set[Value | None]]) -> bool:
        """Whether `move` may be taken from a safe state and lead to one, as far as `possible` values tell."""
        if move.phase is not Phase.START or self._safe.root == EVERYTHING or self._left < 0:
            return True
        written = {
            target(action): {action.value.value}
            for action in move.actions
            if action.condition is None and isinstance(action.value, Constant) and possible[target(action)] != {None}
        }
        return self._may_be_safe(possible, written) and self._may_be_safe(possible, {})

    def _may_be_safe(
        self, possible: Mapping[str, set[Value | None]], written: Mapping[str, set[bool | int | str]]
    ) -> bool:
        """Whether a safe state may have `written` values, or else `possible` ones; of an unknown variable every one."""
        axes = [(possible[name], written.get(name)) for name in self._safe.names]
        children: dict[int, tuple[bool, list[int]]] = {}  # whether every one of them must be, and which
        pending = [self._safe.root]
        while pending:
            reference = pending.pop()
            if reference in children or reference < FIRST_NODE:
                continue
            axis, branches = self._safe.nodes[reference - FIRST_NODE]
            values, instead = axes[axis]
            if instead is None and values == {None}:
                children[reference] = True, list(branches)
            else:
                positions = self._positions[axis]
                known = (value for value in instead or values if value is not None)
                children[reference] = False, [branches[positions[value]] for value in known]
            pending.extend(children[reference][1])
        self._left -= len(children)
        may = {NOTHING: False, EVERYTHING: True}
        for reference in sorted(children):  # a node comes after those it refers to
            every, below = children[reference]
            may[reference] = (all if every else any)(may[each] for each in below)
        return may[self._safe.root]

    @cached_property
    def _positions(self) -> tuple[dict[Value, int], ...]:
        return tuple({value: place for place, value in enumerate(domain)} for domain in self._safe.domains)
