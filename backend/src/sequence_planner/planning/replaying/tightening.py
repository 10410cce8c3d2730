"""Plans with every start as early as it can be, where all that can happen happens at once.

A solver has no reason to prefer one of two plans that are as short as each other, and often lets devices tarry. What is
carried out is closer to the plan, and seldom breaks it, if nothing in it waits without need.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from sequence_planner.automaton.compiled import CompiledTick
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Task
from sequence_planner.planning.heuristic.space import Position, Space
from sequence_planner.planning.plan import Plan, PlanTick

_MOST_NODES = 400  # then the plan stays as it is


@dataclass(frozen=True)
class _Node:
    """A position, the starts that are still to come, and the ticks so far."""

    position: Position
    order: tuple[str, ...]
    ticks: tuple[PlanTick, ...]


class Tightening:
    """Tightens plans of one automaton under one supervisor."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._compiled = CompiledTick(automaton, hot=False)
        self._supervisor = supervisor

    def tightened(self, task: Task, plan: Plan, budget: Budget) -> Plan:
        """`plan` with its starts as early as can be; as it is if that takes more ticks, or longer than the budget."""
        space = Space(self._compiled, self._supervisor, task, at_once=False)
        helpful = tuple(dict.fromkeys(effect for tick in plan.ticks for effect in tick.effects))
        order = tuple(name for _, name in plan.starts)
        reached: dict[object, int] = {}
        pending = [_Node(space.begin(), order, ())]
        for _ in range(_MOST_NODES):
            if not pending or budget.spent:
                break
            node = pending.pop()
            if not node.position.goals and not node.order:
                return replace(plan, ticks=node.ticks)
            key = (node.position.key, node.order)
            if reached.get(key, len(node.ticks) + 1) <= len(node.ticks):
                continue
            reached[key] = len(node.ticks)
            if len(node.ticks) < len(plan.ticks):
                pending += _waited(space, node, helpful)
            pending += reversed(_started(space, node))
        return plan


def _waited(space: Space, node: _Node, helpful: tuple[str, ...]) -> list[_Node]:
    effects = space.everything(node.position, helpful)
    later = space.wait(node.position, effects)
    return [] if later is None else [_Node(later, node.order, (*node.ticks, PlanTick(effects, ())))]


def _started(space: Space, node: _Node) -> list[_Node]:
    """The start of each that can start now, the earliest of the order first."""
    nodes: list[_Node] = []
    for name in dict.fromkeys(node.order):
        after = space.start(node.position, name)
        if after is not None:
            place = node.order.index(name)
            last = node.ticks[-1]
            ticks = (*node.ticks[:-1], PlanTick(last.effects, (*last.starts, name)))
            nodes.append(_Node(after, node.order[:place] + node.order[place + 1 :], ticks))
    return nodes
