"""What a MES is told of the station itself, as the records of the run's journal are read one after the other: stops,
faults, the states of PackML, and what its orders wait for.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

from pydantic import BaseModel, ConfigDict, JsonValue

from sequence_planner.control.happenings import ErrandStopped, ErrandTaken, ModeChanged, ProductionStarted
from sequence_planner.control.standing_notes import JOB_WAITS, PACKML
from sequence_planner.history.codec import BEGUN, SNAPSHOT, kind_of
from sequence_planner.history.line import ALARM
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.mes.events import EventKind

_STARTED: Final = kind_of(ProductionStarted)
_MODES: Final = frozenset(map(kind_of, (ModeChanged, ErrandTaken, ErrandStopped)))
_OF_ALARMS: Final = ("priority", "text", "consequence", "action")


@dataclass(frozen=True)
class Told:
    """An event to be, of a job order or of the station."""

    kind: EventKind
    job_order: str | None
    time: float
    content: Mapping[str, JsonValue]


class StationStanding(BaseModel):
    """How the station stands, as far as it was told: alarms that last by their keys, and what jobs wait for."""

    model_config = ConfigDict(frozen=True, extra="forbid")
    mode: str | None = None
    packml: str | None = None
    alarms: dict[str, dict[str, JsonValue]] = {}
    waits: dict[str, list[str]] = {}

    def after(self, record: RunRecord) -> tuple[StationStanding, list[Told]]:
        """How it stands after a record, and what is to be told."""
        reader = _READERS.get(record.kind)
        if reader is None:
            return self, []
        changes: dict[str, Any] = {}
        told = list(reader(self, record.time, json.loads(record.content), changes))
        return (self.model_copy(update=changes) if changes else self), told

    def without(self, job: str) -> StationStanding:
        """Where a job is over, nothing is waited for any more."""
        if job not in self.waits:
            return self
        return self.model_copy(update={"waits": {id_: waits for id_, waits in self.waits.items() if id_ != job}})

    def _begun(self, time: float, content: Mapping[str, Any], changes: dict[str, Any]) -> Iterator[Told]:
        """The controller was started anew: nothing of before is an alarm, and production is not started."""
        mode = content.get("mode")
        told: dict[str, JsonValue] = {"mode": mode}
        yield Told(EventKind.CONTROLLER_STARTED, None, time, told)
        for key, alarm in self.alarms.items():
            yield Told(EventKind.ALARM_ENDED, None, time, {"alarm": key, **alarm})
        changes |= {"mode": mode, "packml": None, "alarms": {}}

    def _whole(self, time: float, content: Mapping[str, Any], changes: dict[str, Any]) -> Iterator[Told]:
        """Where reading begins with a snapshot, that says the mode."""
        if self.mode is None:
            changes["mode"] = content.get("mode")
        yield from ()

    def _mode(self, time: float, content: Mapping[str, Any], changes: dict[str, Any]) -> Iterator[Told]:
        mode = content.get("mode")
        if mode is None or mode == self.mode:
            return
        by = content.get("what", {}).get("by")
        changes["mode"] = mode
        yield Told(EventKind.MODE_CHANGED, None, time, {"mode": mode, "before": self.mode, "by": by})

    def _production(self, time: float, content: Mapping[str, Any], changes: dict[str, Any]) -> Iterator[Told]:
        yield Told(EventKind.PRODUCTION_STARTED, None, time, {"mode": self.mode})

    def _packml(self, time: float, content: Mapping[str, Any], changes: dict[str, Any]) -> Iterator[Told]:
        state = content["state"]
        if state != self.packml:
            changes["packml"] = state
            told: dict[str, JsonValue] = {"state": state, "before": self.packml}
            yield Told(EventKind.PACKML_CHANGED, None, content["since"], told)

    def _alarm(self, time: float, content: Mapping[str, Any], changes: dict[str, Any]) -> Iterator[Told]:
        key, lasts = content["alarm"], content.get("ended") is None
        if lasts == (key in self.alarms):
            return
        alarm: dict[str, JsonValue] = {name: content.get(name) for name in _OF_ALARMS}
        changes["alarms"] = {name: each for name, each in self.alarms.items() if name != key}
        if lasts:
            changes["alarms"][key] = alarm
        yield Told(EventKind.ALARM_RAISED if lasts else EventKind.ALARM_ENDED, None, time, {"alarm": key, **alarm})

    def _waits(self, time: float, content: Mapping[str, Any], changes: dict[str, Any]) -> Iterator[Told]:
        job, waits = content["job"], content["waits_for"]
        if waits != self.waits.get(job, []):
            changes["waits"] = {**self.waits, job: waits}
            yield Told(EventKind.WAITS, job, content["since"], {"waits_for": waits})


_READERS: Final = {
    BEGUN: StationStanding._begun,
    SNAPSHOT: StationStanding._whole,
    _STARTED: StationStanding._production,
    PACKML: StationStanding._packml,
    ALARM: StationStanding._alarm,
    JOB_WAITS: StationStanding._waits,
    **dict.fromkeys(_MODES, StationStanding._mode),
}
