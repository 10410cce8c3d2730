"""Notes for the journal of how the station stands: its PackML state, and what each of its jobs waits for.

Nothing follows from them; whoever reads the journal, as what tells a MES of events does, need not find out itself. What
lasts for a moment alone is not noted, so that a plan that is made anew is none.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final, Generic, TypeVar

from pydantic import JsonValue

from sequence_planner.control.moment import Moment
from sequence_planner.control.view import PackML

PACKML: Final = "packml"  # of the records
JOB_WAITS: Final = "job-waits"
PACKML_LASTS: Final = 1.0  # seconds after which it is noted
WAITS_LAST: Final = 5.0
LOOK_EVERY: Final = 0.5  # seconds

Tell = Callable[[str, Mapping[str, JsonValue]], None]
T = TypeVar("T")


class _Steady(Generic[T]):
    """Says once of each value that lasted for so long, and since when (seconds since the epoch)."""

    def __init__(self, lasts: float) -> None:
        self._lasts = lasts
        self._told: list[T] = []  # one, or none
        self._seen: tuple[T, Moment] | None = None

    def see(self, value: T, now: Moment) -> tuple[T, float] | None:
        """The value, where it is to be told now."""
        if self._seen is None or self._seen[0] != value:
            self._seen = value, now
        since = self._seen[1]
        if [value] == self._told or now.monotonic - since.monotonic < self._lasts:
            return None
        self._told = [value]
        return value, since.epoch


class StandingNotes:
    """Tells `tell` how the station stands, whenever that has changed for good."""

    def __init__(self, tell: Tell) -> None:
        self._tell = tell
        self._packml: _Steady[PackML] = _Steady(PACKML_LASTS)
        self._jobs: dict[str, _Steady[list[str]]] = {}
        self._looked = float("-inf")

    def due(self, now: Moment) -> bool:
        """Whether it is time for another look, which counts as taken."""
        if now.monotonic - self._looked < LOOK_EVERY:
            return False
        self._looked = now.monotonic
        return True

    def look(self, packml: PackML, waits: Mapping[str, list[str]], now: Moment) -> None:
        """Take note of how it stands now."""
        if (changed := self._packml.see(packml, now)) is not None:
            self._tell(PACKML, {"state": changed[0].value, "since": changed[1]})
        self._jobs = {job: self._jobs.get(job) or _Steady(WAITS_LAST) for job in waits}
        for job, steady in self._jobs.items():
            if (told := steady.see(waits[job], now)) is not None:
                texts: list[JsonValue] = [*told[0]]
                self._tell(JOB_WAITS, {"job": job, "waits_for": texts, "since": told[1]})
