"""Commands for control and execution: mode, production start, stepping, service, deployment, overrides."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field, TypeAdapter

from sequence_planner.controller.commands.commands import (
    AcknowledgeAlarm,
    AcknowledgeTask,
    ApproveRequest,
    CommandBase,
    CommandJob,
    ConfirmEstimates,
    CorrectEstimates,
    DecideOutputs,
    DeclineRequest,
    ForceVariable,
    ForgetJob,
    ReleaseForce,
    ReportProblem,
    RequestApproval,
    RestoreAlarm,
    SequenceJobs,
    SetByOrder,
    ShelveAlarm,
    SolveProblem,
    StopErrand,
    SuppressAlarm,
    TakeErrand,
    TakeJob,
    TryAbility,
    UndoCorrection,
    UnshelveAlarm,
)
from sequence_planner.controller.views.station import FieldValue
from sequence_planner.execution.vocabulary import Mode, ServiceKind
from sequence_planner.journal.entry import LONGEST_REASON

# What a person may ask of how the station executes: its mode, its steps, and what takes part in it.


class SetMode(CommandBase):
    """Execute automatically, pause, or hold. Restart mode has commands of its own, in and out."""

    kind: Literal["set-mode"] = "set-mode"
    mode: Literal[Mode.AUTOMATIC, Mode.PAUSED, Mode.HOLD]

    @property
    def needs_control(self) -> bool:
        """To go on needs it; anybody who may act may pause and hold."""
        return not self.harmless

    @property
    def harmless(self) -> bool:
        """Pausing and holding are."""
        return self.mode is not Mode.AUTOMATIC


class EnterRestart(CommandBase):
    """Pause the operations for a restart. Nothing is started by it."""

    kind: Literal["enter-restart"] = "enter-restart"
    for_control: ClassVar[bool] = True


class LeaveRestart(CommandBase):
    """Leave restart mode for the paused one; to go on is another command."""

    kind: Literal["leave-restart"] = "leave-restart"
    for_control: ClassVar[bool] = True


class StartProduction(CommandBase):
    """Allow outputs to be published. Nothing else implies it."""

    kind: Literal["start-production"] = "start-production"
    for_control: ClassVar[bool] = True


class SetStepping(CommandBase):
    """For commissioning: with `on`, every single start waits for a person's step."""

    kind: Literal["set-stepping"] = "set-stepping"
    for_control: ClassVar[bool] = True
    on: bool


class TakeStep(CommandBase):
    """One start may be taken, as soon as there is one."""

    kind: Literal["take-step"] = "take-step"
    for_control: ClassVar[bool] = True


class Deploy(CommandBase):
    """Let another model take the place of the one that runs, and begin anew with it. Its files lie in the folder
    `staged` beside the controller's socket; `revision` and `name` are those it was saved under. With `reset` emulated
    devices and the station begin as the new model says, else they go on as they are.
    """

    kind: Literal["deploy"] = "deploy"
    for_control: ClassVar[bool] = True
    reason: str = Field(min_length=1, max_length=LONGEST_REASON)
    revision: str = Field(pattern=r"^[0-9a-f]{40}$")
    name: str = Field(max_length=200)
    staged: str = Field(pattern=r"^deploy-[0-9a-f]{16}$")
    reset: bool = False

    @property
    def subject(self) -> str:
        """The revision."""
        return f"revision {self.name}"


class SetService(CommandBase):
    """Take a resource, an ability or an operation out of service, or put it back."""

    kind: Literal["set-service"] = "set-service"
    for_control: ClassVar[bool] = True
    reason: str = Field(min_length=1, max_length=LONGEST_REASON)
    of: ServiceKind
    name: str
    in_service: bool

    @property
    def subject(self) -> str:
        """The thing that it takes out of service or puts back."""
        return f"{self.of} {self.name}"


# What a person or a system may ask of the controller. Every command carries its actor, and may carry a reason.


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
    """A command by which whoever is in control gives it up."""

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
    | RequestApproval
    | ApproveRequest
    | DeclineRequest
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
