"""The order of work: the best of the dispatch rules' schedules, improved by search within a limit of work."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import replace
from math import inf
from typing import Final, TypeAlias

from sequence_planner.mes.sequencing.dispatching import RULES, by_priority, dispatch
from sequence_planner.mes.sequencing.instance import TICK, Instance, Starts, cost, earliest_ends, instance, job_end
from sequence_planner.mes.sequencing.waits import waits_among
from sequence_planner.mes.sequencing.work import Schedule, Step, Work

# What the solver takes for a second is two to five of a processor, and a busy machine must be in time too.
EFFORT: Final = 0.1  # of the limit, by the solver's measure

Times: TypeAlias = dict[Step, tuple[float, float]]


def sequence(
    works: Sequence[Work],
    exclusive: Iterable[Collection[str]],
    now: float,
    limit: float,
    remaining: Callable[[], float] = lambda: inf,
) -> Schedule:
    """The order of work after at most about `limit` seconds. The same question has the same answer, unless the search
    ends before because no seconds on the wall are `remaining`.

    Of the jobs of one set in `exclusive` no two overlap: pairs, or larger groups. What counts is the tardiness of jobs
    times their weights, then the time at which all is done, then when each job ends. Raises `ValueError` for works that
    cannot be worked, see `instance`.
    """
    from sequence_planner.mes.sequencing.windows import improve  # noqa: PLC0415 - the solver takes a second to import

    problem = instance(works, exclusive, now)
    best = min((dispatch(problem, rule) for rule in RULES), key=lambda starts: cost(problem, starts))
    found = improve(problem, best, EFFORT * limit, remaining)
    return replace(_told(works, problem, found.starts, found.bound), optimal=found.proven)


def by_rule(works: Sequence[Work], exclusive: Iterable[Collection[str]], now: float, why: str) -> Schedule:
    """The order by priority, due time and storage, because of `why`. Raises `ValueError` as `sequence` does."""
    problem = instance(works, exclusive, now)
    return replace(_told(works, problem, dispatch(problem, by_priority), 0), fallback=why)


def _told(works: Sequence[Work], problem: Instance, starts: Starts, bound: int) -> Schedule:
    now, ends = problem.now, [job_end(problem, starts, job) for job in range(len(problem.jobs))]
    least = sum(
        job.weight * max(0, end - job.due)
        for job, end in zip(problem.jobs, earliest_ends(problem), strict=True)
        if job.due is not None
    )
    times: Times = {}
    for work, job in zip(works, problem.jobs, strict=True):
        for number in job.tasks:
            task = problem.tasks[number]
            began = work.operations[task.name].started
            start = now + starts[number] * TICK if began is None else began
            times[job.name, task.name] = start, now + problem.end(number, starts[number]) * TICK
    late = {
        job.name: (end - job.due) * TICK
        for job, end in zip(problem.jobs, ends, strict=True)
        if job.due is not None and end > job.due
    }
    order = sorted(range(len(problem.jobs)), key=lambda job: _begin(works[job], problem, times, job))
    schedule = Schedule(
        jobs=[problem.jobs[job].name for job in order],
        starts=times,
        waits={},
        late=late,
        tardiness=cost(problem, starts)[0] * TICK,
        bound=max(bound, least) * TICK,
        optimal=False,
    )
    return replace(schedule, waits=waits_among(works, schedule))


def _begin(work: Work, problem: Instance, times: Times, job: int) -> tuple[bool, float, int, int]:
    """By begin: those that have begun first, of equal ones the heavier and then the one that was stored first."""
    found = problem.jobs[job]
    begin = min((times[work.job, name][0] for name in work.operations), default=problem.now)
    return not found.begun, begin, -found.weight, job
