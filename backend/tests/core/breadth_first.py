"""Plans by breadth-first search on the reference tick: every set of effects, every sequence of starts, tick by tick.

A start that has been taken in a tick is not taken again in the same one. The fewest starts are kept for each state and
set of goals already reached, so the first layer in which all goals are reached has the fewest ticks, then the fewest
starts. Goals that are met already need no plan.
"""

from __future__ import annotations

from dataclasses import dataclass

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.automaton.tick import supervised_start
from sequence_planner.expressions.evaluation import holds
from sequence_planner.expressions.types import Value

from .explicit import outcomes

Key = tuple[Value | None, ...]


@dataclass(frozen=True)
class Shortest:
    """The fewest ticks in which all goals can be reached, and the fewest starts with that many ticks."""

    ticks: int
    starts: int


@dataclass(frozen=True)
class _Node:
    state: State
    reached: frozenset[str]
    starts: int


def shortest(
    automaton: Automaton, supervisor: Supervisor, state: State, goals: frozenset[str], longest: int
) -> Shortest | None:
    """The shortest plan from `state`, or None if there is none of at most `longest` ticks."""
    helpful = [effect for effect in automaton.effects if not effect.fault]
    seen: set[tuple[Key, frozenset[str]]] = set()
    met = frozenset(goal for goal in goals if holds(automaton.operations[goal].goal, state))
    if met == goals:
        return Shortest(0, 0)
    layer = [_Node(state, met, 0)]
    for ticks in range(1, longest + 1):
        done: list[int] = []
        following: dict[tuple[Key, frozenset[str]], _Node] = {}
        for node in layer:
            for after in outcomes(automaton, node.state, helpful):
                reached = node.reached | {g for g in goals if holds(automaton.operations[g].goal, after)}
                if reached == goals:
                    done.append(node.starts)
                    continue
                for end, starts in _ends(automaton, supervisor, node.state, after):
                    key = (_key(end), reached)
                    total = node.starts + starts
                    if key not in seen and (key not in following or total < following[key].starts):
                        following[key] = _Node(end, reached, total)
        if done:
            return Shortest(ticks, min(done))
        seen |= following.keys()
        layer = list(following.values())
    return None


def _ends(automaton: Automaton, supervisor: Supervisor, published: State, state: State) -> list[tuple[State, int]]:
    """Every state in which the tick can end after step 3 has led to `state`, with the number of starts."""
    found = {(_key(state), frozenset[str]()): (state, 0)}
    pending = [(state, frozenset[str]())]
    while pending:
        current, taken = pending.pop()
        for ability in automaton.abilities.values():
            if ability.restart or ability.name in taken:
                continue
            after = supervised_start(automaton, supervisor, published, current, ability)
            if after is None:
                continue
            now = taken | {ability.name}
            if (_key(after), now) not in found:
                found[_key(after), now] = (after, len(now))
                pending.append((after, now))
    return list(found.values())


def _key(state: State) -> Key:
    return tuple(state.values())
