"""A thread that takes the lease of the command as soon as it may, and holds it from then on.

It has nothing else to do and waits for nothing but the lease's own short statements, so a station that is busy renews
its lease all the same. Whoever is about to say something to a device asks `held`, which is true only as long as nobody
else can have taken the lease.
"""

from __future__ import annotations

import asyncio
import contextlib
import threading
from dataclasses import dataclass

import structlog
from sqlalchemy import Connection

from sequence_planner.standby.lease import EVERY, Lease
from sequence_planner.storage.error import StorageError

LOG = structlog.get_logger(__name__)
ENDING = 3.0  # seconds


class LeaseLostError(Exception):
    """Another station has taken the lease, or may long have: it commands from now on."""


@dataclass(frozen=True)
class Standing:
    """How things are: who holds the lease or did last, who else is there, and why this station does not take it."""

    name: str
    active: bool
    holder: str | None
    standing_by: tuple[str, ...]
    trouble: str | None


class Keeper:
    """Keeps a lease. Used from the event loop on which it was made, but for `held`."""

    def __init__(self, lease: Lease) -> None:
        self._lease = lease
        self._loop = asyncio.get_running_loop()
        self._taken: asyncio.Future[None] = self._loop.create_future()
        self._lost: asyncio.Future[None] = self._loop.create_future()
        self._settled: asyncio.Future[None] = self._loop.create_future()
        self._stands_by: asyncio.Future[None] = self._loop.create_future()
        self._ending = threading.Event()
        self._is_lost = False
        self._thread = threading.Thread(target=self._work, name="lease", daemon=True)
        self.standing = Standing(lease.name, False, None, (), None)

    @property
    def held(self) -> bool:
        """Whether this station may say something to a device at this moment."""
        return self._lease.held

    @property
    def taken_from(self) -> str | None:
        """Who commanded before this station did; None if that was nobody else."""
        return self._lease.taken_from

    @property
    def epoch(self) -> int | None:
        """That of the lease, while it is this station's."""
        return self._lease.epoch

    @property
    def settled_before(self) -> bool:
        """See `Lease.settled_before`."""
        return self._lease.settled_before

    def fence(self, connection: Connection) -> bool:
        """See `Lease.fence`; used from the thread that writes the journal."""
        return self._lease.fence(connection)

    def begin(self) -> None:
        """From now on it waits for the lease, or holds it."""
        self._thread.start()

    async def taken(self) -> None:
        """Wait until the lease was taken."""
        await asyncio.shield(self._taken)

    async def stands_by(self) -> None:
        """Wait until it is seen that another station holds it, or that this one must not take it."""
        await asyncio.shield(self._stands_by)

    async def settled(self, within: float) -> bool:
        """Whether all that was accepted before it was taken is known to be recorded, by now or in so many seconds."""
        await asyncio.wait({self._settled}, timeout=within)
        return self._settled.done()

    async def lost(self) -> None:
        """Wait until it was lost. Raises `LeaseLostError` then."""
        await asyncio.shield(self._lost)
        raise LeaseLostError

    async def end(self, *, deployed: bool, settled: bool) -> None:
        """Let go of the lease: nothing is said to a device any more. See `Lease.release`."""
        self._ending.set()
        await asyncio.to_thread(self._thread.join, ENDING)
        with contextlib.suppress(StorageError):  # then it runs out
            await asyncio.to_thread(self._lease.release, deployed=deployed, settled=settled)
        self._lease.close()

    def _work(self) -> None:
        while not self._ending.is_set():
            try:
                self._step()
            except StorageError as error:
                self._lease.look_anew()
                self._tell(str(error))
                if self._lease.is_gone:
                    # It says nothing, but it is seen on the network, and whoever commands now waits until it is not.
                    LOG.warning("this station leaves the command to others", because="the database does not answer")
                    self._lose()
            if self._is_lost:
                return
            self._ending.wait(EVERY)

    def _step(self) -> None:
        if self._lease.is_ours:
            if not self._lease.renew():
                self._lose()
        elif self._lease.try_to_take():
            LOG.info("this station commands from now on", name=self._lease.name)
        else:
            self._lease.stand_by()
            if self._lease.is_elsewhere:
                self._call(self._stands_by)
        if self._lease.settled_before:
            self._call(self._settled)  # before it is told that the lease was taken
        if self._lease.is_ours:
            self._call(self._taken)
        self._tell(None)

    def _lose(self) -> None:
        self._is_lost = True
        self._call(self._lost)

    def _tell(self, trouble: str | None) -> None:
        """Show how things are; where the database does not answer it is said that nobody knows."""
        lease = self._lease
        holder = None if lease.seen is None else lease.seen.holder
        others: tuple[str, ...] = ()
        if trouble is None:
            with contextlib.suppress(StorageError):
                others = lease.standing_by()
            trouble = None if lease.is_ours else lease.hindrance
        if trouble != self.standing.trouble and trouble is not None:
            LOG.warning("the lease of the command", trouble=trouble)
        self.standing = Standing(lease.name, lease.is_ours, holder, others, trouble)

    def _call(self, future: asyncio.Future[None]) -> None:
        def done() -> None:
            if not future.done():
                future.set_result(None)

        with contextlib.suppress(RuntimeError):  # the loop has ended
            self._loop.call_soon_threadsafe(done)
