"""What is said to the controller of orders that the station works on or may have been given.

All of it may be said twice. What the controller answers to a command was decided after all that was said to it before,
as it carries commands out one after the other.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection

from sqlalchemy import Connection
from starlette.concurrency import run_in_threadpool

from sequence_planner.actor import SYSTEM, Actor
from sequence_planner.control.commands import CommandRefused
from sequence_planner.control.job_commands import CommandJob, ForgetJob, TakeJob
from sequence_planner.control.job_view import JobView
from sequence_planner.control.view import StationView
from sequence_planner.control.vocabulary import JobState
from sequence_planner.mes import orders
from sequence_planner.mes.order import JobOrder
from sequence_planner.mes.states import OrderState, Wish
from sequence_planner.web.controller_client import ControllerClient
from sequence_planner.web.identity import IdentityOffice

TRY_AGAIN = 10.0  # seconds after which an order that the station has refused is given to it again
SAY_AGAIN = 1.0  # seconds after which a view knows of what was said, as far as that is durable


class OrderDispatch:
    """Speaks to `controller` of the orders of `office`; `changed` is called when that has changed one.

    Its methods raise `CommandRefused` when nobody knows what became of what was said, and `StorageError`.
    """

    def __init__(self, office: IdentityOffice, controller: ControllerClient, changed: Callable[[], None]) -> None:
        self._office = office
        self._controller = controller
        self._changed = changed
        self._refused: dict[str, tuple[str, float]] = {}  # why the station has not taken an order, and when
        # What was wished for when something was said of a job last, and when: older views do not know of it.
        self._said: dict[str, tuple[Wish | None, float]] = {}
        self._strays: dict[str, float] = {}  # jobs under way that nobody waits for any more, and since when

    def keep(self, known: Collection[str]) -> None:
        """Remember nothing of orders but these."""
        self._said = {id_: said for id_, said in self._said.items() if id_ in known}
        self._refused = {id_: why for id_, why in self._refused.items() if id_ in known}

    def why_refused(self, order: str) -> str | None:
        """Why the station has not taken an order when it was given to it last."""
        refused = self._refused.get(order)
        return None if refused is None else refused[0]

    def may_take(self, order: str) -> bool:
        """Whether an order is to be given to the station now, which may have refused it a moment ago."""
        _, refused = self._refused.get(order, ("", float("-inf")))
        return time.monotonic() - refused > TRY_AGAIN

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
