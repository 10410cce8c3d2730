"""The figures of the day and of shifts: how long the station worked, what it has made, how long a product takes."""

from __future__ import annotations

import time as clock
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any, Final

from pydantic import BaseModel, ConfigDict

from sequence_planner.controller.alarms.kinds import OVERDUE, STILL
from sequence_planner.controller.views.details import WorkMasterView
from sequence_planner.controller.views.station import PackML
from sequence_planner.execution.products import final_operation
from sequence_planner.mes.shifts import Shift, Span, seconds_within, with_span

# Kept as the records of the run's journal are read one after the other, together with what is made for jobs, so that
# nothing is read twice and a server that is started anew knows them at once.
#
# Availability is that of ISO 22400-2, APT / PBT. The actual production time (APT) is that of PackML's `execute`, but
# for the time in which all that runs is stuck, at devices of which an alarm says that they do not do what they should.
# While the controller was away nothing was produced. The planned busy time (PBT) of a shift is all of it but its
# breaks, as far as the station was watched. Nobody plans that of a day: it is all of it since the station worked first,
# without the time in which it works by order and has none.
#
# Records say when it worked and when products were done, and nothing of shifts: what a shift comes to is reckoned when
# somebody asks, with the shifts as they are then.
#
# How long something lasted is told by the monotonic clock, which nobody sets; only the day is that of the wall clock.

EXECUTE: Final = PackML.EXECUTE.value
SUSPENDED: Final = PackML.SUSPENDED.value
# Nothing runs in these; which runs were called off no other record says.
_AT_REST: Final = frozenset(each.value for each in (PackML.IDLE, PackML.HELD, PackML.STOPPED, PackML.ABORTED))
_STUCK: Final = frozenset(each.name for each in (OVERDUE, STILL))  # alarms
CYCLES: Final = 20  # of a work master that are remembered
_MASTERS: Final = 100  # of which there are cycles: work masters come and go with the model
_TREND_EVERY: Final = 600.0  # seconds between two points
_TREND: Final = 150  # points: a day of 25 hours
_MADE: Final = 5000  # products whose orders are remembered
_BACK: Final = 3600.0  # seconds by which a clock that is set back leaves the day as it is
_KEPT: Final = 26 * 3600.0  # seconds: a shift of a day on which the clocks are set back, and a bit more
_JOINED: Final = 0.05  # seconds between records, by two clocks, that were no pause
_SPANS: Final = 500  # in which it worked
_MINUTE: Final = 60


