"""More jobs than can be searched at once: a window of them slides over the schedule.

The jobs stand in the order in which they begin. A window of the first is put to where these are best, the first half of
it stays there, and the window moves on to the next. What comes behind the window follows in the order that it had. The
first window, which is worked next, has half of the work; the others share the rest until it is spent. A window's answer
is taken only if the whole is better for it: a gain in front may be a loss behind.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from sequence_planner.mes.sequencing.dispatching import in_order, pack
from sequence_planner.mes.sequencing.instance import Instance, Starts, cost
from sequence_planner.mes.sequencing.solving import solve

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
    """Where a job stands: those that have begun come first."""
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
