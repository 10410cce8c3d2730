"""What is to be put into an order, and the order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias


@dataclass(frozen=True)
class Operation:
    """An operation of a job that is not completed.

    `after` are those of the same job that come before it; one that is not among the job's operations is completed.
    `seconds` is how long it is expected to take, and `started` since when (seconds since the epoch) it is active. While
    it is worked no operation of another job is on its `resources`.
    """

    after: frozenset[str]
    seconds: float
    resources: frozenset[str]
    started: float | None = None


@dataclass(frozen=True)
class Work:
    """What is left of a job. `due` and `earliest`, before which it does not begin, are in seconds since the epoch.

    The higher its `priority`, the more it weighs when it is late. One that has `begun` goes on.
    """

    job: str
    priority: int
    due: float | None
    earliest: float | None
    operations: Mapping[str, Operation]
    begun: bool = False


Step: TypeAlias = tuple[str, str]
"""A job and one of its operations."""


@dataclass(frozen=True)
class Schedule:
    """In which order to work.

    `jobs` are in the order in which they begin. `starts` has when each operation is expected to start and to end
    (seconds since the epoch). `waits` says which operations of other jobs, on a common resource, each one waits for,
    and no more than is needed to say so; see `waits.waits_among` for those of some jobs. `late` has the seconds by
    which jobs are expected to miss their due time, `tardiness` is the sum of these times their weights, which nothing
    brings below `bound`. The first `horizon` jobs were searched, the others follow by rule. It is `optimal` when there
    is proof that neither that sum nor, with it, the time at which all is done can be less. `fallback` says why the
    order is only that of priority, due time and storage; empty if it is not.
    """

    jobs: list[str]
    starts: dict[Step, tuple[float, float]]
    waits: dict[Step, list[Step]]
    late: dict[str, float]
    tardiness: float
    bound: float
    optimal: bool
    horizon: int
    fallback: str = ""


def weight(priority: int) -> int:
    """How much a second counts that a job of this priority is late."""
    return max(priority, 0) + 1
