"""Plan tracking: replanning decisions, progress of the current plan, and reasons for its replacement."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from copy import copy
from dataclasses import dataclass, field, replace

from sequence_planner.automaton.automaton import Automaton, Kind, State
from sequence_planner.automaton.compiled_tick import CompiledRun
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.state import ActiveGoals
from sequence_planner.execution.vocabulary import PlanStatus
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import TRUE
from sequence_planner.planning.diagnosis import Diagnosis, DiagnosisRequest
from sequence_planner.planning.goals.pursuit import Goals, moved
from sequence_planner.planning.problem import (
    Circumstances,
    Contract,
    Plan,
    PlanAnswer,
    PlanRequest,
    PlanTick,
    Verdict,
)
from sequence_planner.planning.validation.lookahead import Lookahead
from sequence_planner.texts.message import all_titles, message

# Why there is a plan, or none: sentences for the people at the station.


def why_new(
    automaton: Automaton, status: PlanStatus, wanted: frozenset[str], requested: frozenset[str], replacing: bool
) -> str:
    """Say why a new plan is followed; `status` is that of the one before, which `requested` had been asked for."""
    new = wanted - requested
    if status is PlanStatus.BROKEN:
        return message("plan.departed")
    if replacing and new:
        return message("plan.became-active", operations=_titles(automaton, new))
    if replacing:
        return message("plan.better")
    return message("plan.made", operations=_titles(automaton, wanted))


def why_none(answer: PlanAnswer, blind: bool) -> str:
    """Say why there is no plan. `blind`: there were measured values that nobody knew."""
    if answer.verdict is Verdict.NONE_AT_ALL:
        return message("plan.none-at-all-blind" if blind else "plan.none-at-all")
    if blind:
        return message("plan.none-blind")
    if answer.verdict is Verdict.LATE and answer.searched <= 0:
        return message("plan.late-unknown")
    late = answer.verdict is Verdict.LATE
    return message("plan.late" if late else "plan.none-up-to", ticks=answer.searched)


def why_violated(automaton: Automaton, names: Iterable[str]) -> str:
    """That none of the operations can be planned, since their formulas were violated."""
    return message("plan.violated", violations="; ".join(violation(automaton, name) for name in sorted(names)))


def violation(automaton: Automaton, name: str) -> str:
    """That the formula of an operation was violated."""
    return message("plan.violation", formula=formula_of(automaton, name), operation=automaton.operations[name].title)


def formula_of(automaton: Automaton, name: str) -> str:
    """The formula of an operation, as it is written."""
    return print_expression(automaton.operations[name].local or TRUE)


def _titles(automaton: Automaton, names: Iterable[str]) -> str:
    return all_titles(automaton.operations[name].title for name in sorted(names))


# The plan that is being followed: what was started, what runs, what comes next.

# An operator looks back on the last minute, and on a few steps at least; older ones are history, and so are those of
# abilities that follow one another faster than can be read.
LOOK_BACK = 60.0
FEWEST_STEPS = 12
REMEMBERED_STEPS = 40


@dataclass
class PlannedStart:
    """One start, planned or taken; `ended` is None while it runs. It has `reacted` once it was seen executing."""

    number: int
    ability: str
    tick: int
    started: Timestamp | None = None
    ended: Timestamp | None = None
    reacted: bool = False


@dataclass
class PlanCursor:
    """The rest of a plan, and the steps taken so far, of this plan and of those before."""

    plan: Plan | None = None
    goals: frozenset[str] = frozenset()  # what it was made for and is not reached yet
    requested: frozenset[str] = frozenset()  # what was asked of the planner, left out or not
    past: list[PlannedStart] = field(default_factory=list)
    ahead: list[PlannedStart] = field(default_factory=list)
    _numbers: int = 0

    def adopt(self, plan: Plan | None, goals: Iterable[str], requested: Iterable[str]) -> None:
        """Follow `plan` from now on; steps already taken stay what they are."""
        self.plan = plan
        self.goals = frozenset(goals)
        self.requested = frozenset(requested)
        self.ahead = [self._step(ability, tick) for tick, ability in plan.starts] if plan else []

    @property
    def first(self) -> int:
        """The number of the first step of the plan; without a plan, the number that the next step will have."""
        return self._numbers + 1 - (len(self.plan.starts) if self.plan is not None else 0)

    def copy(self) -> PlanCursor:
        """One that does not change when this one does."""
        return replace(self, past=[replace(step) for step in self.past], ahead=[replace(step) for step in self.ahead])

    def drop(self) -> None:
        """Drop what is left of the plan, which has become needless."""
        self.ahead.clear()

    def start(self, now: Timestamp) -> PlannedStart:
        """The first step ahead is taken. An earlier run of its ability that was never seen to finish is over."""
        step = self.ahead.pop(0)
        self.finish(step.ability, now)
        step.started = now
        self.past.append(step)
        self._forget(now)
        return step

    def _forget(self, now: Timestamp) -> None:
        ended = [(past, past.ended.monotonic) for past in self.past if past.ended is not None]
        since = now.monotonic - LOOK_BACK
        for age, (step, at) in enumerate(reversed(ended), 1):
            if age > REMEMBERED_STEPS or (age > FEWEST_STEPS and at < since):
                self.past.remove(step)

    def pull_forward(self, index: int) -> None:
        """The step ahead at `index` becomes the next. The order then is no longer that of the plan's ticks."""
        self.ahead.insert(0, self.ahead.pop(index))

    def finish(self, ability: str, now: Timestamp) -> bool:
        """The ability finished; whether it was running."""
        for step in self.past:
            if step.ability == ability and step.ended is None:
                step.ended = now
                return True
        return False

    @property
    def running(self) -> list[PlannedStart]:
        """The steps that have started and not finished."""
        return [step for step in self.past if step.ended is None]

    @property
    def names(self) -> tuple[str, ...]:
        """The abilities still to be started, in order."""
        return tuple(step.ability for step in self.ahead)

    def rest(self, taken: int = 0) -> tuple[tuple[str, ...], Sequence[PlanTick]]:
        """The starts ahead after the next `taken`, and those ticks of the plan that lie behind the tick under way.

        The tick under way is the one of the last start taken, or the beginning of the plan. There are no such ticks
        when the order is no longer the plan's.
        """
        names = self.names[taken:]
        planned = self.plan.starts if self.plan is not None else ()
        done = len(planned) - len(names)
        if self.plan is None or tuple(name for _, name in planned[done:]) != names:
            return names, ()
        current = planned[done - 1][0] if done else 0
        return names, self.plan.ticks[current:]

    def _step(self, ability: str, tick: int) -> PlannedStart:
        self._numbers += 1
        return PlannedStart(self._numbers, ability, tick)


