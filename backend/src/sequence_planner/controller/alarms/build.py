"""Builds the alarms of a station, and the features that watch over devices and abilities."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from sequence_planner.controller.alarms.alarm import KIND as ASIDE
from sequence_planner.controller.alarms.alarm import aside_again
from sequence_planner.controller.alarms.beginning import Beginning
from sequence_planner.controller.alarms.consequences import Consequences
from sequence_planner.controller.alarms.manager import AlarmManager
from sequence_planner.controller.alarms.model_conditions import ModelAlarms
from sequence_planner.controller.features.abilities import Abilities
from sequence_planner.controller.features.records import Records
from sequence_planner.controller.io.devices import Devices
from sequence_planner.controller.io.links import DeviceLinks
from sequence_planner.controller.recovery.operator_plans import OperatorPlans
from sequence_planner.controller.recovery.safe_state import SafeStateMonitor
from sequence_planner.controller.recovery.stalls import StallDetector
from sequence_planner.controller.recovery.who_can import WhoCan, in_thread
from sequence_planner.controller.restore import RestoredState
from sequence_planner.execution.executor import Executor


@dataclass(frozen=True)
class Watching:
    """The alarms, who knows what comes of them, and the features."""

    alarms: AlarmManager
    outside: SafeStateMonitor
    consequences: Consequences
    who_can: WhoCan
    links: DeviceLinks
    still: StallDetector
    abilities: Abilities
    operator_plans: OperatorPlans
    beginning: Beginning
    of_model: ModelAlarms


def build_alarms(
    execution: Executor,
    devices: Devices,
    records: Records,
    known: RestoredState,
    expect: Callable[[], None],
) -> Watching:
    """Build them; `expect` is called when somebody may soon ask for advice."""
    outside, who_can = SafeStateMonitor(execution, devices.feeds.heard_on), WhoCan(execution, in_thread)
    consequences = Consequences(execution, who_can)
    still = StallDetector(execution, lambda: outside.certain)
    records.recorder.know(ASIDE, aside_again(known.aside))
    return Watching(
        alarms=AlarmManager(execution, outside, records.add_note, known, expect),
        outside=outside,
        consequences=consequences,
        who_can=who_can,
        links=DeviceLinks(execution, devices.feeds, devices.network, devices.commander, who_can, consequences),
        still=still,
        abilities=Abilities(execution, devices.feeds, still, consequences),
        operator_plans=OperatorPlans(execution, devices.feeds.heard_on),
        beginning=Beginning(execution, known),
        of_model=ModelAlarms(execution),
    )
