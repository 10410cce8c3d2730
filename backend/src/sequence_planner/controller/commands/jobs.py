"""Commands for jobs: which of them a station takes that works by order, in which order, and how they go on."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field, StrictBool

from sequence_planner.controller.commands.command import Command, Route, Why
from sequence_planner.core.actor import ActorKind
from sequence_planner.core.data_models import DataModel

JobId = Annotated[str, Field(pattern=r"^[A-Za-z0-9._-]{1,64}$")]
Operation = Annotated[str, Field(min_length=1, max_length=400)]
_NO_CONTROL = (ActorKind.KEY, ActorKind.SYSTEM)  # orders come from other systems, which never are in control


class OrderCommand(Command):
    """A command about jobs. Only a person has to be in control for it."""

    @property
    def needs_control(self) -> bool:
        """A job moves devices; it goes on in the mode that a person has chosen."""
        return self.actor.kind not in _NO_CONTROL


class TakeJob(OrderCommand):
    """Work a job of a work master. Asking for it again changes nothing."""

    kind: Literal["take-job"] = "take-job"
    about = "job {job}"
    job: JobId
    title: str = Field(min_length=1, max_length=200)
    work_master: str = Field(min_length=1, max_length=400)


class JobOperation(DataModel):
    """An operation of a job."""

    job: JobId
    operation: Operation


class JobWait(JobOperation):
    """It is not eligible before the operations it waits `for` are completed, or their jobs are over."""

    for_: Annotated[list[JobOperation], Field(alias="for", max_length=1000)]
    model_config = ConfigDict(frozen=True, extra="forbid", validate_by_name=True, serialize_by_alias=True)


class SequenceJobs(OrderCommand):
    """The order between operations of different jobs, in place of what was said before.

    What it says of jobs that are not under way, and of operations that they do not have, is ignored.
    """

    kind: Literal["sequence-jobs"] = "sequence-jobs"
    waits: list[JobWait] = Field(max_length=10_000)


class CommandJob(OrderCommand):
    """A job is paused, resumed, stopped once what is active is completed, or aborted at once."""

    kind: Literal["command-job"] = "command-job"
    about = "job {job}"
    job: JobId
    what: Literal["pause", "resume", "stop", "abort"]

    @property
    def needs_control(self) -> bool:
        """To go on needs it; anybody who may act may keep a job from going on."""
        return self.what == "resume" and super().needs_control


class ForgetJob(OrderCommand):
    """A job that has ended is shown no longer: whoever ordered it knows how it ended."""

    kind: Literal["forget-job"] = "forget-job"
    about = "job {job}"
    job: JobId


class SetByOrder(Command):
    """Let operations of work masters be active for job orders only, or whenever they can be. It takes control."""

    routes = (
        Route(
            "PUT",
            "/settings/job-mode",
            "set_job_mode",
            tag="modes",
            body="ByOrderBody",
            body_text="Whether the station is to work by order, and why.",
        ),
    )
    kind: Literal["work-by-order"] = "work-by-order"
    for_control = True
    reason: Why
    on: StrictBool
