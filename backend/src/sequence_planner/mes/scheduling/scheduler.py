"""Order scheduler: best dispatch rule improved by bounded search, in a killable worker process."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import Final, TypeAlias

import structlog

from sequence_planner.mes.scheduling.dispatch import (
    RULES,
    Rule,
    by_priority,
    dispatch,
    in_order,
    pack,
    waits_among,
)
from sequence_planner.mes.scheduling.problem import (
    TICK,
    Instance,
    JobWork,
    Schedule,
    Starts,
    Step,
    cost,
    earliest_ends,
    instance,
    job_end,
)
from sequence_planner.process.budget import Budget
from sequence_planner.process.task import WorkerError
from sequence_planner.process.worker import Worker

# The order of work: the best of the dispatch rules' schedules, improved by search within a limit of work.
#
# Where there are very many orders that is done for those that come first (a rolling horizon): it is done anew as soon
# as something has changed, and nobody knows what will come before the last of a thousand orders is begun.

# What the solver takes for a second is two to five of a processor, and a busy machine must be in time too.
EFFORT: Final = 0.1  # of the limit, by the solver's measure
HORIZON: Final = 600  # operations that are searched; rules alone take a second for ten times as many

Times: TypeAlias = dict[Step, tuple[float, float]]


def sequence(
    works: Sequence[JobWork],
    exclusive: Iterable[Collection[str]],
    now: float,
    limit: float,
    remaining: Callable[[], float] = lambda: inf,
    most: int = HORIZON,
) -> Schedule:
    """The order of work after at most about `limit` seconds. The same question has the same answer, unless the search
    ends before because no seconds on the wall are `remaining`.

    Of the jobs of one set in `exclusive` no two overlap: pairs, or larger groups. What counts is the tardiness of jobs
    times their weights, then the time at which all is done, then when each job ends. Of more than `most` operations as
    many are searched as come first, and the others follow by rule. Raises `ValueError` for works that cannot be worked,
    see `instance`.
    """
    from sequence_planner.mes.scheduling.cp_sat import improve  # noqa: PLC0415 - the solver takes a second to import

    groups = [frozenset(each) for each in exclusive]
    problem = instance(works, groups, now)
    if len(problem.tasks) > most:
        return _rolling(works, groups, problem, limit, remaining, most)
    best = min((dispatch(problem, rule) for rule in RULES), key=lambda starts: cost(problem, starts))
    found = improve(problem, best, EFFORT * limit, remaining)
    return replace(_schedule(works, problem, found.starts, found.bound), optimal=found.proven)


def by_rule(works: Sequence[JobWork], exclusive: Iterable[Collection[str]], now: float, why: str) -> Schedule:
    """The order by priority, due time and storage, because of `why`. Raises `ValueError` as `sequence` does."""
    problem = instance(works, exclusive, now)
    many = len(problem.tasks) > HORIZON
    starts = pack(problem, _in_rows(problem, by_priority)) if many else dispatch(problem, by_priority)
    return replace(_schedule(works, problem, starts, 0), fallback=why, horizon=0)


def _rolling(
    works: Sequence[JobWork],
    groups: Sequence[frozenset[str]],
    problem: Instance,
    limit: float,
    remaining: Callable[[], float],
    most: int,
) -> Schedule:
    """Search what comes first, by the best of the rules, by itself; what comes then follows as it was.

    What is around the search takes the machine, however busy it is, about as long behind it as before it.
    """
    before = remaining()
    best = min((pack(problem, _in_rows(problem, rule)) for rule in RULES), key=lambda starts: cost(problem, starts))
    order = sorted(range(len(problem.jobs)), key=lambda job: _place(problem, best, job))
    tasks, near = 0, list[int]()
    for job in order:
        tasks += len(problem.movable(job))
        if near and tasks > most and not problem.jobs[job].begun:
            break
        near.append(job)
    taken = 0.0 if before == inf else before - remaining()

    def left() -> float:
        return remaining() - taken

    found = sequence([works[job] for job in sorted(near)], groups, problem.now, limit, left, len(problem.tasks))
    number = {(problem.jobs[task.job].name, task.name): each for each, task in enumerate(problem.tasks)}
    first = sorted(
        (found.starts[step][0], number[step]) for step in found.starts if problem.tasks[number[step]].end is None
    )
    known = set(near)
    rest = in_order(problem, best, [job for job in order if job not in known])
    candidate = pack(problem, [*(task for _, task in first), *rest])
    starts = min(candidate, best, key=lambda each: cost(problem, each))
    return replace(_schedule(works, problem, starts, 0), horizon=len(near))


def _in_rows(problem: Instance, rule: Rule) -> list[int]:
    """The tasks that have not started, those of one job behind those of another: by rule, what has begun first."""
    jobs = sorted(range(len(problem.jobs)), key=lambda job: (not problem.jobs[job].begun, rule(problem, job), job))
    return [task for job in jobs for task in problem.movable(job)]


def _place(problem: Instance, starts: Starts, job: int) -> tuple[int, int]:
    """Tell where a job stands in a schedule; those that have begun come first."""
    found = problem.jobs[job]
    return -1 if found.begun else min((starts[task] for task in found.tasks), default=0), job


def _schedule(works: Sequence[JobWork], problem: Instance, starts: Starts, bound: int) -> Schedule:
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
        horizon=len(works),
    )
    return replace(schedule, waits=waits_among(works, schedule))


def _begin(work: JobWork, problem: Instance, times: Times, job: int) -> tuple[bool, float, int, int]:
    """By begin: those that have begun first, of equal ones the heavier and then the one that was stored first."""
    found = problem.jobs[job]
    begin = min((times[work.job, name][0] for name in work.operations), default=problem.now)
    return not found.begun, begin, -found.weight, job


# The order of work, answered in time: by a process of its own that can be killed, or else by rule.

LOG = structlog.get_logger(__name__)
_NICENESS = 5  # ticks come first
_ANSWERING: Final = 0.2  # of the time, for what is around the search
LATE: Final = 8.0  # seconds; on a busy machine the best that was found comes later than it was asked for


@dataclass(frozen=True)
class SchedulingQuestion:
    """The jobs that are to be put into an order, as `sequence` is asked."""

    works: tuple[JobWork, ...]
    exclusive: tuple[frozenset[str], ...]
    now: float
    deadline: float


class Sequencer:
    """Has works put into an order. Used from one event loop; one question at a time, the others wait for their turn."""

    def __init__(self, late: float = LATE) -> None:
        self._late = late
        self._turn = asyncio.Lock()
        self._process: Worker[SchedulingQuestion, Schedule] = Worker(
            scheduling, None, "order of work", niceness=_NICENESS, errors=(ValueError,)
        )

    async def sequence(
        self, works: Sequence[JobWork], exclusive: Collection[frozenset[str]], now: float, limit: float
    ) -> Schedule:
        """The order that is the best to be found within `limit` seconds after its turn has come. It is waited for some
        seconds longer, as it is better than none; when there is none by then, the order by rule, which says why in
        `fallback`. Raises `ValueError` for works that cannot be worked.
        """
        question = SchedulingQuestion(tuple(works), tuple(exclusive), now, limit)
        async with self._turn:
            try:
                async with asyncio.timeout(limit + self._late):
                    return await self._process.ask(question, limit)
            except TimeoutError:
                why = f"no order was found within {limit + self._late:g} s"
            except (ValueError, WorkerError) as error:
                why = str(error)
        LOG.warning("the order of work is by rule", why=why, jobs=len(works))
        return await asyncio.to_thread(by_rule, works, exclusive, now, why)

    def close(self) -> None:
        """End the process. Whoever waits has the order by rule."""
        self._process.close()


def scheduling(model: None) -> Callable[[SchedulingQuestion, Budget], Schedule]:
    """Return what answers each question, which raises `ValueError`; a process's life."""
    from sequence_planner.mes.scheduling import cp_sat as windows  # noqa: F401, PLC0415 - imported before the first question

    def answer(question: SchedulingQuestion, budget: Budget) -> Schedule:
        late = _ANSWERING * question.deadline
        remaining = lambda: budget.remaining - late  # noqa: E731
        return sequence(question.works, question.exclusive, question.now, question.deadline, remaining)

    return answer
