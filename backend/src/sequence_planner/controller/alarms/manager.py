"""Alarm manager: all alarms of a station, chattering alarms, flood suppression and operator actions."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping

from pydantic import JsonValue

from sequence_planner.controller.alarms.alarm import (
    KIND,
    Alarm,
    ConsequenceGraph,
    Suppression,
    aside_to_keep,
)
from sequence_planner.controller.alarms.device_conditions import DeviceAlarms
from sequence_planner.controller.alarms.model_conditions import ModelAlarms
from sequence_planner.controller.alarms.plan_conditions import PlanAlarms
from sequence_planner.controller.alarms.registry import AlarmRegistry, Folding
from sequence_planner.controller.alarms.station_conditions import StationAlarms
from sequence_planner.controller.commands.alarms import (
    AcknowledgeAlarm,
    RestoreAlarm,
    ShelveAlarm,
    SuppressAlarm,
    UnshelveAlarm,
)
from sequence_planner.controller.commands.command import handles
from sequence_planner.controller.io.inputs import Inputs
from sequence_planner.controller.io.network import NetworkWatch
from sequence_planner.controller.io.outputs import Outputs
from sequence_planner.controller.recovery.safe_state import SafeStateMonitor
from sequence_planner.controller.recovery.stalls import StallDetector
from sequence_planner.controller.recovery.who_can import Run, WhoCan, at_once
from sequence_planner.controller.restore import RestoredState
from sequence_planner.controller.views.station import AlarmView
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor

# What wants a person's attention, and what people do about it.

TellEvent = Callable[[str, Mapping[str, JsonValue]], None]
KEEP_EVERY = 86400.0  # seconds after which what is aside is told again, so that it is among what the journal keeps


class AlarmManager(StationAlarms):
    """The alarms of a station. `tell` hears what becomes of each, for the journal.

    `known` has those that were shelved or out of service before the controller was started. `run` is where it is found
    out who can do what.
    """

    def __init__(
        self,
        execution: Executor,
        outside: SafeStateMonitor,
        feeds: Inputs,
        network: NetworkWatch,
        commander: Outputs,
        tell: TellEvent,
        known: RestoredState | None = None,
        run: Run = at_once,
    ) -> None:
        known = known or RestoredState()
        undone = known.deployment if known.deployment and known.deployment.why is not None else None
        super().__init__(execution, outside, known, undone)
        self.who_can = WhoCan(execution, run)
        self._devices = DeviceAlarms(execution, feeds, network, commander, self.who_can)
        self.still = StallDetector(execution, lambda: outside.certain)
        self._declared = ModelAlarms(execution.automaton)
        self._plans = PlanAlarms(execution, feeds, self.still, self.who_can)
        self._following = ConsequenceGraph(execution.automaton, self._touched)
        self._folding = Folding()
        self._lives = AlarmRegistry(self._told)
        self._tell = tell
        self._kept: dict[str, Suppression] = {}
        self._kept_at = float("-inf")
        self._aside_before = known.aside

    def look(self, planner_trouble: str | None, moment: Timestamp) -> None:
        """Take note of what is there now; often enough that nothing comes and goes unseen."""
        self._resume(moment)
        self.who_can.look(self._devices.untold, moment.monotonic)
        of_devices = tuple(self._devices.causes(moment))
        of_plans = self._plans.causes(planner_trouble, moment.monotonic, self._devices.untold)
        of_model = self._declared.causes(self._execution.state, moment.monotonic)
        causes = (*of_devices, *of_plans, *self.causes(), *of_model)
        folded = self._folding.fold(self._following.trace(causes), self._lives.out_of_service, moment.monotonic)
        self._lives.observe(folded.alarms, folded.folded, moment)
        self._keep(moment)

    def current(self, planner_trouble: str | None, moment: Timestamp) -> dict[str, AlarmView]:
        """All alarms now."""
        self.look(planner_trouble, moment)
        return self._lives.view()

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        return {"who_can": self.who_can.found}

    @property
    def untold(self) -> Collection[str]:
        """The resources whose silence is too young to be told."""
        return self._devices.untold

    @handles(AcknowledgeAlarm)
    def acknowledge(self, command: AcknowledgeAlarm, moment: Timestamp) -> None:
        """A person has seen the alarm."""
        self._lives.acknowledge(command.alarm, command.since, command.actor.name)
        self._keep(moment)

    @handles(ShelveAlarm)
    def shelve(self, command: ShelveAlarm, moment: Timestamp) -> None:
        """A person does not want to be told of the alarm for some time."""
        until = Timestamp(moment.epoch + command.seconds, moment.monotonic + command.seconds)
        self._lives.shelve(command.alarm, command.actor.name, command.reason, until)
        self._keep(moment)

    @handles(UnshelveAlarm)
    def unshelve(self, command: UnshelveAlarm, moment: Timestamp) -> None:
        """The alarm is told again."""
        self._lives.unshelve(command.alarm)
        self._keep(moment)

    @handles(SuppressAlarm)
    def suppress(self, command: SuppressAlarm, moment: Timestamp) -> None:
        """The alarm is out of service."""
        self._lives.suppress(command.alarm, command.actor.name, command.reason)
        self._keep(moment)

    @handles(RestoreAlarm)
    def restore(self, command: RestoreAlarm, moment: Timestamp) -> None:
        """The alarm is in service again."""
        self._lives.put_back(command.alarm)
        self._keep(moment)

    def _touched(self) -> frozenset[str]:
        """The variables for which the state is unsafe."""
        situation = self._outside.situation
        return frozenset() if situation is None or not situation.certain else self._outside.touched(situation)

    def _resume(self, moment: Timestamp) -> None:
        """Put aside again what was aside before the start."""
        before, self._aside_before = self._aside_before, {}
        for key, each in before.items():
            self._lives.put_aside(key, each.cause(key), each.aside(moment), moment)

    def _told(self, key: str, life: Alarm, event: str) -> None:
        view = life.view()
        self._tell("alarm", {"alarm": key, "event": event, **view.model_dump(mode="json")})

    def _keep(self, moment: Timestamp) -> None:
        """Tell what is aside when that has changed, and now and then."""
        kept = {key: life.aside for key, life in self._lives.aside.items() if life.aside is not None}
        old = moment.monotonic - self._kept_at > KEEP_EVERY
        if kept != self._kept or (old and kept):
            self._kept, self._kept_at = kept, moment.monotonic
            self._tell(KIND, aside_to_keep(self._lives.aside))
