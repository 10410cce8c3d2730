"""The order of work of the orders: looked for whenever something is known anew, told to the station, and shown."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Sequence
from typing import Annotated

import structlog
from fastapi import Query, Request
from pydantic import BaseModel

from sequence_planner.actor import SYSTEM
from sequence_planner.control.commands import CommandRefused
from sequence_planner.control.job_commands import JobOperation, JobWait, SequenceJobs
from sequence_planner.control.view import StationView
from sequence_planner.identity.roles import Role, Scope
from sequence_planner.mes.order import JobOrder
from sequence_planner.mes.order_of_work import order_of_work
from sequence_planner.mes.sequencing.asking import MOST, Asked, asked, held_up
from sequence_planner.mes.sequencing.known_times import KnownTimes
from sequence_planner.mes.sequencing.process import Sequencer
from sequence_planner.mes.sequencing.waits import waits_among
from sequence_planner.mes.sequencing.work import Schedule
from sequence_planner.mes.times import iso
from sequence_planner.storage.error import StorageError
from sequence_planner.web.access import allowed
from sequence_planner.web.controller_client import ControllerClient
from sequence_planner.web.identity import IdentityOffice
from sequence_planner.web.interface import interface
from sequence_planner.web.order_desk import OrderDesk

LOG = structlog.get_logger(__name__)
LOOK_EVERY = 1.0  # seconds
ASK_EVERY = 5.0  # seconds between two questions
LIMIT = 5.0  # seconds for an answer
HELD_UP = 30.0  # seconds after which nobody waits any longer for a job of which nothing is active

router = interface("/order-of-work", tags=["job orders"], dependencies=[allowed(Role.VIEWER, scope=Scope.ORDERS_READ)])


class ExpectedOperation(BaseModel):
    """When an operation is expected to start and to end."""

    operation: str
    start: float
    start_at = iso("start")
    end: float
    end_at = iso("end")


class ExpectedOrder(BaseModel):
    """When an order is expected to be worked, and by how many seconds it is expected to be late."""

    id: str
    late: float
    operations: list[ExpectedOperation]


class OrderOfWorkAnswer(BaseModel):
    """The orders in the order in which they are to begin, as it was found at `time`; null while there is none.

    The first `horizon` orders were searched for the best that was found in time, the others follow by rule; `bound` is
    what the weighted `tardiness` of all cannot be below. It is `optimal` when no other has less weighted tardiness, or
    with it an earlier end. `fallback` says why it is only
    that of priority and due time; empty if it is not. Times are in seconds since the epoch.
    """

    time: float | None
    time_at = iso("time", optional=True)
    job_orders: list[ExpectedOrder]
    tardiness: float
    bound: float
    optimal: bool
    horizon: int
    fallback: str


class OrderOfWorkDesk:
    """Looks for the order of work of what `desk` knows, once there are two orders to be put into one."""

    def __init__(self, office: IdentityOffice, controller: ControllerClient, desk: OrderDesk) -> None:
        self._office = office
        self._controller = controller
        self._desk = desk
        self._resources: dict[str, str] = {}
        self._known = KnownTimes(self._resources)
        self._sequencer: Sequencer | None = None
        self._asked = Asked((), ())  # last
        self._answered = Asked((), ())  # what `found` answers
        self._asked_at = float("-inf")  # on the clock of `time.monotonic`
        self._places: dict[str, int] = {}
        self._said: SequenceJobs | None = None
        self._held_up: dict[str, float] = {}  # jobs, and since when
        self.found: tuple[float, Schedule] | None = None
        self._in_trouble = False
        desk.sequence = self.ordered

    async def run(self) -> None:
        """Look until cancelled. What fails is tried again and again; until then it is as it was."""
        try:
            while True:
                try:
                    await self._look()
                    self._in_trouble = False
                except (StorageError, CommandRefused, ValueError) as error:
                    self._note(str(error))
                except Exception as error:  # whatever it is, orders are worked by rule at least
                    if not self._in_trouble:
                        LOG.exception("the order of work cannot be looked for")
                    self._note(repr(error))
                await asyncio.sleep(LOOK_EVERY)
        finally:
            if self._sequencer is not None:
                self._sequencer.close()

    def ordered(self, orders: Sequence[JobOrder]) -> list[JobOrder]:
        """Those that have a place in the order that was found, then the others by rule."""
        places = self._places  # any thread may ask, and there are others at any time
        return sorted(order_of_work(orders), key=lambda order: places.get(order.id, len(places)))

    async def _look(self) -> None:
        view = self._controller.view if self._controller.heard else None
        masters = await self._desk.work_masters()
        if view is None or masters is None or self._controller.stands_by:
            return
        question = asked(self._desk.orders, view, masters, await self._times(view))
        if len(question.works) < 2:
            self._asked = self._answered = Asked((), ())
            self._places, self.found = {}, None
        else:
            await self._ask(question)
        await self._tell(view)

    async def _times(self, view: StationView) -> KnownTimes:
        """How long operations take, as far as the run's journal tells by now."""
        # Also of abilities that have come with another model since.
        self._resources.update((name, ability.resource) for name, ability in view.abilities.items())
        known = self._known
        if len(self._desk.orders) > 1:
            await self._office.read(known.read_on)
        return known

    async def _ask(self, question: Asked) -> None:
        now = time.monotonic()
        again = self.found is None or bool(self.found[1].fallback) or question != self._asked
        if not again or now - self._asked_at < ASK_EVERY:
            return
        if self._sequencer is None:
            self._sequencer = Sequencer(asyncio.get_running_loop())
        self._asked, self._asked_at = question, now
        schedule = await self._sequencer.sequence(question.works, question.exclusive, self._office.now(), LIMIT)
        self.found, self._answered = (self._office.now(), schedule), question
        self._places = {job: place for place, job in enumerate(schedule.jobs)}

    async def _tell(self, view: StationView) -> None:
        """Have the station keep to the order between operations of different jobs that it works on."""
        now, still = time.monotonic(), held_up(view.jobs)
        self._held_up = {job: self._held_up.get(job, now) for job in still}
        going = {job for job in view.jobs if now - self._held_up.get(job, now) < HELD_UP}
        waits = {}
        if self.found is not None:
            works = [work for work in self._answered.works if work.job in going]
            waits = waits_among(works, self.found[1])
        said = SequenceJobs(
            actor=SYSTEM,
            waits=[
                JobWait(
                    job=job,
                    operation=operation,
                    for_=[JobOperation(job=other, operation=its) for other, its in before],
                )
                for (job, operation), before in waits.items()
            ],
        )
        # The station may remember what was said before this server was started.
        before = None if self._said is None and len(view.jobs) > 1 else [] if self._said is None else self._said.waits
        if said.waits != before:
            await self._controller.send(said)
            self._said = said

    def _note(self, reason: str) -> None:
        if not self._in_trouble:
            LOG.warning("the order of work is not looked for now", reason=reason)
        self._in_trouble = True


@router.get("")
async def read_order_of_work(request: Request, limit: Annotated[int, Query(ge=1, le=MOST)] = MOST) -> OrderOfWorkAnswer:
    """When orders are expected to be worked, in the order in which they are to begin; only the first `limit`."""
    desk: OrderOfWorkDesk = request.app.state.order_of_work
    if desk.found is None:
        return OrderOfWorkAnswer(
            time=None, job_orders=[], tardiness=0.0, bound=0.0, optimal=False, horizon=0, fallback=""
        )
    found, schedule = desk.found
    operations: dict[str, list[ExpectedOperation]] = {job: [] for job in schedule.jobs[:limit]}
    for (job, operation), (start, end) in schedule.starts.items():
        if job in operations:
            operations[job].append(ExpectedOperation(operation=operation, start=start, end=end))
    return OrderOfWorkAnswer(
        time=found,
        job_orders=[
            ExpectedOrder(id=job, late=schedule.late.get(job, 0.0), operations=its) for job, its in operations.items()
        ],
        tardiness=schedule.tardiness,
        bound=schedule.bound,
        optimal=schedule.optimal,
        horizon=schedule.horizon,
        fallback=schedule.fallback,
    )
