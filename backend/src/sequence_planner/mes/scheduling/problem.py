"""The scheduling problem: jobs, tasks, resources, durations from past runs, and the cost of a schedule."""

from __future__ import annotations

import json
from collections import defaultdict, deque
from collections.abc import Collection, Iterable, Mapping, Sequence, Set
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter
from itertools import islice
from math import ceil, floor, isfinite
from statistics import median
from typing import Any, Final, TypeAlias

from sqlalchemy import Connection

from sequence_planner.controller.views.details import WorkMastersView, WorkMasterView
from sequence_planner.controller.views.station import JobStepState, JobView, StationView
from sequence_planner.execution.vocabulary import JobState
from sequence_planner.journal import run_journal
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.mes.order import JobOrder, OrderState
from sequence_planner.mes.queue import order_of_work

# What is to be put into an order, and the order.


@dataclass(frozen=True)
class WorkOperation:
    """An operation of a job that is not completed.

    `after` are those of the same job that come before it; one that is not among the job's operations is completed.
    `seconds` is how long it is expected to take, and `started` since when (seconds since the epoch) it is active. While
    it is worked no operation of another job is on its `resources`.
    """

    after: frozenset[str]
    seconds: float
    resources: frozenset[str]
    started: float | None = None


@dataclass(frozen=True)
class JobWork:
    """The rest that is left of a job. `due` and `earliest`, before which it does not begin, are in seconds since the
    epoch.

    The higher its `priority`, the more it weighs when it is late. One that has `begun` goes on.
    """

    job: str
    priority: int
    due: float | None
    earliest: float | None
    operations: Mapping[str, WorkOperation]
    begun: bool = False


Step: TypeAlias = tuple[str, str]
"""A job and one of its operations."""


@dataclass(frozen=True)
class Schedule:
    """In which order to work.

    `jobs` are in the order in which they begin. `starts` has when each operation is expected to start and to end
    (seconds since the epoch). `waits` says which operations of other jobs, on a common resource, each one waits for,
    and no more than is needed to say so; see `waits.waits_among` for those of some jobs. `late` has the seconds by
    which jobs are expected to miss their due time, `tardiness` is the sum of these times their weights, which nothing
    brings below `bound`. The first `horizon` jobs were searched, the others follow by rule. It is `optimal` when there
    is proof that neither that sum nor, with it, the time at which all is done can be less. `fallback` says why the
    order is only that of priority, due time and storage; empty if it is not.
    """

    jobs: list[str]
    starts: dict[Step, tuple[float, float]]
    waits: dict[Step, list[Step]]
    late: dict[str, float]
    tardiness: float
    bound: float
    optimal: bool
    horizon: int
    fallback: str = ""


def weight(priority: int) -> int:
    """Return how much a second counts that a job of this priority is late."""
    return max(priority, 0) + 1


# The question as a scheduling problem in whole numbers: jobs of tasks on resources that take one at a time.
#
# Times are in ticks from now on. What is expected is never known so well that a tenth of a second would matter.

TICK: Final = 0.1  # seconds
LONGEST: Final = 1e7  # seconds that an operation may take
FARTHEST: Final = 1e9  # seconds; a due time or a beginning farther away than that is taken for so far
_SLACK: Final = 1e-6  # ticks, for what floating point numbers make of seconds since the epoch


@dataclass(frozen=True)
class ScheduledTask:
    """An operation of the job with this index. `end` is when it is expected to end if it has started."""

    job: int
    name: str
    length: int
    resources: frozenset[str]
    after: tuple[int, ...]
    end: int | None


@dataclass(frozen=True)
class ScheduledJob:
    """A job; `due` can be over already, `release` cannot. `tasks` are indices, each after those it comes after."""

    name: str
    weight: int
    due: int | None
    release: int
    tasks: tuple[int, ...]
    begun: bool


@dataclass(frozen=True)
class Instance:
    """All jobs, and the `rivals`: groups of jobs of which no two overlap, but for those that have begun."""

    now: float
    jobs: tuple[ScheduledJob, ...]
    tasks: tuple[ScheduledTask, ...]
    rivals: tuple[tuple[int, ...], ...]
    groups: tuple[tuple[int, ...], ...]  # which of the rivals each job is among

    def end(self, task: int, start: int) -> int:
        """Return when a task ends that starts then."""
        end = self.tasks[task].end
        return start + self.tasks[task].length if end is None else end

    def movable(self, job: int) -> list[int]:
        """The tasks of a job that have not started."""
        return [each for each in self.jobs[job].tasks if self.tasks[each].end is None]


Starts = Sequence[int]
"""Start of each task; 0 for one that has started."""


