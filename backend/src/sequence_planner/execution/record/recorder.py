"""Recorder of an execution: journal records, the complete memory as a document, and the model digest."""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Callable, Iterator, Mapping
from typing import Any, Final

from pydantic import JsonValue

from sequence_planner.automaton.automaton import Automaton, Kind, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.events import Confirmed, Corrected, Heard, Ticked, TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.jobs import Job, Jobs, Waits
from sequence_planner.execution.plan_tracker import PlannedStart, PlanQuestion, Replacement
from sequence_planner.execution.record.codec import (
    BEGUN,
    SNAPSHOT,
    TICKED,
    Codec,
    Document,
    Senses,
    Shape,
    Shapes,
    TickBook,
    UnreadableError,
    kind_of,
)
from sequence_planner.execution.state import ActiveGoals, ExecutionState, InitialState, OutOfService
from sequence_planner.execution.vocabulary import PlanStatus
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import Expression
from sequence_planner.planning.diagnosis import Diagnosis
from sequence_planner.planning.problem import Plan, PlanAnswer, PlanRequest
from sequence_planner.version import VERSION

# All that an execution remembers, as one document: what comes next depends on nothing else.
#
# The tables say of each attribute what it is. A test compares them with the attributes that there are, so that a new
# one cannot be forgotten: it belongs into a table, or to what is made of the rest.

Table = Mapping[str, Any]  # attribute: its type

EXECUTION: Final[Table] = {
    "state": State,
    "published": State,
    "active": frozenset[str],
    "_operations": ActiveGoals,
    "conduct": ExecutionState,
    "ticks": int,
    "revision": int,
    "obstacles": tuple[str, ...],
    "asked": PlanRequest | None,
}
PLAN: Final[Table] = {
    "status": PlanStatus,
    "reason": str,
    "answer": PlanAnswer | None,
    "replanned": int,
    "replacement": Replacement | None,
    "diagnosis": Diagnosis | None,
    "_asked": PlanQuestion | None,
    "_asked_better": PlanQuestion | None,
    "_started_since_asked": bool,
    "_none_while_blind": bool,
    "_undecided": bool,
    "_none": PlanRequest | None,
}
ORDER: Final[Table] = {
    "plan": Plan | None,
    "goals": frozenset[str],
    "requested": frozenset[str],
    "past": list[PlannedStart],
    "ahead": list[PlannedStart],
    "_numbers": int,
}
# What belongs to the station, is made of the rest (`state` is that of `_run`, `circumstances` those of `conduct`), or
# has an own table.
DERIVED: Final = frozenset(
    {
        *("automaton", "supervisor", "listeners", "plan", "order", "circumstances"),
        *("_automaton", "_compiled", "_run", "_supervised", "_curious", "_free", "_lookahead"),
    }
)


class Memory:
    """Writes and reads what executions of one station remember."""

    def __init__(self, automaton: Automaton, codec: Codec) -> None:
        self._automaton = automaton
        self._codec = codec
        self._texts: dict[str, tuple[object, bytes]] = {}  # of each part, as it was last

    def document(self, execution: Executor) -> Document:
        """All that an execution remembers."""
        return {part: self._codec.encode(form, value) for part, form, value in _parts(execution)}

    def digest(self, execution: Executor) -> str:
        """16 hexadecimal digits over all that it remembers."""
        total = hashlib.sha256()
        for part, form, value in _parts(execution):
            known = self._texts.get(part)
            # Steps are all that is changed in place; everything else is replaced when it changes.
            now = [tuple(vars(step).values()) for step in value] if isinstance(value, list) else value
            if known is None or (known[0] != now if isinstance(now, list) else known[0] is not now):
                known = self._texts[part] = now, json.dumps(self._codec.encode(form, value)).encode() + b"\n"
            total.update(known[1])
        return total.hexdigest()[:16]

    def execution(self, supervisor: Supervisor, document: Mapping[str, JsonValue]) -> Executor:
        """An execution that goes on as the one did that remembered this. Raises `UnreadableError`."""
        execution = Executor(self._automaton, supervisor)
        for part, owner, name, form in _places(execution):
            if part not in document:
                raise UnreadableError(f"nothing is said of {part}")
            setattr(owner, name, self._codec.decode(form, document[part]))
        execution._face()  # in the circumstances that are remembered
        return execution


def _parts(execution: Executor) -> Iterator[tuple[str, Any, object]]:
    """Each part by its name, with its type and value."""
    for part, owner, name, form in _places(execution):
        yield part, form, getattr(owner, name)


def _places(execution: Executor) -> Iterator[tuple[str, object, str, Any]]:
    """Each part by its name: whose attribute it is, the attribute's name and its type."""
    owners = (("", execution, EXECUTION), ("plan.", execution.plan, PLAN), ("order.", execution.plan.order, ORDER))
    for prefix, owner, table in owners:
        for name, form in table.items():
            yield f"{prefix}{name.lstrip('_')}", owner, name, form


