"""Who has made and checked backups: in the journal, before it is begun and when it has ended."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import Final

from pydantic import JsonValue
from sqlalchemy import Connection

from sequence_planner.actor import Actor
from sequence_planner.backup.trouble import Trouble
from sequence_planner.journal import audit
from sequence_planner.journal.entry import Entry, Outcome, Record

_LOOKED_AT: Final = 200  # of the newest records of each kind


class Doing(StrEnum):
    """What is done with a backup, as the journal calls it."""

    MAKING = "make-backup"
    CHECKING = "check-backup"


@dataclass(frozen=True)
class Attempt:
    """How something with a backup ended, or `REQUESTED` where that was not told; and why it failed."""

    doing: Doing
    file: str
    time: float
    by: Actor
    outcome: Outcome
    trouble: Trouble
    why: str


@dataclass(frozen=True)
class Recorded:
    """What was done last, what was made last, and how each file was found when it was last read as a whole, by name."""

    last: Attempt | None
    made: Attempt | None
    checked: dict[str, Attempt]


def begun(connection: Connection, doing: Doing, by: Actor, file: str, now: float) -> int:
    """Record that it begins; the number of the record."""
    entry = Entry(actor=by, action=doing, subject=file, outcome=Outcome.REQUESTED)
    return audit.append(connection, entry, now).number


def ended(
    connection: Connection,
    doing: Doing,
    by: Actor,
    file: str,
    now: float,
    *,
    outcome: Outcome = Outcome.DONE,
    about: int | None = None,
    details: Mapping[str, JsonValue] = MappingProxyType({}),
) -> None:
    """Record how it ended; `about` is the number of the record with which it began, where there is one."""
    entry = Entry(actor=by, action=doing, subject=file, outcome=outcome, about=about, details=dict(details))
    audit.append(connection, entry, now)


def recorded(connection: Connection) -> Recorded:
    """What the journal tells of the latest."""
    records = [each for doing in Doing for each in audit.read(connection, limit=_LOOKED_AT, action=doing)]
    attempts = [_attempt(each) for each in sorted(records, key=lambda record: record.number)]
    # What was made was read again then; what could not be read for another reason says nothing of the file.
    said = [each for each in attempts if each.outcome is Outcome.DONE or each.trouble is Trouble.NOT_WHOLE]
    return Recorded(
        last=attempts[-1] if attempts else None,
        made=next((each for each in reversed(attempts) if each.doing is Doing.MAKING), None),
        checked={each.file: each for each in said},
    )


def _attempt(record: Record) -> Attempt:
    entry = record.entry
    trouble = Trouble(str(entry.details.get("trouble", Trouble.OTHER)))
    why = str(entry.details.get("why", ""))
    return Attempt(Doing(entry.action), entry.subject, record.time, entry.actor, entry.outcome, trouble, why)
