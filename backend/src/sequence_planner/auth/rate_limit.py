"""Rate limits on failed sign-in attempts, persisted in the database, and the journal's digest of refusals."""

from __future__ import annotations

import math
import threading
from dataclasses import dataclass
from enum import StrEnum
from ipaddress import IPv6Address, IPv6Network, ip_address

from sqlalchemy import ColumnElement, Connection, Row, delete, insert, select, update

from sequence_planner.auth.roles import IdentityRefused
from sequence_planner.auth.tables import ATTEMPTS
from sequence_planner.auth.tokens import hash_of, name_key
from sequence_planner.journal.entry import Entry
from sequence_planner.texts.message import message

# How often somebody may be wrong. Kept in the database, so that a restart does not forget it.
#
# Everybody who tries is counted as wrong first, and taken back when right: however many try at once, no more than the
# limit are let through. What a name or an address is counted under is a hash, so that a password typed in place of a
# name is not kept. Names that nobody has are counted like others.

WRONG_IN_A_ROW = 5  # for one name, before it has to wait
FIRST_WAIT = 60.0  # seconds; doubled with each further one
LONGEST_WAIT = 900.0
WINDOW = 60.0  # seconds in which those of one address are counted
FORGOTTEN_AFTER = 86400.0  # seconds without an attempt
CLOCK_PUT_BACK = 60.0  # seconds; attempts that are further in the future are of another time


class AttemptKind(StrEnum):
    """A kind of thing that attempts are counted for."""

    NAME = "name"
    ADDRESS = "address"
    PAIRING_ADDRESS = "pairing-address"
    PAIRING = "pairing"
    PROVIDER = "provider"


MOST_IN_WINDOW = {
    AttemptKind.ADDRESS: 10,
    AttemptKind.PAIRING_ADDRESS: 5,
    AttemptKind.PAIRING: 30,
    AttemptKind.PROVIDER: 20,
}


@dataclass(frozen=True)
class Counter:
    """A key that attempts are counted under: those at one name in a row, others in windows of a minute."""

    kind: AttemptKind
    subject: str


def of_name(name: str) -> Counter:
    """Attempts at one name, whether somebody has it or not."""
    return Counter(AttemptKind.NAME, hash_of(name_key(name)))


def of_address(kind: AttemptKind, address: str) -> Counter:
    """Attempts from one address; of IPv6, from the 64-bit network that one host has for itself (RFC 4291, 2.5.4)."""
    try:
        parsed = ip_address(address.partition("%")[0])
    except ValueError:
        return Counter(kind, hash_of(address))
    if isinstance(parsed, IPv6Address):
        parsed = parsed.ipv4_mapped or IPv6Network((parsed, 64), strict=False).network_address
    return Counter(kind, hash_of(str(parsed)))


EVERYBODY = Counter(AttemptKind.PAIRING, hash_of("everybody"))
"""Attempts to pair, whoever makes them."""


@dataclass(frozen=True)
class Waiting:
    """The one who has to wait, and for how many seconds."""

    counter: Counter
    seconds: float

    def refusal(self) -> IdentityRefused:
        """Return what to say; the same whoever has to wait."""
        seconds = math.ceil(self.seconds)
        return IdentityRefused(
            "too-many-attempts", message("refused.too-many-attempts.seconds", seconds=seconds), 429, retry_after=seconds
        )


def waiting(connection: Connection, counters: tuple[Counter, ...], now: float) -> Waiting | None:
    """The first of the counters that has to wait."""
    waits = (Waiting(counter, _wait(connection, counter, now)) for counter in counters)
    return next((each for each in waits if each.seconds > 0), None)


def count(connection: Connection, counters: tuple[Counter, ...], now: float) -> None:
    """Count an attempt as wrong, in the transaction that has checked it."""
    for counter in counters:
        row = _row(connection, counter)
        wrong, since = (1, now) if row is None or _over(counter, row, now) else (row.wrong + 1, row.since)
        values = {"wrong": wrong, "since": since, "last": now, "blocked_until": _blocked(counter, wrong, since, now)}
        if row is None:
            connection.execute(insert(ATTEMPTS).values(kind=counter.kind.value, subject=counter.subject, **values))
        else:
            connection.execute(update(ATTEMPTS).where(_at(counter)).values(values))


