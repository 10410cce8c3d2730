"""What corrections claim: that work is done, or nearer to its end, although nobody has done anything.

Only somebody who has looked knows whether that is so. Believed without being so it is a false record of the product.
"""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.automaton.structure import Automaton, Operation, State
from sequence_planner.expressions.evaluation import holds
from sequence_planner.expressions.syntax import Expression, conjuncts
from sequence_planner.planning.goals.pursuit import Goals


def claimed(automaton: Automaton, goals: Goals, before: State, after: State) -> tuple[str, ...]:
    """The goals that a correction from `before` to `after` claims, by the names of their operations.

    Of `goals`, those of active operations, each of which some part holds then and did not before. Of all others each
    that holds then and did not before, unless work is undone with it, which the station then does once more: that the
    bolts are only placed brings the goal of placing them about too, and claims nothing.
    """
    asked = {goal.name for goal in goals}
    nearer = [goal.name for goal in goals if any(_begins(part, before, after) for part in conjuncts(goal.predicate))]
    others = [name for name, each in automaton.operations.items() if name not in asked]
    done = [name for name in others if _begins(automaton.operations[name].goal, before, after)]
    if done and any(holds(each.precondition, after) for each in _undone(automaton, before, after)):
        done = []
    return (*nearer, *done)


def _undone(automaton: Automaton, before: State, after: State) -> Iterator[Operation]:
    return (each for each in automaton.operations.values() if _begins(each.goal, after, before))


def _begins(predicate: Expression, before: State, after: State) -> bool:
    return holds(predicate, after) and not holds(predicate, before)
