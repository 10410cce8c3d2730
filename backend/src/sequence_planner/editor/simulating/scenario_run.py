"""Carries scenarios out in simulated time, and finds whether what they expect comes about."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from sequence_planner.automaton.automaton import State
from sequence_planner.core.immutable import Immutable
from sequence_planner.editor.schemas.simulation import Advance, SimulationStop
from sequence_planner.editor.simulating.simulation import DraftSimulation, SimulatedMoment
from sequence_planner.editor.usable import Usable
from sequence_planner.history.simulated_station import STEP
from sequence_planner.language.evaluator import holds
from sequence_planner.language.printer import print_value
from sequence_planner.language.syntax import variables
from sequence_planner.language.types import Place
from sequence_planner.process.budget import Budget
from sequence_planner.scenarios.scenario import Scenario, ScenarioCondition, ScenarioStep
from sequence_planner.texts.message import Argument, Item, Message, joined, message

MOST_VALUES: Final = 8  # that are told of one condition


class ScenarioFailure(Immutable):
    """What did not come about, or must not have, and where that is written."""

    place: Place
    why: Message


class ScenarioRun(Immutable):
    """A scenario that was carried out, `seconds` of simulated time long; `moments` are what happened. It has passed
    where there is no `failure`.
    """

    scenario: Scenario
    seconds: float
    failure: ScenarioFailure | None
    moments: tuple[SimulatedMoment, ...]

    @property
    def started(self) -> frozenset[str]:
        """The abilities that were started in it."""
        return frozenset(name for moment in self.moments for name in moment.started)

    @property
    def completed(self) -> frozenset[str]:
        """The operations that were completed in it."""
        return frozenset(name for moment in self.moments for name in moment.completed)


class _Failed(Exception):
    def __init__(self, place: Place, why: Message) -> None:
        super().__init__(why)
        self.failure = ScenarioFailure(place, why)


class ScenarioRunner:
    """Carries a scenario out with a model; `simulation` stands where it has ended."""

    def __init__(self, meant: Usable, scenario: Scenario, budget: Budget, *, goes_back: bool = False) -> None:
        self._scenario, self._budget = scenario, budget
        self.simulation = DraftSimulation(meant, scenario.given, goes_back=goes_back)
        self.simulation.station.people_wait = scenario.people_wait
        self._moments: list[SimulatedMoment] = []
        self._done: set[str] = set()  # tasks, which stay open until the station has heard of it
        self._from = 0  # the first moment in which the next step may find what it expects
        self._starts = 0  # how many starts of that moment were found by steps before

    def run(self) -> ScenarioRun:
        """Carry it out to its end, or to what fails."""
        failure = None
        try:
            self._check_never(self.simulation.present)
            for step in self._scenario.steps:
                self._carry_out(step)
        except _Failed as failed:
            failure = failed.failure
        return ScenarioRun(self._scenario, self.simulation.passed, failure, tuple(self._moments))

    def _carry_out(self, step: ScenarioStep) -> None:
        if step.fault is not None or step.sets or step.done:
            self._do(step)
        elif step.holds is not None:
            self._await_condition(step, step.holds)
        elif step.starts:
            self._await_starts(step)
        elif step.completes is not None:
            self._await_completion(step, step.completes)
        else:
            for _ in self._moments_within(step, step.wait):
                pass
            self._from, self._starts = len(self._moments), 0

    def _do(self, step: ScenarioStep) -> None:
        """Somebody, or a device, does something."""
        done: list[str] = []
        if step.done:
            open_tasks = self.simulation.station.tasks.open.values()
            done = [each.id for each in open_tasks if each.ability in step.done and each.id not in self._done]
            self._done |= set(done)
            if not done:
                raise _Failed(step.place, message("scenario.no-task", ability=" / ".join(sorted(step.done))))
        faults = [] if step.fault is None else [step.fault]
        self._moments += self.simulation.do(Advance(faults=faults, sets=dict(step.sets), done=done))
        self._check_never(self.simulation.present)
        self._from, self._starts = len(self._moments), 0

    def _await_condition(self, step: ScenarioStep, condition: ScenarioCondition) -> None:
        if holds(condition.meaning, self.simulation.present):
            return
        for index in self._moments_within(step, step.within or 0.0):
            if holds(condition.meaning, self.simulation.present):
                self._from, self._starts = index, 0
                return
        told: dict[str, Argument] = {"condition": condition.text, "values": self._values_in(condition)}
        if step.within:
            raise _Failed(condition.place, message("scenario.not-held", seconds=_shown(step.within), **told))
        raise _Failed(condition.place, message("scenario.not-held.now", **told))

    def _await_starts(self, step: ScenarioStep) -> None:
        awaited = list(step.starts)
        for index in self._moments_within(step, step.within or 0.0, again=True):
            started = self._moments[index].started
            for number in range(self._starts, len(started)):
                if started[number] in awaited[0][1]:
                    self._from, self._starts = index, number + 1
                    awaited.pop(0)
                    if not awaited:
                        return
            self._starts = 0
        said = message("scenario.not-started", ability=awaited[0][0], seconds=_shown(step.within or 0.0))
        raise _Failed(step.place, said)

    def _await_completion(self, step: ScenarioStep, operation: str) -> None:
        for index in self._moments_within(step, step.within or 0.0, again=True):
            if operation in self._moments[index].completed:
                self._from, self._starts = index, 0
                return
        seconds = _shown(step.within or 0.0)
        raise _Failed(step.place, message("scenario.not-completed", operation=operation, seconds=seconds))

    def _moments_within(self, step: ScenarioStep, seconds: float, *, again: bool = False) -> Iterator[int]:
        """Let so much time pass, and yield the number of each moment in which something happens: `again` from the one
        on in which the step before was found.
        """
        if again:
            yield from range(self._from, len(self._moments))
        until = self.simulation.passed + seconds
        while True:
            left = until - self.simulation.passed
            left = left if left > STEP / 2 else 0.0  # what is left of the last moment
            moments, stop = self.simulation.go_on(left, self._budget, once=True)
            for moment in moments:
                self._moments.append(moment)
                self._check_never(self.simulation.present)
                yield len(self._moments) - 1
            if stop is SimulationStop.RESTLESS:
                raise _Failed(step.place, message("scenario.restless", seconds=_shown(self.simulation.passed)))
            if stop is SimulationStop.LATE or self._budget.spent:
                raise _Failed(step.place, message("scenario.late", seconds=_shown(self.simulation.passed)))
            if not moments and not left:
                return

    def _check_never(self, state: State) -> None:
        for each in self._scenario.never:
            if holds(each.meaning, state):
                seconds = _shown(self.simulation.passed)
                why = message("scenario.never", condition=each.text, seconds=seconds, values=self._values_in(each))
                raise _Failed(each.place, why)

    def _values_in(self, condition: ScenarioCondition) -> Item:
        """The values that the variables of a condition have now."""
        state = self.simulation.present
        names = [name for name in dict.fromkeys(variables(condition.meaning)) if name in state]
        told: list[Item] = []
        for name in names[:MOST_VALUES]:
            value = state[name]
            known = None if value is None else f"{name} == {print_value(value)}"
            told.append(known or message("scenario.not-known", name=name))
        return joined(told) if told else message("scenario.constant")


def run_scenarios(meant: Usable, scenarios: Sequence[Scenario], budget: Budget) -> Iterator[ScenarioRun]:
    """Yield each scenario as it was carried out."""
    for each in scenarios:
        yield ScenarioRunner(meant, each, budget).run()


def not_exercised(meant: Usable, runs: Sequence[ScenarioRun]) -> Mapping[str, list[str]]:
    """Name the abilities that no run has started, and the operations that none has completed."""
    started = frozenset().union(*(each.started for each in runs))
    completed = frozenset().union(*(each.completed for each in runs))
    return {
        "abilities": [name for name in meant.automaton.abilities if name not in started],
        "operations": [name for name in meant.automaton.operations if name not in completed],
    }


def _shown(seconds: float) -> str:
    return f"{seconds:.1f}".removesuffix(".0")
