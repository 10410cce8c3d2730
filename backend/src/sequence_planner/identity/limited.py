"""Refusals by a limit, gathered for the journal: whoever floods the door does not flood the journal as well."""

from __future__ import annotations

import threading
from dataclasses import dataclass

from sequence_planner.identity.attempts import Counter
from sequence_planner.journal.entry import Entry

EVERY = 60.0  # seconds between two entries for one name or address


@dataclass(frozen=True)
class _Gathered:
    """Refusals by one counter that no entry tells of yet, and when the last entry was written."""

    entry: Entry
    number: int
    told: float | None


class Limited:
    """The first refusal of a name or an address is told at once, further ones together a minute later.

    Only who has been counted is refused, and that is limited itself, so this does not grow without end.
    """

    def __init__(self) -> None:
        self._gathered: dict[Counter, _Gathered] = {}
        self._lock = threading.Lock()

    def note(self, counter: Counter, entry: Entry, now: float) -> None:
        """Somebody was refused; of several, `entry` tells of the last."""
        with self._lock:
            before = self._gathered.get(counter)
            number, told = (0, None) if before is None else (before.number, before.told)
            self._gathered[counter] = _Gathered(entry, number + 1, told)

    def due(self, now: float) -> bool:
        """Whether there is something to tell."""
        with self._lock:
            return any(_due(each, now) for each in self._gathered.values())

    def take(self, now: float) -> list[Entry]:
        """The entries that are due, each with the number of refusals that it stands for."""
        with self._lock:
            due = {counter: each for counter, each in self._gathered.items() if _due(each, now)}
            later = {key: each for key, each in self._gathered.items() if each.number or _recent(each, now)}
            self._gathered = {**later, **{key: _Gathered(each.entry, 0, now) for key, each in due.items()}}
        return [
            each.entry.model_copy(update={"details": {**each.entry.details, "times": each.number}})
            for each in due.values()
        ]


def _due(gathered: _Gathered, now: float) -> bool:
    return gathered.number > 0 and not _recent(gathered, now)


def _recent(gathered: _Gathered, now: float) -> bool:
    return gathered.told is not None and abs(now - gathered.told) < EVERY
