"""Alarms that come and go: one that does so often is one alarm that lasts."""

from __future__ import annotations

from collections import deque

OFTEN = 3  # times that an alarm comes ..
WITHIN = 60.0  # .. in so many seconds: then it comes and goes
QUIET = 15.0  # seconds for which the cause of such an alarm must be away before it counts as gone


class Arrivals:
    """When the alarms have come, as long as that matters; also those that are gone by now. On the monotonic clock."""

    def __init__(self) -> None:
        self._times: dict[str, deque[float]] = {}

    def note(self, key: str, monotonic: float) -> None:
        """The cause of an alarm has come."""
        self._times.setdefault(key, deque(maxlen=OFTEN)).append(monotonic)

    def quiet(self, key: str) -> float:
        """For how many seconds its cause must be away, so that the alarm counts as gone."""
        times = self._times.get(key)
        often = times is not None and len(times) == OFTEN and times[-1] - times[0] <= WITHIN
        return QUIET if often else 0.0

    def forget(self, monotonic: float) -> None:
        """Drop what is too old to matter."""
        old = [key for key, times in self._times.items() if monotonic - times[-1] > WITHIN + QUIET]
        for key in old:
            del self._times[key]
