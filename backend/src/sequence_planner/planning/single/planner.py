"""The planner of automata whose starts are taken one at a time: plans are known, mended, or found by engines."""

from __future__ import annotations

import time
from collections.abc import Sequence, Set

from sequence_planner.automaton.plain.steps import plain_transitions, step
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.immutable import Immutable, replace
from sequence_planner.planning.attempt import Attempt
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.demands import Starts
from sequence_planner.planning.engine import Finding, Task
from sequence_planner.planning.engines import Engines, Report
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.plain_answer import PlainAnswer
from sequence_planner.planning.plan import Contract, Goal, Plan, Verdict, one_by_one, starts_of
from sequence_planner.planning.planner import PlannerError
from sequence_planner.planning.recollection import NAME as RECOLLECTION
from sequence_planner.planning.repair import NAME as REPAIR
from sequence_planner.planning.replaying.replay import missing
from sequence_planner.planning.single.derived import without_flags
from sequence_planner.planning.single.detours import Detours
from sequence_planner.planning.single.engines import LANE, PROVING, factories
from sequence_planner.planning.single.neighbourhood import shortened
from sequence_planner.planning.single.stepping import Stepping
from sequence_planner.planning.single.ways import Ways

# Of the time that it took to find a plan, and in seconds of the processor: what it may cost to shorten it.
_SHARE, _LEAST, _MOST = 0.5, 0.02, 0.5
_AGAIN = 2  # times that each of its starts is taken, on average


class _Taken(Immutable):
    """The states that a plan leads through, and the goals missing in each."""

    states: tuple[State, ...]
    missing: tuple[Goals, ...]


class SinglePlanner:
    """Plans for one plain automaton under one supervisor, warm from question to question."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        bare = without_flags(automaton)
        self._supervisor = supervisor
        self._transitions = plain_transitions(automaton)
        starts = Starts(bare, supervisor)
        self._ways = Ways(starts)
        self._stepping = Stepping(bare, supervisor)
        self._detours = Detours(self._stepping, self._ways)
        self._engines = Engines(bare, supervisor, LANE, factories(starts))
        self._last: tuple[Plan, _Taken] | None = None

    def answer(
        self, goals: Sequence[Goal], state: State, contract: Contract, longest: int, budget: Budget
    ) -> PlainAnswer:
        """A way from the safe `state` on which each of `goals` holds in some state."""
        began = time.monotonic()
        left = missing(goals, state)
        if not left:
            return PlainAnswer(Verdict.FOUND, (), True, 0, time.monotonic() - began)
        known = self._ways.known(state, left)
        if known is not None and len(known.order) <= longest and (known.minimal or contract is Contract.FAST):
            length = len(known.order)
            searched = length if known.minimal else 1
            return PlainAnswer(
                Verdict.FOUND, known.order, known.minimal, searched, time.monotonic() - began, RECOLLECTION
            )
        task = Task(state, left, contract=contract, longest=longest + 1, depth=longest + 1)
        attempt = Attempt(task, lambda plan: self._accepts(task, plan), budget)
        mended = self._detours.found(state, left, budget)
        without: Set[str] = frozenset()
        if mended is not None and len(mended) <= longest:
            attempt.take(Report(REPAIR, Finding(one_by_one(mended), searched=2)))  # some goal is missing
            # Only a shorter one is of use.
            task, without = replace(task, longest=len(mended), depth=len(mended)), PROVING
        for report in () if _enough(attempt) else self._engines.work(task, budget, lambda: attempt.patience, without):
            attempt.take(report)
            if report.finding.plan is not None:
                self._shorten(attempt, budget)
            if _enough(attempt) or not attempt.patience:
                break
        if attempt.troubles and not attempt.heard and not budget.spent:
            raise PlannerError("; ".join(attempt.troubles))
        return self._answered(attempt, longest, time.monotonic() - began)

    def _shorten(self, attempt: Attempt, budget: Budget) -> None:
        """Look for a shorter plan near one that does the same again and again, for some of the time that it took.

        Others are seldom much longer than needed.
        """
        plan, task = attempt.plan, attempt.task
        if plan is None or plan.minimal_ticks or len(plan.starts) < _AGAIN * len(set(_order(plan))):
            return
        seconds = min(max(_SHARE * attempt.took, _LEAST), _MOST)
        shorter = shortened(_order(plan), task.state, task.goals, self._stepping, budget.working(seconds))
        if shorter is not None:
            attempt.take(Report(attempt.engine, Finding(one_by_one(shorter), searched=attempt.searched)))

    def _answered(self, attempt: Attempt, longest: int, seconds: float) -> PlainAnswer:
        plan, searched = attempt.plan, max(attempt.searched - 1, 0)
        if plan is not None:
            order = _order(plan)
            assert self._last is not None
            taken = self._last[1] if self._last[0] == plan else self._taken(attempt.task, order)
            assert taken is not None
            self._ways.keep(order, taken.states, taken.missing, plan.minimal_ticks)
            searched = len(order) if plan.minimal_ticks else max(searched, 1)
            return PlainAnswer(Verdict.FOUND, order, plan.minimal_ticks, searched, seconds, attempt.engine)
        if attempt.impossible:
            return PlainAnswer(Verdict.NONE_AT_ALL, (), False, 0, seconds, attempt.engine, attempt.proof)
        verdict = Verdict.NONE_UP_TO if searched >= longest else Verdict.LATE
        return PlainAnswer(verdict, (), False, searched, seconds, attempt.engine)

    def _accepts(self, task: Task, plan: Plan) -> bool:
        """Whether the starts of `plan`, one by one, lead to the goals by the steps of the automaton."""
        taken = self._taken(task, _order(plan))
        if taken is None or len(plan.starts) > task.longest:
            return False
        self._last = plan, taken
        return True

    def _taken(self, task: Task, order: Sequence[str]) -> _Taken | None:
        states, left = [task.state], [task.goals]
        for name in order:
            transition = self._transitions[name]
            after = step(states[-1], transition)
            if after is None or (transition.controllable and not self._supervisor.allows(states[-1], after)):
                return None
            states.append(after)
            left.append(missing(left[-1], after))
        return None if left[-1] else _Taken(tuple(states), tuple(left))


def _enough(attempt: Attempt) -> bool:
    """Whether what the contract asks for is known: of as many ticks there are as many starts."""
    plan = attempt.plan
    return attempt.answered or (plan is not None and plan.minimal_ticks)


def _order(plan: Plan) -> tuple[str, ...]:
    return tuple(name for _, name in starts_of(plan.ticks))
