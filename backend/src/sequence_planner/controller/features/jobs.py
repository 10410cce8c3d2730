"""Jobs: their commands, what is shown of them, and what they consist of."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from graphlib import CycleError, TopologicalSorter

from sequence_planner.automaton.automaton import Automaton, WorkMaster, target
from sequence_planner.controller.alarms.manager import AlarmManager
from sequence_planner.controller.commands.command import CommandRefused, answers, handles
from sequence_planner.controller.commands.jobs import CommandJob, ForgetJob, SequenceJobs, SetByOrder, TakeJob
from sequence_planner.controller.commands.queries import AboutWorkMasters, AskOperationDefinition
from sequence_planner.controller.features.tasks import TaskHandler
from sequence_planner.controller.recovery.explain import ConditionContext
from sequence_planner.controller.recovery.explain import waits_for as start_waits_for
from sequence_planner.controller.views.automaton_diagram import Drawing, work_masters_view
from sequence_planner.controller.views.details import OperationDefinitionView, WorkMastersView
from sequence_planner.controller.views.jobs import Around, job_views, waits_for
from sequence_planner.controller.views.wording import hint_of
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.jobs import Job, JobAct, Jobs, Step, Waits
from sequence_planner.execution.vocabulary import JobState
from sequence_planner.texts.message import Message, message

# Jobs, as they are ordered: what is asked for is done if the station allows it now, or refused with the reason.


class JobHandler:
    """Takes commands about the jobs of `execution`. Who repeats one, as it was not answered, changes nothing."""

    def __init__(self, execution: Executor) -> None:
        self._execution = execution

    @property
    def _jobs(self) -> Jobs:
        return self._execution.conduct.jobs

    @property
    def _automaton(self) -> Automaton:
        return self._execution.automaton

    @handles(TakeJob)
    def take(self, command: TakeJob, moment: Timestamp) -> None:
        """Let the job be under way, if nothing of another one is in its way."""
        known = self._jobs.get(command.job)
        if known is not None and known.work_master == command.work_master:
            return
        masters = self._automaton.work_masters
        master = masters.get(command.work_master)
        if master is None:
            raise CommandRefused(
                "unknown-work-master",
                message(
                    "refused.unknown-work-master.name",
                    name=command.work_master,
                    hint=hint_of(command.work_master, masters),
                ),
                404,
            )
        if known is not None:
            raise CommandRefused(
                "job-conflict", message("refused.job-conflict.id", job=known.id, master=known.work_master)
            )
        if not self._jobs.by_order:
            raise CommandRefused("not-in-job-mode", message("refused.not-in-job-mode.by-order"))
        for other in self._jobs.under_way:
            if common := _in_common(master, masters[other.work_master]):
                raise CommandRefused(
                    "job-conflict",
                    message("refused.job-conflict.common", job=other.id, title=other.title, operations=common),
                )
        by = command.actor.name
        self._execution.accept_job(command.job, command.title, command.work_master, by, moment)

    @handles(SequenceJobs)
    def sequence(self, command: SequenceJobs, moment: Timestamp) -> None:
        """Keep the order, without what is not under way."""
        known = self._steps()
        waits: dict[Step, frozenset[Step]] = {}
        for each in command.waits:
            step = (each.job, each.operation)
            before = frozenset((other.job, other.operation) for other in each.for_) & known.keys()
            if step in known and before:
                waits[step] = waits.get(step, frozenset()) | before
        self._require_no_circle(known, waits)
        if waits != self._jobs.waits:
            self._execution.sequence_jobs(waits, command.actor.name, moment)

    def _steps(self) -> dict[Step, frozenset[Step]]:
        """All operations of jobs under way, each with those of its job that come before it."""
        return {
            (job.id, name): frozenset((job.id, each) for each in before)
            for job in self._jobs.under_way
            for name, before in self._automaton.work_masters[job.work_master].operations.items()
        }

    @staticmethod
    def _require_no_circle(known: Mapping[Step, frozenset[Step]], waits: Waits) -> None:
        try:
            TopologicalSorter({step: before | waits.get(step, frozenset()) for step, before in known.items()}).prepare()
        except CycleError as error:
            circle = " → ".join(f"{job}/{name}" for job, name in reversed(error.args[1]))
            raise CommandRefused("cyclic-order", message("refused.cyclic-order.circle", circle=circle), 422) from None

    @handles(CommandJob)
    def command(self, command: CommandJob, moment: Timestamp) -> None:
        """Let the job pause, go on, stop or abort."""
        job, act, execution = self._known(command.job), JobAct(command.what), self._execution
        if not job.under_way:
            if act is JobAct.ABORT or act is JobAct.STOP:
                raise _ended(job, "nothing-left")
            raise _ended(job, "order-another")
        if self._jobs.after_act(job.id, act, execution.active, self._automaton, moment) != self._jobs:
            execution.command_job(job.id, act, command.actor.name, command.reason or "", moment)

    @handles(ForgetJob)
    def forget(self, command: ForgetJob, moment: Timestamp) -> None:
        """Show a job no longer that has ended."""
        job = self._jobs.get(command.job)
        if job is None:
            return
        if job.under_way:
            raise CommandRefused(
                "job-under-way",
                message(
                    "refused.job-under-way.state", job=job.id, title=job.title, state=message(f"job-state.{job.state}")
                ),
            )
        self._execution.forget_job(job.id, command.actor.name, moment)

    @handles(SetByOrder)
    def set_by_order(self, command: SetByOrder, moment: Timestamp) -> None:
        """Let the station work by order, or freely."""
        if command.on == self._jobs.by_order:
            return
        if not command.on and (under_way := self._jobs.under_way):
            named = ", ".join(job.title for job in under_way)
            raise CommandRefused("jobs-under-way", message("refused.jobs-under-way.named", jobs=named))
        self._execution.set_by_order(command.on, command.actor.name, command.reason, moment)

    @answers(AboutWorkMasters)
    def work_masters(self, query: AboutWorkMasters) -> WorkMastersView:
        """All work masters of the station, and what its abilities write."""
        return work_masters_view(self._automaton)

    @answers(AskOperationDefinition)
    def operation(self, query: AskOperationDefinition) -> OperationDefinitionView:
        """How an operation is defined, and what of that holds now. Raises `CommandRefused`."""
        operation = self._automaton.operations.get(query.name)
        if operation is None:
            raise CommandRefused("unknown-operation", message("refused.unknown-operation.those", name=query.name), 404)
        drawing = Drawing(self._automaton, self._execution.state, {}, None)
        return drawing.of_operation(operation, self._execution.revision)

    def _known(self, name: str) -> Job:
        job = self._jobs.get(name)
        if job is None:
            raise CommandRefused("unknown-job", message("refused.unknown-job.name", name=name), 404)
        return job


def _ended(job: Job, what_to_do: str) -> CommandRefused:
    state = message(f"job-state.{job.state}")
    return CommandRefused(
        "job-ended", message(f"refused.job-ended.{what_to_do}", job=job.id, title=job.title, state=state)
    )


def _in_common(one: WorkMaster, other: WorkMaster) -> list[str]:
    """The operations that both have, and the variables that the products of both bring."""
    brought = set(map(target, one.brings)) & set(map(target, other.brings))
    return sorted((one.operations.keys() & other.operations.keys()) | brought)


# What is shown of jobs, as far as they are durable, and what they wait for.


class JobViews:
    """The jobs of `execution` as they are `durable`; what they wait for is said from what is known around them.

    `held_up` names the active operations that cannot be completed while some resources do nothing.
    """

    def __init__(
        self,
        execution: Executor,
        durable: Callable[[], Jobs],
        tasks: TaskHandler,
        alarms: AlarmManager,
        is_controlled: Callable[[], bool],
        held_up: Callable[[Collection[str]], frozenset[str]],
        conditions: ConditionContext,
    ) -> None:
        self._execution = execution
        self._durable = durable
        self._tasks, self._alarms, self._is_controlled = tasks, alarms, is_controlled
        self._held_up, self._conditions = held_up, conditions

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        jobs = self._durable()
        return {"by_order": jobs.by_order, "jobs": job_views(self._execution, jobs, self._around(moment))}

    def waits(self, moment: Timestamp) -> dict[str, list[Message]]:
        """What jobs wait for that are to go on."""
        self._alarms.current(moment)
        around, told = self._around(moment), (JobState.WAITING, JobState.RUNNING)
        jobs = [job for job in self._execution.conduct.jobs.under_way if job.state in told]
        return {job.id: waits_for(self._execution, job, around) for job in jobs}

    def _around(self, moment: Timestamp) -> Around:
        execution, ahead = self._execution, self._execution.plan.order.ahead
        name = ahead[0].ability if ahead and execution.conduct.jobs.under_way else None
        waits = (
            []
            if name is None
            else start_waits_for(execution, name, self._conditions.feeds, self._conditions.guards().get(name))
        )
        return Around(
            moment.monotonic,
            self._held_up,
            self._tasks.open,
            self._tasks.problems,
            self._alarms.shown,
            next_waits=tuple(waits),
            controlled=self._is_controlled(),
        )
