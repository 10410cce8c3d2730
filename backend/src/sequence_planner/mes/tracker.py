"""Order tracking from the run journal: job progress, job responses and station events for a MES."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from pydantic import BaseModel, ConfigDict, Field, JsonValue
from sqlalchemy import Connection, delete, insert, select

from sequence_planner.controller.commands.audit import JOB_WAITS, PACKML
from sequence_planner.controller.views.details import WorkMastersView
from sequence_planner.controller.views.part import Value
from sequence_planner.db.database import Database
from sequence_planner.execution.events import (
    Corrected,
    ModeChanged,
    OperatorPlanStarted,
    OperatorPlanStopped,
    ProductionStarted,
    ServiceChanged,
)
from sequence_planner.execution.record.codec import BEGUN, KINDS, SNAPSHOT, TICKED, kind_of
from sequence_planner.execution.vocabulary import JobState
from sequence_planner.history.timeline import ALARM
from sequence_planner.journal import run_journal
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.mes import events, orders, responses
from sequence_planner.mes.events import EventKind
from sequence_planner.mes.figures import DayFigures, MadeProduct
from sequence_planner.mes.order import JobOrder, OrderState
from sequence_planner.mes.responses import (
    AbilityMade,
    CorrectionMade,
    Deviation,
    JobOutcome,
    JobResponse,
    OperationMade,
)
from sequence_planner.mes.tables import JOB_LEDGER

# What records of the run's journal say of jobs, in the form in which orders need it. `docs/journal.md` says how they
# are written.

CORRECTED: Final = kind_of(Corrected)
_SERVICE: Final = kind_of(ServiceChanged)
REPLANNED: Final = "replanned"
GIVEN_UP: Final = "given-up"


@dataclass(frozen=True)
class ReadJob:
    """A job as a record says it is; times are in seconds since the epoch."""

    id: str
    work_master: str
    title: str
    state: JobState
    taken: float
    ended: float | None
    started: Mapping[str, float]
    completed: Mapping[str, float]


@dataclass(frozen=True)
class ReadRecord:
    """A record: `whole` ones say everything of the station, all others what is new.

    `jobs` are those that have changed, None where one is not kept any more; `runs` are the starts that a whole record
    remembers, by ability and when it was started, each with its end.
    """

    number: int
    time: float
    kind: str
    whole: bool
    values: Mapping[str, Any]
    jobs: Mapping[str, ReadJob | None]
    started: tuple[str, ...]
    ended: tuple[str, ...]
    called_off: tuple[str, ...]
    runs: Mapping[tuple[str, float], float | None]
    correction: Mapping[str, Any] | None
    deviations: tuple[tuple[str, Mapping[str, Any]], ...]
    monotonic: float | None  # when it was on the monotonic clock, as far as it says so
    packml: str | None
    by_order: bool | None
    activated: tuple[str, ...]
    completed: tuple[str, ...]


def read(record: RunRecord) -> ReadRecord:
    """Return what a record says."""
    content = json.loads(record.content)
    whole = record.kind in (BEGUN, SNAPSHOT)
    told = content if record.kind == TICKED else {}  # a note, such as that of an alarm, has names of its own
    return ReadRecord(
        number=record.number,
        time=record.time,
        kind=record.kind,
        whole=whole,
        values=_values(content, whole) if whole or record.kind in KINDS else {},
        jobs=_jobs(content) if whole or record.kind in KINDS else {},
        started=tuple(told.get("started", ())),
        ended=tuple(told.get("ended", ())),
        called_off=tuple(told.get("called_off", ())),
        runs=_runs(content) if whole else {},
        correction=content["what"] if record.kind == CORRECTED else None,
        deviations=() if whole else tuple(_deviations(record.kind, content)),
        monotonic=_monotonic(record.kind, content),
        packml=content["state"] if record.kind == PACKML else None,
        by_order=content.get("by_order") if whole or record.kind in KINDS else None,
        activated=tuple(told.get("activated", ())),
        completed=tuple(told.get("completed", ())),
    )


def _monotonic(kind: str, content: Mapping[str, Any]) -> float | None:
    """When a record was on the clock that nobody sets. At the beginning of a controller another one counts."""
    if kind in (TICKED, SNAPSHOT):
        return content["now"][1] if "now" in content else None
    return content.get("monotonic") if kind == PACKML else None


def _values(content: Mapping[str, Any], whole: bool) -> dict[str, Any]:
    if whole:
        return {**content["values"], **content.get("senses", {}).get("measured", {})}
    return {**content.get("all", {}), **content.get("measured", {}), **content.get("changes", {})}


def _jobs(content: Mapping[str, Any]) -> dict[str, ReadJob | None]:
    return {name: None if each is None else _job(each) for name, each in content.get("jobs", {}).items()}


def _job(document: Mapping[str, Any]) -> ReadJob:
    ended = document.get("ended")
    return ReadJob(
        id=document["id"],
        work_master=document["work_master"],
        title=document["title"],
        state=JobState(document.get("state", JobState.WAITING.value)),
        taken=document["taken"]["epoch"],
        ended=None if ended is None else ended["epoch"],
        started={name: at["epoch"] for name, at in document.get("started", {}).items()},
        completed={name: at["epoch"] for name, at in document.get("completed", {}).items()},
    )


def _runs(content: Mapping[str, Any]) -> dict[tuple[str, float], float | None]:
    past = content.get("memory", {}).get("order.past", ())
    return {
        (each["ability"], each["started"]["epoch"]): each["ended"]["epoch"] if each.get("ended") else None
        for each in past
        if each.get("started")
    }


def _deviations(kind: str, content: Mapping[str, Any]) -> list[tuple[str, Mapping[str, Any]]]:
    """Return what did not go as planned."""
    found: list[tuple[str, Mapping[str, Any]]] = []
    if kind == ALARM:
        found.append((kind, content))
    if kind == _SERVICE:
        found.append((kind, {name: value for name, value in content["what"].items() if name != "now"}))
    if kind == TICKED and (given_up := content.get("given_up")):
        found.append((GIVEN_UP, {"abilities": given_up}))
    if kind in KINDS and (plan := content.get("plan", {})).get("replaced"):
        found.append((REPLANNED, {"reason": plan["reason"]}))
    return found


# What a MES is told of the station itself, as the records of the run's journal are read one after the other: stops,
# faults, the states of PackML, and what its orders wait for.

_STARTED: Final = kind_of(ProductionStarted)
_MODES: Final = frozenset(map(kind_of, (ModeChanged, OperatorPlanStarted, OperatorPlanStopped)))
_OF_ALARMS: Final = ("priority", "text", "consequence", "action")


@dataclass(frozen=True)
class StationEvent:
    """An event to be, of a job order or of the station."""

    kind: EventKind
    job_order: str | None
    time: float
    content: Mapping[str, JsonValue]


class StationStanding(BaseModel):
    """The standing of the station, as far as it was told: alarms that last by their keys, and what jobs wait for."""

    model_config = ConfigDict(frozen=True, extra="forbid")
    mode: str | None = None
    packml: str | None = None
    alarms: dict[str, dict[str, JsonValue]] = Field(default={})
    waits: dict[str, list[str]] = Field(default={})

    def after(self, record: RunRecord) -> tuple[StationStanding, list[StationEvent]]:
        """Return how it stands after a record, and what is to be told."""
        reader = _READERS.get(record.kind)
        if reader is None:
            return self, []
        changes: dict[str, Any] = {}
        told = list(reader(self, record.time, json.loads(record.content), changes))
        return (self.model_copy(update=changes) if changes else self), told

    def without(self, job: str) -> StationStanding:
        """Return the standing without a job that is over: nothing is waited for any more there."""
        if job not in self.waits:
            return self
        return self.model_copy(update={"waits": {id_: waits for id_, waits in self.waits.items() if id_ != job}})

    def _begun(self, time: float, content: Mapping[str, Any], changes: dict[str, Any]) -> Iterator[StationEvent]:
        """The controller was started anew: nothing of before is an alarm, and production is not started."""
        mode = content.get("mode")
        told: dict[str, JsonValue] = {"mode": mode}
        yield StationEvent(EventKind.CONTROLLER_STARTED, None, time, told)
        for key, alarm in self.alarms.items():
            yield StationEvent(EventKind.ALARM_ENDED, None, time, {"alarm": key, **alarm})
        changes |= {"mode": mode, "packml": None, "alarms": {}}

    def _whole(self, time: float, content: Mapping[str, Any], changes: dict[str, Any]) -> Iterator[StationEvent]:
        """Take the mode from a snapshot that says it, where reading begins with one."""
        if self.mode is None:
            changes["mode"] = content.get("mode")
        yield from ()

    def _mode(self, time: float, content: Mapping[str, Any], changes: dict[str, Any]) -> Iterator[StationEvent]:
        mode = content.get("mode")
        if mode is None or mode == self.mode:
            return
        by = content.get("what", {}).get("by")
        changes["mode"] = mode
        yield StationEvent(EventKind.MODE_CHANGED, None, time, {"mode": mode, "before": self.mode, "by": by})

    def _production(self, time: float, content: Mapping[str, Any], changes: dict[str, Any]) -> Iterator[StationEvent]:
        yield StationEvent(EventKind.PRODUCTION_STARTED, None, time, {"mode": self.mode})

    def _packml(self, time: float, content: Mapping[str, Any], changes: dict[str, Any]) -> Iterator[StationEvent]:
        state = content["state"]
        if state != self.packml:
            changes["packml"] = state
            told: dict[str, JsonValue] = {"state": state, "before": self.packml}
            yield StationEvent(EventKind.PACKML_CHANGED, None, content["since"], told)

    def _alarm(self, time: float, content: Mapping[str, Any], changes: dict[str, Any]) -> Iterator[StationEvent]:
        key, lasts = content["alarm"], content.get("ended") is None
        if lasts == (key in self.alarms):
            return
        alarm: dict[str, JsonValue] = {name: content.get(name) for name in _OF_ALARMS}
        changes["alarms"] = {name: each for name, each in self.alarms.items() if name != key}
        if lasts:
            changes["alarms"][key] = alarm
        yield StationEvent(
            EventKind.ALARM_RAISED if lasts else EventKind.ALARM_ENDED, None, time, {"alarm": key, **alarm}
        )

    def _waits(self, time: float, content: Mapping[str, Any], changes: dict[str, Any]) -> Iterator[StationEvent]:
        job, waits = content["job"], content["waits_for"]
        if waits != self.waits.get(job, []):
            changes["waits"] = {**self.waits, job: waits}
            yield StationEvent(EventKind.WAITS, job, content["since"], {"waits_for": waits})


_READERS: Final = {
    BEGUN: StationStanding._begun,
    SNAPSHOT: StationStanding._whole,
    _STARTED: StationStanding._production,
    PACKML: StationStanding._packml,
    ALARM: StationStanding._alarm,
    JOB_WAITS: StationStanding._waits,
    **dict.fromkeys(_MODES, StationStanding._mode),
}


# What is made for each job under way, kept as the records of the run's journal are read one after the other.
#
# Every start of an ability belongs to one job at most: of the jobs with an active operation then, to that whose goal
# depends on a variable which the ability writes, and to the one that was taken first where that does not decide. So the
# responses together say exactly what the journal says.

MOST_DEVIATIONS: Final = 1000  # of a job that are told; an alarm that comes and goes over a weekend has more


class JobMade(BaseModel):
    """A job, and what was made for it so far."""

    model_config = ConfigDict(extra="forbid")
    job: str
    work_master: str
    state: JobState
    taken: float
    ended: float | None = None
    operations: dict[str, OperationMade] = {}
    abilities: list[AbilityMade] = []
    deviations: list[Deviation] = []
    deviations_left_out: int = 0
    corrections: list[CorrectionMade] = []

    @property
    def active(self) -> list[str]:
        """The operations that have begun for it and are not completed, if it goes on."""
        if self.state is not JobState.RUNNING:
            return []
        return [name for name, each in self.operations.items() if each.started is not None and each.ended is None]

    def copied(self) -> JobMade:
        """One that can go on without this one; what cannot change is common to both, as there can be a lot of it."""
        lists = {"abilities": [*self.abilities], "deviations": [*self.deviations], "corrections": [*self.corrections]}
        return self.model_copy(update={**lists, "operations": dict(self.operations)})


@dataclass(frozen=True)
class News:
    """Something about a job: it was `taken`, an operation has `started` or is `completed`, or the job is `over`."""

    what: str
    job: JobMade
    time: float
    operation: str | None = None


class Ledger(BaseModel):
    """All jobs that are kept, in the order in which they were taken, and the values, as of record `number`.

    Of how the station stands, what records up to `silent` say is known and was not told: it is older than this ledger.
    """

    model_config = ConfigDict(extra="forbid")
    number: int = 0
    silent: int | None = None  # as of a program that told nothing of the station
    station: StationStanding = StationStanding()
    figures: DayFigures = Field(default_factory=DayFigures)
    jobs: dict[str, JobMade] = {}
    values: dict[str, Value | None] = {}

    def copied(self) -> Ledger:
        """One that can go on without this one."""
        jobs = {id_: job.copied() for id_, job in self.jobs.items()}
        return self.model_copy(update={"jobs": jobs, "figures": self.figures.copied()})

    def process(self, record: ReadRecord, masters: WorkMastersView) -> list[News]:
        """Take note of the next record. What it says of jobs that have become others comes back."""
        self.number = record.number
        self.values = dict(record.values) if record.whole else {**self.values, **record.values}
        if record.whole:
            self._settle(record)
        self._end(record)
        had = {job.work_master for job in self.jobs.values() if not job.state.is_over}
        # Operations begin and are completed before abilities start, and what was active then is what they start for.
        news = list(self._jobs(record, masters))
        self._count(record, news, masters, had)
        self._start(record, masters)
        self._record_deviations(record)
        return news

    def update_station(self, record: RunRecord) -> list[StationEvent]:
        """Take note of how the station stands after a record that was taken. What is to be told of it comes back."""
        self.station, told = self.station.after(record)
        for job in [job for job in self.station.waits if job not in self.jobs or self.jobs[job].state.is_over]:
            self.station = self.station.without(job)
        return told if record.number > (self.silent or 0) else []

    def _count(self, record: ReadRecord, news: Sequence[News], masters: WorkMastersView, had: Collection[str]) -> None:
        """Keep the figures of the day. Of the work masters those that are not `had` had no job under way."""
        figures = self.figures
        if record.kind == BEGUN:
            figures.note_start(record.time)
            figures.running = [ability for (ability, _), ended in record.runs.items() if ended is None]
        else:
            figures.pass_to(record.time, record.monotonic)
        if record.packml is not None:
            figures.turn(record.packml)
        lasting = [name for name in record.started if not _is_instant(masters, name)]
        figures.note_runs(lasting, {*record.ended, *record.called_off})
        for kind, content in record.deviations:
            if kind == ALARM:
                figures.note_alarm(content)
        if record.by_order is not None:
            figures.by_order = record.by_order
        figures.idle = figures.by_order and all(job.state.is_over for job in self.jobs.values())
        for each in news:
            if each.what == "over" and each.job.state is JobState.ENDED:
                product = MadeProduct(job=each.job.job, work_master=each.job.work_master, ended=each.time)
                figures.count_product(product)
        if figures.by_order:
            figures.open, figures.untouched = {}, []
        else:
            free = {name: its for name, its in masters.work_masters.items() if name not in had}
            figures.work_freely(free, record.activated, record.completed, record.time, starts=bool(record.started))

    def _jobs(self, record: ReadRecord, masters: WorkMastersView) -> Iterator[News]:
        for id_, job in record.jobs.items():
            if job is None:
                self.jobs.pop(id_, None)
            else:
                yield from self._job(job, record, masters)
        if record.whole:
            for gone in [id_ for id_ in self.jobs if id_ not in record.jobs]:
                made = self.jobs.pop(gone)
                if not made.state.is_over:  # a station that remembers nothing has begun anew
                    made.state, made.ended = JobState.ABORTED, record.time
                    yield News("over", made, record.time)

    def _job(self, job: ReadJob, record: ReadRecord, masters: WorkMastersView) -> Iterator[News]:
        made = self.jobs.get(job.id)
        if made is None:
            made = JobMade(job=job.id, work_master=job.work_master, state=JobState.WAITING, taken=job.taken)
            self.jobs[job.id] = made
            yield News("taken", made, job.taken)
        elif made.state.is_over:
            return
        yield from self._operations(made, job, record, masters)
        made.state, made.ended = job.state, job.ended
        if job.state.is_over:
            yield News("over", made, record.time if job.ended is None else job.ended)

    def _operations(self, made: JobMade, job: ReadJob, record: ReadRecord, masters: WorkMastersView) -> Iterator[News]:
        for name in [each for each in made.operations if each not in {*job.started, *job.completed}]:
            del made.operations[name]  # it was reset
        for name, at in job.started.items():
            if name not in made.operations:
                made.operations[name] = OperationMade(operation=name, started=at, record=record.number)
                yield News("started", made, at, name)
        for name, at in job.completed.items():
            known = made.operations.get(name)
            if known is None or known.ended is None:
                actuals = {each: self.values.get(each) for each in goal_reads(masters, made.work_master, name)}
                made.operations[name] = OperationMade(
                    operation=name,
                    started=None if known is None else known.started,
                    ended=at,
                    record=record.number,
                    actuals=actuals,
                )
                yield News("completed", made, at, name)

    def _start(self, record: ReadRecord, masters: WorkMastersView) -> None:
        for name in record.started:
            self._end_run(name, record.time, called_off=False)  # one that was never seen to end is over
            job = self._owner(name, masters)
            if job is not None:
                ended = record.time if _is_instant(masters, name) else None
                job.abilities.append(AbilityMade(ability=name, started=record.time, ended=ended, record=record.number))

    def _owner(self, ability: str, masters: WorkMastersView) -> JobMade | None:
        """The job for which an ability starts now; None where the station starts it for itself."""
        able = masters.abilities.get(ability)
        written = frozenset() if able is None else frozenset(able.writes)
        candidates = [job for job in self.jobs.values() if job.active]
        candidates.sort(key=lambda job: job.taken)
        for job in candidates:
            if any(written & set(goal_reads(masters, job.work_master, name)) for name in job.active):
                return job
        return next(iter(candidates), None)

    def _end(self, record: ReadRecord) -> None:
        for name in record.ended:
            self._end_run(name, record.time, called_off=False)
        for name in record.called_off:
            self._end_run(name, record.time, called_off=True)

    def _end_run(self, ability: str, time: float, *, called_off: bool) -> None:
        for job in self.jobs.values():
            if job.state.is_over:
                continue
            for index, each in enumerate(job.abilities):
                if each.ability == ability and each.ended is None:
                    job.abilities[index] = each.model_copy(update={"ended": time, "called_off": called_off})

    def _settle(self, record: ReadRecord) -> None:
        """A whole record knows of runs that ended as the station was held: no other record says which did."""
        for job in self.jobs.values():
            for index, each in enumerate(job.abilities):
                ended = record.runs.get((each.ability, each.started))
                if each.ended is None and ended is not None and not job.state.is_over:
                    job.abilities[index] = each.model_copy(update={"ended": ended, "called_off": True})

    def _record_deviations(self, record: ReadRecord) -> None:
        for job in self.jobs.values():
            if job.state.is_over and (job.ended is None or job.ended < record.time):
                continue
            for kind, content in record.deviations:
                if len(job.deviations) < MOST_DEVIATIONS:
                    told = Deviation(time=record.time, record=record.number, kind=kind, content=dict(content))
                    job.deviations.append(told)
                else:
                    job.deviations_left_out += 1
            if (what := record.correction) is not None:
                job.corrections.append(
                    CorrectionMade(
                        time=record.time,
                        record=record.number,
                        values=what["values"],
                        by=what["by"],
                        why=what["why"],
                    )
                )


def _is_instant(masters: WorkMastersView, name: str) -> bool:
    """Return whether an ability is over as it starts: no record says that it ended."""
    ability = masters.abilities.get(name)
    return ability is not None and ability.instant


def goal_reads(masters: WorkMastersView, work_master: str, operation: str) -> list[str]:
    """The variables on which the goal of an operation depends; none for what the model does not have any more."""
    master = masters.work_masters.get(work_master)
    known = None if master is None else master.operations.get(operation)
    return [] if known is None else known.goal_reads


# Orders go on as the run's journal says: what is durable there has happened, and is told once.
#
# The journal is read on from where the ledger stands, be there orders or not: what becomes of the station is told too.
# What a page of records brings about is one transaction: the orders, their events and responses, and where the ledger
# stands then.

_PAGE: Final = 500  # records read at once
_KEEP_EVERY: Final = 2000  # records after which it is kept how far they were read, though nothing has come of them
_OUTCOMES: Final = {
    JobState.ENDED: (JobOutcome.COMPLETED, OrderState.ENDED, EventKind.ENDED),
    JobState.STOPPED: (JobOutcome.STOPPED, OrderState.ENDED, EventKind.ENDED),
    JobState.ABORTED: (JobOutcome.ABORTED, OrderState.ABORTED, EventKind.ABORTED),
}


class OrderTracker:
    """Reads the run's journal in `database` on behalf of its orders. Used by one thread at a time."""

    def __init__(self, database: Database) -> None:
        self._database = database
        self._ledger: Ledger | None = None
        self._kept = 0  # the number of the record up to which the database knows

    @property
    def figures(self) -> DayFigures:
        """The figures of the day as of the last record that was read; nobody may change them. Any thread may ask."""
        ledger = self._ledger
        return DayFigures() if ledger is None else ledger.figures

    def read_on(self, masters: WorkMastersView) -> tuple[bool, bool]:
        """Take note of the next records: whether orders have changed by it, and whether there may be more records.

        Raises `StorageError`; then nothing has happened.
        """
        if self._ledger is None:
            self._ledger = self._begin()
            self._kept = self._ledger.number
        with self._database.reading() as connection:
            records = run_journal.after(connection, self._ledger.number, _PAGE)
        if not records:
            return False, False
        ledger, happened = self._ledger.copied(), list[tuple[News, JobResponse | None] | StationEvent]()
        for record in records:
            for news in ledger.process(read(record), masters):
                happened.append((news, response(news.job, masters) if news.what == "over" else None))
            happened += ledger.update_station(record)
        if happened or ledger.number - self._kept >= _KEEP_EVERY:
            with self._database.writing() as connection:
                if _number(connection) != self._kept:  # where several stations share it another one has read on
                    self._ledger = None
                    return True, True
                for each in happened:
                    if isinstance(each, StationEvent):
                        emit_event(connection, each)
                    else:
                        update_order(connection, *each)
                _keep(connection, ledger)
            self._kept = ledger.number
        self._ledger = ledger
        return any(not isinstance(each, StationEvent) for each in happened), len(records) == _PAGE

    def _begin(self) -> Ledger:
        """The ledger as it is kept. Where nothing was told of the station so far, that begins now."""
        with self._database.reading() as connection:
            ledger = _load(connection)
            if ledger.silent is not None:
                return ledger
        with self._database.writing() as connection:
            ledger = _load(connection)
            if ledger.silent is None:
                ledger = _beginning(connection, ledger)
                _keep(connection, ledger)
        return ledger


