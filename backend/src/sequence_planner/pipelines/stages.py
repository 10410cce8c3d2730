"""The stages: how fields of a message and variables of a resource correspond.

A record is a message as a dict of plain values. `read` goes from record to variables, `write` from variables to record.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from sequence_planner.automaton.structure import State
from sequence_planner.expressions.types import Type, Value, contains

Record = Mapping[str, object]


@dataclass
class Reading:
    """What a message says: values (None: unknown) and what in it made no sense."""

    values: dict[str, Value | None] = field(default_factory=dict)
    troubles: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class FieldStage:
    """A field and a variable of the same meaning."""

    field: str
    variable: str
    type: Type

    def read(self, record: Record, reading: Reading) -> None:
        """The variable takes the field's value; one outside its domain makes it unknown."""
        value = record[self.field]
        if contains(self.type, value):
            assert isinstance(value, bool | int | str)
            reading.values[self.variable] = value
        else:
            reading.values[self.variable] = None
            reading.troubles.append(f"{self.field} is {value!r}, and {self.variable} ranges over {self.type}")

    def write(self, state: State, record: dict[str, object]) -> None:
        """The field takes the variable's value, where it is known."""
        if (value := state[self.variable]) is not None:
            record[self.field] = value


@dataclass(frozen=True)
class Coordinates:
    """Named points in a space of numbers."""

    points: Mapping[str, tuple[float, ...]]

    def numbers(self, raw: object) -> tuple[float, ...] | None:
        """A field's value as a place in this space; None when it is not as many finite numbers as there are axes."""
        numbers = tuple(float(number) for number in raw) if isinstance(raw, list) else ()
        axes = len(next(iter(self.points.values())))
        return numbers if len(numbers) == axes and all(map(math.isfinite, numbers)) else None

    def nearest(self, numbers: tuple[float, ...], tolerance: float) -> str | None:
        """The point whose every coordinate is within `tolerance` of `numbers`, the nearest of several, or None."""
        distances = {
            name: max(abs(a - b) for a, b in zip(point, numbers, strict=True)) for name, point in self.points.items()
        }
        name = min(distances, key=distances.__getitem__)
        return name if distances[name] <= tolerance else None


@dataclass(frozen=True)
class DiscretiseStage:
    """Numbers become the name of the point they are at, or `otherwise`."""

    field: str
    variable: str
    coordinates: Coordinates
    tolerance: float
    otherwise: str

    def read(self, record: Record, reading: Reading) -> None:
        """The variable becomes the point's name; numbers that are none make it unknown."""
        numbers = self.coordinates.numbers(record[self.field])
        if numbers is None:
            reading.values[self.variable] = None
            reading.troubles.append(f"{self.field} is no position: {record[self.field]!r}")
            return
        reading.values[self.variable] = self.coordinates.nearest(numbers, self.tolerance) or self.otherwise


@dataclass(frozen=True)
class RememberStage:
    """A variable keeps the last value of another, but for some values. Its memory is the reader's."""

    variable: str
    of: str
    ignored: frozenset[str]

    def read(self, memory: dict[str, Value | None], reading: Reading) -> None:
        """Take the new value if it counts; `memory` lasts from message to message."""
        value = reading.values.get(self.of)
        if value is not None and value not in self.ignored:
            memory[self.variable] = value
        reading.values[self.variable] = memory.get(self.variable)


@dataclass(frozen=True)
class UndiscretiseStage:
    """A name becomes the coordinates of its point."""

    variable: str
    field: str
    coordinates: Coordinates

    def write(self, state: State, record: dict[str, object]) -> None:
        """The field takes the coordinates."""
        value = state[self.variable]
        if isinstance(value, str):
            record[self.field] = list(self.coordinates.points[value])

    def read(self, record: Record, reading: Reading) -> None:
        """The variable is the name of the nearest point: a command is always one of them, but for rounding."""
        numbers = self.coordinates.numbers(record[self.field])
        reading.values[self.variable] = None if numbers is None else self.coordinates.nearest(numbers, math.inf)
        if numbers is None:
            reading.troubles.append(f"{self.field} is no position: {record[self.field]!r}")


@dataclass(frozen=True)
class ConstantStage:
    """Fields that never change."""

    fields: Mapping[str, object]

    def write(self, record: dict[str, object]) -> None:
        """Set them."""
        record.update(self.fields)
