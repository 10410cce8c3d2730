"""Errands held against the reference tick, step by step and by everything that is demanded of them."""

from __future__ import annotations

from collections.abc import Sequence

from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.structure import Ability, Automaton, State
from sequence_planner.automaton.tick import apply_effects, finish, supervised_start, synchronise
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.immutable import Immutable
from sequence_planner.planning.advice.situation import Situation
from sequence_planner.planning.goals.pursuit import Goals, moved, settled
from sequence_planner.planning.plan import PlanTick
from sequence_planner.planning.way_back import violated

_UNSUPERVISED = Supervisor(StateSet((), ()), {})


class Stop(Immutable):
    """After step 3 of a tick, and the goals of operations that are missing there."""

    state: State
    goals: Goals


class Walk(Immutable):
    """The stops of an errand, one for each tick, and the specifications that it violates though they were not before.

    `unsupervised` says that it starts something outside the safe states.
    """

    stops: tuple[Stop, ...]
    breaks: tuple[str, ...]
    unsupervised: bool

    @property
    def end(self) -> Stop:
        """The last stop."""
        return self.stops[-1]


def walked(automaton: Automaton, supervisor: Supervisor, begin: Situation, ticks: Sequence[PlanTick]) -> Walk | None:
    """The walk that `ticks` are in restart mode; None if they are none, or fail a formula of an operation on the way.

    As long as the state is outside the safe states abilities start by their written guards, and from the first safe
    one on by the supervisor.
    """
    effects = {effect.name: effect for effect in automaton.effects if not effect.fault}
    offline = begin.circumstances.offline
    state, goals = begin.state, begin.goals
    inside, unsupervised = supervisor.safe.includes(state), False
    before = violated(automaton, state)
    broken: set[str] = set()
    stops: list[Stop] = []
    for tick in ticks:
        published = state
        if any(name not in effects or effects[name].resource in offline for name in tick.effects):
            return None
        sensed = apply_effects(state, [effects[name] for name in tick.effects])
        if sensed is None or len({*tick.effects, *tick.starts}) < len(tick.effects) + len(tick.starts):
            return None
        state = synchronise(automaton, finish(automaton, sensed).state)
        left = settled(goals, state)
        if left is None or not _allowed(begin, state):
            return None
        goals = left
        inside = inside or supervisor.safe.includes(state)
        broken.update(violated(automaton, state))
        stops.append(Stop(state, goals))
        for name in tick.starts:
            ability = automaton.abilities[name]
            if _barred(begin, ability):
                return None
            unsupervised = unsupervised or not inside
            after = supervised_start(automaton, supervisor if inside else _UNSUPERVISED, published, state, ability)
            left = None if after is None else moved(goals, after)
            if after is None or left is None or not _allowed(begin, after):
                return None
            state, goals = after, left
            inside = inside or supervisor.safe.includes(state)
            broken.update(violated(automaton, state))
    breaks = tuple(name for name in automaton.specifications if name in broken.difference(before))
    return Walk(tuple(stops), breaks, unsupervised)


def _allowed(begin: Situation, state: State) -> bool:
    return all(evaluate(avoided, state) is False for avoided in begin.circumstances.avoid)


def _barred(begin: Situation, ability: Ability) -> bool:
    """As in restart mode: restart abilities are not."""
    return ability.resource in begin.circumstances.offline or ability.name in begin.circumstances.barred
