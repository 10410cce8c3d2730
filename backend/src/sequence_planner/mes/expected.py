"""When orders are expected to begin and to be ready, by how long orders of the same work master took."""

from __future__ import annotations

import json
from collections import defaultdict, deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from heapq import heapify, heappop, heappush
from math import inf, isfinite
from statistics import median
from typing import Any, Final

from sqlalchemy import Connection, func, select

from sequence_planner.controller.alarms.kinds import GIVEN_UP, MANY_SILENT, NEVER_HEARD, OVERDUE, SILENT, STILL
from sequence_planner.controller.views.details import WorkMastersView
from sequence_planner.controller.views.station import PlanStepView, StationStanding, StationView, StepStatus
from sequence_planner.execution.vocabulary import JobState, PlanStatus
from sequence_planner.mes.order import JobOrder, OrderState, Wish
from sequence_planner.mes.queue import in_the_way, station_waits
from sequence_planner.mes.responses import JobOutcome
from sequence_planner.mes.tables import JOB_RESPONSES

# How long an order takes: from its begin to its end, as the last ones of its work master did that were completed.

REMEMBERED: Final = 20  # orders of a work master
_A_BIT_LONGER: Final = 1.1
_LOOK_BACK: Final = 500  # responses that are read at most: nobody asks for weeks


class CycleTimes:
    """Reads on in what was made of orders, also of those that were cleared since."""

    def __init__(self) -> None:
        self._number = 0  # of the last response that was read
        self._seconds: dict[str, deque[float]] = defaultdict(lambda: deque(maxlen=REMEMBERED))

    def seconds(self, work_master: str) -> float | None:
        """Return how long an order takes: the median of the last ones; None before one was completed."""
        made = self.last_seconds(work_master)
        return median(made) if made else None

    def last_seconds(self, work_master: str) -> list[float]:
        """Return how long the last ones took, the oldest first."""
        return list(self._seconds.get(work_master, ()))

    def longer(self, work_master: str, than: float) -> float:
        """Return how long an order takes that has taken so long already: as the others did that took longer. One that
        takes a bit longer than any may still be expected, and else nobody knows.
        """
        made = self.last_seconds(work_master)
        others = [seconds for seconds in made if seconds > than]
        at_most = max(made, default=0.0) * _A_BIT_LONGER
        return median(others) if others else at_most if at_most > than else inf

    def read_on(self, connection: Connection) -> None:
        """Read what was made since, or the last of it where that is too much."""
        numbers = JOB_RESPONSES.c.number
        last: int = connection.execute(select(func.max(numbers))).scalar_one() or 0
        if last == self._number:
            return
        if last < self._number:  # the database was restored from a backup
            self._number = 0
            self._seconds.clear()
        begin = max(self._number, last - _LOOK_BACK)
        chosen = select(JOB_RESPONSES.c.content).where(numbers > begin, numbers <= last).order_by(numbers)
        for content in connection.execute(chosen).scalars():
            self.add_response(json.loads(content))
        self._number = last

    def add_response(self, made: Mapping[str, Any]) -> None:
        """Take in a response. One with a clock that was set back meanwhile tells nothing, and neither does one of which
        most was done before it began.
        """
        began, ended = made["began"], made["ended"]
        found_done = [each for each in made["operations"] if each["started"] is None and each["ended"] is not None]
        if 2 * len(found_done) > len(made["operations"]):
            return
        if made["outcome"] == JobOutcome.COMPLETED.value and began is not None and ended > began:
            self._seconds[made["work_master"]].append(ended - began)


# Whether anything goes on now.

_STUCK: Final = frozenset(each.name for each in (OVERDUE, STILL, GIVEN_UP))
_UNHEARD: Final = frozenset(each.name for each in (SILENT, MANY_SILENT, NEVER_HEARD))
_PATIENCE: Final = 10.0  # seconds that a person may take longer than expected, and as long again as expected


def stands(view: StationView, now: float) -> bool:
    """Return whether nothing goes on, until nobody knows when: devices do not do what they should, there is no plan, or
    a person is waited for who takes longer than people do.
    """
    if view.standing is StationStanding.STOPPED:
        return True
    running = [step for step in view.plan.steps if step.status is StepStatus.RUNNING]
    if running:
        return all(_is_held_up(step, view, now) for step in running)
    return view.plan.status is PlanStatus.NONE and any(operation.active for operation in view.operations.values())


