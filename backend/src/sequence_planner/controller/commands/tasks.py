"""Tasks that wait for people, and the commands for them: what a person may say about one, as it was seen."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, Literal

from pydantic import Field

from sequence_planner.controller.commands.command import Command, Revision, Route


class ProblemKind(StrEnum):
    """What is in the way, as far as one touch can say it."""

    MISSING = "missing"  # a part
    DAMAGED = "damaged"
    TOOL = "tool"
    OTHER = "other"


@dataclass(frozen=True)
class WaitingTask:
    """A task that waits for a person; `created` in seconds since the epoch."""

    id: str
    revision: int
    ability: str
    title: str
    text: str
    created: float


@dataclass(frozen=True)
class TaskProblem:
    """An obstacle that keeps somebody from doing a task: who says so, since when (seconds since the epoch), and why, if
    told.
    """

    by: str
    since: float
    why: str
    what: ProblemKind | None = None


class TaskCommand(Command):
    """Refused when the task or its revision is gone, so that a late or repeated one is never about another task."""

    about = "task {task}"
    task: Annotated[str, Field(max_length=200)]
    revision: Revision


class AcknowledgeTask(TaskCommand):
    """Say that a task is done; refused when the task or its revision is gone, or a watch is not for its resource."""

    routes = (
        Route(
            "POST",
            "/tasks/{task}/acknowledgement",
            "acknowledge_task",
            tag="actions",
            body="AcknowledgementBody",
            body_text="The task is done.",
            watch=True,
            may_say_why=False,
        ),
    )
    kind: Literal["acknowledge-task"] = "acknowledge-task"


class ReportProblem(TaskCommand):
    """Say that a task cannot be done as things are; refused as an acknowledgement is.

    It raises an alarm until the task is over or the problem solved, and changes nothing else. Said again, it is told
    with the last reason.
    """

    routes = (
        Route(
            "POST",
            "/tasks/{task}/problem",
            "report_problem",
            tag="actions",
            body="ProblemBody",
            body_text="The task cannot be done as things are; `what` is in the way as far as one touch can say it, and "
            "the reason.",
            watch=True,
        ),
    )
    kind: Literal["report-problem"] = "report-problem"
    what: ProblemKind | None = None


class SolveProblem(TaskCommand):
    """Say that a task can be done after all; refused as an acknowledgement is."""

    routes = (
        Route(
            "POST",
            "/tasks/{task}/problem/solved",
            "solve_problem",
            tag="actions",
            body="SolvedBody",
            body_text="The task can be done after all.",
            watch=True,
            may_say_why=False,
        ),
    )
    kind: Literal["solve-problem"] = "solve-problem"
