"""Flags and the variables that they follow."""

from __future__ import annotations

from collections.abc import Iterable

from sequence_planner.automaton.automaton import Automaton, Flag


class FollowingFlags:
    """The flags of an automaton by what they depend on."""

    def __init__(self, automaton: Automaton) -> None:
        self._flags = automaton.flags
        self._readers = automaton.flag_readers

    def flags(self, names: Iterable[str]) -> list[Flag]:
        """The flags that can change when the variables `names` do, in their order."""
        found: dict[int, None] = {}
        pending = list(names)
        while pending:
            for number in self._readers.get(pending.pop(), ()):
                if number not in found:
                    found[number] = None
                    pending.append(self._flags[number].name)
        return [self._flags[number] for number in sorted(found)]
