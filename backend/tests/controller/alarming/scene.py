"""Alarms as they are made at a station, and what they tell the journal."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from pydantic import JsonValue

from sequence_planner.controller.alarms.beginning import Beginning
from sequence_planner.controller.alarms.consequences import Consequences
from sequence_planner.controller.alarms.kinds import Cause
from sequence_planner.controller.alarms.manager import AlarmManager
from sequence_planner.controller.alarms.model_conditions import ModelAlarms
from sequence_planner.controller.commands.alarms import (
    AcknowledgeAlarm,
    AlarmCommand,
    RestoreAlarm,
    ShelveAlarm,
    SuppressAlarm,
    UnshelveAlarm,
)
from sequence_planner.controller.features.abilities import Abilities
from sequence_planner.controller.features.commissioning.forces import Forces
from sequence_planner.controller.features.plan import LivePlan
from sequence_planner.controller.features.records import unwritten
from sequence_planner.controller.features.tasks import OpenTasks, TaskHandler
from sequence_planner.controller.features.variables import Beliefs
from sequence_planner.controller.io.inputs import Inputs
from sequence_planner.controller.io.links import DeviceLinks
from sequence_planner.controller.io.network import NetworkWatch
from sequence_planner.controller.io.outputs import Outputs
from sequence_planner.controller.recovery.consistency import ConsistencyMonitor
from sequence_planner.controller.recovery.explain import ConditionContext
from sequence_planner.controller.recovery.manual import ByHand
from sequence_planner.controller.recovery.operator_plans import OperatorPlans
from sequence_planner.controller.recovery.safe_state import SafeStateMonitor
from sequence_planner.controller.recovery.stalls import StallDetector
from sequence_planner.controller.recovery.who_can import WhoCan
from sequence_planner.controller.restore import RestoredState
from sequence_planner.controller.views.station import AlarmView
from sequence_planner.core.actor import SYSTEM
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.events import TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.ros.transports.memory import MemoryNetwork
from sequence_planner.station import ReadyStation
from support.simulated import Rig


@dataclass
class Told:
    """What the journal was told."""

    notes: list[tuple[str, Mapping[str, JsonValue]]] = field(default_factory=list)

    def __call__(self, kind: str, content: Mapping[str, JsonValue], *, lasts: bool = False) -> None:
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


class Scene:
    """The alarms of a station, and the features that have them; what these would find out by themselves a test says.

    No device has been heard yet; those of `feeds` may have been.
    """

    def __init__(
        self,
        execution: Executor,
        station: ReadyStation,
        told: Told | None = None,
        known: RestoredState | None = None,
        feeds: Inputs | None = None,
        network: NetworkWatch | None = None,
        outputs: Outputs | None = None,
        tasks: TaskHandler | None = None,
    ) -> None:
        known, tasks = known or RestoredState(), tasks or TaskHandler(execution.automaton)
        feeds = feeds or Inputs(station.pipelines, station.registry)
        network = network or NetworkWatch(station.pipelines, station.registry)
        outside, who_can = SafeStateMonitor(execution), WhoCan(execution)
        self._consequences = consequences = Consequences(execution, who_can)
        self.trouble: str | None = None
        """What is wrong with the planner."""
        self.unjournalled: str | None = None
        self.unrecorded: str | None = None
        """Why what happens, and why commands, cannot be recorded."""
        self.links = DeviceLinks(execution, feeds, network, outputs or commander(station), who_can, consequences)
        self.abilities = Abilities(execution, feeds, StallDetector(execution, lambda: outside.certain), consequences)
        self.consistency = ConsistencyMonitor(execution, untold=lambda: self.links.untold)
        self.by_hand = ByHand(execution, station.pipelines, lambda kind, content: None)
        around = ConditionContext(feeds.heard_on, lambda name: None, Beliefs(execution), dict)
        self.alarms = AlarmManager(execution, outside, told or Told(), known)
        self.alarms.look_at(
            (
                self.links,
                self.abilities,
                OperatorPlans(execution, feeds.heard_on),
                LivePlan(execution, consequences, around, lambda: self.trouble, lambda: self.links.untold),
                self,
                outside,
                Beginning(execution, known),
                self.consistency,
                Forces(execution),
                OpenTasks(execution, tasks, lambda: False, consequences.waiting_for),
                self.by_hand,
                ModelAlarms(execution),
            )
        )

    def causes(self, moment: Timestamp) -> Iterator[Cause]:
        """What the journal does not have."""
        return unwritten(self._consequences, self.unjournalled, self.unrecorded, None)

    def note(self, outcome: TickOutcome) -> None:
        """After a tick."""
        self.abilities.after_tick(outcome, Timestamp(0.0, 0.0))

    def current(self, moment: Timestamp) -> dict[str, AlarmView]:
        """All alarms now."""
        return self.alarms.current(moment)


def alarms(rig: Rig, known: RestoredState | None = None) -> Scene:
    """The alarms of the station of a rig."""
    return Scene(rig.execution, rig.station, known=known, tasks=rig.desk)


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
