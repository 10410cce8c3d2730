"""The figures of the day and the shift: what is in work, what was made, how long it takes, how long was worked."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from statistics import median
from typing import Any

from sequence_planner.controller.views.details import WorkMasterView
from sequence_planner.controller.views.station import StationView
from sequence_planner.core.clock import iso
from sequence_planner.mes import orders
from sequence_planner.mes.expected import NOBODY_KNOWS
from sequence_planner.mes.figures import DayFigures, MadeProduct, end_of_day, last_operation, start_of_day
from sequence_planner.mes.order import JobOrder, OrderState
from sequence_planner.mes.shifts import Shift, shift_after, shift_at
from sequence_planner.server.dependencies import AnswerModel
from sequence_planner.server.services.identity import IdentityService
from sequence_planner.server.services.orders import OrderService


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

    `by_order` of them were made for orders, of `planned` ones with the orders that are due today or are late; `by_now`
    of these are due by now. Both are null where no order is due. `count` is null where nobody knows, as the model does
    not tell when a product is done. `to_make` are the orders that may start and are not over.
    """

    count: int | None
    planned: int | None
    by_now: int | None
    by_order: int
    to_make: int


class CycleFigures(AnswerModel):
    """How many seconds the last products of a work master took, the oldest first, and the median of these."""

    work_master: str
    median: float
    last: list[float]


class AvailabilityPoint(AnswerModel):
    """The availability from the first work of the day, or from the beginning of the shift, until `time`."""

    time: float
    time_at = iso("time")
    share: float


class AvailabilityFigures(AnswerModel):
    """The part of the day, or of a shift without its breaks, in which the station worked (ISO 22400-2), from 0 to 1.

    From `since` it `counted` seconds in which it could have, and worked in `available` of them: of the day since it
    worked first, of a shift since that began or the station is known.
    """

    since: float
    since_at = iso("since")
    share: float
    counted: float
    available: float
    trend: list[AvailabilityPoint]


class ShiftTimes(AnswerModel):
    """A shift of a certain day. Its title is by language, under "" that of none in particular."""

    name: str
    title: dict[str, str]
    begins: float
    begins_at = iso("begins")
    ends: float
    ends_at = iso("ends")


class ShiftFigures(ShiftTimes):
    """The shift that is on, and how many products were completed in it; null where the model does not tell."""

    made: int | None
    availability: AvailabilityFigures | None


class FiguresAnswer(AnswerModel):
    """The figures of the `day` that began then; times are in seconds since the epoch. What nobody knows is null.

    `shift` is the one that is on, and `next_shift` the one that begins next: null where the station has no shifts.
    """

    time: float
    time_at = iso("time")
    day: float
    day_at = iso("day")
    in_work: list[ProductInWork]
    made: MadeToday
    cycle: CycleFigures | None
    availability: AvailabilityFigures | None
    shift: ShiftFigures | None
    next_shift: ShiftTimes | None


async def figures_of(desk: OrderService, office: IdentityService, view: StationView) -> FiguresAnswer:
    """The figures of the day and the shift as of now, of a station whose `view` is live."""
    now = time.time()
    known = desk.tracker.figures.copied()
    if known.counted_to is not None:  # it still is as the journal said last
        known.pass_to(now, time.monotonic())
    jobs = [each.job for each in known.made if each.job is not None]
    due = await office.read(lambda connection: orders.due_times(connection, jobs)) if jobs else []
    masters = await desk.work_masters()
    products = {} if masters is None else masters.work_masters
    in_work = _in_work(desk, known, view, products)
    written = await desk.shifts()
    shifts = {} if written is None else written.shifts
    on, then = shift_at(shifts, now), shift_after(shifts, now)
    tells = known.count > 0 or view.by_order or any(last_operation(each) for each in products.values())
    return FiguresAnswer(
        time=now,
        day=start_of_day(now),
        in_work=in_work,
        made=_made(known, due, desk.orders, now, tells=tells),
        cycle=_cycle(desk, known, in_work),
        availability=_availability(known),
        shift=None if on is None else _shift(known, on, now, tells=tells),
        next_shift=None if then is None else ShiftTimes(**_times(then)),
    )


def _in_work(
    desk: OrderService, known: DayFigures, view: StationView, masters: Mapping[str, WorkMasterView]
) -> list[ProductInWork]:
    expected = desk.expected([each for each in desk.orders if each.is_at_station])
    found = [
        ProductInWork(
            job=id_,
            title=job.title,
            work_master=job.work_master,
            began=job.taken if job.begun is None else job.begun,
            expected_end=expected.get(id_, NOBODY_KNOWS).end,
        )
        for id_, job in view.jobs.items()
        if not job.state.is_over and not (job.begun is None and view.cycle_stop is not None)
    ]
    found += [
        ProductInWork(job=None, title=masters[name].title, work_master=name, began=began, expected_end=None)
        for name, began in known.in_work().items()
        if name in masters
    ]
    return found


def _made(
    known: DayFigures, done: Sequence[float], still_open: Sequence[JobOrder], now: float, *, tells: bool
) -> MadeToday:
    """Count what was made, of which these were due then, and what is to be made by tonight."""
    tonight = end_of_day(now)
    by_order = sum(each.job is not None for each in known.made)
    to_make = sum(each.state is not OrderState.NOT_ALLOWED_TO_START for each in still_open)
    count = known.count if tells else None
    to_do = [each.due for each in still_open if each.due is not None and each.due < tonight]
    if count is None or (not to_do and not any(each < tonight for each in done)):
        return MadeToday(count=count, planned=None, by_now=None, by_order=by_order, to_make=to_make)
    planned = by_order + len(to_do)
    later = sum(each > now for each in (*done, *to_do))
    return MadeToday(count=count, planned=planned, by_now=planned - later, by_order=by_order, to_make=to_make)


def _cycle(desk: OrderService, known: DayFigures, in_work: Sequence[ProductInWork]) -> CycleFigures | None:
    """Return how long products take of what is in work, or else was made last, for an order or freely."""
    asked: list[ProductInWork | MadeProduct] = [*in_work, *reversed(known.made)]
    for each in asked[:1]:
        last = known.cycles.get(each.work_master, []) if each.job is None else desk.times.last_seconds(each.work_master)
        if last:
            return CycleFigures(work_master=each.work_master, median=median(last), last=last)
    return None


def _availability(known: DayFigures) -> AvailabilityFigures | None:
    share = known.availability
    if share is None or known.since is None:
        return None
    return AvailabilityFigures(
        since=known.since,
        share=share,
        counted=known.counted,
        available=known.available,
        trend=[AvailabilityPoint(time=at, share=then) for at, then in known.trend],
    )


def _times(shift: Shift) -> dict[str, Any]:
    return {"name": shift.name, "title": dict(shift.title), "begins": shift.begin, "ends": shift.end}


def _shift(known: DayFigures, shift: Shift, now: float, *, tells: bool) -> ShiftFigures:
    counted, available = known.seconds_of(shift, now)
    availability = None
    if counted > 0:
        availability = AvailabilityFigures(
            since=known.counted_from(shift),
            share=available / counted,
            counted=counted,
            available=available,
            trend=[AvailabilityPoint(time=at, share=share) for at, share in known.trend_of(shift, now)],
        )
    return ShiftFigures(**_times(shift), made=known.made_in(shift) if tells else None, availability=availability)
