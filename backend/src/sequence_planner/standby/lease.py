"""Command lease for redundant stations: database tables, acquisition and renewal, model digest."""

from __future__ import annotations

import asyncio
import contextlib
import hashlib
import json
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import structlog
from sqlalchemy import (
    BigInteger,
    Boolean,
    Column,
    Connection,
    Engine,
    Integer,
    QueuePool,
    Row,
    String,
    Table,
    create_engine,
    select,
    text,
    update,
)
from sqlalchemy.exc import SQLAlchemyError

from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.errors import storage_error
from sequence_planner.db.location import PostgresqlServer, address
from sequence_planner.db.metadata import METADATA
from sequence_planner.model.files import STAGES, read_files

# Whether two stations run the same model: a digest of its files, the Python stages of its pipelines among them.


def digest_of(folder: Path) -> str:
    """64 hexadecimal digits over the texts of the model in `folder`. Raises `OSError`."""
    stages = {str(path.relative_to(folder)): path.read_bytes().hex() for path in (folder / STAGES).rglob("*.py")}
    texts = json.dumps([read_files(folder), stages], sort_keys=True)
    return hashlib.sha256(texts.encode()).hexdigest()


# The tables of this package. No column holds a time: the clocks of several machines need not agree.

NAME = String(100)
NUMBER = BigInteger().with_variant(Integer, "sqlite")

LEASE = Table(
    "command_lease",
    METADATA,
    Column("id", Integer, primary_key=True, autoincrement=False),  # there is one row, the first
    Column("holder", NAME, nullable=False),  # who commands, or did last
    Column("model", String(64), nullable=False),  # digest of what the holder runs; empty: of what was deployed there
    Column("epoch", NUMBER, nullable=False),  # how often it was taken
    Column("renewals", NUMBER, nullable=False),  # since it was taken
    Column("free", Boolean, nullable=False),  # the holder has let go of it
    # Up to which epoch it is certain that nothing was accepted that is not in the journal.
    Column("settled", NUMBER, nullable=False, server_default="-1"),
)

STANDBYS = Table(
    "standbys",
    METADATA,
    Column("name", NAME, primary_key=True),
    Column("model", String(64), nullable=False),
    Column("signs", NUMBER, nullable=False),  # how often it has said that it is there
)


# The lease of the command over a station's devices: at any moment at most one of several stations holds it.
#
# It is a row in the database that all share. Its holder counts it up again and again; who sees the count stand still
# for longer than the lease lasts may take it, by a write that only succeeds if the count is still that one. The holder
# for its part holds it no longer than that from the moment on at which it began to count up last, less a margin. So no
# two hold it at once, whatever the clocks of the day say: each measures only how long something took, by a clock of
# its own that goes on while its process stands still (Gray and Cheriton, *Leases*, SOSP 1989, with counts for their
# times). #
# What its holder writes into the journal passes a `fence` in the same transaction: who takes the lease reads all that
# was written under the one before, and nothing is written under that afterwards.
#
# A holder that falls silent may have died, or be cut off and go on accepting that people stop the station, which the
# journal never hears of. So who takes the lease does not know whether the last recorded word was the last, unless an
# epoch is `settled`: by its holder that lets go of it with everything recorded, or by a later process on the same
# machine that knows its holder to be dead, and what that had accepted.

LASTS: Final = 3.0  # seconds from a renewal
MARGIN: Final = 0.5  # seconds by which its holder lets go of it before somebody else may take it
LEAVES: Final = 10.0  # seconds without it after which its holder leaves the network, where others wait for that
EVERY: Final = 0.4  # seconds between two renewals, and between two looks of those who wait for it
ANSWERED: Final = 1.0  # seconds in which the database has to answer
DEPLOYED: Final = ""  # in the place of a model's digest: of the one that its last holder comes back with
_THE_ROW: Final = LEASE.c.id == 1
_MILLISECONDS: Final = int(ANSWERED * 1000)
_SETTINGS: Final = {  # of libpq; a connection is made within two seconds at least
    "client_encoding": "utf8",
    "connect_timeout": 2,
    "tcp_user_timeout": _MILLISECONDS,
    "options": f"-c statement_timeout={_MILLISECONDS} -c lock_timeout={_MILLISECONDS}",
}


