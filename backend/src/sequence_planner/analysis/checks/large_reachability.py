"""Reachability queries for large state spaces, answered from known runs and an over-approximation."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TYPE_CHECKING

from sequence_planner.analysis.checks.evidence import Again, Evidence, Runs, grown
from sequence_planner.analysis.checks.feasibility import UNKNOWN, FeasibilityFinding, Possibility, Subject
from sequence_planner.analysis.checks.reachability import Questions, ReachabilityQuery, bits
from sequence_planner.analysis.layered_ways import LayeredWay, joined, joining
from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.language.syntax import Expression
from sequence_planner.planning.problem import Contract, Goal, PlanRequest, PlanTick, goals_of
from sequence_planner.synthesis.approximation import around, composed
from sequence_planner.synthesis.bdd import Function
from sequence_planner.synthesis.reachability import Tracer
from sequence_planner.synthesis.traces import Trace
from sequence_planner.synthesis.transition_relation import (
    MOST_BITS,
    NodeLimit,
    Plant,
    TooMuchError,
    TransitionStep,
    orders,
    together,
)

if TYPE_CHECKING:
    from sequence_planner.planning.planner import Planner

# An inquiry where the states that are reached are too many to be computed: `large_reachability` says how it answers.

_SOON = 3_000_000  # of all effort; for what takes longer, something else is tried first
_LARGER = (20, 26)  # bits of larger parts, and of those after them
_KEPT = 60  # ways, and traps, for the next edit: those that have served last
_MOST_NEAR = 3  # states that are looked at one by one
_PLANNING_ONE = 2.0  # seconds, for a plan for one goal


class Plans:
    """Plans under a `supervisor`, on which no more than so many `seconds` are spent in all."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, seconds: float) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._left = 0.0 if automaton.one_at_a_time else seconds

    @property
    def all_goals(self) -> tuple[Goal, ...]:
        """The goals of all operations."""
        return goals_of(self._automaton, self._automaton.operations)

    @cached_property
    def _planner(self) -> Planner:
        from sequence_planner.planning.planner import Planner  # noqa: PLC0415 - few models need it

        return Planner(self._automaton, self._supervisor)

    def __call__(self, state: State, goals: Sequence[Goal]) -> tuple[PlanTick, ...]:
        """A plan for these goals from `state`, or for as many as one is soon found for."""
        if self._left <= 0 or not goals:
            return ()
        from sequence_planner.planning.planner import PlannerError  # noqa: PLC0415 - few models need it

        began = time.monotonic()
        seconds = min(self._left, _PLANNING_ONE * len(goals))
        request = PlanRequest(state, tuple(goals), seconds, contract=Contract.FAST)
        try:
            plan = self._planner.answer(request).plan
        except PlannerError:
            plan = None
        self._left -= time.monotonic() - began
        return () if plan is None else plan.ticks


