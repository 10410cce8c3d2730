"""The part of a revision of a model that is told: whoever only shows it has no use for git."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Revision:
    """A saved revision: `id` is the hash of its commit, `tree` that of its files. Times are seconds since the epoch."""

    id: str
    name: str
    message: str
    by: str
    time: float
    tree: str
