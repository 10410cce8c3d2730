"""Who has been let in, for the time in which the database does not answer.

A database that restarts must not blind the screens of operators, nor keep anybody from pausing, however long it is
away. So whoever was signed in is let in as before, as long as the session would last; nobody else is. Whenever
something has changed, all who are remembered are looked up again: whoever was signed out or revoked by then stays out.
What cannot be recorded is refused by the controller all the same.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, replace

from sqlalchemy import Connection

from sequence_planner.identity import keys, sessions, watches
from sequence_planner.identity.keys import Key
from sequence_planner.identity.sessions import LONGEST_IDLE, SignedIn
from sequence_planner.identity.watches import Watch, WatchState
from sequence_planner.web.cookies import Credentials

MOST = 1000
_LET_IN = (WatchState.WAITING, WatchState.ACTIVE)


@dataclass(frozen=True)
class Bearer:
    """Who shows credentials: those of them that are right."""

    signed_in: SignedIn | None = None
    watch: Watch | None = None
    key: Key | None = None

    @property
    def expires(self) -> float:
        """When the first of them ends at the latest, in seconds since the epoch."""
        return min((each.expires for each in (self.signed_in, self.watch, self.key) if each), default=0.0)


@dataclass
class _Remembered:
    used: float  # seconds since the epoch
    bearer: Bearer


class BearerMemory:
    """Bearers by what they have shown, of which only a hash is kept. `round` counts how often all were looked up."""

    def __init__(self) -> None:
        self.round = 0
        self._found: dict[bytes, _Remembered] = {}  # the one that was not found for longest is the first

    def keep(self, shown: Credentials, bearer: Bearer, now: float, asked_in: int) -> None:
        """Remember who was found at `now`. What was asked before all were looked up again says nothing new."""
        mark = _mark(shown)
        if bearer == Bearer():
            self._found.pop(mark, None)
        elif asked_in == self.round:
            self._found.pop(mark, None)
            self._found[mark] = _Remembered(now, bearer)
            if len(self._found) > MOST:
                del self._found[next(iter(self._found))]

    def recall(self, shown: Credentials, now: float) -> Bearer | None:
        """Who has shown this before, if that has not ended since: a session lasts for an hour without a request."""
        found = self._found.get(_mark(shown))
        if found is None or now >= found.bearer.expires or abs(now - found.used) > LONGEST_IDLE:
            return None
        found.used = now
        return found.bearer

    def look_up(self, connection: Connection, now: float) -> Callable[[], None]:
        """Look all up again; what is found counts once what is given back is called, as what was changed is durable."""
        before = dict(self._found)
        found = _still_there([each.bearer for each in before.values()], connection, now)

        def take() -> None:
            self.round += 1
            for (mark, each), bearer in zip(before.items(), found, strict=True):
                if bearer is None:
                    self._found.pop(mark, None)
                else:
                    each.bearer = bearer
            for mark in self._found.keys() - before.keys():  # kept since, and not looked up
                del self._found[mark]

        return take

    def forget(self, whose: Callable[[Bearer], bool]) -> None:
        """Forget these, as they could not be looked up."""
        self.round += 1
        for mark in [mark for mark, each in self._found.items() if whose(each.bearer)]:
            del self._found[mark]


def _still_there(bearers: list[Bearer], connection: Connection, now: float) -> list[Bearer | None]:
    """Each as it is by now; None where one of its credentials works no more."""
    signed_in = [each.signed_in.session for each in bearers if each.signed_in is not None]
    live = sessions.find_all_live(connection, signed_in, now) if signed_in else {}
    worn = {each.id: each for each in watches.all_watches(connection, now)} if any(b.watch for b in bearers) else {}
    made = {each.id: each for each in keys.all_keys(connection)} if any(b.key for b in bearers) else {}

    def as_it_is(bearer: Bearer) -> Bearer | None:
        session, watch, key = bearer.signed_in, bearer.watch, bearer.key
        if session is not None and (session := live.get(session.session)) is None:
            return None
        if watch is not None and ((watch := worn.get(watch.id)) is None or watch.state not in _LET_IN):
            return None
        if key is not None and not _is_as_it_was(key, made.get(key.id)):
            return None
        return replace(bearer, signed_in=session, watch=watch)

    return [as_it_is(each) for each in bearers]


def _is_as_it_was(key: Key, found: Key | None) -> bool:
    """Whether a key was neither revoked nor given another secret since."""
    if found is None or found.revoked is not None:
        return False
    return (key.former_until, key.created) == (found.former_until, found.created)


def _mark(shown: Credentials) -> bytes:
    return hashlib.sha256(repr(shown).encode("utf-8", "surrogatepass")).digest()
