"""What a person or a system may ask of the controller. Every command carries its actor, and may carry a reason."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field, TypeAdapter

from sequence_planner.control.alarm_commands import (
    AcknowledgeAlarm,
    RestoreAlarm,
    ShelveAlarm,
    SuppressAlarm,
    UnshelveAlarm,
)
from sequence_planner.control.command_base import CommandBase, CommandRefused
from sequence_planner.control.job_commands import CommandJob, ForgetJob, SequenceJobs, SetByOrder, TakeJob
from sequence_planner.control.override_view import FieldValue
from sequence_planner.control.production_commands import (
    Deploy,
    EnterRestart,
    LeaveRestart,
    SetMode,
    SetService,
    SetStepping,
    StartProduction,
    TakeStep,
)
from sequence_planner.control.restart_commands import (
    ConfirmEstimates,
    CorrectEstimates,
    DecideOutputs,
    ForceVariable,
    ReleaseForce,
    StopErrand,
    TakeErrand,
    TryAbility,
    UndoCorrection,
)
from sequence_planner.control.task_commands import AcknowledgeTask, ReportProblem, SolveProblem

__all__ = ["COMMAND", "AcknowledgeTask", "Command", "CommandBase", "CommandRefused", "SetMode", "StartProduction"]


class SetOverride(CommandBase):
    """A person sets fields of an override, such as `ur10.speed`; fields that are not named are as they come."""

    kind: Literal["set-override"] = "set-override"
    for_control: ClassVar[bool] = True
    name: str
    fields: dict[str, FieldValue]

    @property
    def subject(self) -> str:
        """The override."""
        return f"override {self.name}"


class ClearOverride(CommandBase):
    """A person takes back what was set."""

    kind: Literal["clear-override"] = "clear-override"
    for_control: ClassVar[bool] = True
    name: str

    @property
    def subject(self) -> str:
        """The override."""
        return f"override {self.name}"


class TakeControl(CommandBase):
    """A person's session is in control from now on.

    `over` is the session from which the person means to take it, null where nobody is in control; it is refused when
    by now somebody else is.
    """

    kind: Literal["take-control"] = "take-control"
    over: str | None = None


class ReleaseControl(CommandBase):
    """Who is in control gives it up."""

    kind: Literal["release-control"] = "release-control"


class WithdrawControl(CommandBase):
    """A session has ended; if it was in control, nobody is now."""

    kind: Literal["withdraw-control"] = "withdraw-control"
    session: str


Command = Annotated[
    SetMode
    | EnterRestart
    | LeaveRestart
    | StartProduction
    | Deploy
    | SetStepping
    | TakeStep
    | SetService
    | CorrectEstimates
    | UndoCorrection
    | ConfirmEstimates
    | DecideOutputs
    | TakeErrand
    | TryAbility
    | StopErrand
    | ForceVariable
    | ReleaseForce
    | AcknowledgeAlarm
    | ShelveAlarm
    | UnshelveAlarm
    | SuppressAlarm
    | RestoreAlarm
    | AcknowledgeTask
    | ReportProblem
    | SolveProblem
    | SetOverride
    | ClearOverride
    | SetByOrder
    | TakeJob
    | SequenceJobs
    | CommandJob
    | ForgetJob
    | TakeControl
    | ReleaseControl
    | WithdrawControl,
    Field(discriminator="kind"),
]
COMMAND: TypeAdapter[Command] = TypeAdapter(Command)
