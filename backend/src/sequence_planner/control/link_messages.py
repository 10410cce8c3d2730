"""What passes between the controller and the server: views one way, commands and wishes the other, with their replies.

Each message is one line of JSON on a Unix domain socket. A command's `id` is chosen by the server and comes back in
the reply; it is null in the reply to a line in which no id could be found.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, JsonValue, TypeAdapter

from sequence_planner.control.asks import Ask
from sequence_planner.control.command_base import TextPlace
from sequence_planner.control.commands import Command, CommandRefused
from sequence_planner.control.network_view import NetworkView
from sequence_planner.control.view import StationView

LONGEST_COMMAND = 2 * 1024 * 1024  # bytes in a line from the server: that of the order between many jobs is the longest
LONGEST_VIEW = 16 * 1024 * 1024  # bytes in a line from the controller


class LinkMessage(BaseModel):
    """Base of all messages: immutable, and nothing beside what is declared."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Refusal(LinkMessage):
    """`CommandRefused` on its way to the server."""

    slug: str
    title: str
    detail: str
    status: int
    place: TextPlace | None = None

    @classmethod
    def of(cls, refused: CommandRefused) -> Refusal:
        """Write down a refusal."""
        return cls(
            slug=refused.slug,
            title=refused.title,
            detail=refused.detail,
            status=refused.status,
            place=refused.place,
        )

    def error(self) -> CommandRefused:
        """Make the exception again that the controller raised."""
        return CommandRefused(self.slug, self.title, self.detail, self.status, self.place)


class ViewMessage(LinkMessage):
    """The whole document as it is now."""

    kind: Literal["view"] = "view"
    view: StationView


class AliveMessage(LinkMessage):
    """Nothing has happened since the document that came last: it is still so, at this time."""

    kind: Literal["alive"] = "alive"
    time: float


class NetworkMessage(LinkMessage):
    """The ROS graph as it is now; sent when it has changed."""

    kind: Literal["network"] = "network"
    network: NetworkView


class AnswerMessage(LinkMessage):
    """What answers an ask: a document of its `answer_type`, to who asked for it."""

    kind: Literal["answer"] = "answer"
    id: int
    answer: dict[str, JsonValue]


class Reply(LinkMessage):
    """What became of a command, or that an ask is refused; `problem` is there when `ok` is false.

    `recorded` is false as long as the journal does not have what was carried out.
    """

    kind: Literal["reply"] = "reply"
    id: int | None
    ok: bool
    recorded: bool = True
    problem: Refusal | None = None


class CommandMessage(LinkMessage):
    """A command and the number under which its reply is awaited.

    `expires` is when nobody waits for it any more, in seconds of `time.monotonic`, which all processes of a machine
    share: a controller that stood still must not start production long after the person who asked for it has left.
    `request` is the number under which the server's log has what the command came from.
    """

    kind: Literal["command"] = "command"
    id: int = Field(ge=0)
    command: Command
    expires: float | None = None
    request: str | None = Field(default=None, max_length=64)


class AskMessage(LinkMessage):
    """A wish to be told what is not shown unasked, and the number under which the answer is awaited.

    `expires` is when nobody waits for it any more; see `CommandMessage`.
    """

    kind: Literal["ask"] = "ask"
    id: int = Field(ge=0)
    ask: Ask
    expires: float


FromController = ViewMessage | AliveMessage | NetworkMessage | Reply | AnswerMessage
FROM_CONTROLLER: TypeAdapter[FromController] = TypeAdapter(Annotated[FromController, Field(discriminator="kind")])
FromServer = CommandMessage | AskMessage
FROM_SERVER: TypeAdapter[FromServer] = TypeAdapter(Annotated[FromServer, Field(discriminator="kind")])


def encode(message: LinkMessage) -> bytes:
    """One line of JSON. Null members of the message itself stay: a view's nulls mean "unknown"."""
    return message.model_dump_json().encode() + b"\n"
