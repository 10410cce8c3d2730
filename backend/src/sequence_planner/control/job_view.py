"""What is shown of the jobs that a station works, and of those that have ended and are not forgotten yet."""

from __future__ import annotations

from enum import StrEnum

from sequence_planner.control.view_part import View
from sequence_planner.control.vocabulary import JobState


class JobStepState(StrEnum):
    """Where an operation of a job stands."""

    WAITING = "waiting"  # others come first, or its job lets none begin
    ELIGIBLE = "eligible"  # active as soon as its precondition holds
    ACTIVE = "active"
    COMPLETED = "completed"


class JobStepView(View):
    """An operation of a job: when it was active first, and when it was completed.

    One whose goal held already is completed without having been active. It `waits_for` operations of its job, or of
    another, written `job/operation`.
    """

    state: JobStepState
    waits_for: list[str]
    started: float | None
    ended: float | None


class JobView(View):
    """A job, with its operations in the order of its work master.

    `begun` is when what its product brings was there. With `stopping` no further operation begins, and it is `stopped`
    as soon as those that were active then are completed. `waits_for` says in words what keeps it from going on.
    """

    title: str
    work_master: str
    state: JobState
    stopping: bool
    taken: float
    begun: float | None
    ended: float | None
    waits_for: list[str]
    steps: dict[str, JobStepView]