def response(job: JobMade, masters: WorkMastersView) -> JobResponse:
    """Return what was made for a job that is over. The description is that of its order, which is entered then."""
    master = masters.work_masters.get(job.work_master)
    names = list(job.operations) if master is None else [*dict.fromkeys([*master.operations, *job.operations])]
    assert job.ended is not None
    return JobResponse(
        job_order=job.job,
        work_master=job.work_master,
        description="",
        outcome=_OUTCOMES[job.state][0],
        began=job.taken,
        ended=job.ended,
        operations=[job.operations.get(name, OperationMade(operation=name)) for name in names],
        abilities=list(job.abilities),
        deviations=list(job.deviations),
        deviations_left_out=job.deviations_left_out,
        corrections=list(job.corrections),
    )


def update_order(connection: Connection, news: News, made: JobResponse | None) -> None:
    """Let an order be as its job is. Of jobs that nobody has ordered here there is nothing to note."""
    order = orders.find(connection, news.job.job)
    if order is None or order.is_over:
        return
    match news.what:
        case "taken":
            _taken(connection, order, news)
        case "over":
            assert made is not None
            _over(connection, order, news, made)
        case _:
            kind = EventKind.OPERATION_STARTED if news.what == "started" else EventKind.OPERATION_COMPLETED
            events.append(connection, kind, order.id, news.time, {"operation": news.operation})


