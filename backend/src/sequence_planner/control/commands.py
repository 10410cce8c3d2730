"""What a person or a system may ask of the controller. Every command carries its actor, and may carry a reason."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter

from sequence_planner.actor import Actor
from sequence_planner.control.override_view import FieldValue
from sequence_planner.control.view import Mode
from sequence_planner.journal.entry import LONGEST_REASON


class CommandBase(BaseModel):
    """`actor` is who asks, `reason` why, in that person's words.

    What moves devices is for the one session in control. `harmless` is what only ever stops them: it is carried out
    even where it cannot be recorded.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")
    for_control: ClassVar[bool] = False
    actor: Actor
    reason: str | None = Field(default=None, max_length=LONGEST_REASON)

    @property
    def needs_control(self) -> bool:
        """Whether its actor must be in control."""
        return self.for_control

    @property
    def harmless(self) -> bool:
        """Whether it can only bring devices to rest."""
        return False

    @property
    def subject(self) -> str:
        """On what it acts, for the record."""
        return ""


class SetMode(CommandBase):
    """Change the mode of execution."""

    kind: Literal["set-mode"] = "set-mode"
    mode: Mode

    @property
    def needs_control(self) -> bool:
        """To go on needs it; anybody who may act may pause."""
        return not self.harmless

    @property
    def harmless(self) -> bool:
        """Pausing is."""
        return self.mode is Mode.PAUSED


class StartProduction(CommandBase):
    """Allow outputs to be published. Nothing else implies it."""

    kind: Literal["start-production"] = "start-production"
    for_control: ClassVar[bool] = True


class AcknowledgeTask(CommandBase):
    """A person says that the task is done; refused when the task or its revision is gone."""

    kind: Literal["acknowledge-task"] = "acknowledge-task"
    task: str
    revision: int

    @property
    def subject(self) -> str:
        """The task."""
        return f"task {self.task}"


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
    | StartProduction
    | AcknowledgeTask
    | SetOverride
    | ClearOverride
    | TakeControl
    | ReleaseControl
    | WithdrawControl,
    Field(discriminator="kind"),
]
COMMAND: TypeAdapter[Command] = TypeAdapter(Command)


class CommandRefused(Exception):
    """The controller does not carry out a command.

    `slug` names the kind of problem for machines (the `type` of RFC 9457), `detail` says to a person what to do;
    `status` is the HTTP status that says the same.
    """

    def __init__(self, slug: str, title: str, detail: str, status: int = 409) -> None:
        super().__init__(detail)
        self.slug = slug
        self.title = title
        self.detail = detail
        self.status = status
