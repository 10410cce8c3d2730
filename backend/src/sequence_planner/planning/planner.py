"""The planner: all goals together, or as many as can be planned together, and no answer that does not replay."""

from __future__ import annotations

import time

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.plan import Plan, PlanAnswer, PlanRequest, Verdict
from sequence_planner.planning.relaxation import unreachable_goals
from sequence_planner.planning.replay import Replay, missing
from sequence_planner.planning.search import Searches, SearchTimeoutError
from sequence_planner.planning.sweep import sweep_order


class PlannerError(Exception):
    """A plan did not replay on the reference tick: the planner and the tick disagree, and nothing may be started."""


class Planner:
    """Plans for one automaton under one supervisor, warm from question to question."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._replay = Replay(automaton, supervisor)
        self._searches = Searches(automaton, supervisor, sweep_order(automaton, supervisor))

    def answer(self, request: PlanRequest) -> PlanAnswer:
        """The plan for as many of the goals as can be planned together, the lowest priority given up first.

        Raises `PlannerError` when a plan does not replay.
        """
        began = time.monotonic()
        budget = Budget(began + request.deadline)
        impossible = unreachable_goals(self._automaton, request.state, request.goals, request.circumstances)
        goals = sorted(
            (goal for goal in request.goals if goal not in impossible), key=lambda goal: (-goal.priority, goal.name)
        )
        verdict = Verdict.NONE_AT_ALL
        searched = 0
        plan: Plan | None = None
        while goals and plan is None:
            left = missing(goals, request.state)
            if not left:
                plan = Plan((), minimal_ticks=True, minimal_starts=True)
                break
            try:
                # Each attempt gets half of what is left, so that fewer goals still have their turn.
                plan = self._searches.search(request.state).plan(
                    request.state, left, request.circumstances, request.longest, budget.part(0.5)
                )
                searched = request.longest
            except SearchTimeoutError as late:
                searched = late.searched
            if plan is None:
                verdict = Verdict.NONE_UP_TO
                goals = [] if budget.spent else goals[:-1]
        seconds = time.monotonic() - began
        names = tuple(goal.name for goal in goals)
        left_out = tuple(goal.name for goal in request.goals if goal not in goals)
        if plan is None:
            return PlanAnswer(verdict, None, (), left_out, searched, seconds)
        tightened = self._replay.tightened(request.state, goals, plan)
        for each in (plan, tightened):
            if not self._replay.exactly(request.state, request.state, goals, (), each.ticks):
                raise PlannerError(f"the plan {each} for {goals} does not replay from {dict(request.state)}")
        plan = tightened
        seconds = time.monotonic() - began
        return PlanAnswer(Verdict.FOUND, plan, names, left_out, len(plan.ticks), seconds)
