"""What is asked about the past, and what is told of it."""

from __future__ import annotations

import json

from pydantic import JsonValue

from sequence_planner.control.job_view import JobView
from sequence_planner.control.restart_view import ErrandView, ForceView, ServiceView
from sequence_planner.control.view import PackML, StepStatus
from sequence_planner.control.view_part import Value, View
from sequence_planner.control.vocabulary import Mode, PlanStatus, Production
from sequence_planner.immutable import Immutable
from sequence_planner.journal.run_journal import RunRecord


class RunRecordView(View):
    """Something that has happened. What `content` has depends on the `kind`; `docs/journal.md` says what."""

    number: int
    time: float
    kind: str
    content: dict[str, JsonValue]
    hash: str


class PlaceView(View):
    """A record's number, and when it was written."""

    number: int
    time: float


class MarkView(View):
    """A record as a time line shows it. Of its content there is what is drawn."""

    number: int
    time: float
    kind: str
    content: dict[str, JsonValue]


class LineView(View):
    """What happened between two times: the records behind number `begin`, up to `end`.

    `first` and `last` are those of the whole journal. `running` had been started before, and `mode` was the mode then.
    Without `whole` there is too much for every start, end and plan to be a mark of its own. `bins` counts the records
    in equal parts of the time.
    """

    first: PlaceView
    last: PlaceView
    begin: int
    end: int
    running: list[str]
    mode: str | None
    marks: list[MarkView]
    whole: bool
    bins: list[int]


class PastStepView(View):
    """A start of the plan as it was then."""

    ability: str
    title: str
    status: StepStatus
    tick: int
    started: float | None
    ended: float | None


class PastPlanView(View):
    """The plan as it was then, and why it was that or none."""

    status: PlanStatus
    reason: str
    steps: list[PastStepView]


class PastView(View):
    """How the station was. `running` are the abilities under way, `active` the active operations."""

    tick: int
    revision: int
    mode: Mode
    packml: PackML
    production: Production
    stepping: bool
    values: dict[str, Value | None]
    running: list[str]
    active: list[str]
    by_order: bool
    jobs: dict[str, JobView]
    plan: PastPlanView
    errand: ErrandView | None
    forces: dict[str, ForceView]
    out_of_service: list[ServiceView]


class MomentView(View):
    """A record, and how the station was right after it."""

    record: RunRecordView
    past: PastView


class BranchView(View):
    """How the station would have gone on: the records that it would have written, and how it would have been then.

    `seconds` is the time that was simulated. With `cut` these are the first records only.
    """

    seconds: float
    records: list[RunRecordView]
    cut: bool
    end: PastView


class LookBack(Immutable):
    """How was the station at this record?"""

    number: int


class TakeBranch(Immutable):
    """How would it have gone on from there, with these corrections? `deadline` seconds are there to find out."""

    number: int
    seconds: float
    corrections: dict[str, Value]
    deadline: float


class Refused(Immutable):
    """Why there is no answer: a slug, and what a person is told."""

    slug: str
    detail: str


Question = LookBack | TakeBranch
Answer = MomentView | BranchView | Refused


def record_view(record: RunRecord) -> RunRecordView:
    """A record as it is shown. What a snapshot keeps for replay is left out: it is shown as the past that it is."""
    content = json.loads(record.content)
    content.pop("memory", None)
    return RunRecordView(number=record.number, time=record.time, kind=record.kind, content=content, hash=record.hash)
