"""The fewest starts of plans with so many ticks.

Sets of starts are collected of which every plan has one, until a plan has no more starts than these demand (Morgado et
al. 2014, *Core-guided MaxSAT with soft cardinality constraints*). Where there is no time for that, the starts of one
plan that it can do without are left out.
"""

from __future__ import annotations

from collections.abc import Sequence

from sequence_planner.planning.budget import Budget
from sequence_planner.planning.plan import Contract, Plan, PlanTick
from sequence_planner.planning.sat.unrolling import Unrolling

# Of the time that is left, what a fast plan may still cost once there is one.
_SHARE = 0.02
_PROVING = 0.8  # of a minimal one, for the proof that no other has fewer starts


def fewest_starts(
    unrolling: Unrolling, given: Sequence[int], length: int, starting: int, contract: Contract, budget: Budget
) -> Plan:
    """The plan of `length` ticks, of which the first `starting` have starts, under the assumptions `given`.

    The solver has just found one. Of a fast contract, it is only tried for a moment whether there are fewer.
    """
    model = unrolling.solver.model()
    ticks, proven = unrolling.read(length, starting, model), False
    if contract is Contract.MINIMAL:
        ticks, proven = _proven_fewest(unrolling, given, ticks, starting, budget.part(_PROVING))
    if not proven:
        ticks = _without_needless(unrolling, given, ticks, model, starting, budget)
    if contract is Contract.FAST:
        ticks, proven = _proven_fewest(unrolling, given, ticks, starting, budget.part(_SHARE))
    return Plan(ticks, minimal_ticks=True, minimal_starts=proven)


def _count(ticks: Sequence[PlanTick]) -> int:
    return sum(len(tick.starts) for tick in ticks)


def _without_needless(
    unrolling: Unrolling,
    given: Sequence[int],
    ticks: tuple[PlanTick, ...],
    model: Sequence[int],
    starting: int,
    budget: Budget,
) -> tuple[PlanTick, ...]:
    """The plan of a model of the solver, less the starts without which the rest of it still is one."""
    choices = set(unrolling.starts(starting))
    taken = choices.intersection(model)
    kept: list[int] = []
    model = []
    while taken.difference(kept):
        choice = min(taken.difference(kept))
        left_out = [-each for each in choices - taken]
        answer = unrolling.solver.solve([*given, *left_out, -choice], budget)
        if answer is None:
            break
        if answer:
            model = unrolling.solver.model()
            taken = choices.intersection(model)
        else:
            kept.append(choice)
    return unrolling.read(len(ticks), starting, model) if model else ticks


def _proven_fewest(
    unrolling: Unrolling, given: Sequence[int], ticks: tuple[PlanTick, ...], starting: int, budget: Budget
) -> tuple[tuple[PlanTick, ...], bool]:
    """The plan with the fewest starts, which are at most those of `ticks`, and whether it is proven."""
    circuit, solver = unrolling.circuit, unrolling.solver
    most, demanded = _count(ticks), 0
    assumed = dict.fromkeys(-choice for choice in unrolling.starts(starting))
    counters: dict[int, tuple[list[int], int]] = {}  # an assumption that not so many are true, with those for more
    while demanded < most:
        answer = solver.solve([*given, *assumed], budget)
        if answer is None:
            return ticks, False
        if answer:
            return unrolling.read(len(ticks), starting, solver.model()), True
        core = [literal for literal in solver.core() if literal in assumed]
        demanded += 1
        further: list[tuple[list[int], int]] = []
        for literal in core:
            del assumed[literal]
            if literal in counters:
                further.append(counters.pop(literal))
        if len(core) > 1:
            further.append((circuit.counted([-literal for literal in core], most - demanded + 1), 0))
        for numbers, several in further:
            if several + 1 < len(numbers):
                following = -numbers[several + 1]
                assumed[following] = None
                counters[following] = (numbers, several + 1)
    return ticks, True
