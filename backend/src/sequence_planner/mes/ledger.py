"""What is made for each job under way, kept as the records of the run's journal are read one after the other.

Every start of an ability belongs to one job at most: of the jobs with an active operation then, to that whose goal
depends on a variable which the ability writes, and to the one that was taken first where that does not decide. So the
responses together say exactly what the journal says.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from pydantic import BaseModel, ConfigDict

from sequence_planner.control.view_part import Value
from sequence_planner.control.vocabulary import JobState
from sequence_planner.control.work_master_view import WorkMastersView
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.mes.responses import AbilityMade, CorrectionMade, Deviation, OperationMade
from sequence_planner.mes.run_reading import ReadJob, ReadRecord
from sequence_planner.mes.station_news import StationStanding, Told

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
    jobs: dict[str, JobMade] = {}
    values: dict[str, Value | None] = {}

    def copied(self) -> Ledger:
        """One that can go on without this one."""
        return self.model_copy(update={"jobs": {id_: job.copied() for id_, job in self.jobs.items()}})

    def take(self, record: ReadRecord, masters: WorkMastersView) -> list[News]:
        """Take note of the next record. What it says of jobs that have become others comes back."""
        self.number = record.number
        self.values = dict(record.values) if record.whole else {**self.values, **record.values}
        if record.whole:
            self._settle(record)
        self._end(record)
        # Operations begin and are completed before abilities start, and what was active then is what they start for.
        news = list(self._jobs(record, masters))
        self._start(record, masters)
        self._note(record)
        return news

    def stand(self, record: RunRecord) -> list[Told]:
        """Take note of how the station stands after a record that was taken. What is to be told of it comes back."""
        self.station, told = self.station.after(record)
        for job in [job for job in self.station.waits if job not in self.jobs or self.jobs[job].state.is_over]:
            self.station = self.station.without(job)
        return told if record.number > (self.silent or 0) else []

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
                ability = masters.abilities.get(name)
                ended = record.time if ability is not None and ability.instant else None
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

    def _note(self, record: ReadRecord) -> None:
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


def goal_reads(masters: WorkMastersView, work_master: str, operation: str) -> list[str]:
    """The variables on which the goal of an operation depends; none for what the model does not have any more."""
    master = masters.work_masters.get(work_master)
    known = None if master is None else master.operations.get(operation)
    return [] if known is None else known.goal_reads
