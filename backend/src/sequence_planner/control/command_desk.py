"""Commands, carried out: first whether their actor may give them now, then what they ask for.

What a role allows is decided before, where requests come in; here it is decided what only the station can know.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from sequence_planner.actor import ActorKind
from sequence_planner.control.alarm_commands import AlarmCommand
from sequence_planner.control.alarming.alarms import Alarms
from sequence_planner.control.commands import (
    ClearOverride,
    Command,
    CommandRefused,
    ReleaseControl,
    SetOverride,
    StartProduction,
    TakeControl,
    WithdrawControl,
)
from sequence_planner.control.corrections import Corrections
from sequence_planner.control.forcing import Forcing
from sequence_planner.control.in_control import InControl
from sequence_planner.control.job_commands import CommandJob, ForgetJob, SequenceJobs, SetByOrder, TakeJob
from sequence_planner.control.job_desk import JobDesk
from sequence_planner.control.mode_desk import ModeDesk
from sequence_planner.control.moment import Moment
from sequence_planner.control.offers import Offers
from sequence_planner.control.overrides import Overrides
from sequence_planner.control.production_commands import Deploy
from sequence_planner.control.restart_commands import (
    ConfirmEstimates,
    CorrectEstimates,
    DecideOutputs,
    ForceVariable,
    ReleaseForce,
    TakeErrand,
    TryAbility,
    UndoCorrection,
)
from sequence_planner.control.task_commands import TaskCommand
from sequence_planner.control.tasks import TaskDesk
from sequence_planner.control.trials import Trials


@dataclass(frozen=True)
class CommandDesk:
    """Takes commands; each room may refuse. `real_devices` names what speaks against a demonstration."""

    modes: ModeDesk
    tasks: TaskDesk
    overrides: Overrides
    corrections: Corrections
    offers: Offers
    trials: Trials
    forcing: Forcing
    jobs: JobDesk
    alarms: Alarms
    start_production: Callable[[], None]
    real_devices: Callable[[], Sequence[str]]
    in_control: InControl = field(default_factory=InControl)

    def carry_out(self, command: Command, moment: Moment) -> None:
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
            case CorrectEstimates() | UndoCorrection() | ConfirmEstimates() | DecideOutputs():
                self.corrections.carry_out(command, moment)
            case TakeErrand():
                self.offers.take(command, moment)
            case TryAbility():
                self.trials.carry_out(command, moment)
            case ForceVariable() | ReleaseForce():
                self.forcing.carry_out(command, moment)
            case TakeJob() | SequenceJobs() | CommandJob() | ForgetJob() | SetByOrder():
                self.jobs.carry_out(command, moment)
            case AlarmCommand():
                self.alarms.carry_out(command, moment)
            case _:
                self.modes.carry_out(command, moment)

    def _check(self, command: Command) -> None:
        actor = command.actor
        if actor.kind is ActorKind.DEMONSTRATION and not command.harmless and (there := self.real_devices()):
            detail = f"{'; '.join(there)}. A demonstration may command emulated devices only."
            raise CommandRefused("real-devices", "There are real devices", detail, 403)
        if command.needs_control and actor.kind is not ActorKind.SYSTEM:
            self.in_control.require(actor)
