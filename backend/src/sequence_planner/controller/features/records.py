"""What a running station has in its journal: what is written, up to which record it is durable, and why not."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from functools import partial

from pydantic import JsonValue

from sequence_planner.controller.alarms.consequences import Consequences
from sequence_planner.controller.alarms.kinds import KEPT_BESIDE, UNJOURNALLED, UNRECORDED, Cause
from sequence_planner.controller.features.failures import Failures
from sequence_planner.controller.io.devices import Devices
from sequence_planner.controller.io.output_gate import OutputGate
from sequence_planner.core.clock import Timestamp
from sequence_planner.db.database import Database
from sequence_planner.execution.events import Heard
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.jobs import Jobs
from sequence_planner.execution.record.recorder import RunRecorder, model_digest
from sequence_planner.execution.state import InitialState
from sequence_planner.execution.vocabulary import Production
from sequence_planner.journal.writer import Fence, RunWriter
from sequence_planner.texts.message import message

PATIENCE = 1.0  # seconds for which outputs may wait for their record before nothing more is started
MOST_UNWRITTEN = 100_000  # records; then nothing more is taken in, and no tick taken


class Records:
    """Writes what happens at `execution` into the journal of `database`, and lets outputs go once it has that.

    It listens to `execution` before all others. `wake` is called when it has changed whether anything may start.
    """

    def __init__(
        self,
        execution: Executor,
        beginning: InitialState | None,
        devices: Devices,
        database: Database,
        fence: Fence,
        failures: Failures,
        wake: Callable[[], None],
    ) -> None:
        self._execution, self._devices = execution, devices
        self._failures, self._wake = failures, wake
        self.writer = RunWriter(database, self._journalled, fence)
        self.recorder = RunRecorder(execution, self.writer.write, model_digest(execution.automaton), beginning)
        self.begun = self.writer.end
        """The first record of this life."""
        self.gate = OutputGate(
            execution, lambda: self.recorder.last, devices.publish, lambda: bool(devices.commander.owed)
        )
        self._jobs = KeptJobs(execution, lambda: self.recorder.last)
        self._kept = 0, ""  # what was asked for and is beside the journal, up to that record
        self._was_behind = False
        self._consequences = Consequences(execution)
        self.unrecorded: str | None = None
        """Why commands cannot be recorded."""

    @property
    def newest(self) -> int:
        """The number of the last record of what has happened, which may not be durable yet."""
        return self.writer.end.number

    @property
    def is_durable(self) -> bool | None:
        """True if all that has happened is durable; None where not even that this life has begun."""
        return self.writer.waiting == 0 if self.writer.durable >= self.begun.number else None

    @property
    def jobs(self) -> Jobs:
        """The jobs as far as they are durable."""
        return self._jobs.up_to(self.writer.durable)

    @property
    def trouble(self) -> str | None:
        """Why what happens cannot be journalled; None when it can."""
        if self.writer.trouble is not None:
            return self.writer.trouble
        if self.gate.longest > PATIENCE:
            return f"the database has not confirmed anything for {PATIENCE:g} s"
        return None

    @property
    def is_full(self) -> bool:
        """True if more waits to be written than may."""
        return self.writer.waiting > MOST_UNWRITTEN

    @property
    def beside(self) -> str | None:
        """What was asked for last that only a file beside the journal has."""
        number, what = self._kept
        return what if number > self.writer.durable else None

    def causes(self, moment: Timestamp) -> Iterator[Cause]:
        """The causes of alarms that there are now."""
        yield from unwritten(self._consequences, self.trouble, self.unrecorded, self.beside)

    def note_kept(self, number: int, what: str) -> None:
        """Note that what was asked for is kept beside the journal until that has the record of this number."""
        self._kept = number, what

    def add_note(self, kind: str, content: Mapping[str, JsonValue], *, lasts: bool = False) -> None:
        """Write down what is no event of the execution."""
        self.recorder.append_record(kind, time.time(), content, lasts=lasts)

    def obstacles(self) -> tuple[str, ...]:
        """What keeps every ability from starting."""
        self._was_behind = self.trouble is not None
        unwritten = [message("waits.journal")] if self._was_behind else []
        began = self._execution.production is Production.STARTED and self.gate.released is None
        unsent = [message("waits.first-commands")] if began else []
        return (*self._devices.obstacles(), *unwritten, *unsent)

    def repeat(self, moment: Timestamp) -> None:
        """Send again what is due of outputs that are out, and what could not be sent."""
        if self.gate.released is not None:
            self._devices.repeat(self.gate.released, moment.monotonic)
            self.gate.go_on()

    def _journalled(self) -> None:
        """More records are durable, or it has changed why none are."""
        self._failures.attempt("sending commands", partial(self.gate.durable, self.writer.durable))
        if (self.trouble is not None) != self._was_behind:
            self._wake()


def unwritten(
    consequences: Consequences, unjournalled: str | None, unrecorded: str | None, beside: str | None
) -> Iterator[Cause]:
    """The causes of alarms of what cannot be written: what happens, commands, and what is only `beside` the journal."""
    if unjournalled is not None:
        yield UNJOURNALLED.cause("", {"why": unjournalled, "waiting": consequences.standstill()})
    if unrecorded is not None:
        yield UNRECORDED.cause("", {"why": unrecorded}, follows=(UNJOURNALLED.key(),))
    if beside is not None:
        yield KEPT_BESIDE.cause("", {"what": beside})


# The jobs as far as they are durable: whoever ordered one puts it away once it is told that it has ended.
#
# Were that told before its record is on the disk, a controller that is killed in between would begin the job's last
# operations again, and nobody would ask for them any more.


class KeptJobs:
    """Listens to `execution`, after whoever writes its records; `recorded` is the number of the last one."""

    def __init__(self, execution: Executor, recorded: Callable[[], int]) -> None:
        self._execution = execution
        self._recorded = recorded
        self._kept = self._newest = execution.conduct.jobs
        self._waiting: deque[tuple[int, Jobs]] = deque()
        execution.listeners.append(self._hear)

    def up_to(self, durable: int) -> Jobs:
        """As they are where all records up to this number are durable."""
        while self._waiting and self._waiting[0][0] <= durable:
            _, self._kept = self._waiting.popleft()
        return self._kept

    def _hear(self, heard: Heard) -> None:
        if self._execution.conduct.jobs is not self._newest:
            self._newest = self._execution.conduct.jobs
            self._waiting.append((self._recorded(), self._newest))