def forgive(connection: Connection, counters: tuple[Counter, ...]) -> None:
    """Take an attempt back that was right after all: a name begins anew, an address is rid of this one only.

    Who knows one password cannot, by signing in now and then, try others without end.
    """
    for counter in counters:
        if counter.kind is AttemptKind.NAME:
            connection.execute(delete(ATTEMPTS).where(_at(counter)))
        else:
            less = {"wrong": ATTEMPTS.c.wrong - 1, "blocked_until": 0.0}
            connection.execute(update(ATTEMPTS).where(_at(counter) & (ATTEMPTS.c.wrong > 0)).values(less))


def clear_attempts(connection: Connection, name: str) -> None:
    """Let a name begin anew, as after its password was reset."""
    connection.execute(delete(ATTEMPTS).where(_at(of_name(name))))


def _wait(connection: Connection, counter: Counter, now: float) -> float:
    row = _row(connection, counter)
    return 0.0 if row is None or now < row.last - CLOCK_PUT_BACK else float(row.blocked_until) - now


def _over(counter: Counter, row: Row[tuple[object, ...]], now: float) -> bool:
    return counter.kind is not AttemptKind.NAME and not row.since <= now < row.since + WINDOW


def _blocked(counter: Counter, wrong: int, since: float, now: float) -> float:
    if counter.kind is not AttemptKind.NAME:
        return since + WINDOW if wrong >= MOST_IN_WINDOW[counter.kind] else 0.0
    more = wrong - WRONG_IN_A_ROW
    return now + min(FIRST_WAIT * 2.0 ** min(more, 10), LONGEST_WAIT) if more >= 0 else 0.0


def _row(connection: Connection, counter: Counter) -> Row[tuple[object, ...]] | None:
    return connection.execute(select(ATTEMPTS).where(_at(counter))).first()


def _at(counter: Counter) -> ColumnElement[bool]:
    return (ATTEMPTS.c.kind == counter.kind.value) & (ATTEMPTS.c.subject == counter.subject)


# Refusals by a limit, gathered for the journal: whoever floods the door does not flood the journal as well.

EVERY = 60.0  # seconds between two entries for one name or address


@dataclass(frozen=True)
class _Gathered:
    """Refusals by one counter that no entry tells of yet, and when the last entry was written."""

    entry: Entry
    number: int
    told: float | None


class RefusalLog:
    """The first refusal of a name or an address is told at once, further ones together a minute later.

    Only who has been counted is refused, and that is limited itself, so this does not grow without end.
    """

    def __init__(self) -> None:
        self._gathered: dict[Counter, _Gathered] = {}
        self._lock = threading.Lock()

    def add_refusal(self, counter: Counter, entry: Entry, now: float) -> None:
        """Somebody was refused; of several, `entry` tells of the last."""
        with self._lock:
            before = self._gathered.get(counter)
            number, told = (0, None) if before is None else (before.number, before.told)
            self._gathered[counter] = _Gathered(entry, number + 1, told)

    def due(self, now: float) -> bool:
        """Return whether there is something to tell."""
        with self._lock:
            return any(_due(each, now) for each in self._gathered.values())

    def collect_due(self, now: float) -> list[Entry]:
        """The entries that are due, each with the number of refusals that it stands for."""
        with self._lock:
            due = {counter: each for counter, each in self._gathered.items() if _due(each, now)}
            later = {key: each for key, each in self._gathered.items() if each.number or _recent(each, now)}
            self._gathered = {**later, **{key: _Gathered(each.entry, 0, now) for key, each in due.items()}}
        return [
            each.entry.model_copy(update={"details": {**each.entry.details, "times": each.number}})
            for each in due.values()
        ]


def _due(gathered: _Gathered, now: float) -> bool:
    return gathered.number > 0 and not _recent(gathered, now)


def _recent(gathered: _Gathered, now: float) -> bool:
    return gathered.told is not None and abs(now - gathered.told) < EVERY
