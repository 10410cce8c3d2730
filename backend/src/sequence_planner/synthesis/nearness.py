"""Which variables are near to a start: what it is about, then what is specified together with that, and so on.

What a supervisor adds to a start is about few variables, and these are near to it. So they are sought there first,
instead of leaving out one after the other all those that are not.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.structure import Automaton
from sequence_planner.automaton.transitions import Transition, starting, transitions


class Nearness:
    """What is near to what in `automaton`, among the variables `names`."""

    def __init__(self, automaton: Automaton, names: Collection[str]) -> None:
        self._automaton = automaton
        self._names = frozenset(names)
        specified = [
            read_variables(automaton, (specification.forbidden,)) & self._names
            for specification in automaton.specifications.values()
        ]
        self._related = (specified, [self._about(each) for each in transitions(automaton)])

    def around(self, ability: str) -> Iterator[frozenset[str]]:
        """Wider and wider sets of variables around the start of an ability, and all of them in the end."""
        found = self._about(starting(self._automaton.abilities[ability]))
        before = None
        while found != before:
            before = found
            for related in self._related:
                yield found
                found = _widened(found, related)
        if found != self._names:
            yield self._names

    def _about(self, transition: Transition) -> frozenset[str]:
        read = read_variables(self._automaton, (transition.guard,))
        return (read | transition.reads | transition.writes) & self._names


def _widened(found: frozenset[str], related: Sequence[frozenset[str]]) -> frozenset[str]:
    return found.union(*(each for each in related if not each.isdisjoint(found)))
