"""Order service: handover of job orders to the controller, and synchronization of their states."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import Callable, Collection, Sequence
from typing import Generic

import structlog
from sqlalchemy import Connection
from starlette.concurrency import run_in_threadpool

from sequence_planner.controller.commands.command import Answer, CommandRefused, Query
from sequence_planner.controller.commands.jobs import CommandJob, ForgetJob, TakeJob
from sequence_planner.controller.commands.queries import AboutShifts, AboutWorkMasters
from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.controller.views.details import ShiftsView, WorkMastersView
from sequence_planner.controller.views.station import JobView, StationView
from sequence_planner.core.actor import SYSTEM, Actor
from sequence_planner.core.storage_error import StorageError
from sequence_planner.execution.vocabulary import JobState, Production
from sequence_planner.mes import orders
from sequence_planner.mes.expected import NOBODY_KNOWS, CycleTimes, ExpectedTimes, expected
from sequence_planner.mes.order import JobOrder, OrderRefused, OrderState, Wish
from sequence_planner.mes.queue import OrderOfWork, Queue, order_of_work, queue
from sequence_planner.mes.tracker import OrderTracker
from sequence_planner.server.services.identity import IdentityService
from sequence_planner.texts.message import Message, message

# What is said to the controller of orders that the station works on or may have been given.
#
# All of it may be said twice. What the controller answers to a command was decided after all that was said to it
# before, as it carries commands out one after the other.

TRY_AGAIN = 10.0  # seconds after which an order that the station has refused is given to it again
SAY_AGAIN = 1.0  # seconds after which a view knows of what was said, as far as that is durable


class OrderDispatch:
    """Speaks to `controller` of the orders of `office`; `changed` is called when that has changed one.

    Its methods raise `CommandRefused` when nobody knows what became of what was said, and `StorageError`.
    """

    def __init__(self, office: IdentityService, controller: ControllerClient, changed: Callable[[], None]) -> None:
        self._office = office
        self._controller = controller
        self._changed = changed
        self._refused: dict[str, tuple[Message, float]] = {}  # why the station has not taken an order, and when
        # What was wished for when something was said of a job last, and when: older views do not know of it.
        self._said: dict[str, tuple[Wish | None, float]] = {}
        self._strays: dict[str, float] = {}  # jobs under way that nobody waits for any more, and since when

    def keep(self, known: Collection[str]) -> None:
        """Remember nothing of orders but these."""
        self._said = {id_: said for id_, said in self._said.items() if id_ in known}
        self._refused = {id_: why for id_, why in self._refused.items() if id_ in known}

    def why_refused(self, order: str) -> Message | None:
        """Return why the station has not taken an order when it was given to it last."""
        refused = self._refused.get(order)
        return None if refused is None else refused[0]

    def may_take(self, order: str) -> bool:
        """Return whether an order is to be given to the station now, which may have refused it a moment ago."""
        refused = self._refused.get(order)
        return refused is None or time.monotonic() - refused[1] > TRY_AGAIN

    async def take(self, order: JobOrder) -> None:
        """Have the controller take an order, be it for another time."""
        command = TakeJob(actor=SYSTEM, job=order.id, title=order.title, work_master=order.work_master)
        try:
            await self._controller.send(command)
        except CommandRefused as refused:
            if refused.status >= 500:  # nobody knows what became of it: it is said again
                raise
            self._refused[order.id] = refused.detail, time.monotonic()
            if order.state is OrderState.ALLOWED_TO_START:
                await self._note(orders.take_back, order)
            return
        self._refused.pop(order.id, None)
        self._said[order.id] = order.wish, time.monotonic()

    async def look_after(self, order: JobOrder, job: JobView | None, heard: float) -> None:
        """Say what is to become of an order, where that is not so yet in the view that was `heard` then."""
        wish, said = self._said.get(order.id, (None, float("-inf")))
        if wish is order.wish and heard <= said + SAY_AGAIN:
            return
        if job is None:
            await self._look_for(order)
            return
        if job.state.is_over:
            return  # the journal tells
        match order.wish:
            case Wish.ABORT:
                await self._command(order, Wish.ABORT)
            case Wish.STOP if not job.stopping or job.state is JobState.PAUSED:
                await self._command(order, Wish.STOP)
            case Wish.PAUSE | Wish.RESUME:
                if await self._command(order, order.wish) is None:
                    self._said[order.id] = None, time.monotonic()
                    await self._note(orders.granted, order)
            case None if order.state is OrderState.INTERRUPTED and job.state is not JobState.PAUSED:
                await self._command(order, Wish.PAUSE)
            case None if order.state is OrderState.RUNNING and job.state is JobState.PAUSED:
                await self._command(order, Wish.RESUME)

    async def tidy(self, view: StationView, heard: float, at_station: Collection[str]) -> None:
        """Jobs whose orders are over: what has ended the station need not show any longer, and what was given up while
        it was on its way to the station is aborted there.
        """
        ended = [id_ for id_, job in view.jobs.items() if job.state.is_over]
        now = time.monotonic()
        strays = [id_ for id_, job in view.jobs.items() if not job.state.is_over and id_ not in at_station]
        self._strays = {id_: self._strays.get(id_, now) for id_ in strays}
        if not ended and not strays:
            return
        over = await self._office.read(lambda connection: orders.those_over(connection, [*ended, *strays]))
        for id_ in ended:
            if id_ in over:
                await self._controller.send(ForgetJob(actor=SYSTEM, job=id_))
        for id_ in strays:
            # The journal may have told of an end that this view does not show yet.
            if id_ in over and heard > self._strays[id_] + SAY_AGAIN:
                self._strays[id_] = now
                await self._say(CommandJob(actor=SYSTEM, reason="its order is over", job=id_, what="abort"))

    async def _look_for(self, order: JobOrder) -> None:
        """The station shows no job of an order: it is given that again, unless it is over, or wished to be.

        What has ended the station forgets once that is noted, and the order may have been read before.
        """
        current = await self._office.read(lambda connection: orders.find(connection, order.id))
        if current is None or current.is_over:
            self._changed()
        elif order.wish is Wish.ABORT or order.wish is Wish.STOP:
            if await self._command(order, order.wish) == "unknown-job":
                await self._note(orders.take_back, order)
        elif self.may_take(order.id):
            await self.take(order)

    async def _command(self, order: JobOrder, wish: Wish) -> str | None:
        """Have the controller do something with a job; for what reason it did not, None when it did."""
        actor, reason = (SYSTEM, None) if order.wish is None else (order.wished_by or SYSTEM, order.wished_because)
        refused = await self._say(_about(actor, reason, order.id, wish))
        if refused in ("control-needed", "real-devices"):
            await self._note(orders.refused, order)
        if refused is None:
            self._said[order.id] = order.wish, time.monotonic()
        return refused

    async def _say(self, command: CommandJob) -> str | None:
        try:
            await self._controller.send(command)
        except CommandRefused as refused:
            if refused.slug not in ("control-needed", "real-devices", "job-ended", "unknown-job"):
                raise
            return refused.slug
        return None

    async def _note(self, what: Callable[[Connection, JobOrder, float], object], order: JobOrder) -> None:
        now = self._office.now()

        def write() -> None:
            with self._office.database.writing() as connection:
                what(connection, order, now)

        await run_in_threadpool(write)
        self._changed()


def _about(actor: Actor, reason: str | None, job: str, wish: Wish) -> CommandJob:
    return CommandJob(actor=actor, reason=reason, job=job, what=wish.value)


# The server's hand between orders and the station: it gives orders to the controller and notes what becomes of them.
#
# It compares again and again what is wanted, which is in the database, with what is shown, and says the difference to
# the controller. All that it says may be said twice, so that neither process, killed at whatever moment, loses or
# doubles anything: an order is noted as handed over before the station hears of it, it is over in the database before
# the station forgets it, and in between only the run's journal, where it is durable, says what was done.

LOG = structlog.get_logger(__name__)
LOOK_EVERY = 0.25  # seconds
LOOK_AT_REST = 1.0  # seconds, while there is no order
ASK_EVERY = 5.0  # seconds after which it is asked again what jobs consist of, and when the station is to work
READ_EVERY = 5.0  # seconds after which orders are read again though nobody has changed one here


class _Asked(Generic[Answer]):
    """What the controller was asked and told last, asked again when that is some time ago."""

    def __init__(self, controller: ControllerClient, query: Query[Answer]) -> None:
        self._controller = controller
        self._query = query
        self._at = float("-inf")  # on the clock of `time.monotonic`
        self.told: Answer | None = None

    async def refreshed(self) -> Answer | None:
        """Return what it says, as far as that was heard."""
        now = time.monotonic()
        if self._controller.heard and now - self._at > ASK_EVERY:
            with contextlib.suppress(CommandRefused):
                self.told = await self._controller.ask(self._query)
                self._at = now
        return self.told


class OrderService:
    """Looks after the orders of `office` at the station of `controller`."""

    def __init__(self, office: IdentityService, controller: ControllerClient) -> None:
        self._office = office
        self._controller = controller
        self._following = OrderTracker(office.database)
        self._poked = asyncio.Event()
        self._masters = _Asked(controller, AboutWorkMasters())
        self._shifts = _Asked(controller, AboutShifts())
        self._read = float("-inf")  # on the clock of `time.monotonic`
        self._orders: list[JobOrder] = []
        self._queue = Queue()
        self._times = CycleTimes()
        self._dispatch = OrderDispatch(office, controller, self.poke)
        self._trouble = ""
        self.sequence: OrderOfWork = order_of_work

    @property
    def orders(self) -> list[JobOrder]:
        """The orders that are not over, as they were read last."""
        return self._orders

    async def run(self) -> None:
        """Look after orders until cancelled. What fails is tried again and again."""
        while True:
            began = time.monotonic()
            try:
                await self._look()
                self._trouble = ""
            except (StorageError, CommandRefused) as error:
                self._note(str(error))
            except Exception as error:  # whatever it is, orders must not be left alone
                if repr(error) != self._trouble:
                    LOG.exception("orders cannot be looked after")
                self._trouble = repr(error)
            await self._rest(time.monotonic() - began)

    async def _rest(self, took: float) -> None:
        """Until the next look: soon when somebody has changed an order, but for where it would fail again.

        A look at thousands of orders takes a while: at least as long is left to those who bring them.
        """
        await asyncio.sleep(LOOK_EVERY if self._trouble else min(took, LOOK_EVERY))
        if self._trouble:
            return
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(LOOK_EVERY if self._orders else LOOK_AT_REST):
                await self._poked.wait()

    def poke(self) -> None:
        """Somebody has changed an order."""
        self._poked.set()

    async def work_masters(self) -> WorkMastersView | None:
        """Return what jobs of the station consist of, as far as that was heard."""
        return await self._masters.refreshed()

    async def shifts(self) -> ShiftsView | None:
        """Return when the station is to work, as far as that was heard."""
        return await self._shifts.refreshed()

    async def unknown_work_master(self, name: str) -> OrderRefused | None:
        """Return why nothing of this work master can be ordered; None where it can, or nobody knows now."""
        masters = await self.work_masters()
        if masters is None or name in masters.work_masters:
            return None
        known = ", ".join(sorted(masters.work_masters))[:1000]
        id_ = "refused.unknown-work-master.known" if known else "refused.unknown-work-master.none"
        return OrderRefused("unknown-work-master", message(id_, name=name, known=known), 422)

    def waits_for(self, asked: Sequence[JobOrder]) -> dict[str, list[Message]]:
        """In words why nothing is done for each of these orders now; empty where something is, or nothing is to be.

        What was changed since the last look is looked at. Any thread may ask.
        """
        waiting, view, now_queued = [each for each in asked if _may_wait(each)], self._view, self._queue
        if not all(now_queued.knows(each) for each in waiting):
            known = {each.id: each for each in [*self._orders, *waiting]}
            now_queued = queue(list(known.values()), view, self._masters.told, self._office.now(), self.sequence)
        return {each.id: self._waits_for(each, view, now_queued) for each in asked}

    def _waits_for(self, order: JobOrder, view: StationView | None, queued: Queue) -> list[Message]:
        refused = self._dispatch.why_refused(order.id)
        if order.is_at_station:
            job = None if view is None else view.jobs.get(order.id)
            return job.waits_for_messages if job is not None else [refused or message("order-waits.take")]
        if not _may_wait(order):
            return []
        return queued.waits.get(order.id) or ([] if refused is None else [refused])

    def expected(self, asked: Sequence[JobOrder]) -> dict[str, ExpectedTimes]:
        """When orders are expected to begin and to be ready, as far as that is known. Any thread may ask."""
        found: dict[str, ExpectedTimes] = {}
        if not all(each.is_over for each in asked):
            known = {each.id: each for each in [*self._orders, *asked] if not each.is_over}
            in_order = self.sequence(list(known.values()))
            found = expected(in_order, self._times, self._masters.told, self._view, self._office.now())
        return {each.id: found.get(each.id, NOBODY_KNOWS) for each in asked}

    @property
    def tracker(self) -> OrderTracker:
        """Return what reads the run's journal for orders, and keeps the figures of the day."""
        return self._following

    @property
    def times(self) -> CycleTimes:
        """How long orders took."""
        return self._times

    def require_control(self, actor: Actor) -> None:
        """Raises `CommandRefused` where a person lets something go on without being in control; a key never is."""
        control = None if self._view is None else self._view.control
        if actor.session is not None and (control is None or control.session != actor.session):
            raise CommandRefused("control-needed", message("refused.control-needed.goes-on"))

    @property
    def _view(self) -> StationView | None:
        return self._controller.view if self._controller.heard else None

    async def _look(self) -> None:
        # The view before the orders: a job that it does not show and that is still to be made was not forgotten.
        view, heard = self._view, self._controller.last_heard or 0.0
        if self._controller.stands_by:
            return  # the station that commands looks after orders
        masters = await self.work_masters()
        await self._read_orders()
        await self._office.read(self._times.read_on)
        at_station = [each for each in self._orders if each.is_at_station]
        if masters is not None and await self._follow(masters):
            await self._read_orders(anew=True)
            at_station = [each for each in self._orders if each.is_at_station]
        if view is not None and view.production is not Production.PREPARING:
            for order in at_station:
                await self._dispatch.look_after(order, view.jobs.get(order.id), heard)
            await self._dispatch.tidy(view, heard, {each.id for each in at_station})
        self._queue = queue(self._orders, view, masters, self._office.now(), self.sequence)
        for order in self._queue.next:
            if self._dispatch.may_take(order.id):
                await self._hand_over(order)

    async def _read_orders(self, *, anew: bool = False) -> None:
        now = time.monotonic()
        if anew or self._poked.is_set() or now - self._read > READ_EVERY:
            self._poked.clear()
            self._read = float("-inf")  # until they are read: what was poked for is not forgotten when that fails
            known = self._orders
            self._orders = await self._office.read(lambda connection: orders.open_orders(connection, known))
            self._read = now
            self._dispatch.keep({each.id for each in self._orders})

    async def _follow(self, masters: WorkMastersView) -> bool:
        """Read on in the run's journal; whether orders have changed by it."""
        changed, more = False, True
        while more:
            news, more = await run_in_threadpool(self._following.read_on, masters)
            changed = changed or news
        return changed

    async def _hand_over(self, order: JobOrder) -> None:
        """Give an order to the station, where it may still start."""
        now = self._office.now()

        def write() -> JobOrder | None:
            with self._office.database.writing() as connection:
                return orders.hand_over(connection, order, now)

        handed = await run_in_threadpool(write)
        if handed is None:
            self.poke()
            return
        self._orders = [handed if each.id == handed.id else each for each in self._orders]
        await self._dispatch.take(handed)

    def _note(self, reason: str) -> None:
        if reason != self._trouble:
            LOG.warning("orders cannot be looked after now", reason=reason)
        self._trouble = reason


def _may_wait(order: JobOrder) -> bool:
    """Return whether it may start and is not at the station yet."""
    return order.state is OrderState.ALLOWED_TO_START and not order.is_at_station
