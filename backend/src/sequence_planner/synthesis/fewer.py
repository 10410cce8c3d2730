"""Supervisors of some of a station's specifications, for those who ask which of them matter."""

from __future__ import annotations

from dataclasses import replace

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.synthesis.supervision import synthesise


class FewerSpecifications:
    """The supervisor of `automaton` with only some of its specifications; `whole` is that of all of them.

    With fewer specifications more states are safe, so there is one whenever there is `whole`. Each is computed once.
    """

    def __init__(self, automaton: Automaton, whole: Supervisor) -> None:
        self._automaton = automaton
        self._known = {frozenset(automaton.specifications): whole}

    def __call__(self, names: frozenset[str]) -> Supervisor:
        """The supervisor of the specifications with these names."""
        if names not in self._known:
            kept = {name: each for name, each in self._automaton.specifications.items() if name in names}
            self._known[names] = synthesise(replace(self._automaton, specifications=kept))
        return self._known[names]
