"""The figures of the day: what is in work, what was made, how long that takes, and how long the station worked."""

from __future__ import annotations

import time
from collections.abc import Sequence
from statistics import median

from fastapi import Request

from sequence_planner.auth.roles import Role, Scope
from sequence_planner.controller.views.station import StationView
from sequence_planner.core.clock import Timestamp, iso
from sequence_planner.mes import orders
from sequence_planner.mes.figures import DayFigures, end_of_day
from sequence_planner.mes.order import JobOrder
from sequence_planner.server.api.job_orders import desk_of
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import AnswerModel, Identity, LiveView
from sequence_planner.server.interface import interface
from sequence_planner.server.services.orders import OrderService

router = interface("/figures", tags=["station"], dependencies=[allowed(Role.VIEWER, scope=Scope.READ)])


class ProductInWork(AnswerModel):
    """A product that is in work since it `began`; `job` is its order, null where the station works freely."""

    job: str | None
    title: str
    work_master: str
    began: float
    began_at = iso("began")
    expected_end: float | None  # null where nobody knows
    expected_end_at = iso("expected_end", optional=True)


class MadeToday(AnswerModel):
    """How many products were completed today.

    Of `planned` ones, with those whose orders are due today or are late; `by_now` are due by now. Both are null where
    no order is due.
    """

    count: int
    planned: int | None
    by_now: int | None


class CycleFigures(AnswerModel):
    """How many seconds the last products of a work master took, the oldest first, and the median of these."""

    work_master: str
    median: float
    last: list[float]


class AvailabilityPoint(AnswerModel):
    """The availability from the first work of the day until `time`."""

    time: float
    time_at = iso("time")
    share: float


class DayAvailability(AnswerModel):
    """The part of the day in which the station worked (ISO 22400-2), from 0 to 1.

    From `since`, when it worked first today, it `counted` seconds in which it could, and worked in `available` of them.
    """

    since: float
    since_at = iso("since")
    share: float
    counted: float
    available: float
    trend: list[AvailabilityPoint]


class FiguresAnswer(AnswerModel):
    """The figures of the `day` that began then; times are in seconds since the epoch. What nobody knows is null."""

    time: float
    time_at = iso("time")
    day: float
    day_at = iso("day")
    in_work: list[ProductInWork]
    made: MadeToday
    cycle: CycleFigures | None
    availability: DayAvailability | None


@router.get("")
async def figures(request: Request, identity: Identity, view: LiveView) -> FiguresAnswer:
    """The figures of the day, as of now: of the time zone of the machine on which the station runs."""
    desk = desk_of(request)
    now = Timestamp(time.time(), time.monotonic())
    known = desk.figures(now)
    jobs = [each.job for each in known.made if each.job is not None]
    due = await identity.read(lambda connection: orders.due_times(connection, jobs)) if jobs else []
    in_work = _in_work(desk, known, view)
    return FiguresAnswer(
        time=now.epoch,
        day=known.day if known.day is not None else now.epoch,
        in_work=in_work,
        made=_made(known, due, desk.orders, now.epoch),
        cycle=_cycle(known, in_work),
        availability=_availability(known),
    )


def _in_work(desk: OrderService, known: DayFigures, view: StationView) -> list[ProductInWork]:
    found = [
        ProductInWork(job=id_, title=job.title, work_master=job.work_master, began=job.taken, expected_end=None)
        for id_, job in view.jobs.items()
        if not job.state.is_over
    ]
    found += [
        ProductInWork(job=None, title=desk.title_of(master), work_master=master, began=began, expected_end=None)
        for master, began in known.open.items()
        if began is not None
    ]
    return found


def _made(known: DayFigures, done: Sequence[float], still_open: Sequence[JobOrder], now: float) -> MadeToday:
    """Count what was made, of which these were due then, and what is to be made by tonight."""
    tonight = end_of_day(now)
    to_do = [each.due for each in still_open if each.due is not None and each.due < tonight]
    if not to_do and not any(each < tonight for each in done):
        return MadeToday(count=known.count, planned=None, by_now=None)
    planned = known.count + len(to_do)
    later = sum(each > now for each in (*done, *to_do))
    return MadeToday(count=known.count, planned=planned, by_now=planned - later)


def _cycle(known: DayFigures, in_work: Sequence[ProductInWork]) -> CycleFigures | None:
    """Return how long products take of what is in work, or else was made last."""
    asked = [each.work_master for each in in_work] or [each.work_master for each in known.made[-1:]] or [*known.cycles]
    last = known.cycles.get(asked[0]) if asked else None
    return None if not last else CycleFigures(work_master=asked[0], median=median(last), last=last)


def _availability(known: DayFigures) -> DayAvailability | None:
    share = known.availability
    if share is None or known.since is None:
        return None
    return DayAvailability(
        since=known.since,
        share=share,
        counted=known.counted,
        available=known.available,
        trend=[AvailabilityPoint(time=at, share=then) for at, then in known.trend],
    )
