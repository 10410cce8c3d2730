"""Plans for plain automata: sequences of transitions, in which the environment helps."""

from __future__ import annotations

from collections.abc import Sequence

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.expressions.syntax import TRUE
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.initial_states import best_plan, initial_states
from sequence_planner.planning.plain_answer import PlainAnswer
from sequence_planner.planning.plan import Contract, Goal
from sequence_planner.planning.single.planner import SinglePlanner

_LONGEST = 1000  # transitions, unless it is said otherwise
_SECONDS = 5.0


class PlainPlanner:
    """Plans for one plain automaton under one supervisor, warm from question to question."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._planner = SinglePlanner(automaton, supervisor)

    def answer(
        self,
        goals: Sequence[Goal],
        state: State | None = None,
        contract: Contract = Contract.MINIMAL,
        longest: int = _LONGEST,
        budget: Budget | None = None,
    ) -> PlainAnswer:
        """A way from `state`, or else from the best of the initial states, on which each of `goals` holds somewhere.

        A minimal plan has the fewest transitions, at most `longest`. Without a budget there are five seconds. Raises
        ValueError when `state` is not safe, for goals with a local formula and for too many initial states, and
        `PlannerError` when every engine fails.
        """
        budget = budget or Budget.seconds(_SECONDS)
        if local := [goal.name for goal in goals if goal.local != TRUE]:
            raise ValueError(f"transitions cannot be planned within local formulas: those of {', '.join(local)}")

        def plan_from(start: State, most: int, time_for_it: Budget) -> PlainAnswer:
            if not self._supervisor.safe.includes(start):
                raise ValueError(f"no plan begins outside the safe set: {dict(start)}")
            return self._planner.answer(goals, start, contract, most, time_for_it)

        if state is not None:
            return plan_from(state, longest, budget)
        states = initial_states(self._automaton)
        if len(states) == 1:
            return plan_from(states[0], longest, budget)
        return best_plan(states, plan_from, goals, contract, longest, budget)


def plan_transitions(
    automaton: Automaton,
    supervisor: Supervisor,
    goals: Sequence[Goal],
    state: State | None = None,
    contract: Contract = Contract.MINIMAL,
    longest: int = _LONGEST,
    budget: Budget | None = None,
) -> PlainAnswer:
    """As `PlainPlanner.answer`, asked once."""
    return PlainPlanner(automaton, supervisor).answer(goals, state, contract, longest, budget)