def boot_clock() -> float:
    """Seconds of a clock that nobody sets, and that goes on while the process, or the machine, stands still."""
    return time.clock_gettime(getattr(time, "CLOCK_BOOTTIME", time.CLOCK_MONOTONIC))


@dataclass(frozen=True)
class Seen:
    """The lease as it was seen: who holds it or did, with what model, and how often it was taken and renewed."""

    holder: str
    model: str
    epoch: int
    renewals: int
    free: bool


@dataclass
class Lease:
    """The lease as one station sees it, which is called `name` and runs the model with this digest.

    Used from one thread but for `held`. Each method raises `StorageError` when the database does not answer.
    """

    engine: Engine
    place: PostgresqlServer
    name: str
    model: str
    clock: Callable[[], float] = boot_clock
    seen: Seen | None = None
    """The last that was seen of it; None if nobody has ever held it."""
    taken_from: str | None = None
    """Previous holder, where it was another one."""
    settled_before: bool = False
    """True if all that was accepted before it was taken here is known to be in the journal."""
    unsettled: int | None = None
    """The epoch in which an earlier process of this very station held it, which has ended, and of which this one alone
    knows what is not recorded: it does not wait for it."""
    _left_at: float | None = None  # when an earlier epoch of this station was settled here: others come first then
    _epoch: int | None = None  # in which it is ours
    _until: float = 0.0  # on the clock
    _still_since: float = 0.0  # nothing about it has changed since
    _renewed_elsewhere: bool = False  # by its holder that was seen last
    _standbys: dict[str, tuple[int, float]] = field(default_factory=dict)  # by name: its count, and since when

    @property
    def held(self) -> bool:
        """True if it is held at this moment."""
        return self.clock() < self._until

    @property
    def is_ours(self) -> bool:
        """True if it was taken, and nobody else is known to have taken it since."""
        return self._epoch is not None

    @property
    def epoch(self) -> int | None:
        """The number of its holder, while that is this station."""
        return self._epoch

    @property
    def is_gone(self) -> bool:
        """True if it was ours and has not been held for so long that somebody else has it, if anybody is there."""
        return self.is_ours and self.clock() >= self._until + LEAVES

    @property
    def hindrance(self) -> str | None:
        """The reason why this station must not take it, whatever becomes of its holder; None if it may."""
        seen = self.seen
        if seen is None or seen.model == self.model or seen.holder == self.name:
            return None
        if seen.model == DEPLOYED:
            return f"another model was deployed at {seen.holder}: deploy it here too"
        return f"{seen.holder} runs another model: deploy the same one here"

    @property
    def is_elsewhere(self) -> bool:
        """True if this station stands by: another one was seen to renew it, or this one must not take it."""
        return not self.is_ours and (self._renewed_elsewhere or self.hindrance is not None)

    def try_to_take(self) -> bool:
        """Look at it, and take it if its holder has let go of it, or has not renewed it for too long."""
        with self._writing() as connection:
            row = connection.execute(select(LEASE).where(_THE_ROW)).first()
        now = self.clock()
        seen = None if row is None else _seen(row)
        self._renewed_elsewhere = _is_renewed(self.seen, seen, self.name) or (
            self._renewed_elsewhere and seen == self.seen
        )
        if seen != self.seen or not self._still_since:
            self.seen, self._still_since = seen, now
        if self.hindrance is not None:
            return False
        if seen is not None and not self._may_take(seen, now):
            return False
        return self._acquire(seen)

    def _may_take(self, seen: Seen, now: float) -> bool:
        """Return whether it may be taken by now from who holds it, or did."""
        if seen.holder == self.name and seen.epoch == self.unsettled:
            return True
        if self._left_at is not None and now - self._left_at < LASTS:
            return False
        return seen.free or now - self._still_since >= LASTS

    def look_anew(self) -> None:
        """The database did not answer. Nobody could renew it meanwhile, so from now on its holder has all the time."""
        self._still_since = 0.0

    def renew(self) -> bool:
        """Hold it for longer; false if somebody else has taken it."""
        began = self.clock()
        with self._writing() as connection:
            ours = _THE_ROW & (LEASE.c.epoch == self._epoch) & ~LEASE.c.free
            counted = update(LEASE).where(ours).values(renewals=LEASE.c.renewals + 1).returning(LEASE.c.settled)
            settled = connection.execute(counted).scalar()
        renewed = settled is not None
        if settled is not None:
            self._update_settled(settled)
            self._hold(began)
        else:
            self._epoch, self._until = None, 0.0
        return renewed

    def fence(self, connection: Connection) -> bool:
        """Return whether it is held in the transaction of `connection`, until whose end nobody else can take it."""
        # Whoever is stopped while it writes must not keep others from the lease for ever.
        connection.execute(text(f"SET LOCAL idle_in_transaction_session_timeout = {_MILLISECONDS}"))
        seen = select(LEASE.c.epoch, LEASE.c.free).where(_THE_ROW)
        found = connection.execute(seen.with_for_update(read=True, key_share=True)).first()
        return found is not None and found.epoch == self._epoch and not found.free

    def release(self, *, deployed: bool = False, settled: bool = False) -> None:
        """Let go of it, so that others need not wait; when another model was `deployed` here only those who run it.

        `settled` says that all that was accepted is recorded.
        """
        epoch, self._epoch, self._until = self._epoch, None, 0.0
        if epoch is not None:
            values = {
                "free": True,
                **({"model": DEPLOYED} if deployed else {}),
                **({"settled": epoch} if settled else {}),
            }
            with self._writing() as connection:
                connection.execute(update(LEASE).where(_THE_ROW & (LEASE.c.epoch == epoch)).values(values))

    def settle(self, epoch: int) -> None:
        """Say of an earlier process of this station that it has ended, and that all it accepted is recorded."""
        with self._writing() as connection:
            later = _THE_ROW & (LEASE.c.epoch >= epoch) & (LEASE.c.settled < epoch)
            connection.execute(update(LEASE).where(later).values(settled=epoch))
            held = _THE_ROW & (LEASE.c.epoch == epoch) & ~LEASE.c.free
            was_held = connection.execute(update(LEASE).where(held).values(free=True)).rowcount == 1
        if was_held:
            self._left_at = self.clock()

    def stand_by(self) -> None:
        """Say that this station is there and waits."""
        from sqlalchemy.dialects.postgresql import insert as insert_or_not  # noqa: PLC0415 - few stations have that

        values = {"name": self.name, "model": self.model, "signs": 1}
        said = insert_or_not(STANDBYS).values(values)
        again = said.on_conflict_do_update(
            index_elements=["name"], set_={"model": self.model, "signs": STANDBYS.c.signs + 1}
        )
        with self._writing() as connection:
            connection.execute(again)

    def standing_by(self) -> tuple[str, ...]:
        """Return who else is there, with the same model, and could take it."""
        with self._writing() as connection:
            rows = connection.execute(select(STANDBYS).where(STANDBYS.c.model == self.model)).all()
        now, before = self.clock(), self._standbys
        self._standbys = {
            row.name: (row.signs, now if before.get(row.name, (None,))[0] != row.signs else before[row.name][1])
            for row in rows
            if row.name != self.name
        }
        # What was read for the first time may be old.
        fresh = (name for name, (_, since) in self._standbys.items() if name in before and now - since < LASTS)
        return tuple(sorted(fresh))

    def close(self) -> None:
        """End all connections."""
        self.engine.dispose()

    def _acquire(self, seen: Seen | None) -> bool:
        began = self.clock()
        from sqlalchemy.dialects.postgresql import insert as insert_or_not  # noqa: PLC0415 - as above

        mine = {"holder": self.name, "model": self.model, "renewals": 0, "free": False}
        with self._writing() as connection:
            if seen is None:
                first = insert_or_not(LEASE).values(id=1, epoch=1, settled=-1, **mine).on_conflict_do_nothing()
                settled = connection.execute(first.returning(LEASE.c.settled)).scalar()
            else:
                as_seen = (
                    (LEASE.c.epoch == seen.epoch) & (LEASE.c.renewals == seen.renewals) & (LEASE.c.free == seen.free)
                )
                values = {**mine, "epoch": seen.epoch + 1}
                # Whoever has passed the fence writes first: taking waits for that, and renewing does not.
                connection.execute(select(LEASE.c.id).where(_THE_ROW).with_for_update())
                taking = update(LEASE).where(_THE_ROW & as_seen).values(values).returning(LEASE.c.settled)
                settled = connection.execute(taking).scalar()
        if settled is not None:
            self.taken_from = None if seen is None or seen.holder == self.name else seen.holder
            self._epoch = 1 if seen is None else seen.epoch + 1
            self.seen = Seen(self.name, self.model, self._epoch, 0, free=False)
            self._update_settled(settled)
            self._hold(began)
        return settled is not None

    def _update_settled(self, settled: int) -> None:
        self.settled_before = self._epoch is not None and settled >= self._epoch - 1

    def _hold(self, began: float) -> None:
        self._until = began + LASTS - MARGIN

    @contextmanager
    def _writing(self) -> Iterator[Connection]:
        """A short transaction, durable when it has ended, which waits for nobody who writes something else."""
        try:
            with self.engine.connect() as connection, connection.begin():
                connection.execute(text("SET LOCAL synchronous_commit = on"))
                yield connection
        except SQLAlchemyError as error:
            raise storage_error(self.place, error) from error