class MadeProduct(BaseModel):
    """A product that was completed; `job` is null where the station worked freely."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    job: str | None
    work_master: str
    ended: float


class DayFigures(BaseModel):
    """The figures of the `day` that began then. `since` the station worked first `counted` seconds could have been
    worked, and `available` were. `heard` is the time of the last record.

    It was `worked` in these spans of time, as far as it was `watched`, and so many products were done in each minute
    since the epoch (`done`): for shifts, those of the last day.

    Of each work master there are the seconds that the last products took which were made freely (`cycles`), and since
    when the next one is made (`open`): null from the end of one until the next has begun. Of those that are `untouched`
    nothing was started yet.
    """

    model_config = ConfigDict(extra="forbid")
    heard: float | None = None
    counted_to: float | None = None  # on the wall clock
    monotonic: float | None = None  # the same instant; null where that is not known
    state: str | None = None
    running: list[str] = []  # the abilities that are under way
    stuck: dict[str, list[str]] = {}  # by the alarms that say so, the resources that do not do what they should
    by_order: bool = False
    idle: bool = False  # works by order, and has none
    day: float | None = None
    since: float | None = None
    counted: float = 0.0
    available: float = 0.0
    trend: list[tuple[float, float]] = []  # when, and the availability until then
    count: int = 0
    made: list[MadeProduct] = []  # the last of these
    watched: float | None = None
    worked: list[Span] = []
    done: dict[int, int] = {}
    cycles: dict[str, list[float]] = {}
    open: dict[str, float | None] = {}
    untouched: list[str] = []

    def copied(self) -> DayFigures:
        """One that can go on without this one."""
        lists = {"trend": [*self.trend], "made": [*self.made], "open": dict(self.open), "done": dict(self.done)}
        lists |= {"untouched": [*self.untouched], "running": [*self.running], "stuck": dict(self.stuck)}
        return self.model_copy(update={**lists, "cycles": {name: [*each] for name, each in self.cycles.items()}})

    @property
    def availability(self) -> float | None:
        """The part of the time that was worked, from 0 to 1; None before anything could be."""
        return self.available / self.counted if self.counted > 0 else None

    def pass_to(self, time: float, monotonic: float | None) -> None:
        """Let time pass until an instant, in the state as it is."""
        elapsed = 0.0
        if self.counted_to is not None:
            elapsed = max(0.0, time - self.counted_to)
            if monotonic is not None and self.monotonic is not None and monotonic >= self.monotonic:
                elapsed = monotonic - self.monotonic
        if monotonic is None and self.monotonic is not None:
            monotonic = self.monotonic + elapsed
        self.heard, self.counted_to, self.monotonic = time, time, monotonic
        self._count(elapsed, time)
        self._note_work(elapsed, time)

    def note_start(self, time: float) -> None:
        """Note that the controller was started anew: nobody knows that it worked since it was heard last."""
        if self.heard is not None:
            self.pass_to(self.heard, None)
        self.turn(None)
        self.running, self.stuck = [], {}
        self.monotonic = None
        self.pass_to(time, None)

    @property
    def works(self) -> bool:
        """Whether the station produces: in `execute`, and not all that runs is stuck."""
        held_up = {resource for each in self.stuck.values() for resource in each}
        stands = bool(self.running) and all(name.partition(".")[0] in held_up for name in self.running)
        return self.state == EXECUTE and not stands

    def note_runs(self, started: Iterable[str], ended: Collection[str]) -> None:
        """Note which abilities ended, and which started then."""
        self.running = [*dict.fromkeys([*(each for each in self.running if each not in ended), *started])]

    def note_alarm(self, alarm: Mapping[str, Any]) -> None:
        """Note whether an alarm says that a device does not do what it should."""
        key = alarm.get("alarm", "")
        if alarm.get("kind") in _STUCK and alarm.get("ended") is None and alarm.get("resources"):
            self.stuck[key] = [*alarm["resources"]]
        else:
            self.stuck.pop(key, None)

    def turn(self, state: str | None) -> None:
        """Note that the state of PackML is another one from now on."""
        if state in _AT_REST:
            self.running = []
        if state == EXECUTE and self.state != EXECUTE and self.counted_to is not None:
            self._begin_untouched(self.counted_to)
        self.state = state

    def _begin_untouched(self, now: float) -> None:
        """The time in which the station stood is not that of a product of which nothing was started before."""
        for name in self.untouched:
            self.open[name] = now

    def in_work(self) -> dict[str, float]:
        """Return since when products are in work that are made freely, by work master. While the station stands, one of
        which nothing was started has not begun.
        """
        stands = self.state not in (None, EXECUTE)
        waiting = set(self.untouched) if stands else set()
        return {name: began for name, began in self.open.items() if began is not None and name not in waiting}

    def _count(self, seconds: float, now: float) -> None:
        midnight = start_of_day(now)
        if self.day is None or midnight > self.day or now < self.day - _BACK:
            if self.day is not None:
                self._new_day()
            self.day = midnight
            seconds = min(seconds, max(0.0, now - midnight))
        if self.idle and self.state == SUSPENDED:
            return
        if self.since is None:
            if self.state not in (EXECUTE, SUSPENDED):
                return
            self.since = now - seconds
        self.counted += seconds
        self.available += seconds if self.works else 0.0
        share = self.availability
        # Not at once: of the first seconds a share says nothing.
        last = self.trend[-1][0] if self.trend else self.since
        if share is not None and not 0 <= now - last < _TREND_EVERY:
            self.trend = [*self.trend, (now, share)][-_TREND:]

    def _note_work(self, seconds: float, now: float) -> None:
        begin = now - seconds
        self.watched = begin if self.watched is None else min(self.watched, begin)
        spans = [each for each in self.worked if each[1] > now - _KEPT]
        end = now if self.works else begin
        self.worked = with_span(spans, begin, end, joined=_JOINED, most=_SPANS)

    def _new_day(self) -> None:
        self.since, self.counted, self.available, self.trend = None, 0.0, 0.0, []
        self.count, self.made = 0, []

    # What is made.

    def count_product(self, product: MadeProduct) -> None:
        """Count a product."""
        self.count += 1
        self.made = [*self.made, product][-_MADE:]
        minute = int(product.ended // _MINUTE)
        kept = int(_KEPT // _MINUTE)
        self.done = {each: n for each, n in self.done.items() if abs(minute - each) <= kept}
        self.done[minute] = self.done.get(minute, 0) + 1

    # What a shift comes to.

    def made_in(self, shift: Shift) -> int:
        """Return how many products were done in a shift."""
        return sum(n for minute, n in self.done.items() if shift.begin <= minute * _MINUTE < shift.end)

    def counted_from(self, shift: Shift) -> float:
        """Return since when a shift is counted: since it began, or the station is known."""
        return shift.begin if self.watched is None else max(self.watched, shift.begin)

    def seconds_of(self, shift: Shift, until: float) -> tuple[float, float]:
        """Return how much of a shift was to be worked until then, and in how much of that the station worked."""
        begin = self.counted_from(shift)
        planned = [(max(first, begin), min(last, until)) for first, last in shift.planned]
        worked = sum(seconds_within(self.worked, first, last) for first, last in planned if first < last)
        return seconds_within(shift.planned, begin, until), worked

    def trend_of(self, shift: Shift, until: float) -> list[tuple[float, float]]:
        """Return the availability in a shift as it was every ten minutes."""
        begin = self.counted_from(shift)
        points = (begin + each * _TREND_EVERY for each in range(1, _TREND + 1))
        found = ((at, self.seconds_of(shift, at)) for at in points if at <= until)
        return [(at, worked / planned) for at, (planned, worked) in found if planned > 0]

    def work_freely(
        self,
        masters: Mapping[str, WorkMasterView],
        activated: Sequence[str],
        completed: Sequence[str],
        now: float,
        *,
        starts: bool = True,
    ) -> None:
        """Note which operations became active and were completed while no job had them, and whether anything `starts`.

        A product is done with the operation that comes after all others of its work master, and begun with one that
        comes after none. Where there is no such operation, the model does not tell.
        """
        for name in completed:
            ended = [master for master, its in masters.items() if last_operation(its) == name]
            for master in ended:
                began = self.open.get(master)
                if began is not None and now > began:
                    self._remember(master, now - began)
                self.open[master] = None
                self.untouched = [each for each in self.untouched if each != master]
            if ended:
                self.count_product(MadeProduct(job=None, work_master=ended[0], ended=now))
        for name in activated:
            for master, its in masters.items():
                first = first_operations(its)
                # Where there are several, the first of them is known once the product before was seen to be done.
                known = self.open[master] is None if master in self.open else len(first) == 1
                if name in first and known:
                    self.open[master] = now
                    self.untouched = [*(each for each in self.untouched if each != master), master]
        if starts:
            if self.state != EXECUTE:
                self._begin_untouched(now)
            self.untouched = []
        for gone in [each for each in self.open if each not in masters]:
            del self.open[gone]
            self.untouched = [each for each in self.untouched if each != gone]

    def _remember(self, master: str, seconds: float) -> None:
        known = self.cycles.pop(master, [])
        self.cycles[master] = [*known, seconds][-CYCLES:]
        for oldest in [*self.cycles][:-_MASTERS]:
            del self.cycles[oldest]


def last_operation(master: WorkMasterView) -> str | None:
    """The operation of a work master that comes after all others; None where there is none."""
    return final_operation({name: operation.after for name, operation in master.operations.items()})


def first_operations(master: WorkMasterView) -> Collection[str]:
    """The operations of a work master that come after no other."""
    return [name for name, operation in master.operations.items() if not operation.after]


def start_of_day(time: float) -> float:
    """When the day of an instant began, where the station stands: at the last midnight of its time zone."""
    local = clock.localtime(time)
    return clock.mktime((local.tm_year, local.tm_mon, local.tm_mday, 0, 0, 0, 0, 0, -1))


def end_of_day(time: float) -> float:
    """When the day of an instant ends."""
    local = clock.localtime(time)
    return clock.mktime((local.tm_year, local.tm_mon, local.tm_mday + 1, 0, 0, 0, 0, 0, -1))
