"""Ticks on a live station, and the start order followed through them.

Pure: it has no clock, does no I/O and starts nothing but in its own state. Whoever runs it brings measurements and
plans, and carries out what a tick's outcome says.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from sequence_planner.automaton.compiled import CompiledRun, CompiledTick
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, Kind, State
from sequence_planner.automaton.tick import reverts
from sequence_planner.control.moment import Moment
from sequence_planner.control.start_order import StartOrder
from sequence_planner.control.view import Mode, PlanStatus, Production
from sequence_planner.expressions.types import Value
from sequence_planner.planning.plan import PlanAnswer, PlanRequest, Verdict
from sequence_planner.planning.replay import Replay


@dataclass(frozen=True)
class TickOutcome:
    """What a tick did. `outputs` are the output variables to be published now.

    `finished` are the abilities that took their finish actions, which one may do again and again while its finish guard
    holds; `ended` are those of them that had been running.
    """

    finished: tuple[str, ...]
    ended: tuple[str, ...]
    started: tuple[str, ...]
    activated: frozenset[str]
    completed: frozenset[str]
    conflicts: tuple[tuple[str, str, str], ...]
    outputs: frozenset[str]
    changed: bool


class Execution:
    """The state of a running station."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self.automaton = automaton
        self.supervisor = supervisor
        self._compiled = CompiledTick(automaton)
        unmeasured = dict.fromkeys(automaton.names(Kind.MEASURED), None)
        self._run = CompiledRun(self._compiled, {**automaton.initial_valuation, **unmeasured})
        self._run.synchronise()
        self.published: State = self.state
        self.active: frozenset[str] = frozenset()
        self.mode = Mode.AUTOMATIC
        self.production = Production.PREPARING
        self.order = StartOrder()
        self.plan_status = PlanStatus.IDLE
        self.plan_reason = ""
        self.answer: PlanAnswer | None = None
        self.replanned = 0
        self.ticks = 0
        self.obstacles: tuple[str, ...] = ()  # what keeps everything from starting, as one waits for it
        self._replay = Replay(automaton, supervisor)
        self._asked: tuple[frozenset[str], State] | None = None
        self._started_since_asked = False
        self._none_while_blind = False  # the last answer was that there is no plan, and values were unknown

    @property
    def state(self) -> State:
        """The values of all variables and flags. It can be set to any other state, from which the ticks then go on."""
        return self._run.state

    @state.setter
    def state(self, state: State) -> None:
        self._run = CompiledRun(self._compiled, state)

    @property
    def safe(self) -> bool:
        """Whether the state is in the safe set for every value its unknown variables could have."""
        return self.supervisor.safe.includes(self.state)

    @property
    def blind(self) -> bool:
        """Whether some measured variable has no value."""
        return self._is_blind(self.state)

    def _is_blind(self, state: State) -> bool:
        return any(state[name] is None for name in self.automaton.names(Kind.MEASURED))

    def start_production(self) -> None:
        """From now on outputs are published; all of them at once, by whoever runs this."""
        self.production = Production.STARTED
        self.published = self.state

    def tick(self, measured: Mapping[str, Value | None], now: Moment) -> TickOutcome:
        """One tick with the given measured values. One that raises has not happened: all is as it was before."""
        kept = (self.state, self.published, self.active, self.order.copy(), self.plan_status, self.plan_reason)
        started = self._started_since_asked
        try:
            outcome = self._tick(measured, now)
        except BaseException:
            self.state, self.published, self.active, self.order, self.plan_status, self.plan_reason = kept
            self._started_since_asked = started
            raise
        self.ticks += 1
        return outcome

    def _tick(self, measured: Mapping[str, Value | None], now: Moment) -> TickOutcome:
        before = self.state
        self._run.sense(measured)
        finishing = self._run.finish()
        self._run.synchronise()
        ended = tuple(name for name in finishing.finished if self.order.finish(name, now))
        active = self._run.update_operations(self.active)
        self._run.record_activity(active)
        activated, completed = active - self.active, self.active - active
        self.active = active
        self.order.goals &= active
        if not self.order.goals:
            self.order.drop()  # goals already met need no plan
        started = self._start(now)
        moved = self._moved_from(before)
        self._look_at_plan(changed=bool(started) or moved)
        # Before production is started nothing is published, and then all outputs are: no change of one is news.
        news = self.automaton.outputs if self.production is Production.STARTED else ()
        outputs = frozenset(name for name in news if self.state[name] != self.published[name])
        self.published = self.state
        changed = bool(started or ended or activated or completed or outputs) or moved
        return TickOutcome(
            finishing.finished, ended, started, activated, completed, finishing.conflicts, outputs, changed
        )

    def _moved_from(self, before: State) -> bool:
        return self.state is not before and self.state != before

    def request(self, deadline: float) -> PlanRequest | None:
        """What to ask the planner now, or None when there is nothing to ask or it would answer the same again."""
        wanted = self._wanted()
        if not wanted or self._asked == (wanted, self.state):
            return None
        self._asked = (wanted, self.state)
        self._started_since_asked = False
        # That there was no plan stays so until an answer says otherwise, unless only knowledge was missing.
        if self.plan_status is PlanStatus.IDLE or (self.plan_status is PlanStatus.NONE and self._none_while_blind):
            self.plan_status = PlanStatus.PLANNING
            self.plan_reason = "a plan is being looked for"
        return PlanRequest(dict(self.state), tuple(self.goals[name] for name in sorted(wanted)), deadline)

    def unanswered(self, why: str, again: bool) -> None:
        """The planner could not answer. With `again` the same question is asked once more, else only another one."""
        if again:
            self._asked = None
        if self.plan_status is PlanStatus.PLANNING:
            self.plan_status = PlanStatus.NONE
            self.plan_reason = f"no plan: {why}"
            self._none_while_blind = False

    def adopt(self, request: PlanRequest, answer: PlanAnswer) -> bool:
        """Follow an answered plan, if it still fits the state. False when a new one must be asked for."""
        self._asked = None
        wanted = self._wanted()
        if not wanted:
            return True
        if answer.plan is None:
            return self._adopt_none(request, answer)
        if self._started_since_asked:
            return False  # the old plan went on, and the new one may hold what it has started
        goals = frozenset(answer.goals) & self.active
        starts = tuple(name for _, name in answer.plan.starts)
        if not self._replay.still_reaches(self.state, self.published, goals, starts, answer.plan.ticks):
            return False
        replacing = self.plan_status in (PlanStatus.FOLLOWED, PlanStatus.BROKEN) and bool(self.order.ahead)
        self.replanned += replacing
        self.plan_reason = self._why_new(wanted, replacing)
        self.order.adopt(answer.plan, goals, request.goals)
        self.answer = answer
        self.plan_status = PlanStatus.FOLLOWED
        return True

    def _adopt_none(self, request: PlanRequest, answer: PlanAnswer) -> bool:
        """There is no plan, or was none a moment ago: a station that is never still must hear of that too."""
        current = request.state == self.state and frozenset(request.goals) == self.active
        if not current and (self.plan_status is PlanStatus.FOLLOWED or frozenset(request.goals) != self.active):
            return False
        self.answer = answer
        self.plan_status = PlanStatus.NONE
        self._none_while_blind = self._is_blind(request.state)
        self.plan_reason = _why_none(answer, self._none_while_blind)
        if current:
            self._asked = (self.active, self.state)
            self.order.adopt(None, (), request.goals)
        return current

    def _start(self, now: Moment) -> tuple[str, ...]:
        """Step 5: the first abilities of the order start, as long as they may."""
        started: list[str] = []
        if self.mode is not Mode.AUTOMATIC or self.production is not Production.STARTED or self.obstacles:
            return ()
        while self._next_may_start():
            self._run.start(self.order.ahead[0].ability)
            self._started_since_asked = True
            step = self.order.start(now)
            ability = self.automaton.abilities[step.ability]
            if ability.finish_guard is None:
                step.ended = now
            started.append(ability.name)
        return tuple(started)

    def _next_may_start(self) -> bool:
        """Whether the first ability of the order starts now, or else it waits.

        While it waits, the order is as good as any other in which the rest still reaches the goals: the first ability
        behind it for which that holds is pulled to the front. So a robot does not wait for a person whose task has
        nothing to do with it.
        """
        if not self.order.ahead:
            return False
        after = self.startable(self.order.ahead[0].ability)
        if after is not None and self.may_go_on(after):
            return True
        tried = {self.order.ahead[0].ability}
        for index, step in enumerate(self.order.ahead[1:], start=1):
            if step.ability in tried:
                continue
            tried.add(step.ability)
            after = self.startable(step.ability)
            rest = self.order.names[:index] + self.order.names[index + 1 :]
            if after is not None and self._replay.eagerly(after, self.published, self.order.goals, rest):
                self.order.pull_forward(index)
                return True
        return False

    def startable(self, name: str) -> State | None:
        """The state after the start of the ability, if its guards and the supervisor allow it now."""
        if name not in self._run.startable() or self.automaton.abilities[name].restart:
            return None  # there is no mode yet in which a restart ability may start
        after = self._run.after_start(name)
        if after is None or reverts(self.automaton, self.published, self.state, after):
            return None
        return after if self.supervisor.allows(self.state, after) else None

    def may_go_on(self, after: State) -> bool:
        """Whether the order after its first start, which leads to the state `after`, still reaches the goals."""
        starts, ticks = self.order.rest(taken=1)
        return self._replay.may_go_on(self.state, after, self.published, self.order.goals, starts, ticks)

    def _look_at_plan(self, changed: bool) -> None:
        """Notice that the plan is done with, or that the state has departed from it."""
        if not self.active:
            self.plan_status = PlanStatus.IDLE
            self.plan_reason = "no operation is active"
            self.order.adopt(None, (), ())
        elif self.production is not Production.STARTED:
            self.plan_reason = "production has not been started"
        elif self.plan_status is PlanStatus.FOLLOWED and changed and self.order.goals:
            starts, ticks = self.order.rest()
            if not self._replay.still_reaches(self.state, self.published, self.order.goals, starts, ticks):
                self.plan_status = PlanStatus.BROKEN

    def _wanted(self) -> frozenset[str]:
        """The goals to plan for, when there is reason to plan."""
        if not self.active or self.production is not Production.STARTED:
            return frozenset()
        new_goals = bool(self.active - self.order.requested)
        done = self.plan_status is PlanStatus.FOLLOWED and not self.order.goals
        return self.active if new_goals or done or self.plan_status is not PlanStatus.FOLLOWED else frozenset()

    def _why_new(self, wanted: frozenset[str], replacing: bool) -> str:
        new = [self.automaton.operations[name].title for name in sorted(wanted - self.order.requested)]
        if self.plan_status is PlanStatus.BROKEN:
            return "re-planned: the station departed from the plan, which no longer reached its goals"
        if replacing and new:
            return f"re-planned: {_listed(new)} became active"
        return f"planned for {_listed([self.automaton.operations[name].title for name in sorted(wanted)])}"


def _why_none(answer: PlanAnswer, blind: bool) -> str:
    if blind:
        return "no plan while measured values are unknown"
    if answer.verdict is Verdict.NONE_AT_ALL:
        return "no plan at all: nothing the station can do from here reaches any of the goals"
    return f"no plan found: none of up to {answer.searched} ticks"


def _listed(titles: Iterable[str]) -> str:
    return ", ".join(titles)
