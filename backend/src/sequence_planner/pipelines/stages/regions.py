"""Named parts of a space of numbers: points with a tolerance, and ranges of a single number."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

from sequence_planner.pipelines.stages.values import is_number

Numbers = tuple[float, ...]


class Regions(Protocol):
    """Named regions. A margin widens a region on every side."""

    @property
    def names(self) -> tuple[str, ...]:
        """Their names, as written."""

    @property
    def axes(self) -> int:
        """How many numbers say a place."""

    def find(self, numbers: Numbers) -> str | None:
        """The region in which `numbers` are."""

    def holds(self, name: str, numbers: Numbers, margin: float) -> bool:
        """Whether `numbers` are in that region, widened by `margin`."""

    def inside(self, name: str) -> Numbers | None:
        """Numbers in that region, and `find` says so; None when there are none."""

    def outside(self, margin: float, start: Numbers | None) -> Numbers | None:
        """Numbers in no region, not even widened by `margin`: `start` or ones near it; None when there are none."""


def numbers_of(raw: object, axes: int) -> Numbers | None:
    """A field's value as a place; None when it is not as many finite numbers as there are axes."""
    numbers = raw if isinstance(raw, list) else [raw]
    if len(numbers) != axes or not all(map(is_number, numbers)):
        return None
    return tuple(map(float, numbers))


def distance(one: Numbers, other: Numbers) -> float:
    """How far they are apart on the axis on which they are furthest apart."""
    return max(abs(a - b) for a, b in zip(one, other, strict=True))


@dataclass(frozen=True)
class Points:
    """Points, each of which is reached when every number is within `tolerance` of its own: the nearest of several."""

    points: Mapping[str, Numbers]
    tolerance: float

    @property
    def names(self) -> tuple[str, ...]:
        """Their names, as written."""
        return tuple(self.points)

    @property
    def axes(self) -> int:
        """How many numbers say a place."""
        return len(next(iter(self.points.values())))

    def nearest(self, numbers: Numbers) -> str:
        """The nearest point, however far it is."""
        return min(self.points, key=lambda name: distance(self.points[name], numbers))

    def find(self, numbers: Numbers) -> str | None:
        """The point within whose tolerance `numbers` are."""
        name = self.nearest(numbers)
        return name if self.holds(name, numbers, 0.0) else None

    def holds(self, name: str, numbers: Numbers, margin: float) -> bool:
        """Whether `numbers` are within the tolerance of that point, widened by `margin`."""
        return distance(self.points[name], numbers) <= self.tolerance + margin

    def inside(self, name: str) -> Numbers | None:
        """The point itself."""
        return self.points[name]

    def outside(self, margin: float, start: Numbers | None) -> Numbers | None:
        """`start`, by default the first point, moved along the first axis until it is at no point."""
        numbers = start or next(iter(self.points.values()))
        step = 2 * (self.tolerance + margin)
        while any(self.holds(name, numbers, margin) for name in self.points):
            numbers = (numbers[0] + step, *numbers[1:])
            step *= 2
        return numbers


@dataclass(frozen=True)
class Ranges:
    """Ranges of a single number, bounds included; None where there is no bound. Of two that touch the first counts."""

    ranges: Mapping[str, tuple[float | None, float | None]]

    @property
    def names(self) -> tuple[str, ...]:
        """Their names, as written."""
        return tuple(self.ranges)

    @property
    def axes(self) -> int:
        """One."""
        return 1

    def find(self, numbers: Numbers) -> str | None:
        """The first range in which the number is."""
        return next((name for name in self.ranges if self.holds(name, numbers, 0.0)), None)

    def holds(self, name: str, numbers: Numbers, margin: float) -> bool:
        """Whether the number is in that range, widened by `margin`."""
        least, greatest = self.ranges[name]
        (number,) = numbers
        return (least is None or least - margin <= number) and (greatest is None or number <= greatest + margin)

    def inside(self, name: str) -> Numbers | None:
        """The middle of that range, or a number well within it where it has one bound or none."""
        least, greatest = self.ranges[name]
        if least is None or greatest is None:
            tried = 0.0 if least is greatest is None else least + 1 if least is not None else (greatest or 0.0) - 1
        else:
            tried = (least + greatest) / 2
        return (tried,) if self.find((tried,)) == name else None

    def outside(self, margin: float, start: Numbers | None) -> Numbers | None:
        """`start`, or a number between two ranges or beyond them."""
        bounds = sorted(bound for pair in self.ranges.values() for bound in pair if bound is not None)
        gaps = [(a + b) / 2 for a, b in pairwise(bounds)]
        beyond = [bounds[0] - 1 - 2 * margin, bounds[-1] + 1 + 2 * margin] if bounds else []
        for tried in [*([] if start is None else start), *gaps, *beyond]:
            if not any(self.holds(name, (tried,), margin) for name in self.ranges):
                return (tried,)
        return None
