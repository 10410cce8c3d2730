"""The transitions of one event of a plain automaton: `grab`, `grab#2`, `grab#3`."""

from __future__ import annotations

NUMBER_SIGN = "#"  # what tells them apart


def event_of(transition: str) -> str:
    """The event of a transition, by its name."""
    return transition.partition(NUMBER_SIGN)[0]
