"""Modes, steps and service: what a person asks for is done if the station allows it now, or refused with the reason."""

from __future__ import annotations

from sequence_planner.control.command_base import CommandRefused
from sequence_planner.control.execution import Execution
from sequence_planner.control.moment import Moment
from sequence_planner.control.offer_refusals import errand_under_way
from sequence_planner.control.outside import Outside
from sequence_planner.control.production_commands import (
    EnterRestart,
    LeaveRestart,
    SetMode,
    SetService,
    SetStepping,
    TakeStep,
)
from sequence_planner.control.restart_commands import StopErrand
from sequence_planner.control.vocabulary import Mode, Production, ServiceKind

ModeCommand = SetMode | EnterRestart | LeaveRestart | SetStepping | TakeStep | SetService | StopErrand


class ModeDesk:
    """Takes commands about how `execution` executes."""

    def __init__(self, execution: Execution, outside: Outside) -> None:
        self._execution = execution
        self._outside = outside

    def carry_out(self, command: ModeCommand, moment: Moment) -> None:
        """Do what is asked for. Raises `CommandRefused`; nothing has changed then."""
        execution, by = self._execution, command.actor.name
        match command:
            case SetMode(mode=mode):
                self._set_mode(Mode(mode), by, moment)
            case EnterRestart():
                if execution.mode is not Mode.RESTART:
                    execution.change_mode(Mode.RESTART, by, moment)
            case LeaveRestart():
                self._leave_restart(by, moment)
            case SetStepping(on=on):
                execution.set_stepping(on)
            case TakeStep():
                self._take_step()
            case SetService(of=of, name=name, in_service=in_service, reason=reason):
                self._require_known(of, name)
                execution.set_service(of, name, in_service, by, reason, moment)
            case StopErrand():
                if execution.errand is not None:
                    execution.stop_errand(by, moment)

    def require_standing(self) -> None:
        """Raises `CommandRefused` where something may be started."""
        execution = self._execution
        if execution.errand is not None:
            raise errand_under_way(execution.errand)
        if execution.production is Production.STARTED and execution.mode is Mode.AUTOMATIC:
            detail = "Operations are executed automatically. Pause the station first."
            raise CommandRefused("in-automatic", "The station is at work", detail)

    def _set_mode(self, mode: Mode, by: str, moment: Moment) -> None:
        execution = self._execution
        if mode is Mode.AUTOMATIC:
            self._require_readiness()
        if execution.mode is Mode.RESTART:
            # Pausing and holding are for everybody; restart mode is left by its own command, and by that alone.
            if mode is Mode.HOLD:
                execution.call_off(by, moment)
            elif execution.errand is not None:
                execution.stop_errand(by, moment)
        elif mode is not execution.mode or execution.errand is not None or mode is Mode.HOLD:
            execution.change_mode(mode, by, moment)

    def _require_readiness(self) -> None:
        """Raises `CommandRefused` unless operations can be executed from here."""
        execution, situation = self._execution, self._outside.situation
        if execution.mode is Mode.RESTART:
            detail = "Leave restart mode first; to go on is another decision."
            raise CommandRefused("in-restart", "The station is in restart mode", detail)
        if execution.errand is not None:
            raise errand_under_way(execution.errand)
        if situation is not None and situation.certain:
            detail = f"{self._outside.describe(situation)} Enter restart mode and see which ways lead back."
            raise CommandRefused("outside-safe-states", "The station is outside its safe states", detail)

    def _leave_restart(self, by: str, moment: Moment) -> None:
        execution = self._execution
        if execution.mode is not Mode.RESTART:
            detail = f"The mode is {execution.mode}: there is nothing to leave."
            raise CommandRefused("not-in-restart", "The station is not in restart mode", detail)
        if execution.errand is not None:
            detail = f"{execution.errand.title} is being carried out. Wait for its end, or stop it."
            raise CommandRefused("errand-under-way", "Something else is being carried out", detail)
        execution.change_mode(Mode.PAUSED, by, moment)

    def _take_step(self) -> None:
        if not self._execution.conduct.stepping:
            detail = "Starts do not wait for steps. Switch stepping on first."
            raise CommandRefused("not-stepping", "The station is not stepping", detail)
        self._execution.take_step()

    def _require_known(self, of: ServiceKind, name: str) -> None:
        automaton = self._execution.automaton
        known = {
            ServiceKind.RESOURCE: automaton.resources,
            ServiceKind.ABILITY: automaton.abilities,
            ServiceKind.OPERATION: automaton.operations,
        }[of]
        if name not in known:
            detail = f"The station has no {of} `{name}`. Look at what it has."
            raise CommandRefused("unknown-name", "There is no such thing", detail, 404)
