"""Ways back into the safe set for a station that something has taken out of it.

The supervisor says nothing about starts outside, and no guard of it is asked: a way back is a run of ticks in which the
environment helps, without faults, and in which abilities start by their written guards, those for restart too.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.dependencies import cone_of_influence, read_variables
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.tick import apply_effects, finish, supervised_start, synchronise
from sequence_planner.core.immutable import replace
from sequence_planner.language.evaluator import holds
from sequence_planner.language.syntax import Or, Variable
from sequence_planner.planning.planner import PlannerError
from sequence_planner.planning.problem import (
    Circumstances,
    Goal,
    Plan,
    PlanTick,
    RecoveryPath,
    WayBackAnswer,
    WayBackRequest,
)
from sequence_planner.planning.sat.search import Searches, SearchTimeoutError, SoughtPlans
from sequence_planner.planning.sat.start_order import sweep_order
from sequence_planner.process.budget import Budget

# Of the time for an answer, what the search for the way may take; the rest is for what the devices could do.
_SHARE = 0.75

_UNSUPERVISED = Supervisor(StateSet((), ()), {})


class WaysBack:
    """Ways of a station's `automaton` into the set `safe`, warm from question to question."""

    def __init__(self, automaton: Automaton, safe: StateSet) -> None:
        self._automaton = automaton
        self._safe = safe

    def answer(self, request: WayBackRequest, budget: Budget | None = None) -> WayBackAnswer:
        """The shortest way, and what threatens meanwhile. Raises `PlannerError` when a way does not replay.

        `budget` can be called off from another thread; without one the deadline of the request is kept.
        """
        began = time.monotonic()
        budget = budget or Budget.seconds(request.deadline)
        state, way, searched = request.state, None, request.longest
        try:
            way = self.way(state, request.circumstances, request.longest, budget.part(_SHARE))
        except SearchTimeoutError as late:
            searched = late.searched
        threatened = self._threatened(state, request.longest, budget)
        if way is not None:
            searched = len(way.ticks)
        return WayBackAnswer(way, threatened, searched, time.monotonic() - began)

    def way(self, state: State, circumstances: Circumstances, longest: int, budget: Budget) -> RecoveryPath | None:
        """The shortest way of at most `longest` ticks, if there is one.

        Raises `SearchTimeoutError` when the budget is spent before, and `PlannerError` when it does not replay.
        """
        unknown = frozenset(name for name in self._automaton.variables if state[name] is None)
        sought = SoughtPlans(state, (), circumstances, longest, into=self._safe.for_all(unknown))
        plan = self._ways.search(state).plan(sought, budget)
        return None if plan is None else self._replayed(state, plan)

    @cached_property
    def _ways(self) -> Searches:
        free = _free(self._automaton)
        return Searches(free, _UNSUPERVISED, sweep_order(free, _UNSUPERVISED))

    @cached_property
    def _threats(self) -> Searches:
        """Runs without starts in which anything may happen, faults too; threats are plans to violate something."""
        automaton = self._automaton
        everything = replace(
            automaton,
            effects=tuple(replace(effect, fault=False) for effect in automaton.effects),
        )
        return Searches(everything, _UNSUPERVISED, ())

    def _threatened(self, state: State, longest: int, budget: Budget) -> tuple[str, ...]:
        if not self._automaton.specifications or violated(self._automaton, state):
            return ()
        forbidden = Or(tuple(specification.forbidden for specification in self._automaton.specifications.values()))
        goals = (Goal("violated", forbidden),)
        try:
            plan = self._threats.search(state).plan(SoughtPlans(state, goals, Circumstances(), longest), budget)
        except SearchTimeoutError:
            return ()
        if plan is None:
            return ()
        *_, (_, end) = positions(self._automaton, state, plan.ticks)
        return violated(self._automaton, end)

    def _replayed(self, state: State, plan: Plan) -> RecoveryPath:
        ticks = self._until_safe(state, plan.ticks)
        if ticks is None:
            raise PlannerError(f"the way back {plan} does not replay from {dict(state)}")
        ticks = self._without_needless(state, ticks)
        before = violated(self._automaton, state)
        visited = [after for _, after in positions(self._automaton, state, ticks)]
        violating = {name for after in visited for name in violated(self._automaton, after)}
        breaks = tuple(name for name in self._automaton.specifications if name in violating.difference(before))
        return RecoveryPath(ticks, visited[-1], breaks, plan.minimal_starts)

    def _until_safe(self, state: State, ticks: Sequence[PlanTick]) -> tuple[PlanTick, ...] | None:
        """`ticks` up to the first safe state; None when there is none, or they cannot be taken as they are written."""
        for taken, after in positions(self._automaton, state, ticks):
            if self._safe.includes(after):
                return taken
        return None

    def _without_needless(self, state: State, ticks: tuple[PlanTick, ...]) -> tuple[PlanTick, ...]:
        """The way without the effects that it does not need, so that nobody waits for them."""
        for number, effect in [(number, name) for number, tick in enumerate(ticks) for name in tick.effects]:
            tick = ticks[number]
            lighter = replace(tick, effects=tuple(name for name in tick.effects if name != effect))
            fewer = (*ticks[:number], lighter, *ticks[number + 1 :])
            if self._until_safe(state, fewer) == fewer:
                ticks = fewer
        return ticks


def violated(automaton: Automaton, state: State) -> tuple[str, ...]:
    """The specifications that `state` violates for certain."""
    return tuple(s.name for s in automaton.specifications.values() if holds(s.forbidden, state))


def positions(
    automaton: Automaton, state: State, ticks: Iterable[PlanTick]
) -> Iterator[tuple[tuple[PlanTick, ...], State]]:
    """The states after step 3 and after each start of a run from `state`, by the reference tick and written guards,
    each with the ticks taken so far; it ends where `ticks` cannot be taken any further.
    """
    effects = {effect.name: effect for effect in automaton.effects}
    taken: tuple[PlanTick, ...] = ()
    for tick in ticks:
        published = state
        sensed = apply_effects(state, [effects[name] for name in tick.effects])
        if sensed is None:
            return
        state = synchronise(automaton, finish(automaton, sensed).state)
        yield (*taken, PlanTick(tick.effects, ())), state
        for number, name in enumerate(tick.starts, start=1):
            after = supervised_start(automaton, _UNSUPERVISED, published, state, automaton.abilities[name])
            if after is None:
                return
            state = after
            yield (*taken, PlanTick(tick.effects, tick.starts[:number])), state
        taken = (*taken, tick)


def deciding(automaton: Automaton, safe: StateSet) -> tuple[str, ...]:
    """The variables and flags that answers depend on: in states that agree on them, an answer is as good as another."""
    asked = [specification.forbidden for specification in automaton.specifications.values()]
    asked += [Variable(name, automaton.variables[name].type) for name in safe.names]
    # A start may also wait for any output to be published.
    names = {*cone_of_influence(_free(automaton), asked), *automaton.outputs}
    flags = [flag.name for flag in automaton.flags if read_variables(automaton, (flag.predicate,)) <= names]
    return (*(name for name in automaton.variables if name in names), *flags)


def _free(automaton: Automaton) -> Automaton:
    """The same without a mode in which abilities may start."""
    abilities = {name: replace(ability, restart=False) for name, ability in automaton.abilities.items()}
    return replace(automaton, abilities=abilities)