class FarInquiry(ReachabilityQuery):
    """An inquiry that takes less, and is soon answered where runs are known."""

    def __init__(
        self, asked: Questions, effort: NodeLimit, order: Sequence[str] = (), plans: Plans | None = None
    ) -> None:
        super().__init__(asked, effort, order)
        self._runs = Runs(self.plant, self.safe)
        self._more: dict[bool, Function] = {}
        self._level = {True: 0, False: 0}
        self.ways: list[LayeredWay] = []
        self.traps: list[Function] = []  # states that nothing leads out of
        self._bounds: list[Function] = []
        self._again: Again | None = None
        self._added = self.diagrams.false  # to what may be reached, by an edit
        self.whole = effort  # for what serves all questions
        self._plans = plans

    def know_plan(self, goals: Sequence[Goal]) -> None:
        """Know what a plan for `goals` leads through, from where the longest run that is known ends."""
        if self._plans is not None:
            begin = self._runs.furthest
            self._runs.follow(begin, self._plans(begin.state, goals))

    def recall(self, known: Evidence) -> bool:
        """Prove again what was `known` before an edit; returns whether all runs of it can still be taken.

        Raises `TooMuchError` where what is reached has become too different.
        """
        plant = self.plant
        self._again = again = Again(plant, known)
        steps = [*plant.uncontrollable, *plant.all_starts]
        for supervised, states in known.reached.items():
            within = self.safe if supervised else self.diagrams.valid
            self._more[supervised] = grown(self.whole, plant.initial | again.states(states), steps, within)
            self._level[supervised] = known.level[supervised]
        self.ways = list(again.ways(self.perhaps_reached()))
        self.traps = list(again.traps(self.perhaps_reached()))
        self._bounds = list(again.bounds())
        self._added = again.added(self.perhaps_reached())
        return self._runs.recall(known.runs)

    def evidence(self, supervisor: Supervisor) -> Evidence:
        """Return what its answers under the `supervisor` rest on."""
        within = self.perhaps_reached()  # in the end; no step leads out of it, so what holds of more holds within it
        return Evidence(
            self.plant.automaton,
            supervisor,
            self.diagrams.names,
            {supervised: self._exported(states) for supervised, states in self._more.items()},
            dict(self._level),
            self._runs.kept(),
            tuple(self._exported_way(way, within) for way in self.ways[-_KEPT:]),
            tuple(self._exported(trap & within) for trap in self.traps[-_KEPT:]),
            tuple(map(self._exported, self._bounds)),
        )

    def _exported_way(self, way: LayeredWay, within: Function) -> tuple[StateSet, tuple[StateSet, ...]]:
        layers = way.kept or tuple(self._exported(layer & within) for layer in way.layers)
        return self._exported(way.target), layers

    def _exported(self, states: Function) -> StateSet:
        known = None if self._again is None else self._again.exported.get(states)
        return self.diagrams.exported(states) if known is None else known

    def perhaps_reached(self, *, supervised: bool = True) -> Function:
        """All states that are reached with or without the supervisor, and perhaps more."""
        if supervised not in self._more:
            within = self.safe if supervised else self.diagrams.valid
            asked, self.effort = self.effort, self.whole  # it serves all questions
            try:
                plant = self.plant
                self._more[supervised] = self._composed(plant, plant.initial, plant.uncontrollable, within)
            finally:
                self.effort = asked
        return self._more[supervised]

    def _closer(self, supervised: bool) -> Iterator[None]:
        """Each time say more closely what is reached, by larger parts; what is known by now comes first."""
        yield
        while (level := self._level[supervised]) < len(_LARGER):
            plant, groups = self.plant, list(together(self.plant.automaton))
            larger = [*groups, *around(self.diagrams, groups, _LARGER[level])]
            within = self.perhaps_reached(supervised=supervised)
            self.effort = self.whole
            steps = self.limited(plant, plant.uncontrollable)
            self._more[supervised] = composed(self.diagrams, plant.initial, steps, larger, within)
            self._level[supervised] += 1
            yield

    def reached(
        self, target: Function, *, supervised: bool = True, faults: bool = True, goal: Expression | None = None
    ) -> Function:
        """Some of the states of `target` that are reached; none only if none of them is.

        Where that is not soon found out, a plan for `goal` is tried first.
        """
        asked = self.effort
        try:
            for _ in self._closer(supervised):
                self.effort = NodeLimit(_SOON, whole=asked)
                with suppress(TooMuchError):
                    return self._gone_back(target, supervised, faults)
                if goal is not None:
                    self.know_plan((Goal("", goal),))
                    goal = None
                    found = target & self._runs.known(supervised=supervised, faults=faults)
                    if found.satisfiable():
                        return found
            self.effort = asked
            return self._gone_back(target, supervised, faults)
        finally:
            self.effort = asked

    def _gone_back(self, target: Function, supervised: bool, faults: bool) -> Function:
        within = self.perhaps_reached(supervised=supervised)
        new = target & within
        steps = self.limited(self.plant, self.plant.uncontrollable if faults else self.plant.helpful)
        layers: list[Function] = []
        seen = new
        while new.satisfiable():
            point = self._runs.nearest(new, supervised=supervised, faults=faults)
            if point is not None:
                self._runs.lead(point, reversed(layers), steps, faults=faults)
                return target & self._runs.known(supervised=supervised, faults=faults)
            layers.append(new)
            new = self.diagrams.disjunction(step.before(new) for step in steps) & within & ~seen
            seen |= new
        if faults:  # so nothing of it is reached
            self._more[supervised] = within & ~seen
        return new

    def way(self, target: Function, *, supervised: bool = True, faults: bool = True) -> Trace | None:
        """A run that is known to lead to some of `target`, the shortest of them."""
        point = self._runs.nearest(target, supervised=supervised, faults=faults)
        return None if point is None else self._runs.trace(point)

    def stuck(self, active: Function, goal: Function) -> Function:
        """Some of the states that are reached, in which `active` is so, and from which `goal` cannot be brought about.

        Where it takes long to know from which it can, those that are next to a known run are looked at first.
        """
        within = self.perhaps_reached()
        left, known = active & within & ~goal, self._runs.known(supervised=True, faults=True)
        for trap in self.traps:
            if (trap & left & known).satisfiable() and not (trap & goal).satisfiable():
                self.traps.remove(trap)
                self.traps.append(trap)
                return trap & left & known
        ways = [way for way in self.ways if not (way.target & within & ~goal).satisfiable()]
        begin = self.diagrams.disjunction(way.states for way in ways) & within
        if not (left & ~begin).satisfiable():
            self.ways = [*(way for way in self.ways if way not in ways), *ways]  # these have served last
            return left & ~begin
        layers = joined(self.diagrams, ways, within)
        layers += (begin | self._newly_leading(goal, begin),)
        if not (left := left & ~layers[-1]).satisfiable():
            self._learn_way(LayeredWay.in_layers(goal, layers))
            return left
        whole, looked = self.effort, False
        self.effort = NodeLimit(_SOON, whole=whole)
        growing = _Growing(self.seen(goal, within), layers, within)
        while (left := left & ~growing.seen).satisfiable():
            try:
                if not growing.go_on(self.limited(self.plant, self.plant.helpful)):
                    break
            except TooMuchError:
                self.effort = whole
                if looked:
                    raise
                looked = True
                if (near := self._stuck_nearby(left, goal)) is not None:
                    return near
        self.effort = whole
        found = self.reached(left)
        if found.satisfiable():
            self.traps.append(within & ~growing.seen)
        else:
            self._learn_way(LayeredWay.in_layers(goal, growing.layers))
        return found

    def _newly_leading(self, goal: Function, known: Function) -> Function:
        """Return what an edit has added of states from which `goal` can be brought about; those `known` are from
        before.
        """
        added, within = self._added & ~known, self.perhaps_reached()
        asked, self.effort = self.effort, NodeLimit(_SOON, whole=self.effort)
        try:
            steps = self.limited(self.plant, self.plant.helpful)
            near = added | self.diagrams.disjunction(step.after(added) for step in steps)
            return joining(added, known | self.seen(goal & near, within), steps)
        except TooMuchError:
            return self.diagrams.false
        finally:
            self.effort = asked

    def _learn_way(self, new: LayeredWay) -> None:
        """Know it, or what says as much, and forget what says no more."""
        new = next((way for way in self.ways if way.says(new)), new)
        self.ways = [*(way for way in self.ways if not new.says(way)), new]

    def _stuck_nearby(self, states: Function, goal: Function) -> Function | None:
        """Some of `states` at most one step from a known run that surely do not lead to `goal`; None if none is met."""
        known = self._runs.known(supervised=True, faults=True)
        steps = self.limited(self.plant, self.plant.uncontrollable)
        near = (known | self.diagrams.disjunction(step.after(known) for step in steps)) & states & self.safe
        for _ in range(_MOST_NEAR):
            if (values := self.diagrams.pick(near)) is None:
                return None
            one = self.diagrams.conjunction(self.diagrams.values(name)[value] for name, value in values.items())
            with suppress(TooMuchError):
                perhaps = self._composed(self.plant, one, self.plant.helpful, self.perhaps_reached())
                if not (perhaps & goal).satisfiable():
                    self.traps.append(perhaps)
                    return self.reached(one)
            near &= ~one
        return None

    def leads(self, states: Function, goal: Function) -> bool | None:
        """Return whether `goal` can be reached from `states` without faults, the supervisor not asked; None if
        unknown.
        """
        if any(not ((states & ~bound) | (bound & goal)).satisfiable() for bound in self._bounds):
            return False
        if Tracer(self.plant, faults=False).leads(goal, states):
            return True
        with suppress(TooMuchError):
            perhaps = self._composed(self.plant, states, self.plant.helpful, self.diagrams.valid)
            if not (perhaps & goal).satisfiable():
                self._bounds.append(perhaps)
                return False
        return None

    def may_ever(self, predicate: Expression) -> bool:
        """Return whether it holds in any state that may be reached by any means."""
        plant, perhaps = self.ever
        if (plant.where(predicate) & perhaps).satisfiable():
            raise TooMuchError  # it may: which it is would have to be found out
        return False

    def _closed(self, plant: Plant) -> Function:
        return self._composed(plant, plant.initial, plant.uncontrollable, plant.diagrams.valid)

    def _composed(
        self, plant: Plant, initial: Function, uncontrollable: Sequence[TransitionStep], within: Function
    ) -> Function:
        steps = self.limited(plant, uncontrollable)
        return composed(plant.diagrams, initial, steps, together(plant.automaton), within)


