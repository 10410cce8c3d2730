"""Decisions about the calls of a service: for each rise of an output, every so often, and one at a time.

Pure: it calls nothing, and is told the time.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class CallCourse:
    """One service, called `every` so many seconds, or only for rises where that is None."""

    every: float | None
    _wanted: bool | None = None  # the output as last seen; its first value is no rise
    _waiting: bool = False  # a rise has not been answered with a call yet
    _begun: float | None = None  # when a call was begun last
    _busy: bool = False
    _outdated: bool = False  # the call under way was begun before the output rose or fell

    def heed(self, wanted: bool) -> bool:
        """The output is so now; returns whether it rises or falls. What was asked before then counts no more."""
        was, self._wanted = self._wanted, wanted
        if was is None or was == wanted:
            return False
        self._waiting = wanted
        self._outdated = self._busy
        return True

    def is_due(self, now: float) -> bool:
        """Whether to call now."""
        if self._busy:
            return False
        is_time = self.every is not None and (self._begun is None or now - self._begun >= self.every)
        return self._waiting or is_time

    def begin(self, now: float) -> None:
        """A call is begun."""
        self._busy, self._waiting, self._outdated, self._begun = True, False, False, now

    def end(self) -> bool:
        """The call under way has ended; returns whether what came of it counts."""
        self._busy = False
        return not self._outdated
