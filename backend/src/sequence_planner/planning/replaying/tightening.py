"""Plans with every start as early as it can be, where all that can happen happens at once.

A solver has no reason to prefer one of two plans that are as short as each other, and often lets devices tarry. What is
carried out is closer to the plan, and seldom breaks it, if nothing in it waits without need.
"""

from __future__ import annotations

from collections.abc import Iterable

from sequence_planner.immutable import Immutable, replace
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Task
from sequence_planner.planning.plan import Plan, PlanTick
from sequence_planner.planning.replaying.acceptance import Acceptance, Course, Waypoint
from sequence_planner.planning.replaying.reference_run import ReferenceRun

_MOST_NODES = 400  # then the plan stays as it is


class _Node(Immutable):
    """A run, the starts that are still to come, and the ticks so far."""

    run: ReferenceRun
    order: tuple[str, ...]
    ticks: tuple[PlanTick, ...]
    before: _Node | None = None


_Move = tuple[_Node, str | None]  # one of the starts that are still to come, or a wait


def tightened(acceptance: Acceptance, task: Task, plan: Plan, budget: Budget) -> Course | None:
    """`plan`, which is accepted, with its starts as early as can be, taken step by step on the reference tick.

    None if that takes more ticks, or longer than the budget.
    """
    helpful = tuple(dict.fromkeys(effect for tick in plan.ticks for effect in tick.effects))
    reached: dict[object, int] = {}
    pending: list[_Move] = [(_Node(acceptance.begin(task), tuple(name for _, name in plan.starts), ()), None)]
    for _ in range(_MOST_NODES):
        node = _next(pending, helpful)
        if node is None or budget.spent:
            return None
        if not node.run.goals and not node.order:
            return _course(replace(plan, ticks=node.ticks), node)
        key = (node.run.key, node.order, node.ticks[-1].starts)
        if reached.get(key, len(node.ticks) + 1) <= len(node.ticks):
            continue
        reached[key] = len(node.ticks)
        if len(node.ticks) < len(plan.ticks):
            pending.append((node, None))
        pending += ((node, name) for name in reversed(dict.fromkeys(node.order)))  # the earliest is tried first
    return None


def _next(pending: list[_Move], helpful: Iterable[str]) -> _Node | None:
    """Where the next move leads that can be taken."""
    while pending:
        node, name = pending.pop()
        after = _waited(node, helpful) if name is None else _started(node, name)
        if after is not None:
            return after
    return None


def _waited(node: _Node, helpful: Iterable[str]) -> _Node | None:
    effects = node.run.everything(helpful)
    run = node.run.fork()
    return _Node(run, node.order, (*node.ticks, PlanTick(effects, ())), node) if run.settle(effects) else None


def _started(node: _Node, name: str) -> _Node | None:
    last = node.ticks[-1]
    if name in last.starts or not node.run.may_start(name):
        return None
    run = node.run.fork()
    if not run.start(name):
        return None
    place = node.order.index(name)
    order = node.order[:place] + node.order[place + 1 :]
    return _Node(run, order, (*node.ticks[:-1], PlanTick(last.effects, (*last.starts, name))), node)


def _course(plan: Plan, last: _Node) -> Course:
    way: list[Waypoint] = []
    node: _Node | None = last
    while node is not None and node.ticks:
        way.append(Waypoint(len(node.ticks) - 1, len(node.ticks[-1].starts), node.run))
        node = node.before
    return Course(plan, tuple(reversed(way)))
