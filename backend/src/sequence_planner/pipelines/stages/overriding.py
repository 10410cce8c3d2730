"""`override`: a person's live values, within bounds, for a while."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from sequence_planner.expressions.resolution import suggestion
from sequence_planner.expressions.types import IntegerRange
from sequence_planner.pipelines.record import FieldType, Record
from sequence_planner.pipelines.stage import Override
from sequence_planner.pipelines.stages.mapping import is_same
from sequence_planner.pipelines.stages.transparent import TransparentStage, again
from sequence_planner.pipelines.stages.values import as_written, fits, shown


@dataclass(frozen=True)
class Bounds:
    """Which values are allowed: the numbers `between` two, or one of `among`."""

    between: tuple[float, float] | None = None
    among: tuple[object, ...] = ()

    def allow(self, type_: FieldType, value: object) -> bool:
        """Whether a field of `type_` may be given `value`."""
        if not fits(type_, value):
            return False
        if self.between is None:
            return any(is_same(value, allowed) for allowed in self.among)
        return isinstance(value, int | float) and self.between[0] <= value <= self.between[1]

    def described(self, type_: FieldType) -> str:
        """What a field of `type_` may be given, for people."""
        if self.between is None:
            return f"one of {', '.join(map(as_written, self.among))}"
        kind = "an integer" if isinstance(type_, IntegerRange) else "a number"
        return f"{kind} from {self.between[0]:g} to {self.between[1]:g}"


@dataclass(frozen=True)
class OverrideStage(TransparentStage):
    """Fields that a person may set, each within its bounds, for so many seconds."""

    name: str
    bounds: Mapping[str, Bounds]
    expires: float
    kind: ClassVar[str] = "override"

    def begin(self) -> OverrideCourse:
        """Begin with nothing set."""
        return OverrideCourse(self)

    def check(self, fields: Mapping[str, object]) -> None:
        """Raises ValueError, with what is allowed, unless all of these values are."""
        if not fields:
            raise ValueError(f"nothing is set: `{self.name}` has the fields {', '.join(self.bounds)}")
        for name, value in fields.items():
            if name not in self.bounds:
                near = suggestion(name, self.bounds) or f"; it has {', '.join(self.bounds)}"
                raise ValueError(f"`{self.name}` has no field `{name}`{near}")
            if not self.bounds[name].allow(self.gives[name], value):
                allowed = self.bounds[name].described(self.gives[name])
                raise ValueError(f"`{name}` cannot be {shown(value)}: it is {allowed}")


@dataclass(slots=True)
class OverrideCourse:
    """Has what is set, and the last record as it came."""

    stage: OverrideStage
    override: Override | None = None
    _last: Record | None = None

    @property
    def name(self) -> str:
        """What it is called where it is set."""
        return self.stage.name

    @property
    def due(self) -> float | None:
        """When what is set expires."""
        return None if self.override is None else self.override.until

    def take(self, record: Record, now: float) -> Record:
        """The record with what is set."""
        self._expire(now)
        self._last = again(record)
        return self._apply(record)

    def wake(self, now: float) -> Record | None:
        """The last record as it came, once what was set has expired."""
        return self._repeat() if self._expire(now) else None

    def set_override(self, fields: Mapping[str, object], now: float, actor: str) -> Record | None:
        """Set these fields and no others; returns the last record with them. Raises ValueError: nothing changes."""
        self.stage.check(fields)
        self.override = Override(dict(fields), actor, now + self.stage.expires)
        return self._repeat()

    def clear_override(self, now: float) -> Record | None:
        """Take back what is set; returns the last record as it came."""
        if self.override is None:
            return None
        self.override = None
        return self._repeat()

    def restore(self, override: Override) -> None:
        """Go on with what was set before the pipeline began afresh."""
        self.override = override

    def _expire(self, now: float) -> bool:
        if self.override is None or now < self.override.until:
            return False
        self.override = None
        return True

    def _repeat(self) -> Record | None:
        return None if self._last is None else self._apply(again(self._last))

    def _apply(self, record: Record) -> Record:
        self.stage.put(record, self.stage.get(record))
        if self.override is not None:
            record.values.update(self.override.fields)
        return record
