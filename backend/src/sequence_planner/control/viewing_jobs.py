"""What is shown of jobs, and in words what keeps them and their operations from going on."""

from __future__ import annotations

from sequence_planner.automaton.structure import Automaton
from sequence_planner.control.execution import Execution
from sequence_planner.control.job_view import JobStepState, JobStepView, JobView
from sequence_planner.control.job_waits import Around, of_running
from sequence_planner.control.jobs import Job, Jobs
from sequence_planner.control.moment import Moment
from sequence_planner.control.vocabulary import JobState


def job_views(execution: Execution, jobs: Jobs | None = None, around: Around | None = None) -> dict[str, JobView]:
    """Each job by its id, in the order in which they were taken: those of the execution, or as they were before."""
    jobs = execution.conduct.jobs if jobs is None else jobs
    return {job.id: _view(execution, jobs, job, around) for job in jobs.taken}


def waits_for(execution: Execution, job: Job, around: Around | None = None) -> list[str]:
    """What keeps a job as a whole from going on."""
    if job.state is JobState.PAUSED:
        return ["the job to be resumed"]
    if job.state is JobState.WAITING:
        return list(execution.keeps_from_beginning(job))
    if job.state is JobState.RUNNING:
        return of_running(execution, job, around)
    return []


def _awaited(jobs: Jobs, job: Job, operation: str, automaton: Automaton) -> list[str]:
    """The operations that have to be completed before this one of the job; those of other jobs as `job/operation`."""
    awaited = jobs.awaited(job, operation)
    own = job.after(operation, automaton) | {name for id_, name in awaited if id_ == job.id}
    return [*sorted(own), *(f"{id_}/{name}" for id_, name in sorted(awaited) if id_ != job.id)]


def why_idle(execution: Execution, operation: str) -> str | None:
    """What has to come before a job asks for an operation; None where one does, or none has to."""
    jobs, automaton = execution.conduct.jobs, execution.automaton
    if not jobs.by_order or operation not in automaton.job_operations:
        return None
    job = jobs.having(operation, automaton)
    if job is None:
        return "a job that asks for it: the station works by order, and no job asks for it"
    if operation in jobs.eligible(job, automaton):
        return None
    if operation in job.completed:
        return f"another job that asks for it: for {job.title} it is completed"
    if job.finishing is not None:
        return f"another job that asks for it: {job.title} is being stopped"
    if job.state is JobState.PAUSED:
        return f"{job.title} to be resumed"
    if job.state is JobState.WAITING:
        return f"{job.title} to begin, which waits for {' and '.join(waits_for(execution, job)) or 'the next tick'}"
    before = [_titled(execution, each) for each in _awaited(jobs, job, operation, automaton)]
    return f"what comes before it for {job.title}: {', '.join(before)}"


def _titled(execution: Execution, step: str) -> str:
    """An operation as people know it; `4711/tighten` is that of another job."""
    job, _, name = step.rpartition("/")
    title = execution.automaton.operations[name].title
    return f"{title} of job {job}" if job else title


def _view(execution: Execution, jobs: Jobs, job: Job, around: Around | None) -> JobView:
    master = execution.automaton.work_masters.get(job.work_master)
    # One that ended before the model was changed can have a work master that is not there any more.
    names = sorted(job.started.keys() | job.completed.keys()) if master is None else list(master.operations)
    eligible = frozenset[str]() if master is None else jobs.eligible(job, execution.automaton)
    return JobView(
        title=job.title,
        work_master=job.work_master,
        state=job.state,
        stopping=job.finishing is not None and job.under_way,
        taken=job.taken.epoch,
        begun=_epoch(job.begun),
        ended=_epoch(job.ended),
        waits_for=waits_for(execution, job, around),
        steps={name: _step(execution, jobs, job, name, eligible) for name in names},
    )


def _step(execution: Execution, jobs: Jobs, job: Job, name: str, eligible: frozenset[str]) -> JobStepView:
    state = _state(execution, job, name, eligible)
    waiting = state is JobStepState.WAITING and job.under_way
    return JobStepView(
        state=state,
        waits_for=_awaited(jobs, job, name, execution.automaton) if waiting else [],
        started=_epoch(job.started.get(name)),
        ended=_epoch(job.completed.get(name)),
    )


def _state(execution: Execution, job: Job, name: str, eligible: frozenset[str]) -> JobStepState:
    if name in job.completed:
        return JobStepState.COMPLETED
    if name not in eligible:
        return JobStepState.WAITING
    return JobStepState.ACTIVE if name in execution.active else JobStepState.ELIGIBLE


def _epoch(moment: Moment | None) -> float | None:
    return None if moment is None else moment.epoch