def emit_event(connection: Connection, told: StationEvent) -> None:
    """Write an event of the station, or of an order that is not over."""
    if told.job_order is not None:
        order = orders.find(connection, told.job_order)
        if order is None or order.is_over:
            return
    events.append(connection, told.kind, told.job_order, told.time, told.content)


def _taken(connection: Connection, order: JobOrder, news: News) -> None:
    if order.state is OrderState.ALLOWED_TO_START:
        orders.become(connection, order, OrderState.RUNNING, news.time, {"began": news.time})
        events.append(connection, EventKind.RUNNING, order.id, news.time, {"state": OrderState.RUNNING.value})


def _over(connection: Connection, order: JobOrder, news: News, made: JobResponse) -> None:
    outcome, state, kind = _OUTCOMES[news.job.state]
    known = {"description": order.description, "due": order.due}
    known["reason"] = order.wished_because if order.wish is not None and outcome is not JobOutcome.COMPLETED else None
    number = responses.write(connection, made.model_copy(update=known), news.time)
    over = {"ended": news.time, "wish": None, "wished_by": None, "wished_because": None}
    orders.become(connection, order, state, news.time, over)
    told: dict[str, JsonValue] = {"state": state.value, "outcome": outcome.value, "response": number}
    told |= {} if order.wish is None else {"reason": order.wished_because}
    events.append(connection, kind, order.id, news.time, told)


def _number(connection: Connection) -> int:
    """Up to which record the database knows."""
    return connection.execute(select(JOB_LEDGER.c.number)).scalar_one_or_none() or 0


def _load(connection: Connection) -> Ledger:
    content: str | None = connection.execute(select(JOB_LEDGER.c.content)).scalar_one_or_none()
    return Ledger() if content is None else Ledger.model_validate_json(content)


def _beginning(connection: Connection, before: Ledger) -> Ledger:
    """A ledger in which the records of now are old: if nothing is worked on, none but the last whole one matters."""
    newest = next((each.number for each in run_journal.before(connection, None, 1)), 0)
    if any(not job.state.is_over for job in before.jobs.values()):
        return before.model_copy(update={"silent": newest})
    whole = next(iter(run_journal.before(connection, None, 1, (BEGUN, SNAPSHOT))), None)
    return Ledger(number=0 if whole is None else whole.number - 1, silent=newest)


def _keep(connection: Connection, ledger: Ledger) -> None:
    connection.execute(delete(JOB_LEDGER))
    connection.execute(insert(JOB_LEDGER), {"id": 1, "number": ledger.number, "content": ledger.model_dump_json()})
