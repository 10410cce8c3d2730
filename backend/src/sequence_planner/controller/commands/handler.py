"""Command handler: authorization and dispatch of all commands, and execution of mode and service commands."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from sequence_planner.controller.alarms.manager import AlarmManager
from sequence_planner.controller.commands.commands import (
    AlarmCommand,
    ApprovedCommand,
    ApproveRequest,
    CommandJob,
    CommandRefused,
    ConfirmEstimates,
    CorrectEstimates,
    DecideOutputs,
    DeclineRequest,
    ForceVariable,
    ForgetJob,
    ReleaseForce,
    RequestApproval,
    SequenceJobs,
    SetByOrder,
    StopErrand,
    TakeErrand,
    TakeJob,
    TaskCommand,
    TryAbility,
    UndoCorrection,
)
from sequence_planner.controller.commands.control_lock import ControlLock
from sequence_planner.controller.commands.job_handler import JobHandler
from sequence_planner.controller.commands.production import (
    ClearOverride,
    Command,
    Deploy,
    EnterRestart,
    LeaveRestart,
    ReleaseControl,
    SetMode,
    SetOverride,
    SetService,
    SetStepping,
    StartProduction,
    TakeControl,
    TakeStep,
    WithdrawControl,
)
from sequence_planner.controller.commands.tasks import TaskHandler
from sequence_planner.controller.io.overrides import Overrides
from sequence_planner.controller.recovery.corrections import Corrections
from sequence_planner.controller.recovery.manual import Approvals, Forcing
from sequence_planner.controller.recovery.proposals import Offers
from sequence_planner.controller.recovery.safe_state import SafeStateMonitor
from sequence_planner.controller.recovery.trials import Trials
from sequence_planner.controller.views.wording import errand_under_way
from sequence_planner.core.actor import ActorKind
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Mode, Production, ServiceKind

# Modes, steps and service: what a person asks for is done if the station allows it now, or refused with the reason.

ModeCommand = SetMode | EnterRestart | LeaveRestart | SetStepping | TakeStep | SetService | StopErrand


class ModeHandler:
    """Takes commands about how `execution` executes."""

    def __init__(self, execution: Executor, outside: SafeStateMonitor) -> None:
        self._execution = execution
        self._outside = outside

    def carry_out(self, command: ModeCommand, moment: Timestamp) -> None:
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

    def _set_mode(self, mode: Mode, by: str, moment: Timestamp) -> None:
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

    def _leave_restart(self, by: str, moment: Timestamp) -> None:
        execution = self._execution
        if execution.mode is not Mode.RESTART:
            detail = f"The mode is {execution.mode}: there is nothing to leave."
            raise CommandRefused("not-in-restart", "The station is not in restart mode", detail)
        if execution.errand is not None:
            detail = f"{execution.errand.title} is being carried out. Wait for its end, or stop it."
            raise CommandRefused("plan-running", "Something else is being carried out", detail)
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


# Commands, carried out: first whether their actor may give them now, then what they ask for.
#
# What a role allows is decided before, where requests come in; here it is decided what only the station can know.


@dataclass(frozen=True)
class CommandHandler:
    """Takes commands; each room may refuse. `real_devices` names what speaks against a demonstration."""

    modes: ModeHandler
    tasks: TaskHandler
    overrides: Overrides
    corrections: Corrections
    offers: Offers
    trials: Trials
    forcing: Forcing
    jobs: JobHandler
    approvals: Approvals
    alarms: AlarmManager
    start_production: Callable[[], None]
    real_devices: Callable[[], Sequence[str]]
    in_control: ControlLock = field(default_factory=ControlLock)

    def carry_out(self, command: Command, moment: Timestamp) -> None:
        """Do what is asked for. Raises `CommandRefused`; nothing has changed then."""
        self._check(command)
        match command:
            case StartProduction():
                self.start_production()
            case TaskCommand():
                self.tasks.carry_out(command, moment.epoch)
            case Deploy():
                self.modes.require_standing()
            case SetOverride(name=name, fields=fields, actor=actor):
                self.overrides.set(name, fields, actor.name, moment.monotonic)
            case ClearOverride(name=name):
                self.overrides.clear(name, moment.monotonic)
            case TakeControl(actor=actor, over=over):
                self.in_control.take(actor, over, moment.epoch)
            case ReleaseControl(actor=actor):
                self.in_control.release(actor)
            case WithdrawControl(session=session):
                self.in_control.withdraw(session)
            case RequestApproval():
                self._check_act(command.act.command(command.actor, command.reason, command.revision))
                self.approvals.ask(command, moment)
            case ApproveRequest():
                self._act(self.approvals.approved(command, moment), moment)
                self.approvals.note_approved(command, moment)
            case DeclineRequest():
                self.approvals.decline(command, moment)
            case CorrectEstimates() | DecideOutputs():
                self.approvals.require_none(command.values)
                self.corrections.carry_out(command, moment)
            case UndoCorrection() | ConfirmEstimates():
                if isinstance(command, UndoCorrection) and (last := self.corrections.last) is not None:
                    self.approvals.require_none(last.values)
                self.corrections.carry_out(command, moment)
            case TakeErrand():
                self.approvals.require_none(command.corrections)
                self.offers.take(command, moment)
            case TryAbility():
                self.trials.carry_out(command, moment)
            case ForceVariable():
                self.approvals.require_none((command.name,))
                self.forcing.carry_out(command, moment)
            case ReleaseForce():
                self.forcing.carry_out(command, moment)
            case TakeJob() | SequenceJobs() | CommandJob() | ForgetJob() | SetByOrder():
                self.jobs.carry_out(command, moment)
            case AlarmCommand():
                self.alarms.carry_out(command, moment)
            case _:
                self.modes.carry_out(command, moment)

    def _act(self, command: ApprovedCommand, moment: Timestamp) -> None:
        """Do what two people want."""
        if isinstance(command, ForceVariable):
            self.forcing.carry_out(command, moment)
        else:
            self.corrections.carry_out(command, moment)

    def _check_act(self, command: ApprovedCommand) -> None:
        """Raises `CommandRefused` when it could not be done now, whoever wants it."""
        if isinstance(command, ForceVariable):
            self.forcing.check(command)
        else:
            self.corrections.check(command)

    def _check(self, command: Command) -> None:
        actor = command.actor
        if actor.kind is ActorKind.DEMONSTRATION and not command.harmless and (there := self.real_devices()):
            detail = f"{'; '.join(there)}. A demonstration may command emulated devices only."
            raise CommandRefused("real-devices", "There are real devices", detail, 403)
        if command.needs_control and actor.kind is not ActorKind.SYSTEM:
            self.in_control.require(actor)
