"""Audit records of commands and their outcomes, and journal notes on PackML state and job waits."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Final, Generic, TypeVar

import structlog
from pydantic import JsonValue
from sqlalchemy.exc import SQLAlchemyError

from sequence_planner.controller.commands.command import Command, CommandRefused
from sequence_planner.controller.commands.tasks import TaskCommand
from sequence_planner.controller.views.station import PackML, TaskView
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.journal.audit import append
from sequence_planner.journal.entry import LONGEST_SUBJECT, Entry, Outcome
from sequence_planner.texts.message import message

# Commands and what became of them, recorded before and after their effect.
#
# A command that cannot be recorded is refused, and an alarm says why. What only ever stops devices is the exception: it
# is carried out first and recorded then, because neither a full nor a slow disk must keep anybody from pausing a
# station. What moves devices and waits for its record meanwhile is void: nothing goes on after a pause because of an
# older word.

LOG = structlog.get_logger(__name__)
PATIENCE = 4.0  # seconds for a record; the server waits a little longer for the answer to a command
AGAIN = 2.0  # seconds after which what could not be recorded yet is tried again


class CommandAudit:
    """Records commands in `database`, one after the other; `told` hears why the last could not be, or None."""

    def __init__(self, database: Database, told: Callable[[str | None], None]) -> None:
        self._database = database
        self._told = told
        # One thread, so that records come in the order in which commands were given; ticks go on meanwhile.
        self._thread = ThreadPoolExecutor(1, "recording")
        self._late: set[asyncio.Task[None]] = set()
        self._pauses = 0  # so far

    async def close(self) -> None:
        """Write what is under way, as long as that is possible, then end."""
        if self._late:
            await asyncio.wait(self._late, timeout=PATIENCE)
        for each in self._late:
            each.cancel()
        self._thread.shutdown(wait=False)

    async def carry_out(
        self, command: Command, tasks: Callable[[], dict[str, TaskView]], act: Callable[[Command], Awaitable[None]]
    ) -> asyncio.Task[None] | None:
        """Record the command, let `act` carry it out, and record what became of it.

        `tasks` are the open ones, for what a command about one is about. What only stops devices is not recorded yet
        when this returns, but when the task ends that it gives back. Raises what `act` raises, and `CommandRefused`
        when the command cannot be recorded, or somebody has paused the station before it was.
        """
        entry, pauses = entry_of(command, tasks), self._pauses
        if command.harmless:
            self._pauses += 1
            await act(command)
            return self.record_late(_end(entry, None, Outcome.DONE), time.time())
        number = await self._record(entry)
        if number is None:
            raise CommandRefused("not-recorded", message("refused.not-recorded.journal"), 503)
        try:
            if command.overtaken_by_pause and self._pauses != pauses:
                raise _overtaken()
            await act(command)
        except CommandRefused as refused:
            await self._record(_end(entry, number, Outcome.REFUSED, refused.slug))
            raise
        except BaseException as error:
            await self._record(_end(entry, number, Outcome.FAILED, type(error).__name__))
            raise
        await self._record(_end(entry, number, Outcome.DONE))
        return None

    def record_late(self, entry: Entry, when: float) -> asyncio.Task[None]:
        """Record what was done at `when`, as soon as that is possible; what it gives back ends then."""
        late = asyncio.create_task(self._record_at_last(entry, when))
        self._late.add(late)
        late.add_done_callback(self._late.discard)
        return late

    async def _record_at_last(self, entry: Entry, when: float) -> None:
        while True:
            writing = asyncio.get_running_loop().run_in_executor(self._thread, self._append, entry)
            done, _ = await asyncio.wait({writing}, timeout=PATIENCE)
            if not done:
                self._told(f"the database does not answer within {PATIENCE:g} s")
            try:
                await writing
            except (SQLAlchemyError, StorageError, OSError) as error:
                LOG.warning("what was done is not recorded yet", action=entry.action, because=_why(error))
                self._told(_why(error))
            else:
                self._told(None)
                return
            await asyncio.sleep(AGAIN)
            entry = entry.model_copy(update={"details": {**entry.details, "carried_out": when}})

    async def note(self, entry: Entry) -> bool:
        """Record what the station has done by itself; whether it is recorded."""
        return await self._record(entry) is not None

    async def _record(self, entry: Entry) -> int | None:
        """The number of the new record; None when there is none."""
        try:
            async with asyncio.timeout(PATIENCE):
                number = await asyncio.get_running_loop().run_in_executor(self._thread, self._append, entry)
        except TimeoutError:
            # It may be written yet, and then says what was asked for and not done.
            LOG.error("a command is not recorded in time", action=entry.action, outcome=entry.outcome)
            self._told(f"the database does not answer within {PATIENCE:g} s")
            return None
        except (SQLAlchemyError, StorageError, OSError) as error:
            LOG.exception("a command is not recorded", action=entry.action, outcome=entry.outcome)
            self._told(_why(error))
            return None
        self._told(None)
        return number

    def _append(self, entry: Entry) -> int:
        with self._database.writing() as connection:
            return append(connection, entry, time.time()).number


def entry_of(command: Command, tasks: Callable[[], dict[str, TaskView]] = dict) -> Entry:
    """Return what the record says of a command that somebody gives."""
    details = command.model_dump(mode="json", exclude={"actor", "reason", "kind"})
    if isinstance(command, TaskCommand) and (task := tasks().get(command.task)) is not None:
        details |= {"ability": task.ability, "title": task.title}
    return Entry(
        actor=command.actor,
        action=command.kind,
        subject=command.subject[:LONGEST_SUBJECT],  # `details` have all of it
        details=details,
        reason=command.reason,
        outcome=Outcome.REQUESTED,
    )


def _end(entry: Entry, number: int | None, outcome: Outcome, because: str | None = None) -> Entry:
    details = entry.details if because is None else {**entry.details, "because": because}
    return entry.model_copy(update={"outcome": outcome, "about": number, "details": details})


def _overtaken() -> CommandRefused:
    return CommandRefused("command-overtaken", message("refused.command-overtaken.paused"))


def _why(error: Exception) -> str:
    """In the words of the database, which name the cause: a full disk, a lock, a server that is away."""
    cause = getattr(error, "orig", None) or error
    return str(cause).strip().splitlines()[0] if str(cause).strip() else type(cause).__name__


# Notes for the journal of how the station stands: its PackML state, and what each of its jobs waits for.
#
# Nothing follows from them; whoever reads the journal, as what tells a MES of events does, need not find out itself.
# What lasts for a moment alone is not noted, so that a plan that is made anew is none.

PACKML: Final = "packml"  # of the records
JOB_WAITS: Final = "job-waits"
PACKML_LASTS: Final = 1.0  # seconds after which it is noted
WAITS_LAST: Final = 5.0
LOOK_EVERY: Final = 0.5  # seconds

Tell = Callable[[str, Mapping[str, JsonValue]], None]
T = TypeVar("T")


class _Steady(Generic[T]):
    """Says once of each value that lasted for so long, and since when (seconds since the epoch)."""

    def __init__(self, lasts: float) -> None:
        self._lasts = lasts
        self._told: list[T] = []  # one, or none
        self._seen: tuple[T, Timestamp] | None = None

    def see(self, value: T, now: Timestamp) -> tuple[T, float] | None:
        """The value, where it is to be told now."""
        if self._seen is None or self._seen[0] != value:
            self._seen = value, now
        since = self._seen[1]
        if [value] == self._told or now.monotonic - since.monotonic < self._lasts:
            return None
        self._told = [value]
        return value, since.epoch


class StandingNotes:
    """Tells `tell` how the station stands, whenever that has changed for good."""

    def __init__(self, tell: Tell) -> None:
        self._tell = tell
        self._packml: _Steady[PackML] = _Steady(PACKML_LASTS)
        self._jobs: dict[str, _Steady[list[str]]] = {}
        self._looked = float("-inf")

    def due(self, now: Timestamp) -> bool:
        """Return whether it is time for another look, which counts as taken."""
        if now.monotonic - self._looked < LOOK_EVERY:
            return False
        self._looked = now.monotonic
        return True

    def look(self, packml: PackML, waits: Mapping[str, Sequence[str]], now: Timestamp) -> None:
        """Take note of how it stands now."""
        if (changed := self._packml.see(packml, now)) is not None:
            state, since = changed
            self._tell(PACKML, {"state": state.value, "since": since, "monotonic": now.monotonic})
        self._jobs = {job: self._jobs.get(job) or _Steady(WAITS_LAST) for job in waits}
        for job, steady in self._jobs.items():
            if (told := steady.see([*waits[job]], now)) is not None:
                texts: list[JsonValue] = [*told[0]]
                self._tell(JOB_WAITS, {"job": job, "waits_for": texts, "since": told[1]})
