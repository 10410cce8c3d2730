"""Plans for plain automata: sequences of transitions, in which the environment helps.

The planner unrolls ticks. Seen as abilities that are done at their start, the transitions of one tick happen one after
another, so that any sequence of transitions is a run of ticks, and the other way round. The fewest ticks are not the
fewest transitions: several fit into one tick if they come in the order of declaration.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

from sequence_planner.automaton.plain.meaning import event_of
from sequence_planner.automaton.plain.steps import plain_transitions, step
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Ability, Automaton, Flag, State
from sequence_planner.automaton.tick import synchronise
from sequence_planner.expressions.evaluation import holds
from sequence_planner.expressions.syntax import FALSE, TRUE
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.plan import Circumstances, Verdict, goals_of
from sequence_planner.planning.planner import PlannerError
from sequence_planner.planning.relaxation import unreachable_goals
from sequence_planner.planning.search import Search, SearchTimeoutError


@dataclass(frozen=True)
class PlainAnswer:
    """Whether there is a plan, and its transitions by name; `searched` is the number of transitions up to which the
    search is complete.
    """

    verdict: Verdict
    transitions: tuple[str, ...]
    searched: int
    seconds: float

    @property
    def events(self) -> tuple[str, ...]:
        """The events of the plan."""
        return tuple(map(event_of, self.transitions))


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


def plan_transitions(
    automaton: Automaton,
    supervisor: Supervisor,
    goal: str,
    state: State | None = None,
    longest: int = 60,
    deadline: float = 5.0,
) -> PlainAnswer:
    """A way of the plain `automaton` from `state`, or else from its declared initial state, to the operation `goal`.

    Searches up to `longest` transitions, for at most `deadline` seconds. Raises ValueError when `state` is not safe,
    and `PlannerError` when a plan is none by the steps of the automaton.
    """
    began = time.monotonic()
    start = automaton.initial_valuation if state is None else state
    if not supervisor.safe.includes(start):
        raise ValueError(f"no plan begins outside the safe set: {dict(start)}")
    derived = for_planning(automaton)
    begin = synchronise(derived, {**dict.fromkeys(derived.types), **start})
    goals = goals_of(automaton, (goal,))
    transitions: tuple[str, ...] | None = None
    verdict, searched = Verdict.NONE_UP_TO, longest
    if holds(automaton.operations[goal].goal, start):
        transitions = ()
    elif unreachable_goals(derived, begin, goals, Circumstances()):
        verdict = Verdict.NONE_AT_ALL
    else:
        # The goal is seen at the beginning of a tick: one more than there are transitions.
        search = Search(derived, supervisor, tuple(derived.abilities.values()), frozenset())
        try:
            plan = search.plan(begin, goals, Circumstances(), longest + 1, Budget(began + deadline))
            transitions = None if plan is None else tuple(name for _, name in plan.starts)
        except SearchTimeoutError as late:
            searched = max(late.searched - 1, 0)
        finally:
            search.close()
    if transitions is None:
        return PlainAnswer(verdict, (), searched, time.monotonic() - began)
    _verify(automaton, supervisor, goal, start, transitions)
    return PlainAnswer(Verdict.FOUND, transitions, searched, time.monotonic() - began)


def _verify(automaton: Automaton, supervisor: Supervisor, goal: str, start: State, plan: Sequence[str]) -> None:
    """Take the steps one by one."""
    transitions = plain_transitions(automaton)
    current = start
    for name in plan:
        after = step(current, transitions[name])
        if after is None or (transitions[name].controllable and not supervisor.allows(current, after)):
            raise PlannerError(f"the plan {' '.join(plan)} for {goal} fails at {name}, from {dict(current)}")
        current = after
    if not holds(automaton.operations[goal].goal, current):
        raise PlannerError(f"the plan {' '.join(plan)} ends in {dict(current)}, where {goal} is not reached")
