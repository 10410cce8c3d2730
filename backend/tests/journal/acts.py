"""Acts to record."""

from __future__ import annotations

from sequence_planner.core.actor import SYSTEM, Actor, ActorKind
from sequence_planner.db.database import Database
from sequence_planner.journal import audit
from sequence_planner.journal.entry import Entry, Record

EVA = Actor(kind=ActorKind.PERSON, id="person-7", name="Eva Åkesson", session="s-1", address="127.0.0.1")


def act(number: int) -> Entry:
    """The odd ones set the mode, the even ones are acknowledgements by Eva."""
    if number % 2:
        return Entry(actor=SYSTEM, action="set-mode", details={"mode": "automatic", "share": 1 / number})
    return Entry(actor=EVA, action="acknowledge", subject=f"task {number - 1}", reason="Bolts placed")


def filled(database: Database, many: int) -> list[Record]:
    """Append so many acts; their numbers are their times too."""
    with database.writing() as connection:
        return [audit.append(connection, act(number), float(number)) for number in range(1, many + 1)]
