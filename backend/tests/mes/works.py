"""Works to put into an order, drawn at random and searched through without any cleverness."""

from __future__ import annotations

import itertools
import random
from collections.abc import Collection, Sequence
from dataclasses import replace
from math import inf

from hypothesis import strategies as st

from sequence_planner.mes.scheduling.problem import JobWork, Schedule, WorkOperation, weight

NOW = 1_700_000_000.0
RESOURCES = ("arm", "press", "table")
Exclusive = list[frozenset[str]]


@st.composite
def questions(draw: st.DrawFn, most: int = 5) -> tuple[list[JobWork], Exclusive]:
    """Up to so many operations of up to three jobs, in whole seconds, some of which have started."""
    works: list[JobWork] = []
    left = draw(st.integers(1, most))
    for number in range(draw(st.integers(1, 3))):
        size = draw(st.integers(0, min(left, 3)))
        left -= size
        operations = {f"o{place}": _operation(draw, place) for place in range(size)}
        works.append(
            JobWork(
                f"job-{number}",
                draw(st.integers(-1, 3)),
                draw(st.none() | st.integers(-10, 20).map(lambda seconds: NOW + seconds)),
                draw(st.none() | st.integers(-5, 8).map(lambda seconds: NOW + seconds)),
                operations,
                draw(st.booleans()),
            )
        )
    names = [work.job for work in works]
    groups = draw(st.lists(st.sets(st.sampled_from([*names, "gone"]), max_size=3).map(frozenset), max_size=2))
    return works, groups


def _operation(draw: st.DrawFn, place: int) -> WorkOperation:
    return WorkOperation(
        draw(
            st.sets(st.sampled_from([*(f"o{each}" for each in range(place)), "completed"]), max_size=2).map(frozenset)
        ),
        float(draw(st.integers(1, 6))),
        draw(st.sets(st.sampled_from(RESOURCES), max_size=2).map(frozenset)),
        None if place or draw(st.integers(0, 3)) else NOW - draw(st.integers(0, 8)),
    )


def begun(work: JobWork) -> bool:
    return work.begun or any(each.started is not None for each in work.operations.values())


def best(works: Sequence[JobWork], exclusive: Exclusive) -> tuple[float, float]:
    """The least weighted tardiness and with it the least end of all, by trying every sequence of the operations."""
    steps = [
        (number, name)
        for number, work in enumerate(works)
        for name, operation in work.operations.items()
        if operation.started is None
    ]
    return min((_cost(works, exclusive, sequence) for sequence in itertools.permutations(steps)), default=(inf, inf))


def _cost(works: Sequence[JobWork], exclusive: Exclusive, sequence: tuple[tuple[int, str], ...]) -> tuple[float, float]:
    """What comes of it if each operation, in this sequence, starts as early as those before it let it."""
    spans: dict[tuple[int, str], tuple[float, float]] = {}
    for number, work in enumerate(works):
        for name, operation in work.operations.items():
            if operation.started is not None:
                spans[number, name] = 0.0, max(0.0, operation.started + operation.seconds - NOW)
    for number, name in sequence:
        work, operation = works[number], works[number].operations[name]
        if any((number, each) not in spans for each in operation.after & work.operations.keys()):
            return inf, inf
        start = 0.0 if begun(work) or work.earliest is None else max(0.0, work.earliest - NOW)
        for (other, its), (_, end) in spans.items():
            if other == number and its in operation.after:
                start = max(start, end)
            if works[other].operations[its].resources & operation.resources:
                start = max(start, end)
            if _rivals(works, exclusive, other, number) and not begun(work):
                start = max(start, end)
        spans[number, name] = start, start + operation.seconds
    if not _apart(works, exclusive, spans):
        return inf, inf
    ends = [max((spans[number, name][1] for name in work.operations), default=0.0) for number, work in enumerate(works)]
    tardiness = sum(
        weight(work.priority) * max(0.0, end - (work.due - NOW))
        for work, end in zip(works, ends, strict=True)
        if work.due is not None
    )
    return tardiness, max(ends, default=0.0)


