"""Schedule improvement with CP-SAT: exact search on a sliding window of jobs."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import inf
from typing import Final

from ortools.sat.python import cp_model

from sequence_planner.mes.scheduling.dispatch import in_order, pack
from sequence_planner.mes.scheduling.problem import Instance, Starts, cost

# Some of the jobs scheduled by CP-SAT, beside tasks that stay where they are.
#
# What counts is minimised in turn, each with what counts more no worse than it was found (lexicographic optimisation):
# weighted tardiness, the end of all, the sum of weighted ends. One worker, one seed and a limit in the solver's own
# measure of work make the same question have the same answer on every machine.

_Interval = tuple[int, int]
_SHARES = (0.6, 0.7, 1.0)  # of the work that is left, for each of what is minimised


@dataclass(frozen=True)
class Solved:
    """The starts of the tasks, in place of the given starts. `bounds` are of weighted tardiness and of the end of all,
    and `proven` says that both are met.
    """

    starts: list[int]
    bounds: tuple[int, int]
    proven: bool


def solve(
    problem: Instance,
    jobs: Sequence[int],
    placed: Iterable[int],
    given: Starts,
    work: float,
    remaining: Callable[[], float],
) -> Solved:
    """The tasks of `jobs` that have not started, put to where they are best; the tasks `placed` stay as in `given`.

    `given` is a schedule, than which this one is no worse for these jobs. `work` is about in seconds; it ends
    before that when no seconds are `remaining`.
    """
    return _Solving(problem, jobs, placed, given, remaining).run(work)


class _Solving:
    def __init__(
        self,
        problem: Instance,
        jobs: Sequence[int],
        placed: Iterable[int],
        given: Starts,
        remaining: Callable[[], float],
    ) -> None:
        self._problem = problem
        self._jobs = jobs
        self._remaining = remaining
        self._best = list(given)
        self._tasks = [task for job in jobs for task in problem.movable(job)]
        self._placed = list(placed) + [number for number, task in enumerate(problem.tasks) if task.end is not None]
        lengths = sum(problem.tasks[task].length for task in self._tasks)
        last = max((problem.end(task, given[task]) for task in self._placed), default=0)
        self._horizon = max(last, *(problem.jobs[job].release for job in jobs), 0) + lengths
        self._model = cp_model.CpModel()
        self._starts: dict[int, cp_model.IntVar] = {}
        self._ends: dict[int, cp_model.IntVar] = {}  # of jobs
        self._add_tasks()
        self._add_resources()
        self._add_rivals()
        self._objectives = self._add_objectives()

    def run(self, work: float) -> Solved:
        bounds, proven = [0, 0, 0], True
        for place, (objective, share) in enumerate(zip(self._objectives, _SHARES, strict=True)):
            found = cost(self._problem, self._best, self._jobs)[place]
            if not self._tasks or (place == 0 and not found):
                bounds[place] = found
                self._model.add(objective <= self._in_model(place))
                continue
            spent, bound = self._minimise(objective, share * work)
            work = max(work - spent, 0.0)
            bounds[place] = bound + self._constant(place)
            value = cost(self._problem, self._best, self._jobs)[place]
            if place < 2:
                proven = proven and bounds[place] >= value
                self._model.add(objective <= self._in_model(place))
        return Solved(self._best, (bounds[0], bounds[1]), proven)

    def _minimise(self, objective: cp_model.LinearExprT, work: float) -> tuple[float, int]:
        """Minimise, and return how much work it took, and what the objective cannot be below."""
        self._model.minimize(objective)
        self._model.clear_hints()  # type: ignore[no-untyped-call]
        for task, start in self._starts.items():
            self._model.add_hint(start, self._best[task])
        solver = cp_model.CpSolver()
        solver.parameters.num_workers = 1
        solver.parameters.interleave_search = True  # the one worker takes turns with all strategies, the local ones too
        solver.parameters.random_seed = 1
        solver.parameters.max_deterministic_time = max(work, 1e-3)
        if (left := self._remaining()) < inf:  # a machine that is busier than was thought
            solver.parameters.max_time_in_seconds = max(left, 1e-3)
        status = solver.solve(self._model)
        if status in (cp_model.INFEASIBLE, cp_model.MODEL_INVALID):
            raise RuntimeError(f"the schedule that was given is none of the model: {solver.status_name(status)}")
        if status in (cp_model.OPTIMAL, cp_model.FEASIBLE):
            for task, start in self._starts.items():
                self._best[task] = solver.value(start)
        return solver.response_proto.deterministic_time, round(solver.best_objective_bound)

    def _add_tasks(self) -> None:
        problem, model = self._problem, self._model
        for number in self._tasks:
            task = problem.tasks[number]
            release = problem.jobs[task.job].release
            known = [problem.end(each, self._best[each]) for each in task.after if each not in self._starts]
            earliest = max(release, *known, 0)
            self._starts[number] = model.new_int_var(earliest, self._horizon, "")
            for before in task.after:
                if before in self._starts:
                    model.add(self._starts[number] >= self._starts[before] + problem.tasks[before].length)
        for job in self._jobs:
            own = problem.jobs[job].tasks
            known = [problem.end(each, self._best[each]) for each in own if each not in self._starts]
            end = self._ends[job] = model.new_int_var(max(known, default=0), self._horizon + 1, "")
            for each in problem.movable(job):
                model.add(end >= self._starts[each] + problem.tasks[each].length)

    def _add_resources(self) -> None:
        problem, model = self._problem, self._model
        wanted: dict[str, list[cp_model.IntervalVar]] = defaultdict(list)
        for number, start in self._starts.items():
            interval = model.new_fixed_size_interval_var(start, problem.tasks[number].length, "")
            for resource in problem.tasks[number].resources:
                wanted[resource].append(interval)
        busy: dict[str, list[_Interval]] = defaultdict(list)
        for number in self._placed:
            span = self._best[number], problem.end(number, self._best[number])
            for resource in problem.tasks[number].resources:
                busy[resource].append(span)
        for resource, intervals in wanted.items():
            model.add_no_overlap([*intervals, *self._fixed(busy[resource])])

    def _add_rivals(self) -> None:
        """No two jobs of a group overlap; those that have begun come first, whatever they do beside each other."""
        problem, model = self._problem, self._model
        spans: dict[int, tuple[cp_model.IntVar, cp_model.IntervalVar]] = {}
        others = self._spans()
        for job in self._jobs:
            if problem.groups[job] and problem.movable(job) and not problem.jobs[job].begun:
                begin = model.new_int_var(problem.jobs[job].release, self._horizon, "")
                for each in problem.movable(job):
                    model.add(begin <= self._starts[each])
                size = model.new_int_var(0, self._horizon + 1, "")
                spans[job] = begin, model.new_interval_var(begin, size, self._ends[job], "")
        for group in problem.rivals:
            new = [job for job in group if job in spans]
            if not new:
                continue
            fixed = [others[job] for job in group if job in others]
            model.add_no_overlap([*(spans[job][1] for job in new), *self._fixed(fixed)])
            for job in group:
                if job in self._ends and problem.jobs[job].begun:
                    for after in new:
                        model.add(spans[after][0] >= self._ends[job])

    def _spans(self) -> Mapping[int, _Interval]:
        """From begin to end, of the other jobs that are there."""
        found: dict[int, _Interval] = {}
        for number in self._placed:
            job = self._problem.tasks[number].job
            if job not in self._ends:
                start = self._best[number]
                begin, end = found.get(job, (start, 0))
                found[job] = min(begin, start), max(end, self._problem.end(number, start))
        return found

    def _fixed(self, intervals: list[_Interval]) -> Iterator[cp_model.IntervalVar]:
        """The intervals, those that overlap as one."""
        begin, until = 0, 0
        for start, end in [*sorted(intervals), (self._horizon + 1, self._horizon + 1)]:
            if start <= until:
                until = max(until, end)
                continue
            if until > begin:
                yield self._model.new_fixed_size_interval_var(begin, until - begin, "")
            begin, until = start, end

    def _add_objectives(self) -> tuple[cp_model.LinearExprT, ...]:
        problem, model = self._problem, self._model
        tardy: list[cp_model.LinearExprT] = []
        makespan = model.new_int_var(0, self._horizon + 1, "")
        for job in self._jobs:
            model.add(makespan >= self._ends[job])
            if (due := problem.jobs[job].due) is not None:
                late = model.new_int_var(0, self._horizon + 1, "")
                model.add(late >= self._ends[job] - max(due, 0))
                tardy.append(problem.jobs[job].weight * late)
        ends = sum(problem.jobs[job].weight * self._ends[job] for job in self._jobs)
        return sum(tardy), makespan, ends

    def _constant(self, place: int) -> int:
        """Return what the model leaves out: how late jobs are already, which no order changes."""
        if place:
            return 0
        jobs = (self._problem.jobs[job] for job in self._jobs)
        return sum(job.weight * -job.due for job in jobs if job.due is not None and job.due < 0)

    def _in_model(self, place: int) -> int:
        return cost(self._problem, self._best, self._jobs)[place] - self._constant(place)


# More jobs than can be searched at once: a window of them slides over the schedule.
#
# The jobs stand in the order in which they begin. A window of the first is put to where these are best, the first half
# of it stays there, and the window moves on to the next. What comes behind the window follows in the order that it had.
# The first window, which is worked next, has half of the work; the others share the rest until it is spent. A window's
# answer is taken only if the whole is better for it: a gain in front may be a loss behind.

MOST_JOBS: Final = 24
MOST_TASKS: Final = 80
_AROUND: Final = 0.02  # of the work that a window takes beyond the search in it


@dataclass(frozen=True)
class Improved:
    """A schedule; of all jobs, weighted tardiness cannot be below `bound`, and it is `proven` that none is better."""

    starts: list[int]
    bound: int
    proven: bool


def improve(problem: Instance, given: Starts, work: float, remaining: Callable[[], float]) -> Improved:
    """A schedule no worse than the given one, after about so many seconds of work, or when none are `remaining`."""
    starts = list(given)
    waiting = sorted(range(len(problem.jobs)), key=lambda job: _begin(problem, starts, job))
    done: list[int] = []  # jobs that stay
    left = work
    while waiting and left > 0.0 and remaining() > 0.0:
        window = _window(problem, waiting)
        behind = waiting[len(window) :]
        whole = not done and not behind
        share = left if whole else left / 2 if not done else left / 8
        left -= share + _AROUND
        solved = solve(problem, window, in_order(problem, starts, done), starts, share, remaining)
        sequence = in_order(problem, solved.starts, [*done, *window]) + in_order(problem, starts, behind)
        candidate = pack(problem, sequence)
        if cost(problem, candidate) <= cost(problem, starts):
            starts = candidate
        if whole:
            return Improved(starts, solved.bounds[0], solved.proven)
        window.sort(key=lambda job: _begin(problem, starts, job))
        stays = max(len(window) // 2, 1) if behind else len(window)
        done += window[:stays]
        waiting = window[stays:] + behind
    return Improved(starts, 0, not problem.jobs)


def _begin(problem: Instance, starts: Starts, job: int) -> tuple[int, int]:
    """Tell where a job stands: those that have begun come first."""
    found = problem.jobs[job]
    return -1 if found.begun else min((starts[task] for task in found.tasks), default=0), job


def _window(problem: Instance, waiting: list[int]) -> list[int]:
    """As many of the first as can be searched at once, one at least."""
    tasks = 0
    for place, job in enumerate(waiting[:MOST_JOBS]):
        tasks += len(problem.movable(job))
        if place and tasks > MOST_TASKS:
            return waiting[:place]
    return waiting[:MOST_JOBS]
