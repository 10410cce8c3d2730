"""Plans for plain automata: sequences of transitions, in which the environment helps.

Seen as abilities that are done at their start, the transitions of one tick happen one after another, so that any
sequence of transitions is a run of ticks, and the other way round. Heuristic search finds some plan; A*, and where
there are too many states the unrolled run, find the fewest transitions or prove that there are no fewer.
"""

from __future__ import annotations

import time
from collections.abc import Sequence

from sequence_planner.automaton.plain.steps import plain_transitions, step
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Ability, Automaton, Flag, State
from sequence_planner.automaton.tick import synchronise
from sequence_planner.expressions.syntax import FALSE, TRUE
from sequence_planner.immutable import Immutable, replace
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Task
from sequence_planner.planning.heuristic.best_first import HeuristicSearch
from sequence_planner.planning.heuristic.fewest import FewestStarts
from sequence_planner.planning.initial_states import best_plan, initial_states
from sequence_planner.planning.one_at_a_time import OneAtATime
from sequence_planner.planning.pdr.engine import Reachability
from sequence_planner.planning.plain_answer import PlainAnswer
from sequence_planner.planning.plan import Circumstances, Contract, Goal, Proof, Verdict, starts_of
from sequence_planner.planning.planner import PlannerError
from sequence_planner.planning.relaxed.relaxation import reachable, unreached
from sequence_planner.planning.replaying.replay import missing

_LONGEST = 1000  # transitions, unless it is said otherwise
_SECONDS = 5.0


def for_planning(automaton: Automaton) -> Automaton:
    """The plain `automaton` with every transition, also the uncontrollable ones, as an ability done at its start.

    What a supervisor of `automaton` allows, it allows here: no uncontrollable transition leads out of its safe set.
    """
    abilities = {
        name: Ability(name, automaton.name, name, TRUE, t.guard, t.actions, FALSE, FALSE, None, ())
        for name, t in plain_transitions(automaton).items()
    }
    flags = tuple(Flag(ability.flag("enabled"), ability.enabled) for ability in abilities.values())
    return replace(automaton, abilities=abilities, flags=flags, effects=(), one_at_a_time=False, initial=None)


def as_station(automaton: Automaton, start: State, goals: Sequence[Goal]) -> tuple[Automaton, Task]:
    """The plain `automaton` for planning, and the task to reach those of `goals` that do not hold in `start`."""
    derived = for_planning(automaton)
    begin = synchronise(derived, {**dict.fromkeys(derived.types), **start})
    return derived, Task(begin, missing(goals, start))


def plan_transitions(
    automaton: Automaton,
    supervisor: Supervisor,
    goals: Sequence[Goal],
    state: State | None = None,
    contract: Contract = Contract.MINIMAL,
    longest: int = _LONGEST,
    budget: Budget | None = None,
) -> PlainAnswer:
    """A way of the plain `automaton` from `state`, or else from the best of its initial states, on which each of
    `goals` holds in some state.

    A minimal plan has the fewest transitions, at most `longest`. Without a budget there are five seconds. Raises
    ValueError when `state` is not safe, for goals with a local formula and for too many initial states, and
    `PlannerError` when a plan is none by the steps of the automaton.
    """
    budget = budget or Budget.seconds(_SECONDS)

    def plan_from(start: State, most: int, time_for_it: Budget) -> PlainAnswer:
        return _planned(automaton, supervisor, goals, start, contract, most, time_for_it)

    if state is not None:
        return plan_from(state, longest, budget)
    states = initial_states(automaton)
    if len(states) == 1:
        return plan_from(states[0], longest, budget)
    return best_plan(states, plan_from, goals, contract, longest, budget)


def _planned(
    automaton: Automaton,
    supervisor: Supervisor,
    goals: Sequence[Goal],
    start: State,
    contract: Contract,
    longest: int,
    budget: Budget,
) -> PlainAnswer:
    began = time.monotonic()
    if not supervisor.safe.includes(start):
        raise ValueError(f"no plan begins outside the safe set: {dict(start)}")
    if local := [goal.name for goal in goals if goal.local != TRUE]:
        raise ValueError(f"transitions cannot be planned within local formulas: those of {', '.join(local)}")
    derived, task = as_station(automaton, start, goals)
    if task.goals:
        question = _Question(derived, supervisor, start, replace(task, contract=contract), longest)
        found = question.answer(budget)
    else:
        found = _Found((), least=0)
    _verify(automaton, supervisor, goals, start, found.order or ())
    seconds = time.monotonic() - began
    if found.order is not None:
        length = len(found.order)
        searched = min(found.least, length)
        return PlainAnswer(Verdict.FOUND, found.order, searched == length, searched, seconds, found.engine)
    verdict = Verdict.NONE_UP_TO if found.least > longest else Verdict.LATE
    if found.none_at_all:
        verdict = Verdict.NONE_AT_ALL
    return PlainAnswer(verdict, (), False, max(found.least - 1, 0), seconds, found.engine, found.proof)


