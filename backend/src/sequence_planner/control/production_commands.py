"""What a person may ask of how the station executes: its mode, its steps, and what takes part in it."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import Field

from sequence_planner.control.command_base import CommandBase
from sequence_planner.control.vocabulary import Mode, ServiceKind
from sequence_planner.journal.entry import LONGEST_REASON


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
        """What it is."""
        return f"{self.of} {self.name}"
