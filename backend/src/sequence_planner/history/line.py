"""What happened between two times, for a time line: what is a mark of its own, and how much there is of all else.

Records of most kinds are few, and are found by the index of their kind. Starts, ends and plans are in the many records
of ticks and answers, which are read one by one where they are not too many; else they are only counted.
"""

from __future__ import annotations

import json
from itertools import pairwise
from typing import Any, Final

from sequence_planner.control.by_hand import KIND as BY_HAND
from sequence_planner.control.happenings import Answered, Asked
from sequence_planner.history.codec import BEGUN, KINDS, SNAPSHOT, TICKED, kind_of
from sequence_planner.history.view import LineView, MarkView, PlaceView
from sequence_planner.journal.run_journal import Place, RunRecord
from sequence_planner.journal.whole_run import WholeRun

MOST_READ: Final = 10_000  # records that are read one by one
MOST_MARKS: Final = 3000
BINS: Final = 60
ALARM: Final = "alarm"
_ASKED, _ANSWERED = kind_of(Asked), kind_of(Answered)
_SELDOM: Final = frozenset({*KINDS, BEGUN, ALARM, BY_HAND} - {TICKED, _ASKED, _ANSWERED})
_TOLD: Final = ("started", "ended", "called_off", "given_up", "plan", "mode")
_TELLING: Final = tuple(f'"{part}":' for part in _TOLD)
_PAGE: Final = 1000


def line(run: WholeRun, since: float, until: float) -> LineView | None:
    """What happened after `since` and up to `until`; None while the journal is empty."""
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
    return LineView(
        first=_place(first),
        last=_place(last),
        begin=before,
        end=end,
        running=_running(run, before) if whole else [],
        mode=_mode(run, before),
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


def _place(place: Place) -> PlaceView:
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


def _running(run: WholeRun, number: int) -> list[str]:
    """What had been started up to a record and had not ended."""
    whole = next(iter(run.before(number + 1, 1, (BEGUN, SNAPSHOT))), None)
    if whole is None:
        return []
    past = json.loads(whole.content)["memory"]["order.past"]
    running = {each["ability"]: None for each in past if each.get("ended") is None}
    for record in run.after(whole.number, max(number - whole.number, 0), (TICKED,)):
        if record.number > number or not any(part in record.content for part in _TELLING):
            continue
        content = json.loads(record.content)
        for name in (*content.get("ended", ()), *content.get("called_off", ())):
            running.pop(name, None)
        running |= dict.fromkeys(content.get("started", ()))
    return list(running)


def _mode(run: WholeRun, number: int) -> str | None:
    """The mode after a record."""
    kinds = (BEGUN, SNAPSHOT, "mode-changed", "errand-taken", "errand-stopped")
    for record in run.before(number + 1, 1, kinds):
        content = json.loads(record.content)
        mode = content.get("mode") or content.get("what", {}).get("mode")
        return None if mode is None else str(mode)
    return None


def _bins(run: WholeRun, since: float, until: float) -> list[int]:
    """How many records there are in each of as many equal parts of the time."""
    length = (until - since) / BINS
    edges = [since + each * length for each in range(BINS + 1)]
    numbers = [run.at(edge) for edge in edges]
    return [max(0, after - before) for before, after in pairwise(numbers)]
