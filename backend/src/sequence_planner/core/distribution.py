"""Counts of how often something took how long."""

from __future__ import annotations

from bisect import bisect_left


class Distribution:
    """Counts what took at most so many seconds, for each of the rising `bounds`, and what took longer than all."""

    __slots__ = ("bounds", "counts", "seconds")

    def __init__(self, bounds: tuple[float, ...]) -> None:
        self.bounds = bounds
        self.counts = [0] * (len(bounds) + 1)  # each without those before it
        self.seconds = 0.0  # in all

    def note(self, seconds: float) -> None:
        """Something took so long."""
        self.counts[bisect_left(self.bounds, seconds)] += 1
        self.seconds += seconds
