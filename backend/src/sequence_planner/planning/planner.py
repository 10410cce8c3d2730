"""The planner: engine selection and attempts, all or most goals together, only replayed plans."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial
from math import inf
from typing import Protocol

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.planning import problem
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.plan_cache import NAME, PlanCache
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.portfolio.engines import ALONE, EngineReport, Engines
from sequence_planner.planning.problem import Contract, Plan, PlanAnswer, PlanRequest, Proof, Verdict
from sequence_planner.planning.repair import NAME as REPAIR
from sequence_planner.planning.repair import Repair
from sequence_planner.planning.validation.acceptance import Acceptance, AcceptedRun, tightened
from sequence_planner.planning.validation.replay import missing
from sequence_planner.process.budget import Budget

# One attempt at a task: what the engines have found so far, and whether it is worth while to wait for more.

# For a shorter plan a fast one waits this share of the work it took, in seconds at least and at most.
_SHARE, _LEAST_GRACE, _MOST_GRACE = 0.2, 0.002, 0.1
_PROOF_GRACE = 0.5  # seconds, or as long as it took, for a proof, when it is known that no plan is short enough


class PlanningAttempt:
    """Collects reports on `task`; `accepts` says whether a plan is one. Plans that are none are their engines' errors.

    When `share` is spent and there is no plan, the time that is left belongs to fewer goals.
    """

    def __init__(self, task: PlanningTask, accepts: Callable[[Plan], bool], share: Budget) -> None:
        self.task = task
        self.share = share
        self.engine = ""  # that has found the plan or the proof
        self.proof: Proof | None = None
        self.exhausted = False  # all that can be reached has been looked at, and there is no plan
        self.troubles: list[str] = []
        self.heard = False  # of an engine that has not failed
        self._accepts = accepts
        self._clock = time.process_time
        self._began = self._clock()
        self._grace: Budget | None = None
        self._plan: Plan | None = None
        self._searched = 0

    @property
    def took(self) -> float:
        """The seconds that this process has worked since it has begun; in a race, those that have passed."""
        return self._clock() - self._began

    @property
    def plan(self) -> Plan | None:
        """The best plan so far; what is proven of it may have been proven by another engine."""
        plan = self._plan
        if plan is None or plan.minimal_ticks or len(plan.ticks) > self._fewest:
            return plan
        return replace(plan, minimal_ticks=True, minimal_starts=not plan.starts)

    @property
    def searched(self) -> int:
        """The ticks up to which it is proven that there is no plan; with a plan, none has fewer."""
        return self._searched if self._plan is None else min(self._fewest, len(self._plan.ticks))

    @property
    def answered(self) -> bool:
        """True if what the contract asks for has been found."""
        plan = self.plan
        if plan is None:
            return self.impossible
        return self.task.contract is Contract.FAST or (plan.minimal_ticks and plan.minimal_starts)

    @property
    def impossible(self) -> bool:
        """True if there is no plan at all."""
        return self.proof is not None or self.exhausted

    @property
    def patience(self) -> float:
        """The seconds for which it is still worth while to wait for another report."""
        plan = self.plan
        if self.impossible or (plan is not None and plan.minimal_ticks and plan.minimal_starts):
            return 0.0
        grace = inf if self._grace is None else self._grace.remaining
        return grace if plan is not None else min(grace, self.share.remaining)

    @property
    def _fewest(self) -> int:
        """No plan has fewer ticks than that."""
        return self._searched + 1

    def race(self) -> None:
        """Go by the time that passes from now on, as engines work in other processes."""
        took, self._clock = self.took, time.monotonic
        self._began = self._clock() - took
        if self._grace is not None:
            self._grace = Budget.seconds(self._grace.remaining)

    def take(self, report: EngineReport) -> None:
        """Take note of a report."""
        finding = report.finding
        if report.trouble:
            self.troubles.append(f"{report.engine}: {report.trouble}")
        elif finding.plan is not None and not self._accepts(finding.plan):
            problem.log("the plan %s by %s for %s does not replay", finding.plan, report.engine, self.task)
            self.troubles.append(f"{report.engine}: its plan does not replay on the reference tick")
        elif finding.plan is not None:
            self.heard = True
            self._take_plan(report.engine, finding.plan)
            self._searched = max(self._searched, finding.searched - 1)
        else:
            self.heard = True
            self._searched = max(self._searched, finding.searched)
            if finding.decided and self._plan is None and not self.impossible:
                self.proof, self.exhausted, self.engine = finding.proof, finding.exhausted, report.engine
        self._wait()

    def _take_plan(self, engine: str, plan: Plan) -> None:
        if self.impossible:
            problem.log("%s has a plan for %s, which %s has proven to have none", engine, self.task, self.engine)
            self.proof, self.exhausted = None, False
        if self._plan is None or _rank(plan) < _rank(self._plan):
            self._plan, self.engine = plan, engine

    def _wait(self) -> None:
        """Say how long what is known now is worth waiting to be bettered."""
        if self._grace is not None:
            return
        if self._plan is not None and self.task.contract is Contract.FAST:
            seconds = min(max(_SHARE * self.took, _LEAST_GRACE), _MOST_GRACE)
        elif self._plan is None and self._searched >= self.task.longest:
            seconds = max(_PROOF_GRACE, self.took)
        else:
            return
        working = self._clock is time.process_time
        self._grace = Budget(inf).seconds_of_work(seconds) if working else Budget.seconds(seconds)


def _rank(plan: Plan) -> tuple[int, int, bool, bool]:
    """Fewer ticks are better, then fewer starts, then more that is proven."""
    return len(plan.ticks), len(plan.starts), not plan.minimal_ticks, not plan.minimal_starts


# The planner: all goals together, or as many as can be planned together, and no answer that does not replay.

_NOTHING_TO_DO = Finding(Plan((), minimal_ticks=True, minimal_starts=True))


class PlannerError(Exception):
    """No engine could answer: each has failed, or its plan did not replay on the reference tick."""


class Solvers(Protocol):
    """Engines that work on one task together."""

    def solve(self, attempt: PlanningAttempt, budget: Budget) -> None:
        """Have them report to `attempt` until that answers, or is not worth waiting for, or the budget is spent."""


class InTurn:
    """Engines that take turns in this thread, where starting processes would cost more than it brings."""

    def __init__(self, engines: Engines) -> None:
        self._engines = engines

    def solve(self, attempt: PlanningAttempt, budget: Budget) -> None:
        """As `Solvers.solve`; an attempt has no more time than its share of `budget`."""
        del budget
        for report in self._engines.work(attempt.task, attempt.share, lambda: attempt.patience):
            attempt.take(report)
            if attempt.answered or not attempt.patience:
                return


class _Outcome(Immutable):
    """The last `attempt`, the goals still to be planned, and of these and those left out the `possible` ones.

    `proof` says why a goal that is not among them is none of them. `undecided` are goals that a plan leaves out, and
    nothing proves that it must.
    """

    possible: Goals
    goals: Goals
    attempt: PlanningAttempt
    proof: Proof | None = None
    undecided: Goals = ()

    @property
    def plan(self) -> Plan | None:
        return self.attempt.plan

    @property
    def verdict(self) -> Verdict:
        if self.plan is not None:
            return Verdict.FOUND
        if not self.possible:
            return Verdict.NONE_AT_ALL
        complete = not self.goals and self.attempt.searched >= self.attempt.task.bound
        return Verdict.NONE_UP_TO if complete else Verdict.LATE

    def fewer(self) -> _Outcome:
        """The goals to be tried next: without the lowest priority, or without the one that is proven impossible."""
        if len(self.goals) > 1 or self.attempt.proof is None:
            return replace(self, goals=self.goals[:-1])
        rest = tuple(goal for goal in self.possible if goal not in self.goals)
        return replace(self, possible=rest, goals=rest, proof=self.attempt.proof)


class Planner:
    """Plans for one automaton under one supervisor, warm from question to question."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, solvers: Solvers | None = None) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._acceptance = Acceptance.of(automaton, supervisor)
        self._recollection = PlanCache(automaton)
        self._repair = Repair(automaton, self._acceptance, self._recollection)
        self._solvers = solvers or InTurn(Engines(automaton, supervisor, ALONE))

    def answer(self, request: PlanRequest, budget: Budget | None = None) -> PlanAnswer:
        """The plan for as many of the goals as can be planned together, the lowest priority given up first.

        What was left out only because of another goal is taken in again. `budget` can be called off from
        another thread; without one the deadline of the request is kept. Raises `PlannerError`.
        """
        began = time.monotonic()
        ordered = tuple(sorted(request.goals, key=lambda goal: (-goal.priority, goal.name)))
        budget = budget or Budget.seconds(request.deadline)
        outcome = self._outcome(request, ordered, budget)
        plan, verdict = self._tightened(outcome, budget), outcome.verdict
        planned = () if plan is None else outcome.goals
        proof = outcome.proof if verdict is Verdict.NONE_AT_ALL else None
        undecided = outcome.possible if plan is None else outcome.undecided
        return PlanAnswer(
            verdict,
            plan,
            tuple(goal.name for goal in planned),
            tuple(goal.name for goal in reversed(ordered) if goal not in planned),
            outcome.attempt.searched,
            time.monotonic() - began,
            outcome.attempt.engine if proof is None else proof.by,
            proof,
            tuple(goal.name for goal in reversed(undecided)),
        )

    def _outcome(self, request: PlanRequest, ordered: Goals, budget: Budget) -> _Outcome:
        possible, proof = self._reachable(request, ordered) if _is_hindered(request) else (ordered, None)
        outcome = _Outcome(possible, possible, self._attempt(request, possible or ordered, budget), proof)
        if outcome.plan is None and possible == ordered and not budget.spent:
            outcome = self._without_unreachable(request, outcome, budget)
        proven = True  # that no more goals can be reached together than those tried last
        while outcome.plan is None and outcome.goals:
            proven = proven and outcome.attempt.proof is not None
            outcome = outcome.fewer()
            if budget.spent:
                break
            outcome = self._attempted(request, outcome, budget)
        if outcome.plan is None:
            return outcome
        if proven:
            return self._more(request, outcome, budget)
        return replace(outcome, undecided=tuple(goal for goal in outcome.possible if goal not in outcome.goals))

    def _more(self, request: PlanRequest, outcome: _Outcome, budget: Budget) -> _Outcome:
        """With each goal that was left out only because of another one."""
        undecided: Goals = ()
        for goal in outcome.possible:
            if goal in outcome.goals:
                continue
            goals = tuple(each for each in outcome.possible if each in outcome.goals or each == goal)
            attempt = None if budget.spent else self._attempt(request, goals, budget)
            if attempt is not None and attempt.plan is not None:
                outcome = replace(outcome, goals=goals, attempt=attempt)
            elif attempt is None or attempt.proof is None:
                undecided += (goal,)
        return replace(outcome, undecided=undecided)

    def _without_unreachable(self, request: PlanRequest, outcome: _Outcome, budget: Budget) -> _Outcome:
        """Look only now at what the delete relaxation excludes: most questions have an answer without."""
        possible, proof = self._reachable(request, outcome.goals)
        if proof is None:
            return outcome
        return self._attempted(request, replace(outcome, possible=possible, goals=possible, proof=proof), budget)

    def _reachable(self, request: PlanRequest, goals: Goals) -> tuple[Goals, Proof | None]:
        """The goals that the delete relaxation does not exclude, and the proof for others, if there are any."""
        from sequence_planner.planning.heuristic.relaxation import reachable, unreached  # noqa: PLC0415

        relaxed = reachable(self._automaton, request.state, request.circumstances)
        possible = tuple(goal for goal in goals if relaxed.may(goal.predicate))
        return possible, None if possible == goals else unreached(self._automaton, relaxed)

    def _attempted(self, request: PlanRequest, outcome: _Outcome, budget: Budget) -> _Outcome:
        if not outcome.goals:
            return outcome
        return replace(outcome, attempt=self._attempt(request, outcome.goals, budget))

    def _attempt(self, request: PlanRequest, goals: Goals, budget: Budget) -> PlanningAttempt:
        """All of `goals`, in half of the time that is left if there are several, so that fewer have their turn.

        Where nothing was found fast, the same is asked as for a minimal plan: who looks for those knows how far it is.
        """
        left = missing(goals, request.state)
        share = budget.part(0.5 if len(goals) > 1 else 1.0)
        for contract in dict.fromkeys((request.contract, Contract.MINIMAL)):
            task = PlanningTask(request.state, left, request.circumstances, contract, request.longest)
            attempt = PlanningAttempt(task, partial(self._accepts, task), share)
            if not left:
                attempt.take(EngineReport("", _NOTHING_TO_DO))
            elif (known := self._recollection.finding(task)) is not None:
                attempt.take(EngineReport(NAME, known))
            elif (repaired := self._repaired(task)) is not None:
                attempt.take(EngineReport(REPAIR, repaired))
            if not attempt.answered:
                self._solvers.solve(attempt, budget)
            if attempt.proof is not None:
                self._recollection.keep_proof(task, attempt.proof)
            if attempt.plan is not None or attempt.proof is not None or share.spent:
                break
        if attempt.troubles and not attempt.heard and not share.spent:
            raise PlannerError("; ".join(attempt.troubles))
        return attempt

    def _tightened(self, outcome: _Outcome, budget: Budget) -> Plan | None:
        """The plan; a minimal one, for which somebody waits anyhow, with its starts as early as there is time for."""
        plan, task = outcome.plan, outcome.attempt.task
        recalled = outcome.attempt.engine in (NAME, REPAIR)
        if plan is None or not plan.starts or task.contract is Contract.FAST or recalled:
            return plan
        early = tightened(self._acceptance, task, plan, budget.part(0.5))
        if early is None:
            return plan
        self._keep(task, early)
        return early.plan

    def _accepts(self, task: PlanningTask, plan: Plan) -> bool:
        """Return whether it replays; one that is known has been replayed, and one that does is known from now on."""
        if self._recollection.plan(task) == plan:
            return True
        course = self._acceptance.course(task, plan)
        if course is None:
            return False
        self._keep(task, course)
        return True

    def _keep(self, task: PlanningTask, course: AcceptedRun) -> None:
        self._recollection.keep_plan(task, course.plan, course.ends)
        self._repair.keep(task, course)

    def _repaired(self, task: PlanningTask) -> Finding | None:
        """A repaired plan, which is known from now on: it has been replayed as it was made."""
        finding = self._repair.finding(task)
        if finding is not None and finding.plan is not None:
            self._recollection.keep_plan(task, finding.plan, ())
        return finding


def _is_hindered(request: PlanRequest) -> bool:
    """Return whether something is missing, so that goals may well be out of reach, which no engine should have to find
    out.
    """
    circumstances = request.circumstances
    absent = circumstances.offline or circumstances.barred
    return bool(absent) or any(value is None for value in request.state.values())
