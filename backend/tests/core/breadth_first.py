"""Plans by breadth-first search on the reference tick: every set of effects, every sequence of starts, tick by tick.

A start that has been taken in a tick is not taken again in the same one. The fewest starts are kept for each state and
what is still missing of the goals, so the first layer in which nothing is missing has the fewest ticks, then the fewest
starts. Goals that are met already need no plan.
"""

from __future__ import annotations

from dataclasses import dataclass

from sequence_planner.automaton.automaton import Ability, Automaton, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import supervised_start
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.types import Value
from sequence_planner.planning.goals.pursuit import Goals, moved, settled
from sequence_planner.planning.problem import Circumstances
from sequence_planner.planning.validation.replay import missing

from .explicit import outcomes

Key = tuple[Value | None, ...]


@dataclass(frozen=True)
class Shortest:
    """The fewest ticks in which all goals can be reached, and the fewest starts with that many ticks."""

    ticks: int
    starts: int


@dataclass(frozen=True)
class _Node:
    """A state at the end of a tick, what is missing then, and the starts so far."""

    state: State
    goals: Goals
    starts: int


def shortest(
    automaton: Automaton,
    supervisor: Supervisor,
    state: State,
    goals: Goals,
    longest: int,
    circumstances: Circumstances = Circumstances(),
) -> Shortest | None:
    """The shortest plan from `state`, or None if there is none of at most `longest` ticks."""
    helpful = [e for e in automaton.effects if not e.fault and e.resource not in circumstances.offline]
    abilities = [a for a in automaton.abilities.values() if may_start(a, circumstances)]
    seen: set[tuple[Key, Goals]] = set()
    if not missing(goals, state):
        return Shortest(0, 0)
    layer = [_Node(state, missing(goals, state), 0)]
    for ticks in range(1, longest + 1):
        done: list[int] = []
        following: dict[tuple[Key, Goals], _Node] = {}
        for node in layer:
            for after in outcomes(automaton, node.state, helpful):
                left = settled(node.goals, after)
                if left is None or not permitted(after, circumstances):
                    continue
                if not left:
                    done.append(node.starts)
                    continue
                root = _Node(after, left, 0)
                for end in _ends(automaton, supervisor, abilities, node.state, root, circumstances):
                    key = (_key(end.state), end.goals)
                    total = node.starts + end.starts
                    if key not in seen and (key not in following or total < following[key].starts):
                        following[key] = _Node(end.state, end.goals, total)
        if done:
            return Shortest(ticks, min(done))
        seen |= following.keys()
        layer = list(following.values())
    return None


def may_start(ability: Ability, circumstances: Circumstances) -> bool:
    """Whether `circumstances` let the ability start."""
    if ability.resource in circumstances.offline or ability.name in circumstances.barred:
        return False
    return circumstances.restart or not ability.restart


def permitted(position: State, circumstances: Circumstances) -> bool:
    """Whether nothing that is to be avoided holds there, nor is open."""
    return all(evaluate(condition, position) is False for condition in circumstances.avoid)


def _ends(
    automaton: Automaton,
    supervisor: Supervisor,
    abilities: list[Ability],
    published: State,
    root: _Node,
    circumstances: Circumstances,
) -> list[_Node]:
    """Every way in which the tick can end after step 3 has led to `root`, with the number of starts."""
    found = {(_key(root.state), root.goals, frozenset[str]()): root}
    pending = [(root, frozenset[str]())]
    while pending:
        current, taken = pending.pop()
        for ability in abilities:
            if ability.name in taken:
                continue
            after = supervised_start(automaton, supervisor, published, current.state, ability)
            goals = None if after is None else moved(current.goals, after)
            if after is None or goals is None or not permitted(after, circumstances):
                continue
            now = taken | {ability.name}
            if (key := (_key(after), goals, now)) not in found:
                found[key] = _Node(after, goals, len(now))
                pending.append((found[key], now))
    return list(found.values())


def _key(state: State) -> Key:
    return tuple(state.values())