# The digest of a station's model: what has happened to a station can be replayed with the same model alone.


def model_digest(automaton: Automaton) -> str:
    """64 hexadecimal digits over all that the ground automaton says; where it was written does not count.

    What the program learns to read of models later has defaults, so the digest of a model that says nothing of it stays
    the same.
    """
    shapes = Shapes({Expression: Shape(print_expression, _unread)})
    orders = [list(each) for each in (automaton.variables, automaton.abilities, automaton.operations)]
    text = json.dumps([orders, shapes.shape(Automaton).encode(automaton)], separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def _unread(document: object) -> object:
    raise UnreadableError("a digest is not read")


# Writes down what happens to an execution, so that it can be done again and goes on after a start of the controller.
#
# Each record says what has happened, what of the estimates and outputs it changed, and the digest of all that the
# execution remembers then. Now and then a `snapshot` says all of it, as the first record, `begun`, does.

SNAPSHOT_EVERY: Final = 1000  # records

Write = Callable[[str, float, str], int]  # kind, seconds since the epoch and content; returns the record's number


class RunRecorder:
    """Listens to `execution`; the first thing it writes is how that begins. `clock` has seconds since the epoch."""

    def __init__(
        self,
        execution: Executor,
        write: Write,
        station_digest: str,
        beginning: InitialState | None = None,
        clock: Callable[[], float] = time.time,
        snapshot_every: int = SNAPSHOT_EVERY,
    ) -> None:
        automaton = execution.automaton
        self._execution = execution
        self._write = write
        self._clock = clock
        self._snapshot_every = snapshot_every
        self._codec = Codec(automaton)
        self._memory = Memory(automaton, self._codec)
        self._book = TickBook()
        self._estimates = frozenset(automaton.names(Kind.ESTIMATED))
        self._kept = (*automaton.names(Kind.ESTIMATED), *automaton.names(Kind.OUTPUT))
        self._whose: Document = {"model": station_digest, "program": VERSION}
        self._unconfirmed_since = None if beginning is None else beginning.unconfirmed_since
        self._unconfirmed = self._estimates if self._unconfirmed_since is not None else frozenset()
        self._service, self._done = execution.conduct.service, execution.conduct.done
        self._mode, self._stepping = execution.conduct.mode, execution.conduct.stepping
        self._jobs, self._answers = execution.conduct.jobs, execution.conduct.answers
        self._plan = _plan(execution)
        self._finished = frozenset[str]()  # of the last tick
        self._lasting: dict[str, Document] = {}
        self._since_snapshot = 0
        self._now = Timestamp(clock(), 0.0) if beginning is None else beginning.now
        self.last = 0
        self._put(BEGUN, clock(), self._everything())
        execution.listeners.append(self._on_event)

    def append_record(self, kind: str, epoch: float, content: Mapping[str, JsonValue], lasts: bool = False) -> None:
        """Write down what is no happening of the execution, such as an alarm.

        What `lasts` holds part by part until it is noted otherwise. It is written again with each snapshot, so that
        what was before that can be cut off.
        """
        if lasts:
            self._lasting[kind] = {**self._lasting.get(kind, {}), **content}
        self._put(kind, epoch, content)
        self._now_and_then(epoch)

    def know(self, kind: str, content: Mapping[str, JsonValue]) -> None:
        """Something that lasts has been noted in a life before: it is written again with each snapshot."""
        self._lasting[kind] = dict(content)

    def _on_event(self, heard: Heard) -> None:
        happening, outcome = heard.happening, heard.outcome
        if isinstance(happening, Ticked):
            content = self._book.content(happening) | self._outcome(outcome)
        else:
            content = self._codec.content(happening)
        if heard.called_off:
            content["called_off"] = list(heard.called_off)
        content |= self._consequences(heard)
        content["digest"] = self._memory.digest(self._execution)
        now = getattr(happening, "now", None)
        self._now = now if isinstance(now, Timestamp) else self._now
        epoch = self._clock() if now is None else self._now.epoch
        self._put(kind_of_happening(happening), epoch, content)
        self._now_and_then(epoch)

    def _consequences(self, heard: Heard) -> Document:
        """Return what is to be known of it where the execution begins again with what it believes now."""
        found: Document = {}
        if changes := self._changes(heard.before, heard.after):
            found["changes"] = changes
        conduct = self._execution.conduct
        if conduct.service != self._service:
            self._service = conduct.service
            found["service"] = self._codec.encode(tuple[OutOfService, ...], tuple(conduct.service.values()))
        if conduct.done != self._done:
            self._done = conduct.done
            found["done"] = sorted(conduct.done)
        if conduct.mode is not self._mode or conduct.stepping != self._stepping:
            self._mode, self._stepping = conduct.mode, conduct.stepping
            found["mode"], found["stepping"] = str(conduct.mode), conduct.stepping
        if conduct.answers != self._answers:
            self._answers = conduct.answers
            found["answers"] = dict(conduct.answers)
        if conduct.jobs is not self._jobs:
            before, self._jobs = self._jobs, conduct.jobs
            found |= self._job_changes(before, conduct.jobs)
        if (plan := _plan(self._execution)) != self._plan:
            found["plan"] = {"status": plan[0], "reason": plan[1]}
            if plan[2] > self._plan[2]:
                found["plan"]["replaced"] = True
            self._plan = plan
        if self._unconfirmed and (seen := _seen(heard) | changes.keys()):
            self._unconfirmed -= seen
        return found

    def _job_changes(self, before: Jobs, after: Jobs) -> Document:
        """Each job that is another by now, and null for one that is not there any more."""
        found: Document = {}
        known = {job.id: job for job in before.taken}
        changed: Document = {
            job.id: self._codec.encode(Job, job) for job in after.taken if known.pop(job.id, None) != job
        }
        if changed := changed | dict.fromkeys(known):
            found["jobs"] = changed
        if after.waits != before.waits:
            found["waits"] = self._codec.encode(Waits, after.waits)
        if after.by_order != before.by_order:
            found["by_order"] = after.by_order
        return found

    def _changes(self, before: State, after: State) -> dict[str, JsonValue]:
        return {} if before is after else {name: after[name] for name in self._kept if before[name] != after[name]}

    def _now_and_then(self, epoch: float) -> None:
        if self._since_snapshot >= self._snapshot_every:
            self._since_snapshot = 0
            self._execution.drop_caches()  # or it would know more than one that goes on from the snapshot
            self._put(SNAPSHOT, epoch, self._everything())
            for kind, content in self._lasting.items():
                self._put(kind, epoch, content)

    def _everything(self) -> Document:
        execution = self._execution
        state, conduct = execution.state, execution.conduct
        return {
            **self._whose,
            "now": [self._now.epoch, self._now.monotonic],
            "values": {name: state[name] for name in self._kept},
            "service": self._codec.encode(tuple[OutOfService, ...], tuple(conduct.service.values())),
            "done": sorted(conduct.done),
            "mode": str(conduct.mode),
            "stepping": conduct.stepping,
            "production": str(conduct.production),
            "answers": dict(conduct.answers),
            "by_order": conduct.jobs.by_order,
            "jobs": {job.id: self._codec.encode(Job, job) for job in conduct.jobs.taken},
            "waits": self._codec.encode(Waits, conduct.jobs.waits),
            "unconfirmed_since": self._unconfirmed_since,
            "unconfirmed": sorted(self._unconfirmed),
            "senses": self._codec.encode(Senses, self._book.senses),
            "memory": self._memory.document(execution),
            "digest": self._memory.digest(execution),
        }

    def _outcome(self, outcome: TickOutcome | None) -> Document:
        """Return what a tick did, for people and programs that read the journal.

        An ability may take its finish actions again with every tick: only the first of them is told.
        """
        if outcome is None:
            return {}
        before, self._finished = self._finished, frozenset(outcome.finished)
        abilities = self._execution.automaton.abilities
        told = {
            "finished": [name for name in outcome.finished if name not in before],
            "ended": list(outcome.ended),
            "started": list(outcome.started),
            "at_once": [name for name in outcome.started if abilities[name].finish_guard is None],
            "activated": sorted(outcome.activated),
            "completed": sorted(outcome.completed),
            "called_off": list(outcome.called_off),
            "given_up": list(outcome.given_up),
        }
        return {name: names for name, names in told.items() if names}

    def _put(self, kind: str, epoch: float, content: Mapping[str, JsonValue]) -> None:
        self.last = self._write(kind, epoch, json.dumps(content, separators=(",", ":")))
        self._since_snapshot += 1


def kind_of_happening(happening: object) -> str:
    """The kind of the record of a happening."""
    return TICKED if isinstance(happening, Ticked) else kind_of(type(happening))


def _plan(execution: Executor) -> tuple[str, str, int]:
    """Return what is said of the plan, and how often another had taken the place of one."""
    return str(execution.plan.status), execution.plan.reason, execution.plan.replanned


def _seen(heard: Heard) -> frozenset[str]:
    """The estimates that a person has confirmed or corrected."""
    match heard.happening:
        case Confirmed(names):
            return names
        case Corrected(values, taken_back=taken_back):
            return frozenset(values) - taken_back
    return frozenset()
