"""The part of a revision of a model that is told: whoever only shows it has no use for git."""

from __future__ import annotations

import re
from dataclasses import dataclass

_UNWRITABLE = re.compile(r"[<>\x00-\x1f]")


@dataclass(frozen=True)
class Revision:
    """A saved revision: `id` is the hash of its commit, `tree` that of its files. Times are seconds since the epoch."""

    id: str
    name: str
    message: str
    by: str
    time: float
    tree: str
    author: str  # the id of who saved it, as a commit has it

    def is_by(self, id_: str) -> bool:
        """Return whether an actor with this id has saved it."""
        return self.author == in_commit(id_)


def in_commit(text: str) -> str:
    """Return the text as the author of a commit can have it."""
    return _UNWRITABLE.sub(" ", text)
