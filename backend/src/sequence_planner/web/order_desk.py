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

import structlog
from starlette.concurrency import run_in_threadpool

from sequence_planner.actor import SYSTEM, Actor
from sequence_planner.control.asks import AboutWorkMasters
from sequence_planner.control.commands import Command, CommandRefused
from sequence_planner.control.job_commands import CommandJob, ForgetJob, TakeJob
from sequence_planner.control.job_view import JobState, JobView
from sequence_planner.control.view import Production, StationView
from sequence_planner.control.work_master_view import WorkMastersView
from sequence_planner.mes import orders
from sequence_planner.mes.following import Following
from sequence_planner.mes.order import JobOrder
from sequence_planner.mes.order_of_work import OrderOfWork, order_of_work
from sequence_planner.mes.queueing import Queue, queue
from sequence_planner.mes.refusal import OrderRefused
from sequence_planner.mes.states import OrderState, Wish
from sequence_planner.storage.error import StorageError
from sequence_planner.web.controller_client import REPLY_DEADLINE, ControllerClient
from sequence_planner.web.identity import IdentityOffice

LOG = structlog.get_logger(__name__)
LOOK_EVERY = 0.25  # seconds
ASK_EVERY = 5.0  # seconds after which it is asked again what jobs consist of
READ_EVERY = 5.0  # seconds after which orders are read again though nobody has changed one here
TRY_AGAIN = 10.0  # seconds after which an order that the station has refused is given to it again
SAY_AGAIN = 1.0  # seconds after which a view knows of what was said, as far as that is durable
UNCERTAIN = REPLY_DEADLINE + 1.0  # seconds in which a job that nobody answered for may still be taken


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
        self._refused: dict[str, tuple[str, float]] = {}  # why the station has not taken an order, and when
        # What was wished for when something was said of a job last, and when: older views do not know of it.
        self._said: dict[str, tuple[Wish | None, float]] = {}
        self._trouble = ""
        self.sequence: OrderOfWork = order_of_work

    @property
    def orders(self) -> list[JobOrder]:
        """The orders that are not over, as they were read last."""
        return self._orders

    async def run(self) -> None:
        """Look after orders until cancelled. What fails is tried again and again."""
        while True:
            try:
                await self._look()
                self._trouble = ""
            except (StorageError, CommandRefused) as error:
                self._note(str(error))
            except Exception as error:  # whatever it is, orders must not be left alone
                if repr(error) != self._trouble:
                    LOG.exception("orders cannot be looked after")
                self._trouble = repr(error)
            await self._rest()

    async def _rest(self) -> None:
        """Until the next look: at once when somebody has changed an order, but for where it would fail again."""
        if self._trouble:
            await asyncio.sleep(LOOK_EVERY)
            return
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(LOOK_EVERY):
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

    def waits_for(self, order: JobOrder) -> list[str]:
        """In words why nothing is done for an order now; empty where something is, or nothing is to be."""
        if order.is_over or order.state is OrderState.NOT_ALLOWED_TO_START:
            return []
        if order.is_at_station:
            view = self._view
            job = None if view is None else view.jobs.get(order.id)
            return ["the station to take it"] if job is None else job.waits_for
        refused = self._refused.get(order.id)
        return self._queue.waits.get(order.id) or ([] if refused is None else [refused[0]])

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
        if masters is not None and (at_station or self._following.has_jobs) and await self._follow(masters):
            await self._read_orders(anew=True)
            at_station = [each for each in self._orders if each.is_at_station]
        if view is not None and view.production is not Production.PREPARING:
            for order in at_station:
                wish, said = self._said.get(order.id, (None, float("-inf")))
                if wish is not order.wish or heard > said + SAY_AGAIN:
                    await self._look_after(order, view.jobs.get(order.id))
            await self._forget(view)
        self._queue = queue(self._orders, view, masters, self._office.now(), self.sequence)
        now = time.monotonic()
        for order in self._queue.next:
            _, refused = self._refused.get(order.id, ("", float("-inf")))
            if now - refused > TRY_AGAIN:
                await self._hand_over(order)

    async def _read_orders(self, *, anew: bool = False) -> None:
        now = time.monotonic()
        if anew or self._poked.is_set() or now - self._read > READ_EVERY:
            self._poked.clear()
            self._orders = await self._office.read(orders.open_orders)
            self._read = now
            known = {each.id for each in self._orders}
            self._said = {id_: said for id_, said in self._said.items() if id_ in known}
            self._refused = {id_: why for id_, why in self._refused.items() if id_ in known}

    async def _follow(self, masters: WorkMastersView) -> bool:
        """Read on in the run's journal; whether orders have changed by it."""
        changed, more = False, True
        while more:
            news, more = await run_in_threadpool(self._following.read_on, masters)
            changed = changed or news
        return changed

    async def _hand_over(self, order: JobOrder) -> None:
        """Give an order to the station, where it may still start."""
        idle = not any(each.is_at_station for each in self._orders)
        now = self._office.now()

        def write() -> JobOrder | None:
            with self._office.database.writing() as connection:
                handed = orders.hand_over(connection, order, now)
                if handed is not None and idle and not self._following.has_jobs:
                    self._following.begin(connection)
                return handed

        handed = await run_in_threadpool(write)
        if handed is None:
            self.poke()
            return
        self._orders = [handed if each.id == handed.id else each for each in self._orders]
        await self._take(handed)

    async def _take(self, order: JobOrder) -> None:
        """Have the controller take an order, be it for another time."""
        command = TakeJob(actor=SYSTEM, job=order.id, title=order.title, work_master=order.work_master)
        try:
            await self._controller.send(command)
        except CommandRefused as refused:
            if refused.status >= 500:  # nobody knows what became of it: it is said again
                raise
            self._refused[order.id] = refused.detail, time.monotonic()
            if order.state is OrderState.ALLOWED_TO_START:
                await self._take_back(order)
            return
        self._refused.pop(order.id, None)
        self._said[order.id] = order.wish, time.monotonic()

    async def _take_back(self, order: JobOrder) -> None:
        now = self._office.now()

        def write() -> None:
            with self._office.database.writing() as connection:
                orders.take_back(connection, order, now)

        await run_in_threadpool(write)
        self.poke()

    async def _look_after(self, order: JobOrder, job: JobView | None) -> None:
        """Say to the controller what is to become of an order, where that is not so yet."""
        if job is None:
            never_taken = order.state is OrderState.ALLOWED_TO_START and order.wish is Wish.ABORT
            if not never_taken:
                await self._take(order)
            elif order.handed_over is not None and self._office.now() - order.handed_over > UNCERTAIN:
                await self._take_back(order)
            return
        if job.state.is_over:
            return  # the journal tells
        match order.wish:
            case Wish.ABORT:
                await self._command(order, Wish.ABORT)
            case Wish.STOP if not job.stopping or job.state is JobState.PAUSED:
                await self._command(order, Wish.STOP)
            case Wish.PAUSE | Wish.RESUME:
                if await self._command(order, order.wish):
                    await self._grant(order)
            case None if order.state is OrderState.INTERRUPTED and job.state is not JobState.PAUSED:
                await self._command(order, Wish.PAUSE)
            case None if order.state is OrderState.RUNNING and job.state is JobState.PAUSED:
                await self._command(order, Wish.RESUME)

    async def _command(self, order: JobOrder, wish: Wish) -> bool:
        """Have the controller do something with a job; whether it did."""
        actor, reason = (SYSTEM, None) if order.wish is None else (order.wished_by or SYSTEM, order.wished_because)
        command: Command = CommandJob(actor=actor, reason=reason, job=order.id, what=wish.value)
        try:
            await self._controller.send(command)
        except CommandRefused as refused:
            if refused.slug in ("control-needed", "real-devices"):
                await self._refuse(order)
                return False
            if refused.slug not in ("job-ended", "unknown-job"):
                raise
            return False
        self._said[order.id] = order.wish, time.monotonic()
        return True

    async def _grant(self, order: JobOrder) -> None:
        now = self._office.now()
        self._said[order.id] = None, time.monotonic()

        def write() -> None:
            with self._office.database.writing() as connection:
                orders.granted(connection, order, now)

        await run_in_threadpool(write)
        self.poke()

    async def _refuse(self, order: JobOrder) -> None:
        now = self._office.now()

        def write() -> None:
            with self._office.database.writing() as connection:
                orders.refused(connection, order, now)

        await run_in_threadpool(write)
        self.poke()

    async def _forget(self, view: StationView) -> None:
        """What has ended, and is noted so, the station need not show any longer."""
        ended = [id_ for id_, job in view.jobs.items() if job.state.is_over]
        if not ended:
            return
        over = await self._office.read(lambda connection: orders.those_over(connection, ended))
        for id_ in ended:
            if id_ in over:
                await self._controller.send(ForgetJob(actor=SYSTEM, job=id_))

    def _note(self, reason: str) -> None:
        if reason != self._trouble:
            LOG.warning("orders cannot be looked after now", reason=reason)
        self._trouble = reason
