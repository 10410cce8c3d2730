"""Schedules by dispatch rules or from a given sequence, and the resulting waits between jobs."""

from __future__ import annotations

from bisect import insort
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Sequence
from heapq import heapify, heappop, heappush
from itertools import islice
from math import inf
from typing import Final, TypeAlias

from sequence_planner.mes.scheduling.problem import Instance, JobWork, Schedule, Starts, Step

# Schedules without search: by dispatch rules, and by a given sequence of tasks.

_LOOK: Final = 100  # tasks that are looked at whenever something may start, the first by rank

Rank: TypeAlias = tuple[float, float]
Rule: TypeAlias = Callable[[Instance, int], Rank]
"""Rank of a job; the lowest comes first, of equal ones the one that was stored first."""


def by_priority(problem: Instance, job: int) -> Rank:
    """The highest weight first, then the earliest due time."""
    found = problem.jobs[job]
    return -found.weight, inf if found.due is None else found.due


def by_due_time(problem: Instance, job: int) -> Rank:
    """The earliest due time first (EDD), then the highest weight."""
    heavy, due = by_priority(problem, job)
    return due, heavy


def by_weighted_length(problem: Instance, job: int) -> Rank:
    """The most weight for the time that is to be worked first (weighted shortest processing time), then EDD."""
    length = sum(problem.tasks[task].length for task in problem.movable(job))
    heavy, due = by_priority(problem, job)
    return heavy / max(length, 1), due


RULES: Final[tuple[Rule, ...]] = (by_priority, by_due_time, by_weighted_length)


def dispatch(problem: Instance, rule: Rule) -> list[int]:
    """A schedule in which whatever may start does so at once, by rank where not all can."""
    return _Dispatching(problem, [rule(problem, job) for job in range(len(problem.jobs))]).run()


class _Dispatching:
    def __init__(self, problem: Instance, ranks: Sequence[Rank]) -> None:
        self._problem = problem
        self._ranks = ranks
        self._starts = [0] * len(problem.tasks)
        self._pending = [len(task.after) for task in problem.tasks]  # tasks that it still comes after
        self._next: list[list[int]] = [[] for _ in problem.tasks]
        self._left = [len(job.tasks) for job in problem.jobs]
        self._under_way = [job.begun for job in problem.jobs]
        begun = (
            (group, job) for job, groups in enumerate(problem.groups) if problem.jobs[job].begun for group in groups
        )
        self._active = Counter(group for group, job in begun if self._left[job])
        self._closed = set(self._active)  # the groups of jobs that are under way
        self._groups = [frozenset(groups) for groups in problem.groups]
        self._used: Counter[str] = Counter()
        self._busy: set[str] = set()
        self._ready: list[tuple[Rank, int]] = []
        self._coming: list[tuple[int, int]] = []  # (time, task) of what is only held up by the job's release
        self._running: list[tuple[int, int]] = []
        for number, task in enumerate(problem.tasks):
            for before in task.after:
                self._next[before].append(number)
            if task.end is not None:
                self._run(number, task.end)
            elif not task.after:
                self._coming.append((problem.jobs[task.job].release, number))
        heapify(self._coming)

    def run(self) -> list[int]:
        now = 0
        while True:
            while self._running and self._running[0][0] <= now:
                self._end(heappop(self._running)[1])
            while self._coming and self._coming[0][0] <= now:
                task = heappop(self._coming)[1]
                insort(self._ready, (self._ranks[self._problem.tasks[task].job], task))
            self._start(now)
            times = [each[0][0] for each in (self._running, self._coming) if each]
            if not times:
                return self._starts
            now = min(times)

    def _start(self, now: int) -> None:
        tasks, busy, closed = self._problem.tasks, self._busy, self._closed
        # If nothing runs, what keeps the first ones from starting may be a job whose next task ranks far behind.
        for entry in list(islice(self._ready, _LOOK if self._running else None)):
            task = tasks[entry[1]]
            if task.resources.isdisjoint(busy) and (
                self._under_way[task.job] or self._groups[task.job].isdisjoint(closed)
            ):
                self._ready.remove(entry)
                self._starts[entry[1]] = now
                self._run(entry[1], now + task.length)

    def _run(self, number: int, end: int) -> None:
        task = self._problem.tasks[number]
        self._used.update(task.resources)
        self._busy |= task.resources
        heappush(self._running, (end, number))
        if not self._under_way[task.job]:
            self._under_way[task.job] = True
            self._active.update(self._groups[task.job])
            self._closed |= self._groups[task.job]

    def _end(self, number: int) -> None:
        task = self._problem.tasks[number]
        self._used.subtract(task.resources)
        self._busy.difference_update(each for each in task.resources if not self._used[each])
        self._left[task.job] -= 1
        if not self._left[task.job]:
            self._active.subtract(self._groups[task.job])
            self._closed.difference_update(each for each in self._groups[task.job] if not self._active[each])
        for after in self._next[number]:
            self._pending[after] -= 1
            if not self._pending[after] and self._problem.tasks[after].end is None:
                heappush(self._coming, (self._problem.jobs[task.job].release, after))