def _is_held_up(step: PlanStepView, view: StationView, now: float) -> bool:
    began, end, ability = step.started, step.expected_end, view.abilities.get(step.ability)
    if began is None:
        return False
    for alarm in view.alarms.values():
        tells = alarm.kind in _UNHEARD or (alarm.kind in _STUCK and alarm.since >= began)
        if tells and alarm.ended is None and step.resource in alarm.resources:
            return True
    is_human = ability is not None and ability.human
    return is_human and end is not None and now > end + max(_PATIENCE, end - began)


# What comes of it for the orders that are not over, if all goes on as it did.


@dataclass(frozen=True)
class ExpectedTimes:
    """When an order is expected to begin and to be ready (seconds since the epoch); None where nobody knows."""

    start: float | None
    end: float | None


NOBODY_KNOWS: Final = ExpectedTimes(None, None)


def expected(
    orders: Sequence[JobOrder],
    times: CycleTimes,
    masters: WorkMastersView | None,
    view: StationView | None,
    now: float,
) -> dict[str, ExpectedTimes]:
    """Return what is expected of `orders`, which are in the order of work; an order that is missing is not known.

    Those that are in each other's way are worked one after the other. Nothing is known of what comes after an order
    that is interrupted, that takes longer than any did or of which none was ever made, nor while the station does not
    work on orders, or stands.
    """
    if masters is None or view is None or station_waits(view) or stands(view, now):
        return {}
    found: dict[str, ExpectedTimes] = {}
    free: dict[str, float] = {}  # by work master, when the last order of it that has a place is ready
    for order in orders:
        if order.is_at_station:
            end = _end_of_worked(order, times, view, now)
            found[order.id] = ExpectedTimes(None, _known(end))
            free[order.work_master] = max(free.get(order.work_master, now), end)
    for strange in view.jobs.keys() - {each.id for each in orders}:
        if not view.jobs[strange].state.is_over:
            free[view.jobs[strange].work_master] = inf
    waiting = [each for each in orders if each.state is OrderState.ALLOWED_TO_START and not each.is_at_station]
    able = [each for each in waiting if each.work_master in masters.work_masters]
    found.update(_in_turn(able, times, masters, free, now))
    return found


def _end_of_worked(order: JobOrder, times: CycleTimes, view: StationView, now: float) -> float:
    job, seconds = view.jobs.get(order.id), times.seconds(order.work_master)
    goes_on = order.state is not OrderState.INTERRUPTED and order.wish in (None, Wish.RESUME)
    if job is not None and (job.state is JobState.PAUSED or job.stopping):
        goes_on = False
    if seconds is None or not goes_on:
        return inf
    began = now if order.began is None else order.began
    if now <= began + seconds:
        return began + seconds
    return began + times.longer(order.work_master, now - began)


def _in_turn(
    orders: Sequence[JobOrder],
    times: CycleTimes,
    masters: WorkMastersView,
    free: dict[str, float],
    now: float,
) -> Iterator[tuple[str, ExpectedTimes]]:
    """Whenever the station is free for one, the first that may begin by then does."""
    may: dict[str, list[tuple[int, JobOrder]]] = defaultdict(list)  # by work master and in turn
    later: dict[str, list[tuple[float, int, JobOrder]]] = defaultdict(list)  # by when they may begin
    for place, order in enumerate(orders):
        if order.earliest is not None and order.earliest > now:
            later[order.work_master].append((order.earliest, place, order))
        else:
            may[order.work_master].append((place, order))
    for each in later.values():
        heapify(each)
    left = {*may, *later}
    rivals = {name: [other for other in {*left, *free} if in_the_way(masters, name, other)] for name in left}
    while left:
        turns = []
        for name in left:
            begin = max([now, *(free[other] for other in rivals[name] if other in free)])
            if may[name]:
                turns.append((begin, may[name][0][0], name))
            else:
                turns.append((max(begin, later[name][0][0]), later[name][0][1], name))
        begin, _, name = min(turns)
        if not isfinite(begin):
            return
        while later[name] and later[name][0][0] <= begin:
            _, place, order = heappop(later[name])
            heappush(may[name], (place, order))
        _, order = heappop(may[name])
        end = begin + (inf if (seconds := times.seconds(name)) is None else seconds)
        yield order.id, ExpectedTimes(begin, _known(end))
        free[name] = end
        if not may[name] and not later[name]:
            left.discard(name)


def _known(time: float) -> float | None:
    return time if isfinite(time) else None
