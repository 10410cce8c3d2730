"""Calling running abilities off, by the `cancel` actions that they declare."""

from __future__ import annotations

from collections.abc import Iterable

from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.automaton.tick import Writes, conflicts_of, writes


def cancelled(automaton: Automaton, state: State, names: Iterable[str]) -> tuple[tuple[str, ...], Writes]:
    """Which of the abilities can be called off, and what that writes; all at once, on the state before.

    Those that declare no cancel actions cannot. Of two that would write different values the one declared first is.
    """
    wanted = set(names)
    candidates: dict[str, Writes] = {}
    for ability in automaton.abilities.values():
        if ability.name in wanted and ability.cancel_actions:
            written = writes(ability.cancel_actions, state)
            if written is not None:
                candidates[ability.name] = written
    refused = {other for _, other, _ in conflicts_of(candidates)}
    called_off = tuple(name for name in candidates if name not in refused)
    together: Writes = {}
    for name in called_off:
        together |= candidates[name]
    return called_off, together