def open_lease(url: str, name: str, model: str) -> Lease:
    """The lease in the database that a URL names. Raises `StorageError` for one that several machines cannot share."""
    place = address(url)
    if not isinstance(place, PostgresqlServer):
        raise StorageError(f"several stations cannot share {place}: a hot standby takes a database of PostgreSQL")
    return Lease(
        create_engine(place.url, connect_args=_SETTINGS, poolclass=QueuePool, pool_size=1, hide_parameters=True),
        place,
        name,
        model,
    )


def _is_renewed(before: Seen | None, now: Seen | None, name: str) -> bool:
    """Return whether somebody else than `name` holds it now, and has taken or renewed it since it was seen before."""
    return before is not None and now is not None and not now.free and now.holder != name and now != before


def _seen(row: Row[tuple[object, ...]]) -> Seen:
    return Seen(row.holder, row.model, row.epoch, row.renewals, row.free)


# A thread that takes the lease of the command as soon as it may, and holds it from then on.
#
# It has nothing else to do and waits for nothing but the lease's own short statements, so a station that is busy renews
# its lease all the same. Whoever is about to say something to a device asks `held`, which is true only as long as
# nobody else can have taken the lease.

LOG = structlog.get_logger(__name__)
ENDING = 3.0  # seconds


class LeaseLostError(Exception):
    """Another station has taken the lease, or may long have: it commands from now on."""


