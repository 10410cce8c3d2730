"""The same questions where the states that are reached are too many to be computed.

Instead of them two sets stand: `runs` that are known lead through fewer, and what is composed of parts has more
(`synthesis.approximation`). A state in the former is reached, one outside the latter is not; of any other it is found
out by going back from it, as far as to a known run, which is then continued, or until nothing leads there. From where a
goal can be brought about is computed within the latter, too. So answers are exact; but a run need not be the shortest.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress

from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.automaton.tick import initial_state
from sequence_planner.checking.inquiry import Inquiry, bearing_on, bits
from sequence_planner.checking.possibility import UNKNOWN, Finding, Possibility, Subject
from sequence_planner.checking.runs import Runs
from sequence_planner.expressions.syntax import Expression
from sequence_planner.planning.plan import Contract, PlanRequest, PlanTick, goals_of
from sequence_planner.synthesis.approximation import around, composed
from sequence_planner.synthesis.diagrams import Function
from sequence_planner.synthesis.effort import MOST_BITS, Effort, TooMuchError
from sequence_planner.synthesis.plant import Plant, orders, together
from sequence_planner.synthesis.shortest import Tracer
from sequence_planner.synthesis.steps import Step
from sequence_planner.synthesis.traces import Trace

MOST_EFFORT = 300_000_000  # nodes for all questions, see `synthesis.effort`: half a minute
MOST_FOR_EACH = 60_000_000
_FIRST = 40_000_000  # of these, to begin
_SOON = 3_000_000  # of these; for what takes longer, something else is tried first
_LARGER = (20, 26)  # bits of larger parts, and of those after them
_MOST_NEAR = 3  # states that are looked at one by one
_PLANNING = 10.0  # seconds, for a plan that leads through the work of all operations


def from_afar(
    automaton: Automaton,
    subjects: Sequence[Subject],
    safe: StateSet,
    supervisor: Supervisor,
    planning: float = _PLANNING,
) -> Iterator[Finding]:
    """What is not possible of `subjects` under the `supervisor`, or not known, where too much is reached.

    No more than so many seconds are spent on `planning`: what is not known by a plan is found out otherwise.
    """
    whole = Effort(MOST_EFFORT)
    inquiry = begun(automaton, subjects, safe, whole)
    if inquiry is None:
        yield from (Finding(UNKNOWN, subject, "") for subject in subjects)
        return
    inquiry.know(_work(automaton, supervisor, planning))
    possibility = Possibility(automaton, inquiry)
    for subject in subjects:
        inquiry.effort = Effort(MOST_FOR_EACH, whole=whole)
        try:
            yield from list(possibility.findings(subject))
        except TooMuchError:
            yield Finding(UNKNOWN, subject, "")


def begun(automaton: Automaton, subjects: Sequence[Subject], safe: StateSet, whole: Effort) -> FarInquiry | None:
    """An inquiry in the first order of variables in which it soon begins, or begins at all."""
    questions = [each for subject in subjects for each in subject.expressions]
    names = sorted(bearing_on(automaton, questions), key=list(automaton.variables).index)
    if bits(automaton, names) > MOST_BITS:
        return None
    for most in (_FIRST, MOST_EFFORT):
        for order in orders(automaton, names):
            inquiry = FarInquiry(automaton, questions, safe, Effort(most, whole=whole), order)
            with suppress(TooMuchError):
                inquiry.perhaps_reached()
                inquiry.whole = whole
                return inquiry
    return None


def _work(automaton: Automaton, supervisor: Supervisor, seconds: float) -> tuple[PlanTick, ...]:
    """A plan for the goals of all operations from the initial state, or of as many as one is soon found for."""
    if automaton.one_at_a_time or not automaton.operations:
        return ()
    from sequence_planner.planning.planner import Planner, PlannerError  # noqa: PLC0415 - few models need it

    goals = goals_of(automaton, automaton.operations)
    request = PlanRequest(initial_state(automaton), goals, seconds, contract=Contract.FAST)
    try:
        answer = Planner(automaton, supervisor).answer(request)
    except PlannerError:
        return ()
    return () if answer.plan is None else answer.plan.ticks


class FarInquiry(Inquiry):
    """An inquiry that takes less, and is soon answered where runs are known."""

    def __init__(
        self,
        automaton: Automaton,
        questions: Iterable[Expression],
        safe: StateSet,
        effort: Effort,
        order: Sequence[str] = (),
    ) -> None:
        super().__init__(automaton, questions, safe, effort, order)
        self._runs = Runs(self.plant, self.safe)
        self._more: dict[bool, Function] = {}
        self._level = {True: 0, False: 0}
        self.whole = effort  # for what serves all questions

    def know(self, ticks: Iterable[PlanTick]) -> None:
        """Take in a plan from the initial state."""
        self._runs.follow(ticks)

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

    def reached(self, target: Function, *, supervised: bool = True, faults: bool = True) -> Function:
        """Some of the states of `target` that are reached; none only if none of them is."""
        asked = self.effort
        try:
            for _ in self._closer(supervised):
                self.effort = Effort(_SOON, whole=asked)
                with suppress(TooMuchError):
                    return self._gone_back(target, supervised, faults)
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
        left = active & within & ~goal
        whole, looked = self.effort, False
        self.effort = Effort(_SOON, whole=whole)
        growing = _Growing(self.seen(goal, within), within)
        left &= ~growing.new
        while left.satisfiable():
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
            left &= ~growing.new
        self.effort = whole
        return self.reached(left)

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
                    return self.reached(one)
            near &= ~one
        return None

    def leads(self, states: Function, goal: Function) -> bool | None:
        """Whether `goal` can be reached from `states` without faults, the supervisor not asked; None if unknown."""
        if Tracer(self.plant, faults=False).leads(goal, states):
            return True
        with suppress(TooMuchError):
            perhaps = self._composed(self.plant, states, self.plant.helpful, self.diagrams.valid)
            if not (perhaps & goal).satisfiable():
                return False
        return None

    def may_ever(self, predicate: Expression) -> bool:
        """Whether it holds in any state that may be reached by any means."""
        plant, perhaps = self.ever
        if (plant.where(predicate) & perhaps).satisfiable():
            raise TooMuchError  # it may: which it is would have to be found out
        return False

    def _closed(self, plant: Plant) -> Function:
        return self._composed(plant, plant.initial, plant.uncontrollable, plant.diagrams.valid)

    def _composed(self, plant: Plant, initial: Function, uncontrollable: Sequence[Step], within: Function) -> Function:
        steps = self.limited(plant, uncontrollable)
        return composed(plant.diagrams, initial, steps, together(plant.automaton), within)


class _Growing:
    """`states`, and from where steps lead to them within a set; `new` is what has come last."""

    def __init__(self, states: Function, within: Function) -> None:
        self.new = states & within
        self._seen = self.new
        self._within = within

    def go_on(self, steps: Sequence[Step]) -> bool:
        """Go a step back, or several; False if there is nothing more."""
        before = self.new
        for step in steps:
            before |= step.before(before) & self._within
        self.new = before & ~self._seen
        self._seen |= self.new
        return self.new.satisfiable()
