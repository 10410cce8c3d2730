"""The parts that the record of who did what is made of."""

from __future__ import annotations

from enum import StrEnum

from pydantic import Field, JsonValue

from sequence_planner.core.actor import Actor
from sequence_planner.core.data_models import DataModel

LONGEST_REASON, LONGEST_SUBJECT = 500, 400  # characters


class Outcome(StrEnum):
    """Progress of an act. A command on the station is recorded before its effect, and again when that is known."""

    REQUESTED = "requested"
    DONE = "done"
    REFUSED = "refused"
    FAILED = "failed"


class Entry(DataModel):
    """Somebody does something.

    `action` is what, as in `set-mode` or `person-created`; `subject` is on what, as in `task 4-1` or `person Eva`;
    `details` are its data, without anything secret; `reason` is why, in the person's words. `about` is the number of
    the record of which this one tells the outcome.
    """

    actor: Actor
    action: str = Field(min_length=1, max_length=100)
    subject: str = Field(default="", max_length=LONGEST_SUBJECT)
    details: dict[str, JsonValue] = Field(default_factory=dict)
    reason: str | None = Field(default=None, max_length=LONGEST_REASON)
    outcome: Outcome = Outcome.DONE
    about: int | None = None


class Record(DataModel):
    """An entry as it was written: `number` counts from 1 without gaps, `time` is in seconds since the epoch.

    `hash` is the SHA-256 over the hash of the record before and this one's contents, so that a record that was changed
    or taken out shows.
    """

    number: int
    time: float
    entry: Entry
    hash: str


def described(entry: Entry) -> str:
    """Describe what somebody did, in a few words."""
    mode = entry.details.get("mode")
    return f"{entry.action} ({mode})" if isinstance(mode, str) else entry.action
