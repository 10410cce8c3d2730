"""What a supervisor may allow where variables have gathered values: what it never allows from there never starts."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

from sequence_planner.automaton.state_set import EVERYTHING, StateSet, Supervisor
from sequence_planner.automaton.structure import target
from sequence_planner.automaton.transitions import Phase, Transition
from sequence_planner.expressions.syntax import Constant
from sequence_planner.expressions.types import Value

_FIRST_NODE = 2  # the references before it are those of nothing and of everything


class Permission:
    """Looks up a supervisor's safe states. It says yes too often and never too seldom."""

    def __init__(self, supervisor: Supervisor) -> None:
        self._safe: StateSet = supervisor.safe

    def may(self, move: Transition, possible: Mapping[str, set[Value | None]]) -> bool:
        """Whether `move` may be taken from a safe state and lead to one, as far as `possible` values tell."""
        if move.phase is not Phase.START or self._safe.root == EVERYTHING:
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
        known = {0: False, 1: True}
        axes = [(possible[name], written.get(name)) for name in self._safe.names]

        def may(reference: int) -> bool:
            if reference not in known:
                axis, children = self._safe.nodes[reference - _FIRST_NODE]
                values, instead = axes[axis]
                if instead is None and values == {None}:
                    known[reference] = all(may(child) for child in children)
                else:
                    positions = self._positions[axis]
                    known[reference] = any(
                        may(children[positions[value]]) for value in instead or values if value is not None
                    )
            return known[reference]

        return may(self._safe.root)

    @cached_property
    def _positions(self) -> tuple[dict[Value, int], ...]:
        return tuple({value: place for place, value in enumerate(domain)} for domain in self._safe.domains)
