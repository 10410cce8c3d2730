"""What the controller replies to lines that it cannot read, and to what it does not carry out."""

from __future__ import annotations

import json

from pydantic import ValidationError

from sequence_planner.control.commands import CommandRefused
from sequence_planner.control.link_messages import FROM_SERVER, LONGEST_COMMAND, FromServer, Refusal, Reply

MOST_ASKS = 16  # of one peer, waiting for their answers at the same time


def read(line: bytes | None) -> FromServer | Reply:
    """What the server says, or the reply to what cannot be read."""
    if line is None:
        return refusal(None, malformed(f"The line is longer than {LONGEST_COMMAND} bytes."))
    try:
        return FROM_SERVER.validate_json(line)
    except ValidationError as error:
        places = ", ".join(".".join(map(str, each["loc"])) or "the line" for each in error.errors()[:5])
        return refusal(_id_in(line), malformed(f"Not a command of this controller: see {places}."))


def too_many() -> CommandRefused:
    """Somebody asks too much at once."""
    detail = f"{MOST_ASKS} questions wait for their answers already. Try again in a moment."
    return CommandRefused("too-many-asks", "Too much is asked at once", detail, 503)


def late() -> CommandRefused:
    """Nobody waits for the answer any more."""
    detail = "The answer was not found in time. Nothing was changed by asking; try again."
    return CommandRefused("answer-late", "The answer would come too late", detail, 504)


def failed(title: str) -> CommandRefused:
    """The controller has met an error of its own."""
    detail = "The controller met an error of its own; it is written in the controller's log."
    return CommandRefused("controller-error", title, detail, 500)


def malformed(detail: str) -> CommandRefused:
    """What came is no message."""
    return CommandRefused("malformed-command", "The command cannot be read", detail, 422)


def refusal(command: int | None, refused: CommandRefused) -> Reply:
    """The reply that refuses what came under this number."""
    return Reply(id=command, ok=False, problem=Refusal.of(refused))


def _id_in(line: bytes) -> int | None:
    """The id in a message that is otherwise wrong, so that whoever waits for its reply gets it."""
    try:
        found = json.loads(line)
    except (ValueError, RecursionError):
        return None
    number = found.get("id") if isinstance(found, dict) else None
    return number if isinstance(number, int) and not isinstance(number, bool) else None
