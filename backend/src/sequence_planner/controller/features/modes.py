"""Modes, production, steps and service: what is asked for is done if the station allows it now, or refused with why."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from sequence_planner.controller.alarms.manager import AlarmManager
from sequence_planner.controller.commands.audit import StandingNotes, Tell
from sequence_planner.controller.commands.command import CommandRefused, handles
from sequence_planner.controller.commands.execution import (
    Deploy,
    EnterRestart,
    LeaveRestart,
    SetCycleStop,
    SetMode,
    SetService,
    SetStepping,
    StartProduction,
    TakeStep,
)
from sequence_planner.controller.io.devices import Devices
from sequence_planner.controller.io.links import DeviceLinks
from sequence_planner.controller.recovery.consistency import ConsistencyMonitor
from sequence_planner.controller.recovery.safe_state import SafeStateMonitor
from sequence_planner.controller.views.execution import (
    cycle_stop_view,
    failing,
    goes_on,
    packml,
    service_views,
    standing,
)
from sequence_planner.controller.views.station import PackML, StationStanding
from sequence_planner.controller.views.wording import plan_running
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.products import final_operations
from sequence_planner.execution.vocabulary import Mode, Production, ServiceKind
from sequence_planner.texts.message import Message, joined, message


class Modes:
    """Takes commands about how `execution` executes, and says how the station stands.

    `alarms` say what fails, `waits` what jobs wait for. `tell` hears how it stands where that has changed for good.
    """

    def __init__(
        self,
        execution: Executor,
        outside: SafeStateMonitor,
        devices: Devices,
        links: DeviceLinks,
        doubting: ConsistencyMonitor,
        alarms: AlarmManager,
        waits: Callable[[Timestamp], Mapping[str, list[Message]]],
        tell: Tell,
    ) -> None:
        self._execution = execution
        self._outside = outside
        self._devices, self._links = devices, links
        self._doubting = doubting
        self._alarms = alarms
        self._waits = waits
        self._notes = StandingNotes(tell)

    @property
    def packml(self) -> PackML:
        """The state that PackML has for it now."""
        return packml(self._execution) if self._devices.network.commands else PackML.RESETTING

    def goes_on(self) -> bool:
        """Return whether anything starts by itself."""
        return goes_on(self._execution, self._outside.certain)

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        execution, silent = self._execution, self._links.silent
        commands = self._devices.network.commands
        fail = failing(execution.automaton, self._alarms.shown, execution.running())
        return {
            "mode": execution.mode,
            "packml": self.packml,
            "standing": standing(execution, self._outside.certain, silent) if commands else StationStanding.PREPARING,
            "failing": [title for title in fail if title not in silent],
            "stepping": execution.conduct.stepping,
            "cycle_stop": cycle_stop_view(execution.conduct.cycle_stop),
            "production": execution.production if commands else Production.PREPARING,
            "out_of_service": service_views(execution.automaton, execution.conduct),
        }

    def stop_after_cycle(self, moment: Timestamp) -> None:
        """Pause, where that was wished for when the product is done, and it is."""
        stop = self._execution.conduct.cycle_stop
        if stop is not None and stop.reached and self._execution.mode is Mode.AUTOMATIC:
            self._execution.change_mode(Mode.PAUSED, stop.by, moment)

    def note_standing(self, moment: Timestamp) -> None:
        """Write down how the station stands, where that has changed for good."""
        if self._devices.network.commands and self._notes.due(moment):
            self._notes.look(self.packml, self._waits(moment), moment)

    @handles(SetMode)
    def set_mode(self, command: SetMode, moment: Timestamp) -> None:
        """Go on, pause or hold; to go on takes a station that can."""
        execution, mode, by = self._execution, Mode(command.mode), command.actor.name
        if mode is Mode.AUTOMATIC:
            self._require_readiness()
        if execution.mode is Mode.RESTART:
            # Pausing and holding are for everybody; restart mode is left by its own command, and by that alone.
            if mode is Mode.HOLD:
                execution.call_off(by, moment)
            elif execution.operator_plan is not None:
                execution.stop_operator_plan(by, moment)
        elif mode is not execution.mode or execution.operator_plan is not None or mode is Mode.HOLD:
            execution.change_mode(mode, by, moment)

    @handles(EnterRestart)
    def enter_restart(self, command: EnterRestart, moment: Timestamp) -> None:
        """Go into restart mode, where it is not in it."""
        if self._execution.mode is not Mode.RESTART:
            self._execution.change_mode(Mode.RESTART, command.actor.name, moment)

    @handles(LeaveRestart)
    def leave_restart(self, command: LeaveRestart, moment: Timestamp) -> None:
        """Go out of restart mode, where nothing is carried out in it."""
        execution = self._execution
        if execution.mode is not Mode.RESTART:
            raise CommandRefused(
                "not-in-restart", message("refused.not-in-restart.leave", mode=message(f"mode.{execution.mode}"))
            )
        if execution.operator_plan is not None:
            raise plan_running(execution.operator_plan.title)
        execution.change_mode(Mode.PAUSED, command.actor.name, moment)

    @handles(SetCycleStop)
    def set_cycle_stop(self, command: SetCycleStop, moment: Timestamp) -> None:
        """Pause when the product is done, or go on as ever."""
        execution = self._execution
        if command.on:
            if execution.mode is not Mode.AUTOMATIC:
                raise CommandRefused(
                    "not-automatic", message("refused.not-automatic.now", mode=message(f"mode.{execution.mode}"))
                )
            if not execution.conduct.jobs.by_order and not final_operations(execution.automaton):
                raise CommandRefused("no-product-end", message("refused.no-product-end.pause"))
        if command.on or execution.conduct.cycle_stop is not None:
            execution.set_cycle_stop(command.on, command.actor.name, command.reason or "", moment)

    @handles(SetStepping)
    def set_stepping(self, command: SetStepping, moment: Timestamp) -> None:
        """Let starts wait for steps, or not."""
        self._execution.set_stepping(command.on)

    @handles(TakeStep)
    def take_step(self, command: TakeStep, moment: Timestamp) -> None:
        """Let one start be taken, where starts wait for steps."""
        if not self._execution.conduct.stepping:
            raise CommandRefused("not-stepping", message("refused.not-stepping.starts"))
        self._execution.take_step()

    @handles(SetService)
    def set_service(self, command: SetService, moment: Timestamp) -> None:
        """Take something that the station has out of service, or put it back."""
        self._require_known(command.of, command.name)
        self._execution.set_service(
            command.of, command.name, command.in_service, command.actor.name, command.reason, moment
        )

    @handles(StartProduction)
    def start_production(self, command: StartProduction, moment: Timestamp) -> None:
        """Start it, where nobody else commands the devices and none would move at once."""
        if self._execution.production is Production.STARTED:
            raise CommandRefused("production-started", message("refused.production-started.already"))
        self._devices.see_network()
        if rivals := self._devices.network.rivals:
            raise CommandRefused(
                "other-controller", message("refused.other-controller.rivals", rivals=joined(rivals.values()))
            )
        if undecided := self._doubting.undecided:
            named = ", ".join(undecided)
            raise CommandRefused("outputs-unconfirmed", message("refused.outputs-unconfirmed.named", names=named))
        self._execution.start_production()

    @handles(Deploy)
    def require_standing(self, command: Deploy, moment: Timestamp) -> None:
        """Let another model take over (which the process does, as this controller ends) where nothing is started."""
        execution = self._execution
        if execution.operator_plan is not None:
            raise plan_running(execution.operator_plan.title)
        if execution.production is Production.STARTED and execution.mode is Mode.AUTOMATIC:
            raise CommandRefused("in-automatic", message("refused.in-automatic.pause"))

    def _require_readiness(self) -> None:
        """Raises `CommandRefused` unless operations can be executed from here."""
        execution, situation = self._execution, self._outside.situation
        if execution.mode is Mode.RESTART:
            raise CommandRefused("in-restart", message("refused.in-restart.leave"))
        if execution.operator_plan is not None:
            raise plan_running(execution.operator_plan.title)
        if situation is not None and situation.certain:
            raise CommandRefused(
                "outside-safe-states",
                message("refused.outside-safe-states.ways", situation=self._outside.describe(situation)),
            )

    def _require_known(self, of: ServiceKind, name: str) -> None:
        automaton = self._execution.automaton
        known = {
            ServiceKind.RESOURCE: automaton.resources,
            ServiceKind.ABILITY: automaton.abilities,
            ServiceKind.OPERATION: automaton.operations,
        }[of]
        if name not in known:
            raise CommandRefused("unknown-name", message(f"refused.unknown-name.{of}", name=name), 404)
