"""The order of work beside dispatch rules: how late jobs are, weighted, and how long it takes.

Run with `make bench`. The instances are drawn by seed: orders that go through several resources, some with a second
work master that excludes the first, with due times that are tight. Beside ours stand the schedules of two rules, each
of which starts whatever may start by the earliest due time (EDD), or by the most weight for the time to be worked
(WSPT).
"""

from __future__ import annotations

import os
import random
import statistics
import time
from collections.abc import Sequence

from sequence_planner.mes.scheduling.dispatch import Rule, by_due_time, by_weighted_length, dispatch
from sequence_planner.mes.scheduling.problem import TICK, JobWork, WorkOperation, cost, instance
from sequence_planner.mes.scheduling.scheduler import by_rule, sequence

NOW = 1_700_000_000.0
SEEDS = range(5)
RESOURCES = [f"resource-{number}" for number in range(5)]
Exclusive = list[frozenset[str]]


def main() -> None:
    """A line for each kind of instances."""
    load = ", ".join(f"{each:.1f}" for each in os.getloadavg())
    print(f"medians of {len(SEEDS)} instances each; load of the machine {load}")
    print("| jobs | limit | EDD / ours | WSPT / ours | proven | bound / ours | search | by rule |")
    print("|---|---|---|---|---|---|---|---|")
    for jobs, operations, groups, limit in [
        (8, 3, 0, 5.0),
        (15, 3, 0, 5.0),
        (15, 3, 2, 5.0),
        (30, 4, 0, 5.0),
        (100, 3, 0, 10.0),
        (1000, 3, 3, 10.0),
    ]:
        measure(jobs, operations, groups, limit)


def measure(jobs: int, operations: int, groups: int, limit: float) -> None:
    """Compare on one kind of instances: with `groups` work masters, of each of which only one order is worked."""
    figures: list[tuple[float, ...]] = []
    for seed in SEEDS:
        works, exclusive = shop(jobs, operations, groups, seed)
        began = time.perf_counter()
        found = sequence(works, exclusive, NOW, limit)
        took = time.perf_counter() - began
        began = time.perf_counter()
        by_rule(works, exclusive, NOW, "")
        took_rule = time.perf_counter() - began
        ours = max(found.tardiness, TICK)
        edd, wspt = (tardiness(works, exclusive, rule) / ours for rule in (by_due_time, by_weighted_length))
        figures.append((edd, wspt, float(found.optimal), found.bound / ours, took, took_rule))
    edd, wspt, _, bound, took, took_rule = map(statistics.median, zip(*figures, strict=True))
    proven = sum(each[2] for each in figures)
    kind = f"{jobs}, {operations} operations" + (f", {groups} work masters" if groups else "")
    print(
        f"| {kind} | {limit:g} s | {edd:.2f} | {wspt:.2f} | {proven:.0f} of {len(SEEDS)} | {bound:.2f} "
        f"| {took:.2f} s | {took_rule * 1000:.0f} ms |"
    )


def tardiness(works: Sequence[JobWork], exclusive: Exclusive, rule: Rule) -> float:
    """The weighted tardiness by a rule."""
    problem = instance(works, exclusive, NOW)
    return max(cost(problem, dispatch(problem, rule))[0] * TICK, TICK)


def shop(jobs: int, operations: int, groups: int, seed: int) -> tuple[list[JobWork], Exclusive]:
    """Orders, and which of them exclude each other."""
    chance = random.Random(seed)
    works: list[JobWork] = []
    routes = [chance.sample(RESOURCES, operations) for _ in range(groups)]
    # With work masters the station does one order of each at a time, without as many as its resources allow.
    pace = 70.0 * operations / max(groups, 1) if groups else 70.0 * operations / len(RESOURCES)
    for number in range(jobs):
        route = routes[number % groups] if groups else chance.sample(RESOURCES, operations)
        parts = {
            f"operation-{place}": WorkOperation(
                frozenset({f"operation-{place - 1}"} if place else ()),
                float(chance.randint(20, 120)),
                frozenset({resource}),
            )
            for place, resource in enumerate(route)
        }
        due = NOW + chance.uniform(0.1, 1.0) * jobs * pace
        works.append(JobWork(f"order-{number}", chance.randint(0, 4), due, None, parts))
    exclusive = [
        frozenset(work.job for place, work in enumerate(works) if place % groups == kind) for kind in range(groups)
    ]
    return works, exclusive


if __name__ == "__main__":
    main()
