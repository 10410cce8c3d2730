"""The answer to a question about a plain automaton."""

from __future__ import annotations

from sequence_planner.automaton.automaton import State
from sequence_planner.automaton.plain.events import event_of
from sequence_planner.core.immutable import Immutable
from sequence_planner.planning.problem import Proof, Verdict


class PlainAnswer(Immutable):
    """The answer whether there is a plan, and its transitions by name; `minimal` says that it is proven that none has
    fewer.

    No plan has up to `searched` transitions, or, when there is a plan, none has fewer than `searched`. `engine` gave
    the answer. That there is none at all is proven by `proof`, or, without one, by having looked at all that can be
    reached. Of several initial states `begin` is the one from which the plan leads.
    """

    verdict: Verdict
    transitions: tuple[str, ...]
    minimal: bool
    searched: int
    seconds: float
    engine: str = ""
    proof: Proof | None = None
    begin: State | None = None

    @property
    def events(self) -> tuple[str, ...]:
        """The events of the plan."""
        return tuple(map(event_of, self.transitions))