class _Growing:
    """The states `begin`, those that are known to lead to them, and from where steps lead to these, within a set, in
    layers; `new` is what has come last.
    """

    def __init__(self, begin: Function, known: Sequence[Function], within: Function) -> None:
        self.layers = [(begin | layer) & within for layer in known]
        self.new = self.seen = self.layers[-1]
        self._within = within

    def go_on(self, steps: Sequence[TransitionStep]) -> bool:
        """Go a step back, or several; False if there is nothing more."""
        before = self.new
        for step in steps:
            before |= step.before(before) & self._within
        self.new = before & ~self.seen
        self.seen |= self.new
        self.layers.append(self.seen)
        return self.new.satisfiable()


# The same questions where the states that are reached are too many to be computed.
#
# Instead of them two sets stand: `evidence` that are known lead through fewer, and what is composed of parts has more
# (`synthesis.approximation`). A state in the former is reached, one outside the latter is not; of any other it is found
# out by going back from it, as far as to a known run, which is then continued, or until nothing leads there. From
# where a goal can be brought about is computed within the latter, too. So answers are exact; but a run need not be the
# shortest.

MOST_EFFORT = 300_000_000  # nodes for all questions, see `synthesis.transition_relation`: half a minute
MOST_FOR_EACH = 60_000_000
_FIRST = 40_000_000  # of these, to begin
_PLANNING = 10.0  # seconds, for a plan that leads through the work of all operations


