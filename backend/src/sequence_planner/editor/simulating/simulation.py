"""A station with the draft in simulated time: it goes on for as long as somebody lets it, and back to any moment.

The execution and the planner are the real ones. Devices stand where they were measured, and do what the model expects
of them unless somebody gives them a fault.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from sequence_planner.automaton.automaton import State
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import Immutable
from sequence_planner.editor.schemas.simulation import Advance, SimulationStop
from sequence_planner.editor.schemas.what_if import transferred
from sequence_planner.editor.usable import Usable
from sequence_planner.execution.events import TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.history.simulated_station import STEP, SimulatedStation
from sequence_planner.language.syntax import ExpressionError
from sequence_planner.language.types import Value, contains
from sequence_planner.model.paths import EditError
from sequence_planner.planning.planner import Planner
from sequence_planner.process.budget import Budget
from sequence_planner.simulation.faults import Clear, Fault, FaultReader
from sequence_planner.texts.message import message

MOST_KEPT: Final = 400  # moments to which it can go back without time passing anew


class SimulatedMoment(Immutable):
    """Something that happened: the variables that are others, each with its value before and after, what runs and is
    active then, and what somebody did.
    """

    seconds: float
    changes: Mapping[str, tuple[Value | None, Value | None]]
    running: frozenset[str]
    active: frozenset[str]
    safe: bool
    began: tuple[Fault | Clear, ...] = ()
    sets: Mapping[str, Value] = {}
    done: tuple[str, ...] = ()  # abilities whose tasks were done
    started: tuple[str, ...] = ()
    ended: tuple[str, ...] = ()
    completed: frozenset[str] = frozenset()


class DraftSimulation:
    """A station with a model that can be used, from the state on that `present` values lead to, `begun` seconds after
    the beginning. Where nobody `goes_back` no moment is kept.
    """

    def __init__(
        self, meant: Usable, present: Mapping[str, Value | None], begun: float = 0.0, *, goes_back: bool = True
    ) -> None:
        automaton, supervisor = meant.automaton, meant.supervisor
        execution = Executor(automaton, supervisor)
        execution.state = execution.published = transferred(automaton, present)
        execution.start_production()
        self.automaton = automaton
        self._reader = FaultReader(automaton, meant.station.pipelines, lambda resource: True)
        planner = Planner(automaton, supervisor)
        self.station = SimulatedStation(meant.station, execution, planner, Timestamp(begun, begun))
        self.begun = begun
        self.before = execution.state
        """The state in which it began."""
        self.deeds: list[tuple[float, Advance]] = []
        """What somebody has done, and when."""
        self.started: list[tuple[float, str]] = []
        """What has started, and when."""
        self._goes_back = goes_back
        self._kept = [(begun, self.station.copy())]

    @property
    def passed(self) -> float:
        """The time that has passed since the beginning."""
        return self.station.now.monotonic

    @property
    def present(self) -> State:
        """The state that it is in."""
        return self.station.execution.state

    def go_back(self, seconds: float) -> float:
        """Go back to a moment that has been; what has happened since is as if it had not been. Returns the last moment
        that is known to be as it was: what comes after it happens anew.
        """
        if seconds > self.passed - STEP / 2:
            return self.passed
        while len(self._kept) > 1 and self._kept[-1][0] > seconds + STEP / 2:
            self._kept.pop()
        since, kept = self._kept[-1]
        self.station = kept.copy()
        self.deeds = [each for each in self.deeds if each[0] <= since]
        self.started = [each for each in self.started if each[0] <= since]
        return since

    def check_advance(self, advance: Advance) -> None:
        """Raises `EditError` for what cannot be done."""
        for line in advance.faults:
            self._read(line)
        for name, value in advance.sets.items():
            if name not in self.station.devices.devices.topics:
                raise EditError(message("step.not-by-device", name=name))
            type_ = self.automaton.variables[name].type
            if not contains(type_, value):
                raise EditError(message("step.not-in-domain", name=name, range=str(type_)))

    def do(self, advance: Advance) -> list[SimulatedMoment]:
        """Do now what was checked before; returns what that was, nothing for a task that is over."""
        began = tuple(self._read(line) for line in advance.faults)
        open_tasks = self.station.tasks.open
        done = [task for each in advance.done if (task := open_tasks.get(each)) is not None]
        for fault in began:
            if isinstance(fault, Clear):
                self.station.devices.clear(fault)
            else:
                self.station.devices.start(fault, self.passed)
        for name, value in advance.sets.items():
            self.station.devices.devices.set_value(name, value)
        for task in done:
            self.station.finish_task(task)
        if not (began or advance.sets or done):
            return []
        abilities = tuple(task.ability for task in done)
        self.deeds.append((self.passed, advance.model_copy(update={"done": [*abilities]})))
        moment = self._moment(self.present, began, advance.sets, abilities)
        self._keep()
        return [moment]

    def go_on(
        self, seconds: float, budget: Budget, until: Callable[[State], bool] | None = None, *, once: bool = False
    ) -> tuple[list[SimulatedMoment], SimulationStop | None]:
        """Let time pass, until a condition comes to hold or, `once`, something happens; returns what happened, and why
        it stopped earlier.
        """
        moments: list[SimulatedMoment] = []
        before, active = self.present, self.station.execution.active
        held = until is None or until(before)
        for outcome in self.station.ticks(seconds):
            moment = self._moment(before, outcome=outcome)
            if moment.changes or moment.started or moment.ended or moment.active != active:
                moments.append(moment)
                self.started += [(moment.seconds, name) for name in moment.started]
                self._keep()
            before, active, had_held = self.present, moment.active, held
            held = until is None or until(before)
            if held and not had_held:
                return moments, SimulationStop.UNTIL
            if self.station.restless:
                return moments, SimulationStop.RESTLESS
            if budget.spent:
                return moments, SimulationStop.LATE
            if once and moments:
                break
        return moments, None

    def _moment(
        self,
        before: State,
        began: tuple[Fault | Clear, ...] = (),
        sets: Mapping[str, Value] | None = None,
        done: tuple[str, ...] = (),
        outcome: TickOutcome | None = None,
    ) -> SimulatedMoment:
        execution, after = self.station.execution, self.present
        return SimulatedMoment(
            self.passed,
            {name: (before[name], after[name]) for name in self.automaton.variables if before[name] != after[name]},
            execution.running(),
            execution.active,
            execution.safe,
            began,
            sets or {},
            done,
            *(() if outcome is None else (outcome.started, (*outcome.ended, *outcome.called_off), outcome.completed)),
        )

    def _keep(self) -> None:
        """Keep how everything stands; of what was long ago, every second moment."""
        if not self._goes_back:
            return
        self._kept.append((self.passed, self.station.copy()))
        if len(self._kept) > MOST_KEPT:
            half = MOST_KEPT // 2
            deeds = {seconds for seconds, _ in self.deeds}  # they do not happen again by themselves
            old = enumerate(self._kept[1:half])
            self._kept[1:half] = [each for index, each in old if index % 2 == 0 or each[0] in deeds]

    def _read(self, line: str) -> Fault | Clear:
        try:
            return self._reader.read(line)
        except ExpressionError as error:
            raise EditError(error.message) from None
