"""The server's hand between orders and the station: it gives orders to the controller and notes what becomes of them.

It compares again and again what is wanted, which is in the database, with what is shown, and says the difference to the
controller. All that it says may be said twice, so that neither process, killed at whatever moment, loses or doubles
anything: an order is noted as handed over before the station hears of it, it is over in the database before the station
forgets it, and in between only the run's journal, where it is durable, says what was done.
"""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import Sequence

import structlog
from starlette.concurrency import run_in_threadpool

from sequence_planner.actor import Actor
from sequence_planner.control.asks import AboutWorkMasters
from sequence_planner.control.commands import CommandRefused
from sequence_planner.control.view import StationView
from sequence_planner.control.vocabulary import Production
from sequence_planner.control.work_master_view import WorkMastersView
from sequence_planner.mes import orders
from sequence_planner.mes.following import Following
from sequence_planner.mes.order import JobOrder
from sequence_planner.mes.order_of_work import OrderOfWork, order_of_work
from sequence_planner.mes.queueing import Queue, queue
from sequence_planner.mes.refusal import OrderRefused
from sequence_planner.mes.states import OrderState
from sequence_planner.storage.error import StorageError
from sequence_planner.web.controller_client import ControllerClient
from sequence_planner.web.identity import IdentityOffice
from sequence_planner.web.order_dispatch import OrderDispatch

LOG = structlog.get_logger(__name__)
LOOK_EVERY = 0.25  # seconds
LOOK_AT_REST = 1.0  # seconds, while there is no order
ASK_EVERY = 5.0  # seconds after which it is asked again what jobs consist of
READ_EVERY = 5.0  # seconds after which orders are read again though nobody has changed one here


class OrderDesk:
    """Looks after the orders of `office` at the station of `controller`."""

    def __init__(self, office: IdentityOffice, controller: ControllerClient) -> None:
        self._office = office
        self._controller = controller
        self._following = Following(office.database)
        self._poked = asyncio.Event()
        self._masters: WorkMastersView | None = None
        self._asked = self._read = float("-inf")  # on the clock of `time.monotonic`
        self._orders: list[JobOrder] = []
        self._queue = Queue()
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
        """What jobs of the station consist of, as far as that was heard."""
        now = time.monotonic()
        if self._controller.heard and now - self._asked > ASK_EVERY:
            with contextlib.suppress(CommandRefused):
                self._masters = await self._controller.ask(AboutWorkMasters())
                self._asked = now
        return self._masters

    async def unknown_work_master(self, name: str) -> OrderRefused | None:
        """Why nothing of this work master can be ordered; None where it can, or nobody knows now."""
        masters = await self.work_masters()
        if masters is None or name in masters.work_masters:
            return None
        known = ", ".join(sorted(masters.work_masters)) or "none"
        detail = f"The station has no work master `{name}`. It has: {known}."[:1000]
        return OrderRefused("unknown-work-master", "There is no such work master", detail, 422)

    def waits_for(self, asked: Sequence[JobOrder]) -> dict[str, list[str]]:
        """In words why nothing is done for each of these orders now; empty where something is, or nothing is to be.

        What was changed since the last look is looked at. Any thread may ask.
        """
        waiting, view, now_queued = [each for each in asked if _may_wait(each)], self._view, self._queue
        if not all(now_queued.knows(each) for each in waiting):
            known = {each.id: each for each in [*self._orders, *waiting]}
            now_queued = queue(list(known.values()), view, self._masters, self._office.now(), self.sequence)
        return {each.id: self._waits_for(each, view, now_queued) for each in asked}

    def _waits_for(self, order: JobOrder, view: StationView | None, queued: Queue) -> list[str]:
        refused = self._dispatch.why_refused(order.id)
        if order.is_at_station:
            job = None if view is None else view.jobs.get(order.id)
            return job.waits_for if job is not None else [refused or "the station to take it"]
        if not _may_wait(order):
            return []
        return queued.waits.get(order.id) or ([] if refused is None else [refused])

    def require_control(self, actor: Actor) -> None:
        """Raises `CommandRefused` where a person lets something go on without being in control; a key never is."""
        control = None if self._view is None else self._view.control
        if actor.session is not None and (control is None or control.session != actor.session):
            detail = "Only who is in control lets devices go on. Take control, then try again."
            raise CommandRefused("control-needed", "Control is needed", detail)

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
    """Whether it may start and is not at the station yet."""
    return order.state is OrderState.ALLOWED_TO_START and not order.is_at_station
