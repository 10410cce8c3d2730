"""Who has been let in lately, for the time in which the database does not answer.

A database that restarts must not blind the screens of operators, nor keep anybody from pausing. So who was found within
the last minutes is let in as before; nobody else is. What cannot be recorded is refused by the controller all the same.
"""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from dataclasses import dataclass

from sequence_planner.identity.keys import Key
from sequence_planner.identity.sessions import SignedIn
from sequence_planner.identity.watches import Watch
from sequence_planner.web.cookies import Credentials

LONGEST = 300.0  # seconds
MOST = 1000


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


class BearerMemory:
    """Bearers by what they have shown, of which only a hash is kept. `round` changes whenever all is forgotten."""

    def __init__(self) -> None:
        self.round = 0
        self._found: OrderedDict[bytes, tuple[float, Bearer]] = OrderedDict()

    def keep(self, shown: Credentials, bearer: Bearer, now: float, asked_in: int) -> None:
        """Remember who was found at `now`, unless all was forgotten since the round in which it was asked."""
        mark = _mark(shown)
        self._found.pop(mark, None)
        if bearer == Bearer() or asked_in != self.round:
            return
        self._found[mark] = (now, bearer)
        if len(self._found) > MOST:
            self._found.popitem(last=False)

    def recall(self, shown: Credentials, now: float) -> Bearer | None:
        """Who has shown this lately, if what was shown has not expired since."""
        when, bearer = self._found.get(_mark(shown), (0.0, Bearer()))
        return bearer if 0 <= now - when <= LONGEST and now < bearer.expires else None

    def forget(self) -> None:
        """Forget everybody: something has changed."""
        self.round += 1
        self._found.clear()


def _mark(shown: Credentials) -> bytes:
    return hashlib.sha256(repr(shown).encode("utf-8", "surrogatepass")).digest()