@dataclass
class FarAnswers:
    """The findings of what is not possible, or not known, and what that rests on, for the next time; None if nothing is
    known.
    """

    findings: list[FeasibilityFinding]
    evidence: Evidence | None


def from_afar(
    automaton: Automaton,
    subjects: Sequence[Subject],
    safe: StateSet,
    supervisor: Supervisor,
    planning: float = _PLANNING,
    known: Evidence | None = None,
) -> FarAnswers:
    """Return what is not possible of `subjects` under the `supervisor`, or not known, where too much is reached.

    No more than so many seconds are spent on `planning`: what is not known by a plan is found out otherwise. What is
    `known` of the model before an edit is proven again; where that leaves something open, all is found out anew.
    """
    asked = Questions(automaton, [each for subject in subjects for each in subject.expressions], safe)
    plans = Plans(automaton, supervisor, planning)
    if known is not None:
        again = _answers(asked, subjects, supervisor, partial(_resumed, asked, plans, known))
        if not any(each.kind == UNKNOWN for each in again.findings):
            return again
    return _answers(asked, subjects, supervisor, partial(_anew, asked, plans))


def _answers(
    asked: Questions,
    subjects: Sequence[Subject],
    supervisor: Supervisor,
    begin: Callable[[NodeLimit], FarInquiry | None],
) -> FarAnswers:
    whole = NodeLimit(MOST_EFFORT)
    inquiry = begin(whole)
    if inquiry is None:
        return FarAnswers([FeasibilityFinding(UNKNOWN, subject, "") for subject in subjects], None)
    possibility = Possibility(asked.automaton, inquiry)
    found: list[FeasibilityFinding] = []
    for subject in subjects:
        inquiry.effort = NodeLimit(MOST_FOR_EACH, whole=whole)
        try:
            found += list(possibility.findings(subject))
        except TooMuchError:
            found.append(FeasibilityFinding(UNKNOWN, subject, ""))
    return FarAnswers(found, inquiry.evidence(supervisor))


def _anew(asked: Questions, plans: Plans, whole: NodeLimit) -> FarInquiry | None:
    inquiry = begun(asked, whole, plans)
    if inquiry is not None:
        inquiry.know_plan(plans.all_goals)
    return inquiry


def _resumed(asked: Questions, plans: Plans, known: Evidence, whole: NodeLimit) -> FarInquiry | None:
    """An inquiry that goes on from what was `known`; None where that is not soon proven again."""
    with suppress(TooMuchError):
        inquiry = FarInquiry(asked, whole, known.ordered(asked.bearing), plans)
        if not inquiry.recall(known):
            inquiry.know_plan(plans.all_goals)
        return inquiry
    return None


def begun(asked: Questions, whole: NodeLimit, plans: Plans | None = None) -> FarInquiry | None:
    """An inquiry in the first order of variables in which it soon begins, or begins at all."""
    automaton = asked.automaton
    names = sorted(asked.bearing, key=list(automaton.variables).index)
    if bits(automaton, names) > MOST_BITS:
        return None
    for most in (_FIRST, MOST_EFFORT):
        for order in orders(automaton, names):
            inquiry = FarInquiry(asked, NodeLimit(most, whole=whole), order, plans)
            with suppress(TooMuchError):
                inquiry.perhaps_reached()
                inquiry.whole = whole
                return inquiry
    return None
