"""The question as a scheduling problem in whole numbers: jobs of tasks on resources that take one at a time.

Times are in ticks from now on. What is expected is never known so well that a tenth of a second would matter.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter
from math import ceil, floor, isfinite
from typing import Final

from sequence_planner.mes.sequencing.work import Work, weight

TICK: Final = 0.1  # seconds
LONGEST: Final = 1e7  # seconds that an operation may take
FARTHEST: Final = 1e9  # seconds; a due time or a beginning farther away than that is taken for so far
_SLACK: Final = 1e-6  # ticks, for what floating point numbers make of seconds since the epoch


@dataclass(frozen=True)
class Task:
    """An operation of the job with this index. `end` is when it is expected to end if it has started."""

    job: int
    name: str
    length: int
    resources: frozenset[str]
    after: tuple[int, ...]
    end: int | None


@dataclass(frozen=True)
class Job:
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
    jobs: tuple[Job, ...]
    tasks: tuple[Task, ...]
    rivals: tuple[tuple[int, ...], ...]
    groups: tuple[tuple[int, ...], ...]  # which of the rivals each job is among

    def end(self, task: int, start: int) -> int:
        """When a task ends that starts then."""
        end = self.tasks[task].end
        return start + self.tasks[task].length if end is None else end

    def movable(self, job: int) -> list[int]:
        """The tasks of a job that have not started."""
        return [each for each in self.jobs[job].tasks if self.tasks[each].end is None]


Starts = Sequence[int]
"""When each task starts; of one that has started it is 0."""


def instance(works: Sequence[Work], exclusive: Iterable[Collection[str]], now: float) -> Instance:
    """The problem. Raises `ValueError` for what cannot be worked: operations after each other in a circle, a time that
    is no number or out of bounds, two jobs of one name.
    """
    index = {work.job: number for number, work in enumerate(works)}
    if len(index) < len(works):
        raise ValueError("two jobs have the same id")
    jobs: list[Job] = []
    tasks: list[Task] = []
    for work in works:
        begun = work.begun or any(each.started is not None for each in work.operations.values())
        numbers = {name: len(tasks) + place for place, name in enumerate(_in_order(work))}
        tasks += [_task(work, name, len(jobs), numbers, now) for name in numbers]
        release = 0 if begun or work.earliest is None else max(0, ceil(_ticks(work.earliest, now) - _SLACK))
        due = None if work.due is None else floor(_ticks(work.due, now) + _SLACK)
        jobs.append(Job(work.job, weight(work.priority), due, release, tuple(numbers.values()), begun))
    known = ({index[name] for name in group if name in index} for group in exclusive)
    rivals = tuple(sorted({tuple(sorted(group)) for group in known if len(group) > 1}))
    groups: list[list[int]] = [[] for _ in jobs]
    for number, group in enumerate(rivals):
        for job in group:
            groups[job].append(number)
    return Instance(now, tuple(jobs), tuple(tasks), rivals, tuple(map(tuple, groups)))


def _in_order(work: Work) -> list[str]:
    graph = {name: sorted(each.after & work.operations.keys()) for name, each in sorted(work.operations.items())}
    try:
        return list(TopologicalSorter(graph).static_order())
    except CycleError as error:
        circle = ", ".join(error.args[1])
        raise ValueError(f"operations of job {work.job} come after each other in a circle: {circle}") from None


def _task(work: Work, name: str, job: int, numbers: dict[str, int], now: float) -> Task:
    operation = work.operations[name]
    if not 0 <= operation.seconds <= LONGEST:  # which no NaN is
        raise ValueError(f"operation {name} of job {work.job} cannot take {operation.seconds} s")
    after = tuple(sorted(numbers[each] for each in operation.after & numbers.keys()))
    end = None
    if operation.started is not None:
        end = max(0, ceil(_ticks(operation.started + operation.seconds, now) - _SLACK))
    length = max(1, ceil(operation.seconds / TICK - _SLACK))
    return Task(job, name, length, operation.resources, after, end)


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
    """When a job ends; one of which nothing is left has ended."""
    return max((problem.end(each, starts[each]) for each in problem.jobs[job].tasks), default=0)


def earliest_ends(problem: Instance) -> list[int]:
    """When each job would end if nothing else were worked: none can end before."""
    starts = [0] * len(problem.tasks)
    for job in problem.jobs:
        for task in job.tasks:
            before = (problem.end(each, starts[each]) for each in problem.tasks[task].after)
            starts[task] = 0 if problem.tasks[task].end is not None else max(job.release, *before, 0)
    return [job_end(problem, starts, number) for number in range(len(problem.jobs))]
