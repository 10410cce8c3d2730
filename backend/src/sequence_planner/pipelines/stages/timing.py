"""`debounce`, `limit`, `tick` and `timeout`: when values count, and when records go on."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from sequence_planner.pipelines.record import Record
from sequence_planner.pipelines.stages.transparent import TransparentStage, again

_NOTHING = Record({})


@dataclass(frozen=True)
class DebounceStage(TransparentStage):
    """A new value of the fields together counts when it has been there for `seconds`; until then the old one does.

    The first one counts at once, for there is no old one; what becomes unknown is so at once.
    """

    seconds: float
    kind: ClassVar[str] = "debounce"

    def begin(self) -> DebounceCourse:
        """Begin with no value that counts."""
        return DebounceCourse(self)


@dataclass(slots=True)
class DebounceCourse:
    """Has the values that count and, with the time when they came, those that may soon."""

    stage: DebounceStage
    due: float | None = None
    _counting: tuple[object, ...] | None = None
    _coming: tuple[object, ...] = ()
    _last: Record = field(default_factory=lambda: _NOTHING)

    def take(self, record: Record, now: float) -> Record:
        """The record with the values that count."""
        self._settle(now)
        values = self.stage.get(record)
        counting = values if self._counting is None else self._counting
        counting = tuple(None if new is None else old for old, new in zip(counting, values, strict=True))
        if values == counting:
            self.due = None
        elif self.due is None or values != self._coming:
            self._coming, self.due = values, now + self.stage.seconds
        self._counting = counting
        self._last = again(record)
        return self.stage.put(record, counting)

    def wake(self, now: float) -> Record | None:
        """The last record with the values that have been there for long enough."""
        return self.stage.put(again(self._last), self._counting or ()) if self._settle(now) else None

    def _settle(self, now: float) -> bool:
        if self.due is None or now < self.due:
            return False
        self._counting, self.due = self._coming, None
        return True


@dataclass(frozen=True)
class LimitStage(TransparentStage):
    """At most one record in `every` seconds, the newest; the last one held back goes on when its time comes."""

    every: float
    kind: ClassVar[str] = "limit"

    def begin(self) -> LimitCourse:
        """Begin with the way free."""
        return LimitCourse(self)


@dataclass(slots=True)
class LimitCourse:
    """Has the record held back, and from when on the next may go."""

    stage: LimitStage
    _free: float | None = None
    _held: Record | None = None

    @property
    def due(self) -> float | None:
        """When the record held back may go."""
        return None if self._held is None else self._free

    def take(self, record: Record, now: float) -> Record | None:
        """The record, if enough time has passed since the last."""
        if self._held is not None:  # what made no sense is not lost with the record that is
            record.troubles = record.troubles or self._held.troubles
        self._held = record
        return self.wake(now)

    def wake(self, now: float) -> Record | None:
        """The record held back, if its time has come."""
        if self._held is None or (self._free is not None and now < self._free):
            return None
        record, self._held = self._held, None
        self._free = now + self.stage.every
        return record


@dataclass(frozen=True)
class TickStage(TransparentStage):
    """The last record again, `every` so many seconds after it last went on."""

    every: float
    kind: ClassVar[str] = "tick"

    def begin(self) -> TickCourse:
        """Begin with no record."""
        return TickCourse(self)


@dataclass(slots=True)
class TickCourse:
    """Has the last record."""

    stage: TickStage
    due: float | None = None
    _last: Record = field(default_factory=lambda: _NOTHING)

    def take(self, record: Record, now: float) -> Record:
        """The record, at once."""
        self._last = again(record)
        self.due = now + self.stage.every
        return record

    def wake(self, now: float) -> Record | None:
        """The last record again."""
        if self.due is None or now < self.due:
            return None
        self.due = now + self.stage.every
        return again(self._last)


@dataclass(frozen=True)
class TimeoutStage(TransparentStage):
    """The fields are unknown when no record has come for `seconds`."""

    seconds: float
    kind: ClassVar[str] = "timeout"

    def begin(self) -> TimeoutCourse:
        """Begin with no record."""
        return TimeoutCourse(self)


@dataclass(slots=True)
class TimeoutCourse:
    """Has the last record, and when it counts no more."""

    stage: TimeoutStage
    due: float | None = None
    _last: Record = field(default_factory=lambda: _NOTHING)

    def take(self, record: Record, now: float) -> Record:
        """The record as it is."""
        self._last = again(record)
        self.due = now + self.stage.seconds
        return self.stage.put(record, self.stage.get(record))

    def wake(self, now: float) -> Record | None:
        """The last record, its fields unknown."""
        if self.due is None or now < self.due:
            return None
        self.due = None
        return self.stage.put(again(self._last), (None,) * len(self.stage.fields))
