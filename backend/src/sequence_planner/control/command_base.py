"""What all commands have in common, and how one is refused."""

from __future__ import annotations

from typing import ClassVar

from pydantic import BaseModel, ConfigDict, Field

from sequence_planner.actor import Actor
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
    def overtaken_by_pause(self) -> bool:
        """Whether it is void where somebody pauses the station while it waits for its record."""
        return self.needs_control

    @property
    def harmless(self) -> bool:
        """Whether it can only bring devices to rest."""
        return False

    @property
    def subject(self) -> str:
        """On what it acts, for the record."""
        return ""


class TextPlace(BaseModel):
    """What is wrong within a text that was sent, and where: from `start` to before `end`, in Unicode characters."""

    model_config = ConfigDict(frozen=True)
    start: int
    end: int
    message: str


class CommandRefused(Exception):
    """The controller does not carry out a command.

    `slug` names the kind of problem for machines (the `type` of RFC 9457), `detail` says to a person what to do;
    `status` is the HTTP status that says the same. `place` is where a text cannot be read.
    """

    def __init__(self, slug: str, title: str, detail: str, status: int = 409, place: TextPlace | None = None) -> None:
        super().__init__(detail)
        self.slug = slug
        self.title = title
        self.detail = detail
        self.status = status
        self.place = place
