"""What a person may say about a task that waits. A command names the task and the revision that was seen."""

from __future__ import annotations

from enum import StrEnum
from typing import Literal

from sequence_planner.control.command_base import CommandBase


class TaskCommand(CommandBase):
    """Refused when the task or its revision is gone, so that a late or repeated one is never about another task."""

    task: str
    revision: int

    @property
    def subject(self) -> str:
        """The task."""
        return f"task {self.task}"


class AcknowledgeTask(TaskCommand):
    """A person says that the task is done."""

    kind: Literal["acknowledge-task"] = "acknowledge-task"


class ProblemKind(StrEnum):
    """What is in the way, as far as one touch can say it."""

    MISSING = "missing"  # a part
    DAMAGED = "damaged"
    TOOL = "tool"
    OTHER = "other"


class ReportProblem(TaskCommand):
    """A person says that the task cannot be done as things are; `what` and the reason may say what is in the way."""

    kind: Literal["report-problem"] = "report-problem"
    what: ProblemKind | None = None


class SolveProblem(TaskCommand):
    """A person says that the task can be done after all."""

    kind: Literal["solve-problem"] = "solve-problem"
