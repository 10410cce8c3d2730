"""Offers made of what has been found: everything about them is worked out here, and nowhere else."""

from __future__ import annotations

from collections.abc import Iterable

from sequence_planner.automaton.automaton import Kind, State
from sequence_planner.automaton.tick import finish, synchronise
from sequence_planner.language.evaluator import holds
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.problem import Goal, Plan, PlanTick
from sequence_planner.planning.recovery.manual_plans import ManualPlan, changes_something
from sequence_planner.planning.recovery.proposals import (
    Act,
    ActKind,
    OfferKind,
    ProposalEffort,
    RecoveryProposal,
    ValueChange,
    changes_between,
    claimed,
)
from sequence_planner.planning.recovery.prover import Prover
from sequence_planner.planning.recovery.request import RecoverySituation
from sequence_planner.planning.recovery.timing import expected_seconds


class Making:
    """Makes offers for a station that is in the situation `here`; `violated` goals are reached only after a reset, and
    devices should have changed the variables that are `awaited`.
    """

    def __init__(
        self, prover: Prover, here: RecoverySituation, violated: Goals = (), awaited: frozenset[str] = frozenset()
    ) -> None:
        self._prover = prover
        self._automaton = prover.automaton
        self._here = here
        self._awaited = awaited
        self._violated = tuple(goal.name for goal in violated)
        self._goals = (*here.goals, *violated)

    def offer(
        self,
        kind: OfferKind,
        end: RecoverySituation,
        then: Plan | None,
        acts: tuple[Act, ...] = (),
        manual: ManualPlan | None = None,
        operation: str | None = None,
        left_out: tuple[Goal, ...] = (),
        begun: tuple[Goal, ...] | None = None,
    ) -> RecoveryProposal:
        """The offer of `acts`, then of the `manual` plan, which end in `end`, and of the plan from there, for the goals
        of the situation or for those that are only `begun` by it.
        """
        returning = [name for act in acts if act.kind is ActKind.RETURN for name, _ in act.values]
        changed: State = {**self._here.state, **{name: value for act in acts for name, value in act.values}}
        measured = changes_between(self._automaton, self._here.state, changed, Kind.MEASURED)
        corrections = changes_between(self._automaton, self._here.state, changed, Kind.ESTIMATED)
        plan = None if manual is None else Plan(manual.ticks, minimal_ticks=False, minimal_starts=False)
        breaks = () if manual is None else manual.walk.breaks
        unsupervised = manual is not None and manual.walk.unsupervised
        ticks = (*(() if plan is None else plan.ticks), *(() if then is None else then.ticks))
        given_up = [*_of(left_out), *(name for name in self._violated if name != operation)]
        reached = [
            *_of(self._here.goals if begun is None else begun),
            *(name for name in self._violated if name == operation),
        ]
        effort = ProposalEffort(
            changes=len(corrections),
            physical=sum(act.kind in (ActKind.DEVICE, ActKind.TASK) for act in acts),
            elsewhere=sum(act.kind is ActKind.DEVICE and not self._helps(act) for act in acts),
            returns=sum(act.kind in (ActKind.RETURN, ActKind.SERVICE) for act in acts),
            starts=0 if plan is None else len(plan.starts),
            seconds=expected_seconds(self._automaton, ticks),
            left_out=len(given_up),
            breaks=len(breaks),
            unsupervised=unsupervised,
            unseen=unsupervised and any(changed[name] is None for name in self._automaton.names(Kind.MEASURED)),
        )
        return RecoveryProposal(
            kind=kind,
            start=changed,
            end=end.state,
            effort=effort,
            corrections=corrections,
            physical=tuple(change for change in measured if change.name not in returning),
            online=tuple(act.name for act in acts if act.kind is ActKind.RETURN),
            in_service=tuple(act.name for act in acts if act.kind is ActKind.SERVICE),
            assumed=tuple(change for change in measured if change.name in returning),
            operator_plan=plan,
            goal=RecoveryProposal.goal if manual is None else manual.goal,
            operation=operation,
            restart=plan is not None and self.restarts(plan.ticks),
            unsupervised=unsupervised,
            at_rest=self.at_rest(end),
            breaks=breaks,
            then=then,
            goals=() if then is None else tuple(name for name in reached if name not in given_up),
            left_out=tuple(given_up),
            claims=self.claims(corrections),
            records=self.records(changed),
            into_safe=manual is not None and manual.into_safe,
            by_hand=tuple(act.name for act in acts if act.kind is ActKind.TASK),
        )

    def _helps(self, act: Act) -> bool:
        """Return whether it is done where something is wrong, if that is known: at a device that does nothing, or whose
        abilities were given up.
        """
        circumstances, variables = self._here.circumstances, self._automaton.variables
        given_up = {self._automaton.abilities[name].resource for name in circumstances.barred}
        if not (self._awaited or circumstances.offline or given_up):
            return True
        return any(name in self._awaited or variables[name].resource in given_up for name, _ in act.values)

    def restarts(self, ticks: Iterable[PlanTick]) -> bool:
        """Return whether restart abilities start."""
        return any(self._automaton.abilities[name].restart for tick in ticks for name in tick.starts)

    def claims(self, corrections: Iterable[ValueChange]) -> tuple[str, ...]:
        """The goals that the corrections alone bring nearer."""
        values = {change.name: change.new for change in corrections}
        if not values:
            return ()
        after = synchronise(self._automaton, {**self._here.state, **values})
        return claimed(self._automaton, self._goals, self._here.state, after)

    def records(self, changed: State) -> tuple[ValueChange, ...]:
        """The estimates that finishing abilities write as soon as the station is `changed`."""
        return changes_between(self._automaton, changed, finish(self._automaton, changed).state, Kind.ESTIMATED)

    def at_rest(self, end: RecoverySituation) -> bool:
        """Return whether it is a safe rest state in which no device has still to follow what it was told."""
        rest, state = self._automaton.rest, end.state
        if (rest is not None and not holds(rest, state)) or not self._prover.is_safe(state):
            return False
        for effect in self._automaton.effects:
            counted_on = not effect.fault and effect.resource not in end.circumstances.offline
            if counted_on and changes_something(effect, state):
                return False
        return True


def _of(goals: Iterable[Goal]) -> list[str]:
    return [goal.name for goal in goals]
