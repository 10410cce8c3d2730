"""Ticks on a live station, and the start order followed through them.

Pure: it has no clock, does no I/O and starts nothing but in its own state. Whoever runs it brings measurements and
plans, and carries out what a tick's outcome says.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from sequence_planner.automaton.compiled import CompiledRun, CompiledTick
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, Kind, State
from sequence_planner.automaton.tick import reverts
from sequence_planner.control.live_plan import LivePlan, Present
from sequence_planner.control.moment import Moment
from sequence_planner.control.pursued import Pursued
from sequence_planner.control.view import Mode, Production
from sequence_planner.expressions.types import Value
from sequence_planner.planning.plan import Circumstances, PlanAnswer, PlanRequest
from sequence_planner.planning.replaying.lookahead import Lookahead


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
        self._lookahead = Lookahead(self._compiled, supervisor)
        unmeasured = dict.fromkeys(automaton.names(Kind.MEASURED), None)
        self._run = CompiledRun(self._compiled, {**automaton.initial_valuation, **unmeasured})
        self._run.synchronise()
        self.published: State = self.state
        self.active: frozenset[str] = frozenset()
        self.pursued = Pursued()
        self.circumstances = Circumstances()
        self.plan = LivePlan(automaton, self._lookahead)
        self.mode = Mode.AUTOMATIC
        self.production = Production.PREPARING
        self.ticks = 0
        self.obstacles: tuple[str, ...] = ()  # what keeps everything from starting, as one waits for it

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
        return any(self.state[name] is None for name in self.automaton.names(Kind.MEASURED))

    def start_production(self) -> None:
        """From now on outputs are published; all of them at once, by whoever runs this."""
        self.production = Production.STARTED
        self.published = self.state

    def face(self, circumstances: Circumstances) -> None:
        """From now on plans are made, and followed, in these circumstances."""
        if circumstances != self.circumstances:
            self.circumstances = circumstances
            self._lookahead.face(circumstances)

    def tick(self, measured: Mapping[str, Value | None], now: Moment) -> TickOutcome:
        """One tick with the given measured values. One that raises has not happened: all is as it was before."""
        kept = (self.state, self.published, self.active, self.pursued, self.plan.copy())
        try:
            outcome = self._tick(measured, now)
        except BaseException:
            self.state, self.published, self.active, self.pursued, self.plan = kept
            raise
        self.ticks += 1
        return outcome

    def _tick(self, measured: Mapping[str, Value | None], now: Moment) -> TickOutcome:
        before = self.state
        self._run.sense(measured)
        finishing = self._run.finish()
        self._run.synchronise()
        ended = tuple(name for name in finishing.finished if self.plan.order.finish(name, now))
        activated, completed = self._update_operations(now)
        started = self._start(now)
        self.plan.look(self._present, self.active)
        # Before production is started nothing is published, and then all outputs are: no change of one is news.
        news = self.automaton.outputs if self.production is Production.STARTED else ()
        outputs = frozenset(name for name in news if self.state[name] != self.published[name])
        self.published = self.state
        moved = self.state is not before and self.state != before
        changed = bool(started or ended or activated or completed or outputs) or moved
        return TickOutcome(
            finishing.finished, ended, started, activated, completed, finishing.conflicts, outputs, changed
        )

    def _update_operations(self, now: Moment) -> tuple[frozenset[str], frozenset[str]]:
        """Step 4: the operations that are activated by it, and those that are completed."""
        active = self._run.update_operations(self.active)
        activated, completed = active - self.active, self.active - active
        self.pursued = self.pursued.settled(completed, self._run.values, now)
        self._run.record_activity(active)
        if self.production is Production.STARTED:
            begun = active - self.pursued.goals.keys()
            self.pursued = self.pursued.activated(self.automaton, begun, self._run.values, now)
        self.active = active
        self.plan.settle(active, self.pursued.hopeful)
        return activated, completed

    def request(self, deadline: float) -> PlanRequest | None:
        """What to ask the planner now, or None when there is nothing to ask or it would answer the same again."""
        return self.plan.request(self._present, deadline)

    def better(self, deadline: float) -> PlanRequest | None:
        """What to ask a planner that has nothing else to do; None when there is nothing that could become better."""
        return self.plan.better(self._present, deadline)

    def adopt(self, request: PlanRequest, answer: PlanAnswer) -> bool:
        """Follow an answered plan, if it still fits the state. False when a new one must be asked for."""
        return self.plan.adopt(self._present, request, answer)

    def may_go_on(self, name: str) -> bool:
        """Whether the order still reaches the goals once its first ability, `name`, has been started now."""
        after = self.startable(name)
        return after is not None and self.plan.may_go_on(self._present, after)

    def startable(self, name: str) -> CompiledRun | None:
        """The run after the start of the ability, if its guards and the supervisor allow it now."""
        ability = self.automaton.abilities[name]
        if ability.resource in self.circumstances.offline or (ability.restart and not self.circumstances.restart):
            return None
        if name not in self._run.startable():
            return None
        after = self._run.fork()
        if not after.start(name) or reverts(self.automaton, self.published, self._run.values, after.values):
            return None
        return after if self.supervisor.allows(self._run.values, after.values) else None

    @property
    def _present(self) -> Present:
        return Present(self._run, self.published, self.pursued, self.circumstances)

    def _start(self, now: Moment) -> tuple[str, ...]:
        """Step 5: the first abilities of the order start, as long as they may."""
        started: list[str] = []
        if self.mode is not Mode.AUTOMATIC or self.production is not Production.STARTED or self.obstacles:
            return ()
        # An ability starts once in a tick, or its first command would never be published.
        while self.plan.next_may_start(self._present, lambda name: None if name in started else self.startable(name)):
            step = self.plan.start(now)
            self._run.start(step.ability)
            self.pursued = self.pursued.moved(self._run.values, now)
            if self.automaton.abilities[step.ability].finish_guard is None:
                step.ended = now
            started.append(step.ability)
        return tuple(started)