def instance(works: Sequence[JobWork], exclusive: Iterable[Collection[str]], now: float) -> Instance:
    """The problem. Raises `ValueError` for what cannot be worked: operations after each other in a circle, a time that
    is no number or out of bounds, two jobs of one name.
    """
    index = {work.job: number for number, work in enumerate(works)}
    if len(index) < len(works):
        raise ValueError("two jobs have the same id")
    jobs: list[ScheduledJob] = []
    tasks: list[ScheduledTask] = []
    for work in works:
        begun = work.begun or any(each.started is not None for each in work.operations.values())
        numbers = {name: len(tasks) + place for place, name in enumerate(_in_order(work))}
        tasks += [_task(work, name, len(jobs), numbers, now) for name in numbers]
        release = 0 if begun or work.earliest is None else max(0, ceil(_ticks(work.earliest, now) - _SLACK))
        due = None if work.due is None else floor(_ticks(work.due, now) + _SLACK)
        jobs.append(ScheduledJob(work.job, weight(work.priority), due, release, tuple(numbers.values()), begun))
    known = ({index[name] for name in group if name in index} for group in exclusive)
    rivals = tuple(sorted({tuple(sorted(group)) for group in known if len(group) > 1}))
    groups: list[list[int]] = [[] for _ in jobs]
    for number, group in enumerate(rivals):
        for job in group:
            groups[job].append(number)
    return Instance(now, tuple(jobs), tuple(tasks), rivals, tuple(map(tuple, groups)))


def _in_order(work: JobWork) -> list[str]:
    graph = {name: sorted(each.after & work.operations.keys()) for name, each in sorted(work.operations.items())}
    try:
        return list(TopologicalSorter(graph).static_order())
    except CycleError as error:
        circle = ", ".join(error.args[1])
        raise ValueError(f"operations of job {work.job} come after each other in a circle: {circle}") from None


def _task(work: JobWork, name: str, job: int, numbers: dict[str, int], now: float) -> ScheduledTask:
    operation = work.operations[name]
    if not 0 <= operation.seconds <= LONGEST:  # which no NaN is
        raise ValueError(f"operation {name} of job {work.job} cannot take {operation.seconds} s")
    after = tuple(sorted(numbers[each] for each in operation.after & numbers.keys()))
    end = None
    if operation.started is not None:
        end = max(0, ceil(_ticks(operation.started + operation.seconds, now) - _SLACK))
    length = max(1, ceil(operation.seconds / TICK - _SLACK))
    return ScheduledTask(job, name, length, operation.resources, after, end)


def _ticks(time: float, now: float) -> float:
    if not isfinite(time):
        raise ValueError(f"{time} is no time")
    return min(max(time - now, -FARTHEST), FARTHEST) / TICK


def cost(problem: Instance, starts: Starts, jobs: Iterable[int] | None = None) -> tuple[int, int, int]:
    """Weighted tardiness, the end of all, and the sum of weighted ends: what counts, in this order."""
    tardiness = makespan = ends = 0
    for number in range(len(problem.jobs)) if jobs is None else jobs:
        job, end = problem.jobs[number], job_end(problem, starts, number)
        if job.due is not None:
            tardiness += job.weight * max(0, end - job.due)
        makespan = max(makespan, end)
        ends += job.weight * end
    return tardiness, makespan, ends


def job_end(problem: Instance, starts: Starts, job: int) -> int:
    """Return when a job ends; one of which nothing is left has ended."""
    return max((problem.end(each, starts[each]) for each in problem.jobs[job].tasks), default=0)


def earliest_ends(problem: Instance) -> list[int]:
    """Return when each job would end if nothing else were worked: none can end before."""
    starts = [0] * len(problem.tasks)
    for job in problem.jobs:
        for task in job.tasks:
            before = (problem.end(each, starts[each]) for each in problem.tasks[task].after)
            starts[task] = 0 if problem.tasks[task].end is not None else max(job.release, *before, 0)
    return [job_end(problem, starts, number) for number in range(len(problem.jobs))]


# How long operations take, and on which resources: as their last runs did, which the run journal tells.

REMEMBERED_RUNS: Final = 5  # of an operation; devices change their pace
UNKNOWN_SECONDS: Final = 60.0  # that an operation is expected to take of which nothing is known
_LOOK_BACK: Final = 20_000  # records that are read at most: nobody asks for days, and then for all of them at once
_PAGE: Final = 1000
_TICKED, _BEGUN = "ticked", "begun"


