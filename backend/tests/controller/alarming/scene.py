"""Alarms as they are made at a station, and what they tell the journal."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import dataclass, field

from pydantic import JsonValue

from sequence_planner.controller.alarms.manager import AlarmManager
from sequence_planner.controller.commands.alarms import (
    AcknowledgeAlarm,
    AlarmCommand,
    RestoreAlarm,
    ShelveAlarm,
    SuppressAlarm,
    UnshelveAlarm,
)
from sequence_planner.controller.io.inputs import Inputs
from sequence_planner.controller.io.network import NetworkWatch
from sequence_planner.controller.io.outputs import Outputs
from sequence_planner.controller.recovery.safe_state import SafeStateMonitor
from sequence_planner.controller.restore import RestoredState
from sequence_planner.core.actor import SYSTEM
from sequence_planner.execution.executor import Executor
from sequence_planner.ros.transports.memory import MemoryNetwork
from sequence_planner.station import ReadyStation
from support.simulated import Rig


@dataclass
class Told:
    """What the journal was told."""

    notes: list[tuple[str, Mapping[str, JsonValue]]] = field(default_factory=list)

    def __call__(self, kind: str, content: Mapping[str, JsonValue]) -> None:
        self.notes.append((kind, content))

    @property
    def events(self) -> list[tuple[JsonValue, JsonValue]]:
        """Which alarm, and what has become of it."""
        return [(content["alarm"], content["event"]) for kind, content in self.notes if kind == "alarm"]


def commander(station: ReadyStation) -> Outputs:
    """One that sends to a network on which nobody listens."""

    async def join() -> Outputs:
        transport = MemoryNetwork().join(station.registry, "sequence_planner", asyncio.get_running_loop())
        return Outputs(station.pipelines.outgoing, station.registry, transport)

    return asyncio.run(join())


def alarms_of(
    execution: Executor,
    station: ReadyStation,
    told: Told | None = None,
    known: RestoredState | None = None,
    feeds: Inputs | None = None,
) -> AlarmManager:
    """The alarms of a station of which no device has been heard yet; those of `feeds` may have been."""
    feeds = feeds or Inputs(station.pipelines, station.registry)
    network = NetworkWatch(station.pipelines, station.registry)
    return AlarmManager(
        execution, SafeStateMonitor(execution), feeds, network, commander(station), told or Told(), known
    )


def alarms(rig: Rig, known: RestoredState | None = None) -> AlarmManager:
    """The alarms of the station of a rig."""
    return alarms_of(rig.execution, rig.station, known=known)


def acknowledge(alarm: str, since: float) -> AlarmCommand:
    return AcknowledgeAlarm(actor=SYSTEM, alarm=alarm, since=since)


def shelve(alarm: str, seconds: float) -> AlarmCommand:
    return ShelveAlarm(actor=SYSTEM, alarm=alarm, seconds=seconds, reason="it is known")


def unshelve(alarm: str) -> AlarmCommand:
    return UnshelveAlarm(actor=SYSTEM, alarm=alarm)


def suppress(alarm: str) -> AlarmCommand:
    return SuppressAlarm(actor=SYSTEM, alarm=alarm, reason="the sensor is broken")


def restore(alarm: str) -> AlarmCommand:
    return RestoreAlarm(actor=SYSTEM, alarm=alarm)
