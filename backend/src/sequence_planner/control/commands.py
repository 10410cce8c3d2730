"""What a person or a system may ask of the controller. Every command carries its actor."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter

from sequence_planner.control.override_view import FieldValue
from sequence_planner.control.view import Mode


class CommandBase(BaseModel):
    """`actor` is who asks: `local` until there is sign-in."""

    model_config = ConfigDict(frozen=True, extra="forbid")
    actor: str = Field(min_length=1, max_length=200)


class SetMode(CommandBase):
    """Change the mode of execution."""

    kind: Literal["set-mode"] = "set-mode"
    mode: Mode


class StartProduction(CommandBase):
    """Allow outputs to be published. Nothing else implies it."""

    kind: Literal["start-production"] = "start-production"


class AcknowledgeTask(CommandBase):
    """A person says that the task is done; refused when the task or its revision is gone."""

    kind: Literal["acknowledge-task"] = "acknowledge-task"
    task: str
    revision: int


class SetOverride(CommandBase):
    """A person sets fields of an override, such as `ur10.speed`; fields that are not named are as they come."""

    kind: Literal["set-override"] = "set-override"
    name: str
    fields: dict[str, FieldValue]


class ClearOverride(CommandBase):
    """A person takes back what was set."""

    kind: Literal["clear-override"] = "clear-override"
    name: str


Command = Annotated[
    SetMode | StartProduction | AcknowledgeTask | SetOverride | ClearOverride, Field(discriminator="kind")
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
