"""Side effects: changes that every device makes along with something else, so that nobody has to be told of them too.

A variable that remembers where a robot has been last is no more than that: it becomes what the pose becomes.
"""

from __future__ import annotations

from collections.abc import Collection

from sequence_planner.automaton.automaton import Automaton, target


def is_along(automaton: Automaton, name: str, others: Collection[str]) -> bool:
    """Return whether nothing gives the variable a value but together with one of the others, which can change alone."""
    return any(_comes_with(automaton, name, other) for other in others)


def _comes_with(automaton: Automaton, name: str, other: str) -> bool:
    writes = [{target(action): action.value for action in effect.actions} for effect in automaton.effects]
    both = [each for each in writes if name in each]
    alone = any(other in each and name not in each for each in writes)
    return name != other and alone and bool(both) and all(each.get(other) == each[name] for each in both)
