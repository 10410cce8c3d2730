"""The jobs of the life before, as they fit the model that there is now."""

from __future__ import annotations

from collections.abc import Mapping

from pydantic import JsonValue

from sequence_planner.automaton.structure import Automaton
from sequence_planner.control.jobs import Job, Jobs, Waits
from sequence_planner.control.moment import Moment
from sequence_planner.control.vocabulary import JobState
from sequence_planner.history.codec import Codec
from sequence_planner.history.shapes import UnreadableError
from sequence_planner.immutable import replace


def restored_jobs(
    automaton: Automaton,
    by_order: bool,
    documents: Mapping[str, JsonValue],
    waits: JsonValue,
    left_out: list[str],
    now: Moment,
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
            left_out.append(f"job {name} cannot be read: {error}")
            job = Job(name, name, "", now, JobState.ABORTED, ended=now)
        if job.under_way and (trouble := _trouble(automaton, jobs, job)):
            left_out.append(f"job {name} was under way and is aborted: {trouble}")
            job = replace(job, state=JobState.ABORTED, ended=now)
        jobs = jobs.taking(_fitting(automaton, job, left_out) if job.under_way else job)
    return replace(jobs, waits=_waits(automaton, jobs, codec.decode(Waits, waits)))


def _trouble(automaton: Automaton, before: Jobs, job: Job) -> str:
    """Why a job cannot go on; empty where it can."""
    master = automaton.work_masters.get(job.work_master)
    if master is None:
        return f"its work master {job.work_master} is not there any more"
    shared = sorted(name for name in master.operations if before.having(name, automaton) is not None)
    return f"another job has {', '.join(shared)} too by now" if shared else ""


def _fitting(automaton: Automaton, job: Job, left_out: list[str]) -> Job:
    """The job, without the operations that its work master has no more."""
    known = automaton.work_masters[job.work_master].operations.keys()
    gone = (job.started.keys() | job.completed.keys() | (job.finishing or frozenset())) - known
    if not gone:
        return job
    left_out.append(f"job {job.id} had {', '.join(sorted(gone))}, and its work master has not any more")
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
