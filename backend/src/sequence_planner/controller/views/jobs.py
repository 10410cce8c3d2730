"""Job views of a running station, with the reasons for waiting jobs and operations in words."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.automaton.lifting.wording import phrase, wording_of
from sequence_planner.controller.commands.tasks import TaskProblem, WaitingTask
from sequence_planner.controller.recovery.explain import of_station
from sequence_planner.controller.views.station import AlarmView, JobStepState, JobStepView, JobView, Priority
from sequence_planner.controller.views.wording import reason_text, title_text
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.jobs import Job, Jobs
from sequence_planner.execution.plan_tracker import PlannedStart
from sequence_planner.execution.timeouts import Late, overdue
from sequence_planner.execution.vocabulary import JobState, Mode, PlanStatus, Production
from sequence_planner.language.syntax import Expression
from sequence_planner.texts.message import Argument, Item, Message, Sentence, as_it_was, awaiting, message, waits_in_one

# In words, what keeps a job that is worked from going on: the one place where that is said.
#
# What it is told from is the execution, and what is known `Around` it: open tasks, alarms, who is in control.

# Alarms of what is said here anyway.
_SAID = {"overdue", "no-plan", "left-out", "undecided", "undecided-outputs", "tried", "problem"}
_MOST_ALARMS = 3


@dataclass(frozen=True)
class Around:
    """The knowledge around an execution now, on the controller's clock `monotonic`.

    `held_up` names the active operations that cannot be completed while some resources do nothing; `next_waits` is what
    the next start of the plan waits for.
    """

    monotonic: float
    held_up: Callable[[Collection[str]], frozenset[str]] = lambda _: frozenset()
    tasks: Mapping[str, WaitingTask] = field(default_factory=dict)
    problems: Mapping[str, TaskProblem] = field(default_factory=dict)
    alarms: Mapping[str, AlarmView] = field(default_factory=dict)
    next_waits: tuple[Message, ...] = ()
    controlled: bool = True


def of_running(execution: Executor, job: Job, around: Around | None) -> list[Message]:
    """Return what a job that has begun waits for; empty only where something is being done that may bring it on.

    Of the past, without `around`, only what the execution itself knows is told.
    """
    found = list(_station(execution, around))
    if around is not None:
        found += _Running(execution, job, around).waits()
    return list(dict.fromkeys(found))


def _station(execution: Executor, around: Around | None) -> Iterator[Message]:
    conduct = execution.conduct
    yield from (each.text for each in of_station(execution))
    stopped = conduct.production is not Production.STARTED or conduct.mode is not Mode.AUTOMATIC
    if stopped and around is not None and not around.controlled:
        yield message("waits.control")
    if conduct.operator_plan is not None:
        yield message("waits.end", title=title_text(conduct.operator_plan.title))


class _Running:
    """One job at one moment."""

    def __init__(self, execution: Executor, job: Job, around: Around) -> None:
        self._execution = execution
        self._automaton = execution.automaton
        self._job = job
        self._around = around
        jobs = execution.conduct.jobs
        self._eligible = jobs.eligible(job, self._automaton)
        self._active = self._eligible & execution.active
        others = (each for each in jobs.under_way if each.id != job.id)
        self._alone = not any(execution.active & jobs.eligible(each, self._automaton) for each in others)

    def waits(self) -> list[Message]:
        found, moves = list[Message](), False
        for step in self._execution.plan.order.running:
            late = self._late(step)
            human = self._automaton.abilities[step.ability].human is not None
            moves = moves or (late is None and not human)
            if late is not None and not human and self._concerns(step.ability):
                title = self._automaton.abilities[step.ability].title
                found.append(message("waits.late", ability=title, late=late.words()))
        found += self._tasks()
        conduct = self._execution.conduct
        if conduct.production is not Production.STARTED or not conduct.executes_operations:
            return found
        found += [*self._operations(), *self._plan(moves)]
        if not moves:
            found += [*self._alarms(), *self._next()]
        return found if found or moves else list(self._goals())

    def _late(self, step: PlannedStart) -> Late | None:
        return overdue(step, self._automaton.abilities[step.ability], self._around.monotonic)

    def _concerns(self, ability: str) -> bool:
        """Return whether what an ability does may be for this job: it is, where nothing says that it is for another."""
        if self._alone:
            return True
        waiting = self._around.held_up({self._automaton.abilities[ability].resource})
        return bool(waiting & self._active) or not waiting

    def _tasks(self) -> Iterator[Message]:
        running = {step.ability: step for step in self._execution.plan.order.running}
        for id_, task in self._around.tasks.items():
            if not self._concerns(task.ability):
                continue
            resource = self._automaton.abilities[task.ability].resource
            step, problem = running.get(task.ability), self._around.problems.get(id_)
            late = None if step is None else self._late(step)
            cannot: Argument = ""
            if problem is not None:
                cannot = message("waits.task-problem", why=problem.why) if problem.why else message("waits.task-cannot")
            yield message(
                "waits.task",
                task=task.title,
                resource=self._automaton.resources.get(resource, resource),
                late="" if late is None else message("waits.task-late", late=late.words()),
                problem=cannot,
            )

    def _operations(self) -> Iterator[Message]:
        """Yield what keeps all its operations from being active."""
        if self._active or not self._job.under_way:
            return
        operations, jobs = self._automaton.operations, self._execution.conduct.jobs
        out = self._execution.conduct.idle_operations(self._automaton)
        for name in sorted(self._eligible):
            if name in out:
                yield message("waits.service", title=operations[name].title)
            elif not self._execution.conduct.jobs.by_order:
                yield message("waits.by-order")
            else:
                lacking = self._lacking(operations[name].precondition)
                yield message("waits.precondition", operation=operations[name].title, condition=lacking)
        if not self._eligible:
            master = self._automaton.work_masters[self._job.work_master]
            awaited = {step for name in master.operations for step in jobs.awaited(self._job, name)}
            for job, name in sorted(awaited):
                yield message("waits.other-job", operation=operations[name].title, job=job)

    def _lacking(self, condition: Expression) -> Sentence:
        """Say what of a condition does not hold, or all of it where that is not to be told."""
        wording = wording_of(self._automaton)
        undone = list(wording.lacking(condition, self._execution.state)) or wording.told_parts(condition)
        return sentences_of(self._automaton).tell_missing(condition, self._execution.state, phrase(*undone))

    def _plan(self, moves: bool) -> Iterator[Message]:
        plan, titles = self._execution.plan, self._automaton.operations
        if not self._active:
            return
        if plan.status is PlanStatus.NONE:
            yield message("waits.plan", reason=reason_text(plan.reason))
        elif plan.status is PlanStatus.FOLLOWED:
            left_out = () if plan.answer is None else plan.answer.left_out
            yield from (
                message("waits.left-out", operation=titles[name].title) for name in left_out if name in self._active
            )
        elif not moves:
            yield message("waits.looking")

    def _alarms(self) -> Iterator[Message]:
        """Alarms that may be why nothing moves."""
        urgent = [
            alarm
            for alarm in self._around.alarms.values()
            if alarm.ended is None and alarm.priority is not Priority.LOW and alarm.kind not in _SAID
        ]
        urgent.sort(key=lambda alarm: (alarm.priority is not Priority.HIGH, alarm.since))
        yield from (message("waits.alarm", alarm=alarm.messages.text) for alarm in urgent[:_MOST_ALARMS])

    def _next(self) -> Iterator[Message]:
        """Yield what the next start waits for, where nothing is under way that could bring it about."""
        order = self._execution.plan.order
        if self._active and order.ahead and not order.running and self._around.next_waits:
            title = self._automaton.abilities[order.ahead[0].ability].title
            yield message("waits.start", ability=title, waits=awaiting(self._around.next_waits))

    def _goals(self) -> Iterator[Message]:
        """Yield what is still to come true, where nothing is to be started for it."""
        if not self._execution.plan.order.ahead:
            operations = self._automaton.operations
            for name in sorted(self._active):
                written = wording_of(self._automaton).in_words(operations[name].goal)
                goal = sentences_of(self._automaton).tell_missing(operations[name].goal, self._execution.state, written)
                yield message("waits.goal", operation=operations[name].title, goal=goal)


# What is shown of jobs, and in words what keeps them and their operations from going on.


def job_views(execution: Executor, jobs: Jobs | None = None, around: Around | None = None) -> dict[str, JobView]:
    """Each job by its id, in the order in which they were taken: those of the execution, or as they were before."""
    jobs = execution.conduct.jobs if jobs is None else jobs
    return {job.id: _view(execution, jobs, job, around) for job in jobs.taken}


def waits_for(execution: Executor, job: Job, around: Around | None = None) -> list[Message]:
    """Return what keeps a job as a whole from going on."""
    if job.state is JobState.PAUSED:
        return [message("waits.resumed")]
    if job.state is JobState.WAITING:
        return [as_it_was(each) for each in execution.keeps_from_beginning(job)]
    if job.state is JobState.RUNNING:
        return of_running(execution, job, around)
    return []


def _awaited(jobs: Jobs, job: Job, operation: str, automaton: Automaton) -> list[str]:
    """The operations that have to be completed before this one of the job; those of other jobs as `job/operation`."""
    awaited = jobs.awaited(job, operation)
    own = job.after(operation, automaton) | {name for id_, name in awaited if id_ == job.id}
    return [*sorted(own), *(f"{id_}/{name}" for id_, name in sorted(awaited) if id_ != job.id)]


def why_idle(execution: Executor, operation: str) -> Message | None:
    """Say what has to come before a job asks for an operation; None where one does, or none has to."""
    jobs, automaton = execution.conduct.jobs, execution.automaton
    if not jobs.by_order or operation not in automaton.job_operations:
        return None
    job = jobs.having(operation, automaton)
    if job is None:
        return message("waits.job")
    if operation in jobs.eligible(job, automaton):
        return None
    if operation in job.completed:
        return message("waits.another-job", job=job.title)
    if operation in job.skipped(automaton):
        return message("waits.another-alternative", job=job.title)
    if job.finishing is not None:
        return message("waits.another-job-stopping", job=job.title)
    if job.state is JobState.PAUSED:
        return message("waits.job-resumed", job=job.title)
    if job.state is JobState.WAITING:
        conditions = waits_for(execution, job) or [message("waits.next-tick")]
        return message("waits.job-begins", job=job.title, waits=awaiting(conditions))
    before = [_titled(execution, each) for each in _awaited(jobs, job, operation, automaton)]
    return message("waits.job-before", job=job.title, operations=before)


def _titled(execution: Executor, step: str) -> Item:
    """An operation as people know it; `4711/tighten` is that of another job."""
    job, _, name = step.rpartition("/")
    title = execution.automaton.operations[name].title
    return message("waits.other-job", operation=title, job=job) if job else title


def _view(execution: Executor, jobs: Jobs, job: Job, around: Around | None) -> JobView:
    master = execution.automaton.work_masters.get(job.work_master)
    # One that ended before the model was changed can have a work master that is not there any more.
    names = sorted(job.started.keys() | job.completed.keys()) if master is None else list(master.operations)
    eligible = frozenset[str]() if master is None else jobs.eligible(job, execution.automaton)
    waits = waits_for(execution, job, around)
    return JobView(
        title=job.title,
        work_master=job.work_master,
        state=job.state,
        stopping=job.finishing is not None and job.under_way,
        taken=job.taken.epoch,
        begun=_epoch(job.begun),
        ended=_epoch(job.ended),
        waits_for=[*waits],
        waits_for_messages=waits,
        sentence=waits_in_one(waits),
        steps={name: _step(execution, jobs, job, name, eligible) for name in names},
    )


def _step(execution: Executor, jobs: Jobs, job: Job, name: str, eligible: frozenset[str]) -> JobStepView:
    state = _state(execution, job, name, eligible)
    waiting = state is JobStepState.WAITING and job.under_way
    return JobStepView(
        state=state,
        waits_for=_awaited(jobs, job, name, execution.automaton) if waiting else [],
        started=_epoch(job.started.get(name)),
        ended=_epoch(job.completed.get(name)),
    )


def _state(execution: Executor, job: Job, name: str, eligible: frozenset[str]) -> JobStepState:
    if name in job.completed:
        return JobStepState.COMPLETED
    if job.work_master in execution.automaton.work_masters and name in job.skipped(execution.automaton):
        return JobStepState.SKIPPED
    if name not in eligible:
        return JobStepState.WAITING
    return JobStepState.ACTIVE if name in execution.active else JobStepState.ELIGIBLE


def _epoch(moment: Timestamp | None) -> float | None:
    return None if moment is None else moment.epoch
