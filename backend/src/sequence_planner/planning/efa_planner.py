"""Planner for plain automata: transition sequences, and the best plan over all initial states."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from itertools import islice
from math import inf
from typing import Final

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.plain.valuations import TooEntangledError, valuations_of
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.core.immutable import replace
from sequence_planner.language.syntax import TRUE
from sequence_planner.planning.plain_answer import PlainAnswer
from sequence_planner.planning.problem import Contract, Goal, Verdict
from sequence_planner.planning.single.planner import SinglePlanner
from sequence_planner.planning.validation.replay import missing
from sequence_planner.process.budget import Budget

# The best plan of a plain automaton over all of its initial states.

MOST_INITIAL: Final = 100  # states that are planned from, one after the other
_SAY_ONE: Final = "say with --state in which one to begin"

PlanFrom = Callable[[State, int, Budget], PlainAnswer]
"""A plan from a state, of at most so many transitions."""


def initial_states(automaton: Automaton) -> list[State]:
    """All of them. Raises ValueError when they are more than `MOST_INITIAL`, or are not found in reasonable time."""
    if automaton.initial is None:
        return [automaton.initial_valuation]
    try:
        types = {name: variable.type for name, variable in automaton.variables.items()}
        found = [*islice(valuations_of(automaton.initial, types), MOST_INITIAL + 1)]
    except TooEntangledError:
        raise ValueError(f"the initial states were not found in reasonable time: {_SAY_ONE}") from None
    if len(found) > MOST_INITIAL:
        raise ValueError(f"`initial` describes more than {MOST_INITIAL} states: {_SAY_ONE}")
    return [{**automaton.initial_valuation, **values} for values in found]


def best_plan(
    states: Sequence[State],
    plan_from: PlanFrom,
    goals: Sequence[Goal],
    contract: Contract,
    longest: int,
    budget: Budget,
) -> PlainAnswer:
    """The best of the plans from `states`, which share the time: the shortest, or by the fast contract the first.

    It is minimal where none from any of the states is shorter, and there is none at all where there is none from each.
    """
    began = time.monotonic()
    ordered = sorted(states, key=lambda state: bool(missing(goals, state)))  # where all hold already there is no better
    answers: list[tuple[State, PlainAnswer]] = []
    best: PlainAnswer | None = None
    for number, state in enumerate(ordered):
        most = longest if best is None else len(best.transitions) - 1
        answer = plan_from(state, most, budget.part(1 / (len(ordered) - number)))
        answers.append((state, answer))
        if answer.verdict is Verdict.FOUND:
            best = replace(answer, begin=state)
            if contract is Contract.FAST or len(best.transitions) <= 1:
                break
    seconds = time.monotonic() - began
    if best is not None:
        rest = ordered[len(answers) :]
        least = min([*(_least(answer) for _, answer in answers), *(float(bool(missing(goals, each))) for each in rest)])
        searched = int(min(least, len(best.transitions)))
        return replace(best, minimal=searched == len(best.transitions), searched=searched, seconds=seconds)
    open_ = [answer for _, answer in answers if answer.verdict is not Verdict.NONE_AT_ALL]
    if not open_:
        return PlainAnswer(Verdict.NONE_AT_ALL, (), False, 0, seconds, answers[-1][1].engine)
    verdict = Verdict.LATE if any(each.verdict is Verdict.LATE for each in open_) else Verdict.NONE_UP_TO
    return PlainAnswer(verdict, (), False, min(each.searched for each in open_), seconds)


def _least(answer: PlainAnswer) -> float:
    """No plan from there has fewer transitions."""
    match answer.verdict:
        case Verdict.FOUND:
            return answer.searched
        case Verdict.NONE_AT_ALL:
            return inf
        case _:
            return answer.searched + 1


# Plans for plain automata: sequences of transitions, in which the environment helps.

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