def pack(problem: Instance, sequence: Iterable[int]) -> list[int]:
    """A schedule in which each task of the sequence starts as early as those before it let it.

    Tasks come after those that they wait for, and the jobs of a group one after the other, those that have begun first.
    """
    starts, ends = [0] * len(problem.tasks), [0] * len(problem.tasks)
    free: dict[str, int] = {}
    over = [0] * len(problem.rivals)  # when the jobs of a group end that come before the `current` one
    current: list[int | None] = [None] * len(problem.rivals)
    current_end = [0] * len(problem.rivals)

    def place(number: int, start: int) -> None:
        task = problem.tasks[number]
        starts[number], ends[number] = start, problem.end(number, start)
        for resource in task.resources:
            free[resource] = max(free.get(resource, 0), ends[number])
        for group in problem.groups[task.job]:
            if problem.jobs[task.job].begun:
                over[group] = max(over[group], ends[number])
            else:
                current_end[group] = max(current_end[group], ends[number])

    for number, task in enumerate(problem.tasks):
        if task.end is not None:
            place(number, 0)
    for number in sequence:
        task = problem.tasks[number]
        start = problem.jobs[task.job].release
        start = max(start, *(ends[each] for each in task.after), *(free.get(each, 0) for each in task.resources), 0)
        if not problem.jobs[task.job].begun:
            for group in problem.groups[task.job]:
                if current[group] != task.job:
                    over[group] = max(over[group], current_end[group])
                    current[group] = task.job
                start = max(start, over[group])
        place(number, start)
    return starts


def in_order(problem: Instance, starts: Starts, jobs: Iterable[int] | None = None) -> list[int]:
    """The tasks that have not started, of all or of some jobs, in the order of their starts."""
    numbers = range(len(problem.jobs)) if jobs is None else jobs
    return sorted((task for job in numbers for task in problem.movable(job)), key=lambda task: (starts[task], task))


# What a schedule means for the controller: which operations wait for which of other jobs.


def waits_among(
    works: Sequence[JobWork], schedule: Schedule, jobs: Collection[str] | None = None
) -> dict[Step, list[Step]]:
    """Tell which operations of these jobs (all: None) wait for which of others of them, and for no more than is needed.

    Two operations of different jobs with a common resource are worked in the order in which they are expected to start.
    Left out is what follows from the rest and from the order inside the jobs. So one that waits for another through a
    third waits for it directly where the job of the third is not among these.
    """
    steps = [
        (schedule.starts[work.job, name][0], number, name)
        for number, work in enumerate(works)
        if jobs is None or work.job in jobs
        for name in work.operations
    ]
    return _waits(works, _before_each_other(works, steps))


def _before_each_other(works: Sequence[JobWork], steps: list[tuple[float, int, str]]) -> list[tuple[int, str]]:
    """By start; those that have started come first."""
    fresh = {(number, name): works[number].operations[name].started is None for _, number, name in steps}
    return [(number, name) for _, number, name in sorted(steps, key=lambda each: (fresh[each[1], each[2]], each))]


def _waits(works: Sequence[JobWork], order: list[tuple[int, str]]) -> dict[Step, list[Step]]:
    """Sets of steps are the bits of numbers: there can be thousands, each with thousands before it."""
    place = {step: number for number, step in enumerate(order)}
    before = [0] * len(order)  # all that a step comes after
    on_resource, of_job = dict[str, int](), dict[int, int]()
    found: dict[Step, list[Step]] = {}
    for number, (job, name) in enumerate(order):
        operation = works[job].operations[name]
        for each in sorted(operation.after):
            if (earlier := place.get((job, each))) is not None and earlier < number:
                before[number] |= before[earlier] | 1 << earlier
        if operation.started is None:
            others = 0
            for resource in operation.resources:
                others |= on_resource.get(resource, 0)
            others &= ~of_job.get(job, 0) & ~before[number]
            direct: list[Step] = []
            while others:  # the latest first: what it comes after is said by it
                latest = others.bit_length() - 1
                direct.append((works[order[latest][0]].job, order[latest][1]))
                before[number] |= before[latest] | 1 << latest
                others &= ~before[number]
            if direct:
                found[works[job].job, name] = sorted(direct)
        of_job[job] = of_job.get(job, 0) | 1 << number
        for resource in operation.resources:
            on_resource[resource] = on_resource.get(resource, 0) | 1 << number
    return found
