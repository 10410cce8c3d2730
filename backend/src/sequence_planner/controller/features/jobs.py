"""Jobs: their commands, what they consist of, and the record of ended ones until their durable acknowledgement."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from graphlib import CycleError, TopologicalSorter

from sequence_planner.automaton.automaton import Ability, Automaton, WorkMaster, target
from sequence_planner.automaton.dependencies import reactions, read_variables
from sequence_planner.controller.commands.command import CommandRefused, answers, handles
from sequence_planner.controller.commands.jobs import CommandJob, ForgetJob, SequenceJobs, SetByOrder, TakeJob
from sequence_planner.controller.commands.queries import AboutWorkMasters
from sequence_planner.controller.views.details import (
    WorkAbilityView,
    WorkMastersView,
    WorkMasterView,
    WorkOperationView,
)
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.events import Heard
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.jobs import Job, JobAct, Jobs, Step, Waits
from sequence_planner.language.printer import print_assignment
from sequence_planner.language.resolver import suggestion

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
            hint = suggestion(command.work_master, masters) or "."
            detail = f"The station has no work master `{command.work_master}`{hint}"
            raise CommandRefused("unknown-work-master", "There is no such work master", detail, 404)
        if known is not None:
            detail = f"Job {known.id} is one of the work master {known.work_master}. Give the new one another id."
            raise CommandRefused("job-conflict", "There is another job of that id", detail)
        if not self._jobs.by_order:
            detail = "Its operations become active whenever they can. A person has to let it work by order first."
            raise CommandRefused("not-in-job-mode", "The station works freely", detail)
        for other in self._jobs.under_way:
            if common := _in_common(master, masters[other.work_master]):
                detail = f"Job {other.id} ({other.title}) is under way and has {_listed(common)} too. Wait for its end."
                raise CommandRefused("job-conflict", "Another job is in the way", detail)
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
            detail = f"Each of these would have to be completed before the next: {circle}."
            raise CommandRefused("cyclic-order", "The order leads into a circle", detail, 422) from None

    @handles(CommandJob)
    def command(self, command: CommandJob, moment: Timestamp) -> None:
        """Let the job pause, go on, stop or abort."""
        job, act, execution = self._known(command.job), JobAct(command.what), self._execution
        if not job.under_way:
            if act is JobAct.ABORT or act is JobAct.STOP:
                raise _ended(job, "There is nothing left of it to end.")
            raise _ended(job, "Order another one.")
        if self._jobs.after_act(job.id, act, execution.active, self._automaton, moment) != self._jobs:
            execution.command_job(job.id, act, command.actor.name, command.reason or "", moment)

    @handles(ForgetJob)
    def forget(self, command: ForgetJob, moment: Timestamp) -> None:
        """Show a job no longer that has ended."""
        job = self._jobs.get(command.job)
        if job is None:
            return
        if job.under_way:
            detail = f"Job {job.id} ({job.title}) is {job.state}. Abort it, or wait for its end."
            raise CommandRefused("job-under-way", "The job has not ended", detail)
        self._execution.forget_job(job.id, command.actor.name, moment)

    @handles(SetByOrder)
    def set_by_order(self, command: SetByOrder, moment: Timestamp) -> None:
        """Let the station work by order, or freely."""
        if command.on == self._jobs.by_order:
            return
        if not command.on and (under_way := self._jobs.under_way):
            named = ", ".join(job.id for job in under_way)
            detail = f"Jobs are under way: {named}. Wait for their end, or stop or abort them."
            raise CommandRefused("jobs-under-way", "Jobs are under way", detail)
        self._execution.set_by_order(command.on, command.actor.name, command.reason, moment)

    @answers(AboutWorkMasters)
    def work_masters(self, query: AboutWorkMasters) -> WorkMastersView:
        """All work masters of the station, and what its abilities write."""
        automaton = self._automaton
        return WorkMastersView(
            work_masters={name: _master(automaton, master) for name, master in automaton.work_masters.items()},
            abilities={name: _ability(automaton, ability) for name, ability in automaton.abilities.items()},
        )

    def _known(self, name: str) -> Job:
        job = self._jobs.get(name)
        if job is None:
            detail = f"The station has no job `{name}`. Look at what it has."
            raise CommandRefused("unknown-job", "There is no such job", detail, 404)
        return job


def _ended(job: Job, what_to_do: str) -> CommandRefused:
    detail = f"Job {job.id} ({job.title}) is {job.state}. {what_to_do}"
    return CommandRefused("job-ended", "The job has ended", detail)


def _in_common(one: WorkMaster, other: WorkMaster) -> list[str]:
    """The operations that both have, and the variables that the products of both bring."""
    brought = set(map(target, one.brings)) & set(map(target, other.brings))
    return sorted((one.operations.keys() & other.operations.keys()) | brought)


def _listed(names: list[str]) -> str:
    """As many of them as can be read."""
    some = ", ".join(f"`{name}`" for name in names[:3])
    return some if len(names) <= 3 else f"{some} and {len(names) - 3} more"


def _master(automaton: Automaton, master: WorkMaster) -> WorkMasterView:
    return WorkMasterView(
        title=master.title,
        brings=[print_assignment(action) for action in master.brings],
        brought=sorted({target(action) for action in master.brings}),
        operations={name: _operation(automaton, name, after) for name, after in master.operations.items()},
    )


def _operation(automaton: Automaton, name: str, after: frozenset[str]) -> WorkOperationView:
    operation = automaton.operations[name]
    read = read_variables(automaton, (operation.goal,))
    return WorkOperationView(title=operation.title, after=sorted(after), goal_reads=sorted(read))


def _ability(automaton: Automaton, ability: Ability) -> WorkAbilityView:
    actions = [*ability.start_actions, *ability.finish_actions, *ability.cancel_actions]
    for effect in reactions(automaton, ability.name):
        actions += effect.actions
    written = sorted({target(action) for action in actions})
    return WorkAbilityView(title=ability.title, writes=written, instant=ability.finish_guard is None)


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