class KnownTimes:
    """Reads on in the run journal. `resource_of` has the resource of each ability."""

    def __init__(self, resource_of: Mapping[str, str]) -> None:
        self._resource_of = resource_of
        self._number: int | None = None  # of the last record that was read
        self._active: dict[str, tuple[float, set[str]]] = {}  # since when, and what was used
        self._seconds: dict[str, deque[float]] = defaultdict(lambda: deque(maxlen=REMEMBERED_RUNS))
        self._used: dict[str, deque[frozenset[str]]] = defaultdict(lambda: deque(maxlen=REMEMBERED_RUNS))

    def seconds(self, operation: str, planned: float | None = None) -> float:
        """Return how long it takes: the median of the last runs; before the first as long as is `planned`, or a
        minute.
        """
        if runs := self._seconds.get(operation):
            return median(runs)
        return UNKNOWN_SECONDS if planned is None else planned

    def resources(self, operation: str, of_goal: frozenset[str]) -> frozenset[str]:
        """Those of the abilities that started in the last runs; before the first those that its goal depends on.

        A run in which no ability started says nothing.
        """
        if runs := self._used.get(operation):
            return frozenset().union(*runs)
        return of_goal

    def read_on(self, connection: Connection) -> bool:
        """Read what has happened since, or the last of it where that is too much; whether it changes what is known."""
        if (bounds := run_journal.bounds(connection)) is None:
            return False
        begin = max(bounds[0].number - 1, bounds[1].number - _LOOK_BACK)
        if self._number is None or self._number < begin:
            self._number = begin
            self._active.clear()  # what has become of it is among what is passed over
        before = self._known()
        while page := run_journal.after(connection, self._number, _PAGE):
            self._number = page[-1].number
            self.add_records(page)
        return self._known() != before

    def add_records(self, records: Sequence[RunRecord]) -> None:
        """Take in what these records tell, which follow on those before."""
        for record in records:
            if record.kind == _BEGUN:
                self._active.clear()  # the controller has started anew, after a time in which nothing was worked
            elif record.kind == _TICKED:
                self._add_tick(record.time, json.loads(record.content))

    def _add_tick(self, time: float, told: dict[str, Any]) -> None:
        """Operations are completed and activated before abilities start."""
        for name in told.get("completed", ()):
            # Where the clock was set meanwhile, as after a start without one, it is not known.
            if (run := self._active.pop(name, None)) is not None and 0 <= time - run[0] <= LONGEST:
                self._seconds[name].append(time - run[0])
                if run[1]:
                    self._used[name].append(frozenset(run[1]))
        for name in told.get("activated", ()):
            self._active[name] = time, set()
        resources = {self._resource_of[name] for name in told.get("started", ()) if name in self._resource_of}
        for _, used in self._active.values():
            used |= resources

    def _known(self) -> dict[str, tuple[float, frozenset[str]]]:
        return {name: (median(runs), self.resources(name, frozenset())) for name, runs in self._seconds.items()}


# What is asked about the orders of a station: the jobs under way as they are shown, then those that wait.

MOST: Final = 1000  # orders that are put into an order, the first by rule; the others follow by rule


@dataclass(frozen=True)
class SchedulingProblem:
    """Works, and groups of them of which no two may overlap."""

    works: tuple[JobWork, ...]
    exclusive: tuple[frozenset[str], ...]


def scheduling_problem(
    orders: Sequence[JobOrder], view: StationView, masters: WorkMastersView, known: KnownTimes
) -> SchedulingProblem:
    """The works of orders that the station works on or may start. Jobs that are paused are none: nobody knows when they
    go on.
    """
    chosen = [each for each in orders if each.is_at_station or each.state is OrderState.ALLOWED_TO_START]
    first = sorted(order_of_work(chosen), key=lambda order: not order.is_at_station)
    works: list[JobWork] = []
    groups: dict[str, set[str]] = defaultdict(set)
    for order in islice(first, MOST):
        master, job = masters.work_masters.get(order.work_master), view.jobs.get(order.id)
        if master is None or (job is not None and (job.state is JobState.PAUSED or job.state.is_over)):
            continue
        works.append(_work(order, master, job, view, known))
        for name in (*master.operations, *master.brought):
            groups[name].add(order.id)
    exclusive = {frozenset(group) for group in groups.values() if len(group) > 1}
    return SchedulingProblem(tuple(works), tuple(sorted(exclusive, key=sorted)))


def _work(
    order: JobOrder, master: WorkMasterView, job: JobView | None, view: StationView, known: KnownTimes
) -> JobWork:
    operations: dict[str, WorkOperation] = {}
    steps = {} if job is None else job.steps
    begun = {name for name, step in steps.items() if step.started is not None or step.ended is not None}
    passed_over = _passed_over(master, begun)
    for name, operation in master.operations.items():
        step = steps.get(name)
        if name in passed_over or (step is not None and step.state is JobStepState.COMPLETED):
            continue
        resources = known.resources(name, _resources(operation.goal_reads, view))
        started = step.started if step is not None and step.state is JobStepState.ACTIVE else None
        operations[name] = WorkOperation(frozenset(operation.after), known.seconds(name), resources, started)
    return JobWork(order.id, order.priority, order.due, order.earliest, operations, order.is_at_station)


def _passed_over(master: WorkMasterView, begun: Set[str]) -> set[str]:
    """The operations of alternatives that are not counted on: those of all branches but the one begun, or the first."""
    found: set[str] = set()
    for branches in master.alternatives:
        taken = next((branch for branch in branches if not begun.isdisjoint(branch)), branches[0])
        found.update(name for branch in branches if branch is not taken for name in branch)
    return found


def _resources(variables: Iterable[str], view: StationView) -> frozenset[str]:
    found = (view.variables[name].resource for name in variables if name in view.variables)
    return frozenset(name for name in found if name)


def held_up(jobs: Mapping[str, JobView]) -> frozenset[str]:
    """The jobs that may not go on by themselves: nothing of them is active. No other should wait for these for long."""
    return frozenset(
        id
        for id, job in jobs.items()
        if job.state is not JobState.RUNNING
        or not any(step.state is JobStepState.ACTIVE for step in job.steps.values())
    )
