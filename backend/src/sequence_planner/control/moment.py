"""An instant on both clocks: one that people read, and one that never goes back."""

from __future__ import annotations

import time
from dataclasses import dataclass


@dataclass(frozen=True)
class Moment:
    """`epoch` in seconds since the epoch; `monotonic` in seconds of `time.monotonic`, as samples carry them."""

    epoch: float
    monotonic: float

    @classmethod
    def now(cls) -> Moment:
        """This instant."""
        return cls(time.time(), time.monotonic())

    def epoch_of(self, monotonic: float | None) -> float | None:
        """Seconds since the epoch of an instant on the other clock."""
        return None if monotonic is None else self.epoch - (self.monotonic - monotonic)
