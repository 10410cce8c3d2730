"""The jobs of a station that works by order: which of their operations are eligible, and what is completed.

A value: each step gives a new one. A job decides nothing but which operations may be active; all else is as ever. It
advances in ticks only. What its operations are, and their order, is in its work master.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from enum import StrEnum

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.execution.vocabulary import JobState

Step = tuple[str, str]  # a job, and an operation of it
Waits = Mapping[Step, frozenset[Step]]


class JobAct(StrEnum):
    """A request that can be made of a job under way."""

    PAUSE = "pause"
    RESUME = "resume"
    STOP = "stop"
    ABORT = "abort"


class Job(Immutable):
    """`started` and `completed` say when its operations were first active and completed.

    Once it is being stopped, `finishing` are the operations that were active then, and no others are eligible.
    """

    id: str
    title: str
    work_master: str
    taken: Timestamp
    state: JobState = JobState.WAITING
    finishing: frozenset[str] | None = None
    begun: Timestamp | None = None
    ended: Timestamp | None = None
    started: Mapping[str, Timestamp] = {}
    completed: Mapping[str, Timestamp] = {}

    @property
    def under_way(self) -> bool:
        """True if it has not ended."""
        return not self.state.is_over

    @property
    def may_begin(self) -> bool:
        """True if it waits for what its product brings, and for nothing else."""
        return self.state is JobState.WAITING and self.finishing is None

    def after(self, operation: str, automaton: Automaton) -> frozenset[str]:
        """The operations that come before this one, or are done one at a time with it and have begun, and are not
        completed.
        """
        master = automaton.work_masters[self.work_master]
        before = master.operations[operation]
        for branches in master.arbitrary:
            if any(operation in branch for branch in branches):
                before = before.union(*(each for each in branches if operation not in each and self._has_begun(each)))
        return before - self.completed.keys() - self.skipped(automaton) if before else before

    def skipped(self, automaton: Automaton) -> frozenset[str]:
        """The operations that are not to be done, as another branch of their alternative has begun."""
        found: frozenset[str] = frozenset()
        for branches in automaton.work_masters[self.work_master].alternatives:
            taken = next((each for each in branches if self._has_begun(each)), None)
            if taken is not None:
                found = found.union(*branches) - taken
        return found - self.completed.keys() if found else found

    def _has_begun(self, branch: frozenset[str]) -> bool:
        return any(name in self.started or name in self.completed for name in branch)

    def after_act(self, act: JobAct, active: frozenset[str], now: Timestamp) -> Job:
        """After a person or a system has asked for this, while some of its operations are `active`."""
        waits = JobState.WAITING if self.begun is None else JobState.RUNNING
        match act:
            case JobAct.PAUSE:
                return replace(self, state=JobState.PAUSED)
            case JobAct.RESUME:
                return replace(self, state=waits)
            case JobAct.STOP:
                if self.finishing is not None and self.state is not JobState.PAUSED:
                    return self
                return replace(self, state=waits, finishing=active)
            case JobAct.ABORT:
                return replace(self, state=JobState.ABORTED, ended=now)

    def over(self, operations: Iterable[str], eligible: frozenset[str], now: Timestamp) -> Job:
        """Ended, where all that it has to do is done."""
        if not self.under_way or self.state is JobState.PAUSED:
            return self
        if self.begun is not None and all(name in self.completed for name in operations):
            return replace(self, state=JobState.ENDED, ended=now)
        if self.finishing is not None and not eligible:
            return replace(self, state=JobState.STOPPED, ended=now)
        return self


class Jobs(Immutable):
    """All that were `taken` and are not forgotten, in that order, and what they wait for beside their work masters.

    While the station works `by_order`, operations of work masters are active only for jobs.
    """

    by_order: bool = False
    taken: tuple[Job, ...] = ()
    waits: Mapping[Step, frozenset[Step]] = {}

    @property
    def under_way(self) -> tuple[Job, ...]:
        """Those that have not ended."""
        return tuple(job for job in self.taken if job.under_way)

    def get(self, job: str) -> Job | None:
        """The job of this id."""
        return next((each for each in self.taken if each.id == job), None)

    def having(self, operation: str, automaton: Automaton) -> Job | None:
        """The job under way that has this operation; no two have."""
        masters = automaton.work_masters
        return next((job for job in self.under_way if operation in masters[job.work_master].operations), None)

    def awaited(self, job: Job, operation: str) -> frozenset[Step]:
        """The operations of other jobs under way that this one is still to wait for."""
        waits = self.waits.get((job.id, operation))
        return frozenset(step for step in waits if self._lacks(*step)) if waits else frozenset()

    def eligible(self, job: Job, automaton: Automaton) -> frozenset[str]:
        """The operations that may be active for this job."""
        if job.state is not JobState.RUNNING:
            return frozenset()
        if job.finishing is not None:
            return frozenset(name for name in job.finishing - job.completed.keys() if not job.after(name, automaton))
        operations = automaton.work_masters[job.work_master].operations
        return frozenset(
            name
            for name in operations.keys() - job.skipped(automaton)
            if name not in job.completed and not job.after(name, automaton) and not self.awaited(job, name)
        )

    def in_turn(self, job: Job, automaton: Automaton, wanted: Collection[str]) -> frozenset[str]:
        """The operations that may be active for this job, where of branches that begin in one tick only the first
        does: that of which one is `wanted`, as it could be active or its goal is reached.
        """
        eligible, master = self.eligible(job, automaton), automaton.work_masters[job.work_master]
        for branches in (*master.alternatives, *master.arbitrary):
            begin = [branch for branch in branches if not branch.isdisjoint(eligible.intersection(wanted))]
            eligible = eligible.difference(*begin[1:])
        return eligible

    def idle(self, automaton: Automaton, wanted: Collection[str] = ()) -> frozenset[str]:
        """The operations that do not become active, as no job asks for them."""
        if not self.by_order:
            return frozenset()
        return automaton.job_operations.difference(*(self.in_turn(job, automaton, wanted) for job in self.under_way))

    # How they change.

    def taking(self, job: Job) -> Jobs:
        """With one more."""
        return replace(self, taken=(*self.taken, job))

    def forgetting(self, job: str) -> Jobs:
        """Without this one."""
        waits = {
            step: left
            for step, before in self.waits.items()
            if step[0] != job and (left := frozenset(each for each in before if each[0] != job))
        }
        return replace(self, taken=tuple(each for each in self.taken if each.id != job), waits=waits)

    def having_begun(self, job: str, now: Timestamp) -> Jobs:
        """Return the jobs with this one having begun: what its product brings is there."""
        return self._each(lambda each: replace(each, state=JobState.RUNNING, begun=now) if each.id == job else each)

    def after_act(self, job: str, act: JobAct, active: frozenset[str], automaton: Automaton, now: Timestamp) -> Jobs:
        """After somebody has asked for this, while some operations are `active`."""

        def tell(each: Job) -> Job:
            if each.id != job or not each.under_way:
                return each
            return each.after_act(act, active & self.eligible(each, automaton), now)

        return self._each(tell)

    def advanced(
        self, automaton: Automaton, active: frozenset[str], reached: Callable[[str], bool], now: Timestamp
    ) -> Jobs:
        """After step 4 of a tick: some operations are `active`, and of others the goals are `reached`."""

        def advance(job: Job) -> Job:
            eligible = self.eligible(job, automaton)
            eligible = self.in_turn(job, automaton, [name for name in eligible if name in active or reached(name)])
            completed = {name: now for name in sorted(eligible) if reached(name)}
            started = {name: now for name in sorted(eligible & active) if name not in job.started}
            if completed or started:
                done, begun = {**job.completed, **completed}, {**job.started, **started}
                job = replace(job, completed=done, started=begun)
            # What comes next is eligible from the next tick on; here it only matters whether anything is left.
            left = eligible - completed.keys()
            needed = automaton.work_masters[job.work_master].operations.keys() - job.skipped(automaton)
            return job.over(needed, left, now)

        return self._each(advance)

    def reopened(self, operation: str, automaton: Automaton) -> Jobs:
        """An operation has been reset: for the job under way that has it, it is as if it had never been active."""
        owner = self.having(operation, automaton)
        if owner is None or operation not in {*owner.started, *owner.completed}:
            return self
        started = {name: at for name, at in owner.started.items() if name != operation}
        completed = {name: at for name, at in owner.completed.items() if name != operation}
        again = replace(owner, started=started, completed=completed)
        return self._each(lambda each: again if each is owner else each)

    def _lacks(self, job: str, operation: str) -> bool:
        """Return whether an operation of a job under way is not completed."""
        found = self.get(job)
        return found is not None and found.under_way and operation not in found.completed

    def _each(self, step: Callable[[Job], Job]) -> Jobs:
        taken = tuple(step(job) for job in self.taken)
        if all(new is old for new, old in zip(taken, self.taken, strict=True)):
            return self
        return replace(self, taken=taken)