def _apart(works: Sequence[JobWork], exclusive: Exclusive, spans: dict[tuple[int, str], tuple[float, float]]) -> bool:
    """Whether no two rivals overlap, and those that have begun come first."""
    for one, other in itertools.permutations(range(len(works)), 2):
        if not _rivals(works, exclusive, one, other) or begun(works[other]):
            continue
        mine, its = ([spans[job, name] for name in works[job].operations] for job in (one, other))
        if not mine or not its:
            continue
        before = max(end for _, end in mine) <= min(start for start, _ in its)
        after = max(end for _, end in its) <= min(start for start, _ in mine)
        if not (before or (after and not begun(works[one]))):
            return False
    return True


def _rivals(works: Sequence[JobWork], exclusive: Exclusive, one: int, other: int) -> bool:
    return one != other and any({works[one].job, works[other].job} <= group for group in exclusive)


def objective(works: Sequence[JobWork], schedule: Schedule) -> tuple[float, float]:
    """Weighted tardiness and the end of all, counted from the times alone."""
    tardiness = last = 0.0
    for work in works:
        end = max((schedule.starts[work.job, name][1] for name in work.operations), default=NOW) - NOW
        last = max(last, end)
        if work.due is not None:
            tardiness += weight(work.priority) * max(0.0, end - (work.due - NOW))
    return tardiness, last


def check(works: Sequence[JobWork], exclusive: Collection[frozenset[str]], schedule: Schedule) -> None:
    """Whatever else an order is like, it can be worked."""
    steps = [(work, name) for work in works for name in work.operations]
    assert sorted(schedule.jobs) == sorted(work.job for work in works)
    assert schedule.starts.keys() == {(work.job, name) for work, name in steps}
    for work, name in steps:
        operation, (start, end) = work.operations[name], schedule.starts[work.job, name]
        if operation.started is not None:
            assert start == operation.started
            continue
        assert end - start >= operation.seconds - 1e-6
        assert start >= NOW
        assert begun(work) or work.earliest is None or start >= work.earliest - 1e-6
        assert all(
            schedule.starts[work.job, each][1] <= start + 1e-6 for each in operation.after & work.operations.keys()
        )
    _check_resources(steps, schedule)
    spans = {
        work.job: (
            min(schedule.starts[work.job, name][0] for name in work.operations),
            max(schedule.starts[work.job, name][1] for name in work.operations),
        )
        for work in works
        if work.operations
    }
    under_way = {work.job for work in works if begun(work)}
    for group in exclusive:
        inside = sorted((spans[job][0], spans[job][1], job) for job in group if job in spans and job not in under_way)
        assert all(one[1] <= other[0] + 1e-6 for one, other in itertools.pairwise(inside))
        ends = [spans[job][1] for job in group if job in spans and job in under_way]
        assert not ends or not inside or max(ends) <= inside[0][0] + 1e-6


def _check_resources(steps: Sequence[tuple[JobWork, str]], schedule: Schedule) -> None:
    on: dict[str, list[tuple[float, float, bool]]] = {}
    for work, name in steps:
        fixed = work.operations[name].started is not None
        for resource in work.operations[name].resources:
            on.setdefault(resource, []).append((*schedule.starts[work.job, name], fixed))
    for spans in on.values():
        moved = sorted(span for span in spans if not span[2])
        assert all(one[1] <= other[0] + 1e-6 for one, other in itertools.pairwise(moved))
        last = max((end for _, end, fixed in spans if fixed), default=NOW)
        assert all(start >= last - 1e-6 for start, _, _ in moved)


def shop(jobs: int, seed: int, operations: int = 3, tight: float = 1.0) -> list[JobWork]:
    """Orders as they come to a station of several resources: each through some of them, due after about its share."""
    chance = random.Random(seed)
    works: list[JobWork] = []
    for number in range(jobs):
        route = chance.sample(RESOURCES, min(operations, len(RESOURCES)))
        parts = {
            f"o{place}": WorkOperation(
                frozenset({f"o{place - 1}"} if place else ()), float(chance.randint(20, 120)), frozenset({resource})
            )
            for place, resource in enumerate(route)
        }
        due = NOW + tight * chance.uniform(0.2, 1.0) * jobs * 70
        works.append(JobWork(f"order-{number}", chance.randint(0, 4), due, None, parts))
    return works


def with_times(works: Sequence[JobWork], seconds: float) -> list[JobWork]:
    """The same, but that every operation takes so long."""
    return [
        replace(work, operations={name: replace(each, seconds=seconds) for name, each in work.operations.items()})
        for work in works
    ]
