"""The goals of a running station: of each active operation how far its local formula has come, and what it forbade.

The positions of a formula are the state at its operation's activation, then every state after step 3 and after each
start, up to the first after step 3 that satisfies the goal. None is counted before production is started, since till
then nobody steers the station. What unknown values leave open counts as violated: nobody can say that it was kept.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.control.moment import Moment
from sequence_planner.planning.goals.pursuit import moved, settled
from sequence_planner.planning.plan import Goal, goal_of


@dataclass(frozen=True)
class Pursued:
    """What is pursued. Each step gives a new one.

    `violated` says when the formula of an operation was violated, from then until the operation is activated again.
    """

    goals: Mapping[str, Goal] = field(default_factory=dict)
    violated: Mapping[str, Moment] = field(default_factory=dict)

    def activated(self, automaton: Automaton, names: Iterable[str], state: State, now: Moment) -> Pursued:
        """Operations are activated in `state`, the first position of their formulas."""
        fresh = {name: goal_of(automaton.operations[name]) for name in names}
        violated = {name: since for name, since in self.violated.items() if name not in fresh}
        return _stepped({**self.goals, **fresh}, violated, fresh, state, now)

    def settled(self, completed: Iterable[str], state: State, now: Moment) -> Pursued:
        """Step 3 has led to `state`, which satisfies the goals of `completed`: the last position of these."""
        done = set(completed)
        broken = [name for name in done & self.goals.keys() if settled((self.goals[name],), state) is None]
        violated = {**dict.fromkeys(broken, now), **self.violated}
        going_on = {name: goal for name, goal in self.goals.items() if name not in done}
        return _stepped(going_on, violated, going_on, state, now)

    def moved(self, state: State, now: Moment) -> Pursued:
        """A start has led to `state`."""
        return _stepped(self.goals, self.violated, self.goals, state, now)

    def without(self, names: Iterable[str]) -> Pursued:
        """Operations are pursued no longer, and what they violated is forgotten."""
        gone = set(names)
        if gone.isdisjoint(self.goals) and gone.isdisjoint(self.violated):
            return self
        return Pursued(
            {name: goal for name, goal in self.goals.items() if name not in gone},
            {name: since for name, since in self.violated.items() if name not in gone},
        )

    @property
    def hopeful(self) -> frozenset[str]:
        """The operations whose goals can still be reached as their formulas demand."""
        return frozenset(name for name in self.goals if name not in self.violated)

    def of(self, names: Iterable[str]) -> tuple[Goal, ...]:
        """The goals of operations, in order of their names."""
        return tuple(self.goals[name] for name in sorted(names))


def _stepped(
    goals: Mapping[str, Goal], violated: Mapping[str, Moment], stepping: Iterable[str], state: State, now: Moment
) -> Pursued:
    """The formulas of those `stepping` go on to `state`; one that has been violated stays where it is."""
    after, broken = dict(goals), dict(violated)
    for name in stepping:
        if name in broken:
            continue
        stepped = moved((after[name],), state)
        if stepped is None:
            broken[name] = now
        else:
            (after[name],) = stepped
    return Pursued(after, broken)
