"""State restored at controller start from the journal: estimates, outputs, mode, alarms and jobs."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from dataclasses import replace as replace_fields
from typing import Any, Final

from pydantic import JsonValue
from sqlalchemy import Connection

from sequence_planner.automaton.automaton import Automaton, Kind
from sequence_planner.controller.alarms.alarm import PutAside
from sequence_planner.controller.views.part import ControlView
from sequence_planner.controller.views.station import BeliefView, DeploymentView, OperationProgress
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.core.storage_error import StorageError
from sequence_planner.execution.events import Confirmed
from sequence_planner.execution.jobs import Job, Jobs, Waits
from sequence_planner.execution.record.codec import BEGUN, SNAPSHOT, Codec, UnreadableError, kind_of
from sequence_planner.execution.state import InitialState, OutOfService
from sequence_planner.execution.vocabulary import JobState, Mode, ServiceKind
from sequence_planner.journal import run_journal
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.language.printer import print_value
from sequence_planner.language.types import Value, contains
from sequence_planner.texts.message import Message, message

# What is known of a station from before the controller was started.


@dataclass(frozen=True)
class RestoredState:
    """The state that came back from the journal: estimates and why they were believed, outputs, service, how far
    operations were, and alarms put aside.

    `left_out` says what did not come back, and why; `produced` that production had been started. `control` is who is
    in control, and `deployment` the last one, where the controller begins because of one. `halted` says why the station
    begins at rest, where that is not what the journal says.
    """

    beginning: InitialState | None = None
    aside: Mapping[str, PutAside] = field(default_factory=dict)
    beliefs: Mapping[str, BeliefView] = field(default_factory=dict)
    progress: Mapping[str, OperationProgress] = field(default_factory=dict)
    left_out: tuple[Message, ...] = ()
    produced: bool = False
    control: ControlView | None = None
    deployment: DeploymentView | None = None
    halted: str | None = None

    @property
    def was_at_work(self) -> bool:
        """True if operations were executed, and nobody had told the station otherwise since."""
        return self.produced and self.beginning is not None and self.beginning.mode is Mode.AUTOMATIC


# The jobs of the life before, as they fit the model that there is now.


def restored_jobs(
    automaton: Automaton,
    by_order: bool,
    documents: Mapping[str, JsonValue],
    waits: JsonValue,
    left_out: list[Message],
    now: Timestamp,
) -> Jobs:
    """The jobs of `documents`, by their ids in the order in which they were taken; `left_out` hears what does not fit.

    None of them is lost: one that cannot go on is aborted, so that whoever ordered it is told. Of one whose work master
    is another one by now, what is completed stays so, and what is new is still to be done.
    """
    codec, jobs = Codec(automaton), Jobs(by_order)
    for name, document in documents.items():
        try:
            job: Job = codec.decode(Job, document)
        except UnreadableError as error:
            left_out.append(message("restored.job-unread", job=name, error=str(error)))
            job = Job(name, name, "", now, JobState.ABORTED, ended=now)
        if job.under_way and (trouble := _trouble(automaton, jobs, job)):
            left_out.append(message("restored.job-aborted", job=name, trouble=trouble))
            job = replace(job, state=JobState.ABORTED, ended=now)
        jobs = jobs.taking(_fitting(automaton, job, left_out) if job.under_way else job)
    return replace(jobs, waits=_waits(automaton, jobs, codec.decode(Waits, waits)))


def _trouble(automaton: Automaton, before: Jobs, job: Job) -> str:
    """Say why a job cannot go on; empty where it can."""
    master = automaton.work_masters.get(job.work_master)
    if master is None:
        return message("restored.no-master", name=job.work_master)
    shared = sorted(name for name in master.operations if before.having(name, automaton) is not None)
    return message("restored.job-shared", operations=", ".join(shared)) if shared else ""


def _fitting(automaton: Automaton, job: Job, left_out: list[Message]) -> Job:
    """The job, without the operations that its work master has no more."""
    known = automaton.work_masters[job.work_master].operations.keys()
    gone = (job.started.keys() | job.completed.keys() | (job.finishing or frozenset())) - known
    if not gone:
        return job
    left_out.append(message("restored.job-operations", job=job.id, operations=", ".join(sorted(gone))))
    return replace(
        job,
        finishing=None if job.finishing is None else job.finishing - gone,
        started={name: at for name, at in job.started.items() if name not in gone},
        completed={name: at for name, at in job.completed.items() if name not in gone},
    )


def _waits(automaton: Automaton, jobs: Jobs, waits: Waits) -> Waits:
    """Between operations that there are."""
    masters = {job.id: automaton.work_masters.get(job.work_master) for job in jobs.taken}
    known = {(id_, name) for id_, master in masters.items() if master is not None for name in master.operations}
    kept = {step: before & known for step, before in waits.items() if step in known}
    return {step: before for step, before in kept.items() if before}


# What is known of the station as its controller starts: what it believed and had commanded, from the journal.

_PAGE: Final = 1000  # records read at once
# What records say of the conduct where it changed.
_CONDUCT: Final = ("service", "done", "mode", "stepping", "by_order", "waits", "answers")
_CONFIRMED: Final = kind_of(Confirmed)


@dataclass(frozen=True)
class Restored:
    """The beginning of an execution. `left_out` says what came back and does not fit the model any more."""

    beginning: InitialState
    left_out: tuple[Message, ...]


def beginning(connection: Connection, automaton: Automaton, now: Timestamp) -> Restored | None:
    """Return what the journal knows of the last life; None if there was none.

    Raises `StorageError` where a record cannot be read. One that is not as it was written is said, and believed.
    """
    whole = _last_whole(connection)
    if whole is None:
        return None
    with _readable(whole):
        known, changed = _read(connection, whole)
        found = known.restored(automaton, now)
    if not changed:
        return found
    text = message("restored.record", number=changed[0])
    return replace_fields(found, left_out=(text, *found.left_out))


def last_mode(connection: Connection) -> Mode | None:
    """The mode in which the last life was last, whatever the model was; None if there was none.

    Raises `StorageError` where a record cannot be read.
    """
    whole = _last_whole(connection)
    if whole is None:
        return None
    with _readable(whole):
        return _read(connection, whole)[0].mode


def _last_whole(connection: Connection) -> RunRecord | None:
    """The last record that says everything."""
    return next(iter(run_journal.before(connection, None, 1, (BEGUN, SNAPSHOT))), None)


@contextmanager
def _readable(whole: RunRecord) -> Iterator[None]:
    """Raise what is wrong with records from `whole` on as `StorageError`."""
    try:
        yield
    except (ValueError, LookupError, TypeError, AttributeError) as error:
        raise StorageError(
            f"the journal cannot be read from record {whole.number} on ({error!r}): see what `sequence-planner "
            "journal --verify` finds, and start with a copy of the database, or with another one"
        ) from error


def _read(connection: Connection, whole: RunRecord) -> tuple[_Known, list[int]]:
    """Return what is known after the last record, and which records are not as they were written."""
    number = whole.number
    last = run_journal.get(connection, number - 1)
    changed = [] if whole.is_whole((last or run_journal.last_trimmed(connection)).hash) else [number]
    known = _Known(whole)
    while page := run_journal.after(connection, number, _PAGE):
        for record, before in zip(page, [known.record, *page], strict=False):
            if record.number != before.number + 1 or not record.is_whole(before.hash):
                changed.append(record.number)
            known.take(record)
        number = page[-1].number
    return known, changed


class _Known:
    """The knowledge that there is after each of the records."""

    def __init__(self, record: RunRecord) -> None:
        self.record = record  # the last one
        self._last = record.time
        self._found: dict[str, Any] = json.loads(record.content)
        self._unconfirmed = set(self._found["unconfirmed"])
        self._jobs: dict[str, Any] = dict(self._found.get("jobs", {}))

    def take(self, record: RunRecord) -> None:
        content = json.loads(record.content)
        self.record = record
        self._last = max(self._last, record.time)
        changes = content.get("changes", {})
        self._found["values"] |= changes
        self._found |= {name: content[name] for name in _CONDUCT if name in content}
        for job, document in content.get("jobs", {}).items():
            if document is None:  # it was forgotten
                self._jobs.pop(job, None)
            else:
                self._jobs[job] = document
        what = content.get("what", {})
        seen = what.get("names", ()) if record.kind == _CONFIRMED else what.get("values", {})
        self._unconfirmed.difference_update(changes, set(seen) - set(what.get("taken_back", ())))

    @property
    def mode(self) -> Mode:
        return Mode(self._found["mode"])

    def restored(self, automaton: Automaton, now: Timestamp) -> Restored:
        left_out: list[Message] = []
        beginning = InitialState(
            self._values(automaton, left_out),
            self._found["unconfirmed_since"] if self._unconfirmed else self._last,
            self._service(automaton, left_out),
            self._done(automaton, left_out),
            now,
            self.mode,
            bool(self._found["stepping"]),
            self.record.number,  # each change of the state is in a record of its own, so there were fewer
            self._restored_jobs(automaton, left_out, now),
            self._answers(automaton),
        )
        return Restored(beginning, tuple(left_out))

    def _restored_jobs(self, automaton: Automaton, left_out: list[Message], now: Timestamp) -> Jobs:
        by_order, waits = bool(self._found.get("by_order", False)), self._found.get("waits", [])
        return restored_jobs(automaton, by_order, self._jobs, waits, left_out, now)

    def _answers(self, automaton: Automaton) -> dict[str, Value]:
        """Return what was said of estimates that are there still, and as it was said."""
        values, estimates = self._found["values"], automaton.names(Kind.ESTIMATED)
        said = {name: value for name, value in self._found.get("answers", {}).items() if name in estimates}
        fitting = {name: value for name, value in said.items() if contains(automaton.variables[name].type, value)}
        return {name: value for name, value in fitting.items() if values.get(name) == value}

    def _values(self, automaton: Automaton, left_out: list[Message]) -> dict[str, Value]:
        fitting: dict[str, Value] = {}
        for name, value in self._found["values"].items():
            variable = automaton.variables.get(name)
            if variable is None or variable.kind not in (Kind.ESTIMATED, Kind.OUTPUT):
                left_out.append(message("restored.no-variable", name=name, value=print_value(value)))
            elif not contains(variable.type, value):
                ranges = str(variable.type)
                left_out.append(message("restored.range", name=name, value=print_value(value), range=ranges))
            else:
                fitting[name] = value
        return fitting

    def _service(self, automaton: Automaton, left_out: list[Message]) -> tuple[OutOfService, ...]:
        parts = {
            ServiceKind.RESOURCE: automaton.resources,
            ServiceKind.ABILITY: automaton.abilities,
            ServiceKind.OPERATION: automaton.operations,
        }
        fitting: list[OutOfService] = []
        for document in self._found["service"]:
            try:
                each: OutOfService = Codec(automaton).decode(OutOfService, document)
            except UnreadableError as error:
                left_out.append(message("restored.service-unread", error=str(error)))
                continue
            if each.name in parts[each.of]:
                fitting.append(each)
            else:
                left_out.append(message(f"restored.no-{each.of}", name=each.name))
        return tuple(fitting)

    def _done(self, automaton: Automaton, left_out: list[Message]) -> frozenset[str]:
        done = frozenset(self._found["done"])
        once = {name for name, each in automaton.operations.items() if not each.repeat}
        left_out += [message("restored.repeats", name=name) for name in sorted(done - once)]
        return done & once