# The plan of a running station: what to ask the planner, which of its answers to follow, and for how long.
#
# Pure, as `executor` is. The first question is for a plan soon, so that the station moves at once; while that plan is
# followed, better ones are asked for, and one is taken only if it leads to the goals in fewer ticks or starts.


@dataclass(frozen=True)
class ExecutionSnapshot:
    """The situation a plan is made for: the run as it stands, the outputs as last published, and what is pursued, in
    what circumstances.
    """

    run: CompiledRun
    published: State
    pursued: ActiveGoals
    circumstances: Circumstances
    confirmed: bool = False  # a person has taken the plan as it is written


@dataclass(frozen=True)
class Replacement:
    """A plan took the place of another: why, which starts went with the old one, and which steps are new."""

    why: str
    dropped: tuple[str, ...]
    new: frozenset[int]


@dataclass(frozen=True)
class PlanQuestion:
    """The question that an answer is about: the answer would be the same again."""

    goals: frozenset[str]
    state: State
    circumstances: Circumstances


class PlanTracker:
    """The start order that is followed, and all that is said about it."""

    def __init__(self, automaton: Automaton, lookahead: Lookahead) -> None:
        self.order = PlanCursor()
        self.status = PlanStatus.IDLE
        self.reason = ""
        self.answer: PlanAnswer | None = None
        self.replanned = 0
        self.replacement: Replacement | None = None  # how the plan that is followed took the place of another
        self._automaton = automaton
        self._lookahead = lookahead
        self._asked: PlanQuestion | None = None
        self._asked_better: PlanQuestion | None = None
        self._started_since_asked = False
        self._none_while_blind = False  # the last answer was that there is no plan, and values were unknown
        self._undecided = False  # whether there is a plan: nobody could say when asked last
        self._none: PlanRequest | None = None  # what there is no plan at all for, as long as nobody has said why
        self.diagnosis: Diagnosis | None = None  # why there is no plan at all

    def copy(self) -> PlanTracker:
        """One that does not change when this one does."""
        other = copy(self)
        other.order = self.order.copy()
        return other

    def request(self, present: ExecutionSnapshot, deadline: float) -> PlanRequest | None:
        """A question for a plan that is needed; None when none is, or it would be answered the same again."""
        wanted = self._wanted(present)
        question = _question(present, wanted)
        if not wanted or self._asked == question:
            return None
        self._asked = question
        self._started_since_asked = False
        # That there was no plan stays so until an answer says otherwise, unless only knowledge was missing.
        if self.status is PlanStatus.IDLE or (self.status is PlanStatus.NONE and self._none_while_blind):
            self.status = PlanStatus.PLANNING
            self.reason = message("plan.looking")
        return _request(present, wanted, deadline, Contract.FAST)

    def better(self, present: ExecutionSnapshot, deadline: float) -> PlanRequest | None:
        """A question for a better plan than the one that is followed; None when it would be answered the same again.

        Where no answer came in time, it is the same question once more: engines go on where they were.
        """
        hopeful = present.pursued.hopeful
        if self._undecided and self.status is PlanStatus.NONE and hopeful:
            return _request(present, hopeful, deadline, Contract.FAST)
        question = _question(present, hopeful)
        incomplete = bool(self.order.ahead) or not hopeful <= self.order.goals  # something to do, or left out
        if not self._following(present) or not incomplete or self._asked_better == question:
            return None
        self._asked_better = question
        self._started_since_asked = False
        return _request(present, hopeful, deadline, Contract.MINIMAL)

    def unanswered(self, why: str, again: bool) -> None:
        """The planner could not answer. With `again` the same question is asked once more, else only another one."""
        if again:
            self._asked = self._asked_better = None
        if self.status is PlanStatus.PLANNING:
            self.status = PlanStatus.NONE
            self.reason = message("plan.unanswered", why=why)
            self._none_while_blind = False
            self._undecided = True

    def unexplained(self, deadline: float) -> DiagnosisRequest | None:
        """A question why there is no plan at all; None when there may be one, or it has been answered."""
        none = self._none
        if none is None or self.status is not PlanStatus.NONE:
            return None
        return DiagnosisRequest(none.state, none.goals, none.circumstances, deadline)

    def explained(self, diagnosis: Diagnosis) -> None:
        """Take note of why there is no plan, as far as that was found."""
        if self._none is not None and self.status is PlanStatus.NONE:
            self._none, self.diagnosis = None, diagnosis

    def adopt(self, present: ExecutionSnapshot, request: PlanRequest, answer: PlanAnswer) -> bool:
        """Follow an answered plan, if it still fits the state. False when a new one must be asked for.

        While a plan is followed, another must be better to take its place.
        """
        self._asked = None
        hopeful = present.pursued.hopeful
        if not hopeful:
            return True
        following = self._following(present)
        if answer.plan is None:
            return following or self._carry_on(request) or self._adopt_none(present, request, answer)
        if self._started_since_asked:
            return following  # the old plan went on, and the new one may hold what it has started
        goals = frozenset(answer.goals) & hopeful
        starts = tuple(name for _, name in answer.plan.starts)
        ticks = self._lookahead.remaining(
            present.run, present.published, present.pursued.select(goals), starts, answer.plan.ticks
        )
        if ticks is None:
            return following
        if following and not self._is_better(present, goals, ticks, answer.plan):
            return True
        same = starts == self.order.names
        replacing = not same and self.status in (PlanStatus.FOLLOWED, PlanStatus.BROKEN) and bool(self.order.ahead)
        self.replanned += replacing
        if not (following and same):
            self.reason = why_new(self._automaton, self.status, hopeful, self.order.requested, replacing)
        before = self.order.names
        self.order.adopt(answer.plan, goals, (goal.name for goal in request.goals))
        if replacing:
            self.replacement = _replacement(self.reason, before, self.order)
        elif not same:
            self.replacement = None
        self.answer = answer
        self.status = PlanStatus.FOLLOWED
        self._none = self.diagnosis = None
        if not hopeful <= goals:
            self._asked_better = None  # it may be an answer about what was for a moment, such as a device being silent
        return True

    def follow(self, plan: Plan, goals: frozenset[str], reason: str) -> None:
        """Follow a plan that a person has taken, as long as it leads to `goals`; one without is followed regardless."""
        self.order.adopt(plan, goals, goals)
        self.status, self.reason = PlanStatus.FOLLOWED, reason
        self._rest()

    def drop(self, reason: str) -> None:
        """Nothing is planned for until further notice."""
        self.order.adopt(None, (), ())
        self.status, self.reason = PlanStatus.IDLE, reason
        self._rest()

    def _rest(self) -> None:
        """Drop questions and answers about another plan."""
        self.answer = self._asked = self._asked_better = self._none = self.diagnosis = self.replacement = None
        self._none_while_blind = self._undecided = False

    def looks(self, lookahead: Lookahead) -> bool:
        """Return whether it is `lookahead` that says where the rest of the plan leads."""
        return self._lookahead is lookahead

    def use_lookahead(self, lookahead: Lookahead) -> None:
        """From now on `lookahead` says it."""
        self._lookahead = lookahead

    def settle(self, active: frozenset[str], hopeful: frozenset[str]) -> None:
        """After step 4: what is reached, or can no more be reached as it should be, is no longer planned for."""
        if self.status is PlanStatus.FOLLOWED and not self.order.goals & active <= hopeful:
            self.status = PlanStatus.BROKEN
        self.order.goals &= hopeful
        self.order.requested &= hopeful  # one that becomes active again is wanted again
        if not self.order.goals:
            self.order.drop()  # goals already met need no plan

    def next_may_start(self, present: ExecutionSnapshot, after_start: Callable[[str], CompiledRun | None]) -> bool:
        """Return whether the first ability of the order starts now, or else it waits. `after_start` is None while it
        may not.

        While it waits, the order is as good as any other in which the rest still reaches the goals: the first ability
        behind it for which that holds is pulled to the front. So a robot does not wait for a person whose task has
        nothing to do with it.
        """
        if not self.order.ahead:
            return False
        after = after_start(self.order.ahead[0].ability)
        if after is not None and self.may_go_on(present, after):
            return True
        if present.confirmed:
            return False
        tried = {self.order.ahead[0].ability}
        for index, step in enumerate(self.order.ahead[1:], start=1):
            if step.ability in tried:
                continue
            tried.add(step.ability)
            after = after_start(step.ability)
            rest = self.order.names[:index] + self.order.names[index + 1 :]
            goals = None if after is None else self._goals_after(present, after)
            if after is None or goals is None:
                continue
            if self._lookahead.length(after, present.published, goals, rest) is not None:
                self.order.pull_forward(index)
                return True
        return False

    def may_go_on(self, present: ExecutionSnapshot, after: CompiledRun, lookahead: Lookahead | None = None) -> bool:
        """Return whether the order after its first start, which leads to `after`, still reaches the goals.

        With a `lookahead` of one's own, nothing is changed by asking.
        """
        starts, ticks = self.order.rest(taken=1)
        goals, lookahead = self._goals_after(present, after), lookahead or self._lookahead
        if goals is not None and present.confirmed:
            return self._its_turn(present, after, goals, lookahead)
        return goals is not None and lookahead.may_go_on(present.run, after, present.published, goals, starts, ticks)

    def _its_turn(self, present: ExecutionSnapshot, after: CompiledRun, goals: Goals, lookahead: Lookahead) -> bool:
        """Return whether a start that a person has seen comes now: as it was written, or else as soon as it still
        helps.

        It does not wait for what may happen by itself beside it: a person may not come, a device do nothing more.
        """
        if lookahead.as_written(after, present.published, goals, *self.order.rest(taken=1)):
            return True
        before = present.pursued.select(self.order.goals)
        if lookahead.as_written(present.run, present.published, before, *self.order.rest()):
            return False
        return lookahead.length(after, present.published, goals, self.order.names[1:]) is not None

    def _goals_after(self, present: ExecutionSnapshot, after: CompiledRun) -> Goals | None:
        """The goals of the plan after a start; None when it violates a formula of theirs.

        Nor may it violate one that the planner has not been asked about yet.
        """
        new = present.pursued.hopeful - self.order.requested
        if moved(present.pursued.select(new), after.values) is None:
            return None
        return moved(present.pursued.select(self.order.goals), after.values)

    def start(self, now: Timestamp) -> PlannedStart:
        """The first ability of the order has been started."""
        self._started_since_asked = True
        return self.order.start(now)

    def update(self, present: ExecutionSnapshot, active: frozenset[str]) -> None:
        """Notice that the plan is done with, or that the state has departed from it."""
        if not active:
            self.status, self.reason = PlanStatus.IDLE, message("plan.none-active")
            self._none = self.diagnosis = None
            self.order.adopt(None, (), ())
        elif not present.pursued.goals:
            self.reason = message("plan.not-started")
        elif not present.pursued.hopeful:
            self.status, self.reason = PlanStatus.NONE, why_violated(self._automaton, active)
            self._none_while_blind = False
            self.order.adopt(None, (), ())
        elif self.status is PlanStatus.FOLLOWED and self.order.goals and self._left(present) is None:
            self.status = PlanStatus.BROKEN

    def still_leads(self, present: ExecutionSnapshot) -> bool:
        """Return whether what is left of the plan reaches its goals from here."""
        if self._left(present) is not None:
            return True
        goals = present.pursued.select(self.order.goals)
        return self._lookahead.as_written(present.run, present.published, goals, *self.order.rest())

    def _following(self, present: ExecutionSnapshot) -> bool:
        return bool(present.pursued.hopeful) and not self._wanted(present)

    def _wanted(self, present: ExecutionSnapshot) -> frozenset[str]:
        """The goals to plan for, when there is need of a plan."""
        hopeful = present.pursued.hopeful
        new_goals = not hopeful <= self.order.requested
        done = self.status is PlanStatus.FOLLOWED and not self.order.goals
        return hopeful if new_goals or done or self.status is not PlanStatus.FOLLOWED else frozenset()

    def _left(self, present: ExecutionSnapshot) -> int | None:
        """In how many ticks the rest of the plan reaches its goals; None when it does not."""
        goals = present.pursued.select(self.order.goals)
        return self._lookahead.remaining(present.run, present.published, goals, *self.order.rest())

    def _is_better(self, present: ExecutionSnapshot, goals: frozenset[str], ticks: int, plan: Plan) -> bool:
        """Return whether `plan` has more goals than the one that is followed, or fewer ticks, or fewer starts, or more
        proof.

        Only what is better takes a plan's place: were it enough to be as good, plans would take turns.
        """
        left = self._left(present)
        if left is None or not goals >= self.order.goals:
            return left is None
        mine = (-len(self.order.goals), left, len(self.order.ahead), not _is_proven(self.order.plan))
        return (-len(goals), ticks, len(plan.starts), not _is_proven(plan)) < mine

    def _carry_on(self, request: PlanRequest) -> bool:
        """Return whether the plan at hand still leads to its goals; others that were asked for are left out for now."""
        if self.status is not PlanStatus.FOLLOWED or not self.order.goals or self.answer is None:
            return False
        asked = frozenset(goal.name for goal in request.goals)
        self.order.requested |= asked
        left_out = tuple(sorted(asked - self.order.goals))
        self.answer = replace(self.answer, left_out=left_out, undecided=left_out)
        return True

    def _adopt_none(self, present: ExecutionSnapshot, request: PlanRequest, answer: PlanAnswer) -> bool:
        """There is no plan, or was none a moment ago: a station that is never still must hear of that too."""
        asked = frozenset(goal.name for goal in request.goals)
        if asked != present.pursued.hopeful:
            return False
        current = PlanQuestion(asked, request.state, request.circumstances) == _question(present, asked)
        self.answer = answer
        self.status = PlanStatus.NONE
        self._none_while_blind = any(request.state[name] is None for name in self._automaton.names(Kind.MEASURED))
        self.reason = why_none(answer, self._none_while_blind)
        self._undecided = answer.verdict is Verdict.LATE
        self._none = request if answer.verdict is Verdict.NONE_AT_ALL else None
        if self._none is None:
            self.diagnosis = None  # else what was said a moment ago stays until more is known
        if current:
            self._asked = _question(present, asked)
            self.order.adopt(None, (), asked)
        return current


def _replacement(why: str, before: tuple[str, ...], order: PlanCursor) -> Replacement:
    """Return what is different of what is ahead; a start that both plans have is the same, whenever it comes."""
    dropped = Counter(before)
    new: set[int] = set()
    for step in order.ahead:
        if dropped[step.ability]:
            dropped[step.ability] -= 1
        else:
            new.add(step.number)
    return Replacement(why, tuple(dropped.elements()), frozenset(new))


def _is_proven(plan: Plan | None) -> bool:
    return plan is not None and plan.minimal_ticks and plan.minimal_starts


def _question(present: ExecutionSnapshot, goals: frozenset[str]) -> PlanQuestion:
    return PlanQuestion(goals, present.run.state, present.circumstances)


def _request(present: ExecutionSnapshot, goals: frozenset[str], deadline: float, contract: Contract) -> PlanRequest:
    return PlanRequest(
        dict(present.run.state),
        present.pursued.select(goals),
        deadline,
        contract=contract,
        circumstances=present.circumstances,
    )
