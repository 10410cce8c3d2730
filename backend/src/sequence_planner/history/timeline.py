"""Time line of past events, and the request and response schemas of the history."""

from __future__ import annotations

import json
from itertools import pairwise
from typing import Any, Final

from pydantic import JsonValue, ValidationError

from sequence_planner.controller.alarms.kinds import BY_HAND
from sequence_planner.controller.views.part import Value, View
from sequence_planner.controller.views.station import (
    AlarmView,
    ForceView,
    JobView,
    OperatorPlanView,
    PackML,
    ServiceView,
    StepStatus,
)
from sequence_planner.controller.views.wording import reason_text
from sequence_planner.core.immutable import Immutable
from sequence_planner.execution.events import Answered, Asked, CalledOff, ModeChanged, OperatorPlanStopped
from sequence_planner.execution.record.codec import BEGUN, KINDS, SNAPSHOT, TICKED, kind_of
from sequence_planner.execution.vocabulary import Mode, PlanStatus, Production
from sequence_planner.journal.full_run import WholeRun
from sequence_planner.journal.run_journal import RecordPlace, RunRecord
from sequence_planner.texts.message import Message

# What is asked about the past, and what is told of it.


class RunRecordView(View):
    """Something that has happened. What `content` has depends on the `kind`; `docs/journal.md` says what.

    `plan_message` is why the plan is as `content` says, for readers of other languages.
    """

    number: int
    time: float
    kind: str
    content: dict[str, JsonValue]
    plan_message: Message | None
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

    `first` and `last` are those of the whole journal. `running` had been started before, the operations `active` were
    so, `mode` was the mode then, and `alarms` had come and were not over: each as it came. Without `whole` there is too
    much for every start, end and plan to be a mark of its own. `bins` counts the records in equal parts of the time.
    """

    first: PlaceView
    last: PlaceView
    begin: int
    end: int
    running: list[str]
    active: list[str]
    mode: str | None
    alarms: list[MarkView]
    marks: list[MarkView]
    whole: bool
    bins: list[int]


class PastStepView(View):
    """A start of the plan as it was then; with `called_off` it ended as it was called off. `operations` are the active
    ones that it serves, while it runs or is ahead.
    """

    ability: str
    title: str
    status: StepStatus
    tick: int
    started: float | None
    ended: float | None
    called_off: bool
    operations: list[str]


class PastPlanView(View):
    """The plan as it was then, and why it was that or none. `steps` are its starts, and what ran still of plans before
    it.
    """

    status: PlanStatus
    reason: str
    reason_message: Message
    steps: list[PastStepView]


class PastView(View):
    """State of the station at a record. `running` are the abilities under way, `active` the active operations."""

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
    errand: OperatorPlanView | None
    forces: dict[str, ForceView]
    out_of_service: list[ServiceView]


class MomentView(View):
    """A record, and how the station was right after it. `alarms` are those that stood then, by their keys, each as it
    was told last; those that were told as part of another are not among them.
    """

    record: RunRecordView
    past: PastView
    alarms: dict[str, AlarmView]


class BranchView(View):
    """Result of a simulation: the records that the station would have written, and its state after them.

    `seconds` is the time that was simulated. With `cut` these are the first records only.
    """

    seconds: float
    records: list[RunRecordView]
    cut: bool
    end: PastView


class LookBack(Immutable):
    """The question how the station was at this record."""

    number: int


class TakeBranch(Immutable):
    """The question how it would have gone on from there, with these corrections; `deadline` seconds are there to find
    out.
    """

    number: int
    seconds: float
    corrections: dict[str, Value]
    deadline: float


Question = LookBack | TakeBranch
Answer = MomentView | BranchView


def record_view(record: RunRecord) -> RunRecordView:
    """A record as it is shown. What a snapshot keeps for replay is left out: it is shown as the past that it is."""
    content = json.loads(record.content)
    content.pop("memory", None)
    reason = content.get("plan", {}).get("reason")
    return RunRecordView(
        number=record.number,
        time=record.time,
        kind=record.kind,
        content=content,
        plan_message=reason_text(reason) if reason else None,
        hash=record.hash,
    )


# What happened between two times, for a time line: what is a mark of its own, and how much there is of all else.
#
# Records of most kinds are few, and are found by the index of their kind. Starts, ends and plans are in the many
# records of ticks and answers, which are read one by one where they are not too many; else they are only counted.

MOST_READ: Final = 10_000  # records that are read one by one
MOST_MARKS: Final = 3000
MOST_ALARMS: Final = 300  # records of alarms that are read to find those that stand
BINS: Final = 60
ALARM: Final = "alarm"
_ASKED, _ANSWERED = kind_of(Asked), kind_of(Answered)
_ENDING: Final = (TICKED, *map(kind_of, (ModeChanged, CalledOff, OperatorPlanStopped)))  # which say what ended
_SELDOM: Final = frozenset({*KINDS, BEGUN, ALARM, BY_HAND.name} - {TICKED, _ASKED, _ANSWERED})
_TOLD: Final = ("started", "at_once", "ended", "called_off", "given_up", "activated", "completed", "plan", "mode")
_TELLING: Final = tuple(f'"{part}":' for part in _TOLD)
_CAME: Final = ("came", "came again")
_OVER: Final = ("returned", "ended")
_PART: Final = "became part of another"
_PAGE: Final = 1000


def line(run: WholeRun, since: float, until: float) -> LineView | None:
    """Return what happened after `since` and up to `until`; None while the journal is empty."""
    bounds = run.bounds()
    if bounds is None:
        return None
    first, last = bounds
    before, end = (run.at(time) for time in (since, until))
    marks = _all(run, before, end) if end - before <= MOST_READ else None
    whole = marks is not None and len(marks) <= MOST_MARKS
    if marks is None or not whole:
        found = run.after(before, MOST_MARKS + 1, _SELDOM)
        marks = [_mark(each) for each in found if each.number <= end]
    running, active = _under_way(run, before) if whole else ([], [])
    return LineView(
        first=_place(first),
        last=_place(last),
        begin=before,
        end=end,
        running=running,
        active=active,
        mode=_mode(run, before),
        alarms=_standing(run, before),
        marks=marks[:MOST_MARKS],
        whole=whole,
        bins=_bins(run, since, until),
    )


def place_at(run: WholeRun, time: float) -> PlaceView | None:
    """The last record up to a time, or the first one there is; None while the journal is empty."""
    bounds = run.bounds()
    if bounds is None:
        return None
    number = max(bounds[0].number, run.at(time))
    found = run.get(number)
    return None if found is None else PlaceView(number=number, time=found.time)


def _place(place: RecordPlace) -> PlaceView:
    return PlaceView(number=place.number, time=place.time)


def _all(run: WholeRun, before: int, end: int) -> list[MarkView]:
    """Of all records behind `before`, up to `end`."""
    marks: list[MarkView] = []
    while before < end and (page := run.after(before, min(_PAGE, end - before))):
        marks += [
            _mark(each) for each in page if each.kind in _SELDOM or any(part in each.content for part in _TELLING)
        ]
        before = page[-1].number
    return [each for each in marks if each.kind not in (TICKED, _ANSWERED, _ASKED, SNAPSHOT) or each.content]


def _mark(record: RunRecord) -> MarkView:
    content = json.loads(record.content)
    told: dict[str, Any] = {} if record.kind == SNAPSHOT else {name: content[name] for name in _TOLD if name in content}
    if record.kind in _SELDOM and record.kind != BEGUN:
        told |= {name: value for name, value in content.get("what", content).items() if name not in ("now", "errand")}
        told.pop("diagnosis", None)
    return MarkView(number=record.number, time=record.time, kind=record.kind, content=told)


def _under_way(run: WholeRun, number: int) -> tuple[list[str], list[str]]:
    """Return the abilities that had been started up to a record and had not ended, and the operations active then."""
    whole = next(iter(run.before(number + 1, 1, (BEGUN, SNAPSHOT))), None)
    if whole is None:
        return [], []
    memory = json.loads(whole.content)["memory"]
    running = {each["ability"]: None for each in memory["order.past"] if each.get("ended") is None}
    active = dict.fromkeys(memory["active"])
    for record in run.after(whole.number, max(number - whole.number, 0), _ENDING):
        if record.number > number or not any(part in record.content for part in _TELLING):
            continue
        content = json.loads(record.content)
        for name in (*content.get("ended", ()), *content.get("called_off", ())):
            running.pop(name, None)
        at_once = content.get("at_once", ())
        running |= dict.fromkeys(name for name in content.get("started", ()) if name not in at_once)
        for name in content.get("completed", ()):
            active.pop(name, None)
        active |= dict.fromkeys(content.get("activated", ()))
    return list(running), list(active)


def _standing(run: WholeRun, number: int) -> list[MarkView]:
    """Return the alarms that stood after a record, each as it came last; of very old ones nothing is known."""
    seen: dict[str, bool] = {}
    found: list[MarkView] = []
    for record in run.before(number + 1, MOST_ALARMS, (ALARM, BEGUN)):
        if record.kind == BEGUN:
            break  # a controller that starts tells anew what stands
        mark = _mark(record)
        key, event = str(mark.content.get("alarm")), mark.content.get("event")
        over = seen.setdefault(key, event in _OVER or mark.content.get("ended") is not None)
        if event in _CAME and not over:
            found.append(mark)
            seen[key] = True
    return found[::-1]


def standing_alarms(run: WholeRun, number: int) -> dict[str, AlarmView]:
    """Return the alarms that stood after a record, as each was told last; of very old ones nothing is known."""
    seen: set[str] = set()
    found: dict[str, AlarmView] = {}
    for record in run.before(number + 1, MOST_ALARMS, (ALARM, BEGUN)):
        if record.kind == BEGUN:
            break
        content = json.loads(record.content)
        key = str(content.pop("alarm", ""))
        if key in seen:
            continue
        seen.add(key)
        if content.pop("event", "") == _PART or content.get("ended") is not None:
            continue
        try:
            found[key] = AlarmView.model_validate(content)
        except (ValidationError, LookupError):
            continue  # another version of the program told it differently
    return found


def _mode(run: WholeRun, number: int) -> str | None:
    """The mode after a record."""
    kinds = (BEGUN, SNAPSHOT, "mode-changed", "errand-taken", "errand-stopped")
    for record in run.before(number + 1, 1, kinds):
        content = json.loads(record.content)
        mode = content.get("mode") or content.get("what", {}).get("mode")
        return None if mode is None else str(mode)
    return None


def _bins(run: WholeRun, since: float, until: float) -> list[int]:
    """Count the records that there are in each of as many equal parts of the time."""
    length = (until - since) / BINS
    edges = [since + each * length for each in range(BINS + 1)]
    numbers = [run.at(edge) for edge in edges]
    return [max(0, after - before) for before, after in pairwise(numbers)]