class _Found(Immutable):
    """What is known: some order, that none has fewer than `least` transitions, or that there is none at all."""

    order: tuple[str, ...] | None = None
    least: int = 1
    engine: str = ""
    none_at_all: bool = False
    proof: Proof | None = None


class _Question(Immutable):
    """What `as_station` makes of a question from `start`, asked of all engines one after the other."""

    derived: Automaton
    supervisor: Supervisor
    start: State
    task: Task
    longest: int

    def answer(self, budget: Budget) -> _Found:
        """The best answer that there is time for."""
        begin = self.task.state
        relaxed = reachable(self.derived, begin, Circumstances())
        if not all(relaxed.may(goal.predicate) for goal in self.task.goals):
            proof = unreached(self.derived, relaxed)
            return _Found(engine="relaxation", none_at_all=True, proof=proof)
        # The flags of abilities that are done at their start say nothing, and cost time.
        bare = replace(self.derived, flags=())
        task = replace(self.task, state={name: begin[name] for name in bare.variables})
        found = self._some(bare, task, budget.part(0.3))
        if found.order is not None and (task.contract is Contract.FAST or budget.spent):
            return found
        found = self._fewest(bare, task, found, budget.part(0.3))
        if found.order is None:
            found = self._proven(found, budget.part(0.5))
        if found.none_at_all or (found.order is not None and found.least >= len(found.order)):
            return found
        return self._bounded(bare, found, budget)

    def _some(self, bare: Automaton, task: Task, budget: Budget) -> _Found:
        ticks = HeuristicSearch(bare, self.supervisor).solve(replace(task, longest=self.longest + 1), budget).plan
        order = None if ticks is None else tuple(name for _, name in starts_of(ticks.ticks))
        return _Found(order if order is not None and len(order) <= self.longest else None, engine=HeuristicSearch.name)

    def _fewest(self, bare: Automaton, task: Task, found: _Found, budget: Budget) -> _Found:
        most = self.longest if found.order is None else len(found.order) - 1
        fewest = FewestStarts(bare, self.supervisor).find(task, most, budget)
        if fewest.order is not None:
            return _Found(fewest.order, fewest.least, FewestStarts.name)
        if fewest.exhausted and found.order is None:
            return _Found(engine=FewestStarts.name, none_at_all=True)
        return replace(found, least=max(fewest.least, found.least))

    def _proven(self, found: _Found, budget: Budget) -> _Found:
        """With a proof that there is no plan at all, if that can be found."""
        # Any order of the abilities will do: each transition could be a tick of its own.
        pdr = Reachability(self.derived, self.supervisor, tuple(self.derived.abilities.values()))
        proof = pdr.solve(replace(self.task, contract=Contract.MINIMAL), budget).proof
        return found if proof is None else replace(found, engine=pdr.name, none_at_all=True, proof=proof)

    def _bounded(self, bare: Automaton, found: _Found, budget: Budget) -> _Found:
        most = self.longest if found.order is None else len(found.order) - 1
        unrolled = OneAtATime(bare, self.supervisor, self.start, self.task.goals)
        order, least = unrolled.fewest(found.least, most, budget)
        if order is not None:
            return _Found(order, least, "bmc")
        return replace(found, least=least)


def _verify(
    automaton: Automaton, supervisor: Supervisor, goals: Sequence[Goal], start: State, plan: Sequence[str]
) -> None:
    """Take the steps one by one."""
    transitions = plain_transitions(automaton)
    current, left = start, missing(goals, start)
    for name in plan:
        after = step(current, transitions[name])
        if after is None or (transitions[name].controllable and not supervisor.allows(current, after)):
            raise PlannerError(f"the plan {' '.join(plan)} fails at {name}, from {dict(current)}")
        current, left = after, missing(left, after)
    if plan and left:
        unreached_goals = ", ".join(goal.name for goal in left)
        raise PlannerError(f"the plan {' '.join(plan)} ends in {dict(current)}, and has not reached {unreached_goals}")