@dataclass(frozen=True)
class LeaseStatus:
    """The state of things: who holds the lease or did last, who else is there, and why this station does not take
    it.
    """

    name: str
    active: bool
    holder: str | None
    standing_by: tuple[str, ...]
    trouble: str | None


class LeaseKeeper:
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
        self.standing = LeaseStatus(lease.name, False, None, (), None)

    @property
    def held(self) -> bool:
        """True if this station may say something to a device at this moment."""
        return self._lease.held

    @property
    def taken_from(self) -> str | None:
        """The station that commanded before this one did; None if that was nobody else."""
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

    def start(self) -> None:
        """From now on it waits for the lease, or holds it."""
        self._thread.start()

    async def taken(self) -> None:
        """Wait until the lease was taken."""
        await asyncio.shield(self._taken)

    async def stands_by(self) -> None:
        """Wait until it is seen that another station holds it, or that this one must not take it."""
        await asyncio.shield(self._stands_by)

    async def settled(self, within: float) -> bool:
        """Return whether all that was accepted before it was taken is known to be recorded, by now or in so many
        seconds.
        """
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
                self._publish(str(error))
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
        self._publish(None)

    def _lose(self) -> None:
        self._is_lost = True
        self._call(self._lost)

    def _publish(self, trouble: str | None) -> None:
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
        self.standing = LeaseStatus(lease.name, lease.is_ours, holder, others, trouble)

    def _call(self, future: asyncio.Future[None]) -> None:
        def done() -> None:
            if not future.done():
                future.set_result(None)

        with contextlib.suppress(RuntimeError):  # the loop has ended
            self._loop.call_soon_threadsafe(done)
