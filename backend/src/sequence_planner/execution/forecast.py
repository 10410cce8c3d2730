"""The times at which the steps of a plan are expected to start and to end, from what the model says and how long runs
have taken.

The plan says in which tick each ability starts; a simulation of it says in which it ends. A step waits for what ends
before it in the plan, as far as its guards read of that; a tick in which nothing ends comes when its effects have had
their time. The first counts from what happened last, so that no time changes as long as nothing happens: what is late
by then is expected at once.
"""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Mapping
from statistics import median

from sequence_planner.automaton.automaton import Automaton, target
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.core.immutable import Immutable
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.outlook import Outlook, simulate_plan
from sequence_planner.execution.plan_tracker import PlannedStart
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.language.syntax import variables
from sequence_planner.synthesis.guards import SupervisorGuard

# As many runs of an ability as are told from: devices change their pace, with a new tool or a slower override.
REMEMBERED_RUNS = 5


class Expected(Immutable):
    """The times at which a step is expected to start and to end, in seconds since the epoch."""

    start: float
    end: float


class Forecast:
    """Looks at an execution after every tick, and says when its steps are expected."""

    def __init__(self, execution: Executor) -> None:
        self._execution = execution
        self._runs: dict[str, deque[float]] = defaultdict(lambda: deque(maxlen=REMEMBERED_RUNS))
        self._counted: frozenset[int] = frozenset()  # the past steps that have ended and were looked at
        self._disturbed: frozenset[int] = frozenset()  # those that ran while the station did not go on by itself
        self._waiting = waiting_for_people(execution.automaton)
        self._outlook = Outlook()
        self._began = 0.0  # when the plan was seen first
        self._read: dict[
            str, tuple[SupervisorGuard | None, frozenset[str]]
        ] = {}  # by each ability, with the guard added then
        self._written: dict[str, frozenset[str]] = {}

    @property
    def outlook(self) -> Outlook:
        """The things that the plan leads to."""
        return self._outlook

    def update(self, now: float) -> None:
        """After a tick: remember how long has taken what ended, and look through a plan that is new."""
        self.look_through(now)
        order = self._execution.plan.order
        if self._execution.mode is not Mode.AUTOMATIC or self._execution.operator_plan is not None:
            self._disturbed |= {step.number for step in order.past if step.number not in self._counted}
        ended = {step.number: step for step in order.past if step.ended is not None}
        for number in sorted(ended.keys() - self._counted - self._disturbed):
            self._learn(ended[number])
        self._counted = frozenset(ended)
        self._disturbed &= {step.number for step in order.past}

    def look_through(self, now: float) -> None:
        """Look through the plan that is followed, where it is a new one: plans are taken between ticks, too."""
        order = self._execution.plan.order
        if order.plan is not self._outlook.plan:
            self._outlook = simulate_plan(order, self._execution.simulated(), self._execution.automaton)
            self._began = now

    def _learn(self, step: PlannedStart) -> None:
        """Remember how long a run has taken, unless it waited: for a person, or for a device that did nothing."""
        ability = self._execution.automaton.abilities[step.ability]
        if step.ability in self._waiting or step.started is None or step.ended is None:
            return
        seconds = step.ended.epoch - step.started.epoch
        if ability.timeouts.finish is None or seconds <= ability.timeouts.finish:
            self._runs[step.ability].append(seconds)

    def expected(self, guards: Mapping[str, SupervisorGuard] | None = None) -> dict[int, Expected]:
        """Return what runs and what is ahead, by the number of the step; `guards` are those that the supervisor
        adds.
        """
        order, outlook = self._execution.plan.order, self._outlook
        ending: dict[int, list[tuple[str, float]]] = defaultdict(list)  # which abilities end in a tick, and when
        table: dict[int, Expected] = {}

        busy: dict[str, float] = {}  # until when people are who do something whose end the simulation does not tell

        def count_on(step: PlannedStart, start: float, tick: int) -> None:
            ability = self._execution.automaton.abilities[step.ability]
            end = start + self._seconds(step, tick)
            table[step.number] = Expected(start, end)
            if (ends := outlook.ends.get(step.number)) is not None:
                ending[ends].append((step.ability, end))
            elif ability.human is not None:
                busy[ability.resource] = max(end, busy.get(ability.resource, end))

        comes, tick = self._began, outlook.tick
        for step in order.past:
            own = step.number >= outlook.first
            tick = max(tick, step.tick) if own else tick
            comes = max(comes, *(moment.epoch for moment in (step.started, step.ended) if moment is not None))
            if step.started is not None and step.ended is None:
                count_on(step, step.started.epoch, step.tick if own else outlook.tick)
        for step in order.ahead:
            # One that was pulled forward keeps the tick that it once had.
            for passed in range(tick + 1, step.tick + 1):
                comes += 0.0 if passed in ending else outlook.waits.get(passed, 0.0)
            tick = max(tick, step.tick)
            read = self._reads(step.ability, (guards or {}).get(step.ability))
            before = [end for each, ended in ending.items() if each <= tick for end in ended]
            comes = max(comes, *(at for name, at in before if self._writes(name) & read), comes)
            ability = self._execution.automaton.abilities[step.ability]
            # People do one thing after the other.
            comes = max(comes, busy.get(ability.resource, comes)) if ability.human is not None else comes
            count_on(step, comes, tick)
        return table

    def _reads(self, name: str, guard: SupervisorGuard | None) -> frozenset[str]:
        """The variables that decide whether the ability starts."""
        known = self._read.get(name)
        if known is not None and known[0] is guard:
            return known[1]
        ability, predicates = self._execution.automaton.abilities[name], self._execution.automaton.flag_predicates
        added = [] if guard is None or guard.expression is None else [guard.expression]
        pending = [v for part in (ability.enabled, ability.start_guard, *added) for v in variables(part)]
        read: set[str] = set()
        while pending:
            variable = pending.pop()
            if variable not in read:
                read.add(variable)
                pending += variables(predicates[variable]) if variable in predicates else ()
        self._read[name] = (guard, frozenset(read))
        return self._read[name][1]

    def _writes(self, name: str) -> frozenset[str]:
        """The variables that a run of the ability may change by its end: all of its resource, and what it writes."""
        if name in self._written:
            return self._written[name]
        automaton = self._execution.automaton
        ability = automaton.abilities[name]
        own = {each.name for each in automaton.variables.values() if each.resource == ability.resource}
        actions = (*ability.start_actions, *ability.finish_actions)
        self._written[name] = frozenset(own | {target(action) for action in actions})
        return self._written[name]

    def _seconds(self, step: PlannedStart, tick: int) -> float:
        """Return how long a run takes: as the last ones have, or as the model says, or as long as its effects take."""
        if runs := self._runs.get(step.ability):
            return median(runs)
        if duration := self._execution.automaton.abilities[step.ability].duration:
            return sum(duration) / 2
        return self._outlook.between(tick, self._outlook.ends.get(step.number, tick))


def waiting_for_people(automaton: Automaton) -> frozenset[str]:
    """The abilities whose runs last as long as people take: what they do themselves, and what ends by it."""
    human = [ability for ability in automaton.abilities.values() if ability.human is not None]
    theirs = {ability.human.acknowledgement for ability in human if ability.human is not None}
    theirs |= {target(action) for ability in human for action in ability.finish_actions}
    return frozenset(
        name
        for name, ability in automaton.abilities.items()
        if ability.human is not None
        or (ability.finish_guard is not None and read_variables(automaton, (ability.finish_guard,)) & theirs)
    )
