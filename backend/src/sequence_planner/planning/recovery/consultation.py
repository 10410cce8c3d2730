"""One consultation of the restart advisor: its inputs, and cheapest proposals first within a time limit."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.language.evaluator import holds
from sequence_planner.language.syntax import TRUE, Expression
from sequence_planner.planning.diagnosis import Diagnosis, DiagnosisRequest
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import Goal, Plan, PlanAnswer, PlanRequest
from sequence_planner.planning.recovery.manual_plans import ManualPlan, ManualPlanner
from sequence_planner.planning.recovery.proposal_builder import Making
from sequence_planner.planning.recovery.proposals import (
    Acts,
    Advice,
    Changes,
    OfferKind,
    Options,
    RecoveryProposal,
)
from sequence_planner.planning.recovery.prover import ProofFinding, Prover
from sequence_planner.planning.recovery.request import AdviceRequest, GoalPlanRequest, RecoverySituation
from sequence_planner.planning.recovery_path import WaysBack
from sequence_planner.planning.sat.search import SearchTimeoutError
from sequence_planner.planning.validation.replay import missing
from sequence_planner.process.budget import Budget, SpentError

# One question to the advisor: what costs a person little is looked for first, until the time is over.

# Of the time that is left, for one plan, for one without some goals, and for one way into the safe states.
_PLAN, _PART, _WAY = 0.3, 0.15, 0.4
# Of what is left once something helps, for all that may be offered beside it; and where that is done elsewhere than
# where something is wrong.
_BESIDE, _BETTER = 0.3, 0.6


class WarmStation(Immutable):
    """All that stays warm from question to question."""

    prover: Prover
    ways: WaysBack
    options: Options
    changes: Changes


class _DeadEnd(Immutable):
    """A manual plan from whose end there is no plan for all goals."""

    kind: OfferKind
    end: RecoverySituation
    acts: Acts
    manual: ManualPlan
    operation: str | None


class RecoverySearch:
    """Looks for offers from the situation `here`. `undecided` says that there may be more than were found.

    Goals that were `violated` are none of the situation's: only the reset of their operations makes them so again.
    `awaited` are the variables that devices should have changed, and have not. Nobody waits for the first offer of one
    that is `patient`.
    """

    def __init__(
        self,
        station: WarmStation,
        here: RecoverySituation,
        budget: Budget,
        violated: Goals = (),
        awaited: frozenset[str] = frozenset(),
        *,
        patient: bool = False,
    ) -> None:
        self.undecided = False
        self.goes_on = False  # as it is, towards all goals
        self.helped = False  # by an offer that reaches all goals, and does more than say so
        self._mended = False  # by one that is done where something is wrong
        self._patient = patient
        self.here = here
        self.prover = station.prover
        self.awaited = awaited
        self.making = Making(station.prover, here, violated, awaited)
        self._violated = violated
        self.budget = budget
        self._ways = station.ways
        self._manual_planner = ManualPlanner(station.prover, station.ways, self.find, lambda: self.budget)
        self._dead_ends: list[_DeadEnd] = []
        self._operations = station.prover.automaton.operations

    def has_helped(self, *, elsewhere: bool = False) -> None:
        """Take note of an offer that reaches all goals, and does more than say so: who waits for it is told soon, and
        somewhat later where there may be a better one, as this is done `elsewhere` than where something is wrong.
        """
        if not self._patient and (not self.helped or (not elsewhere and not self._mended)):
            self.budget = self.budget.part(_BETTER if elsewhere else _BESIDE)
        self.helped, self._mended = True, self._mended or not elsewhere

    def find(
        self, task: PlanningTask, share: float = _PLAN, *, last: bool = True, helped: bool = False
    ) -> ProofFinding:
        """A plan. What is not decided is asked again, unless this is the `last` time.

        Once a person has `helped` the devices that did not react they are counted on again.

        Raises `SpentError` when there is no time for it any more.
        """
        self.budget.require()
        prover = self.prover.counting if helped else self.prover
        finding = prover.find(task, self.budget.part_of_work(share))
        self.undecided = self.undecided or (last and not finding.decided)
        return finding

    def as_it_is(self) -> Iterator[RecoveryProposal]:
        """Production goes on towards all goals."""
        here = self.here
        if not self.prover.is_safe(here.state):
            return
        plan = self.find(here.production()).plan
        if plan is not None:
            self.goes_on = True
            self.has_helped()
            yield self.making.offer(OfferKind.REPLAN, here, plan)

    def without_some(self) -> Iterator[RecoveryProposal]:
        """Production goes on as it is, without the goals of lowest priority."""
        if not self.goes_on and self.prover.is_safe(self.here.state):
            some = self.some(self.here)
            if some is not None and some[2].goals:
                yield self.making.offer(OfferKind.REPLAN, self.here, some[0], left_out=some[1])

    def by_manual_plans(self) -> Iterator[RecoveryProposal]:
        """Manual plans without changes: back into the safe states, to rest, or by restart abilities."""
        kind = OfferKind.RESTART if self.prover.is_safe(self.here.state) else OfferKind.WAY_BACK
        yield from self.concluded(kind, self._manual_plans_from(self.here), ())

    def by_manual_plans_after(self, acts: Acts, after: RecoverySituation) -> Iterator[RecoveryProposal]:
        """The same after what a person has changed."""
        yield from self.concluded(OfferKind.COMBINED, self._manual_plans_from(after), acts)

    def by_resets(self) -> Iterator[RecoveryProposal]:
        """Operations begin anew: their preconditions are brought about again."""
        for goal in (*self.here.goals, *self._violated):
            if (operation := self._operations.get(goal.name)) is not None:
                again = not holds(operation.precondition, self.here.state)
                if again or goal in self._violated or (goal.local != TRUE and goal.at != 0):
                    manual_plans = self.asked(operation.precondition, goal.name)
                    yield from self.concluded(OfferKind.RESET, manual_plans, (), goal.name)

    def asked(self, target: Expression, operation: str | None, restart: bool = True) -> Iterator[ManualPlan]:
        """The manual plan to `target`, from outside the safe states after the way into them.

        While an operation is reset nothing is asked of it, and then its formula begins anew.
        """
        other = self.here.without(frozenset({operation} if operation is not None else ()))
        all_goals = (*self.here.goals, *self._violated)
        begun = [replace(goal, at=0) for goal in all_goals if goal.name == operation]
        way = None if self.prover.is_safe(other.state) else self._way(other)
        if way is None and not self.prover.is_safe(other.state):
            return
        manual = self._manual_planner.to(other if way is None else way.end, target, restart)
        if manual is not None and way is not None:
            manual = self._manual_planner.joined(other, way, manual)
        if manual is not None:
            end = manual.end
            goals = missing((*end.goals, *begun), end.state)
            ordered = [goal.name for goal in all_goals]
            yield replace(
                manual, end=replace(end, goals=tuple(sorted(goals, key=lambda goal: ordered.index(goal.name))))
            )

    def concluded(
        self, kind: OfferKind, manual_plans: Iterator[ManualPlan], acts: Acts, operation: str | None = None
    ) -> Iterator[RecoveryProposal]:
        """Offers of those manual plans from whose end there is a plan for all goals."""
        seen: set[object] = set()
        for manual in manual_plans:
            if manual.ticks not in seen:
                seen.add(manual.ticks)
                then = self._then(manual)
                if then is None:
                    self._dead_ends.append(_DeadEnd(kind, manual.end, acts, manual, operation))
                else:
                    self.has_helped()
                    yield self.making.offer(kind, manual.end, then, acts, manual, operation)

    def without_goals(self) -> Iterator[RecoveryProposal]:
        """Yield, for where nothing else helps, manual plans after which some goals are given up."""
        for dead in self._dead_ends:
            some = self.some(dead.end)
            if some is not None and (some[2].goals or dead.manual.walk.unsupervised or self._was_outside):
                then, left_out, _ = some
                yield self.making.offer(dead.kind, dead.end, then, dead.acts, dead.manual, dead.operation, left_out)

    @property
    def _was_outside(self) -> bool:
        return not self.prover.is_safe(self.here.state)

    def some(self, here: RecoverySituation) -> tuple[Plan, tuple[Goal, ...], RecoverySituation] | None:
        """A plan for as many goals as can be, those of lowest priority given up first; which, and for which it is."""
        left_out: list[Goal] = []
        while (least := here.least()) is not None:
            here = here.without(frozenset({least.name}))
            left_out.append(least)
            plan = self.find(here.production(), _PART).plan
            if plan is not None:
                return plan, tuple(left_out), here
        return None

    def _then(self, manual: ManualPlan) -> Plan | None:
        task = manual.end.production()
        if manual.rest is not None and task.goals and self.prover.accepts(task, manual.rest):
            return manual.rest
        return self.find(task).plan

    def _manual_plans_from(self, here: RecoverySituation) -> Iterator[ManualPlan]:
        if self.prover.is_safe(here.state):
            for manual in self._manual_planner.startable(here):
                if not self.goes_on or self.making.restarts(manual.ticks):
                    yield manual
            if not self.goes_on:
                rest = self._manual_planner.to_rest(here)
                if rest is not None:
                    yield rest
                yield from self._manual_planner.onwards(here)
        elif (way := self._way(here)) is not None:
            dead = len(self._dead_ends)
            yield way
            if len(self._dead_ends) > dead:
                for further in self._manual_plans_from(way.end):
                    if (both := self._manual_planner.joined(here, way, further)) is not None:
                        yield both

    def _way(self, here: RecoverySituation) -> ManualPlan | None:
        self.budget.require()
        try:
            return self._manual_planner.into_safe(here, _WAY)
        except (SearchTimeoutError, SpentError):
            self.undecided = True
            return None


# All that the advisor's process can be asked, and what it answers.

Request = AdviceRequest | GoalPlanRequest | PlanRequest | DiagnosisRequest
Answer = Advice | PlanAnswer | Diagnosis
