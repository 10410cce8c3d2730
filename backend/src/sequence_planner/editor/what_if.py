"""The conduct of a station with another model, from a state on: simulated, without touching the station.

The execution and the planner are the real ones. Devices stand where they were measured, and do what the model expects
of them; people do each task that they are given.
"""

from __future__ import annotations

import time
from collections.abc import Mapping

from sequence_planner.automaton.automaton import State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.controller.views.wording import reason_text
from sequence_planner.core.clock import Timestamp
from sequence_planner.editor.schemas.what_if import Completed, Run, WhatIfView, transferred
from sequence_planner.execution.events import Heard
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import PlanStatus
from sequence_planner.history.simulated_station import SimulatedStation
from sequence_planner.language.types import Value
from sequence_planner.planning.planner import Planner
from sequence_planner.station import ReadyStation

SLICE = 1.0  # seconds simulated between two looks at the time that is left
MOST_RUNS = 2000


class Diary:
    """Listens to an execution that begins at 0 seconds."""

    def __init__(self, execution: Executor, station: SimulatedStation) -> None:
        self._execution = execution
        self._station = station
        self._under_way: dict[str, float] = {}
        self.runs: list[Run] = []
        self.completed: list[Completed] = []
        execution.listeners.append(self._hear)

    def end(self) -> None:
        """Note what is under way as having no end."""
        for name, started in self._under_way.items():
            self._note(name, started, None)
        self.runs.sort(key=lambda run: run.started)

    def _hear(self, heard: Heard) -> None:
        if (outcome := heard.outcome) is None:
            return
        now = self._station.now.monotonic
        for name in (*outcome.ended, *outcome.called_off):
            if name in self._under_way:
                self._note(name, self._under_way.pop(name), now)
        for name in outcome.started:
            if self._execution.automaton.abilities[name].finish_guard is None:
                self._note(name, now, now)
            else:
                self._under_way[name] = now
        operations = self._execution.automaton.operations
        self.completed += [
            Completed(operation=name, title=operations[name].title, at=now) for name in sorted(outcome.completed)
        ]

    def _note(self, name: str, started: float, ended: float | None) -> None:
        ability = self._execution.automaton.abilities[name]
        run = Run(ability=name, title=ability.title, resource=ability.resource, started=started, ended=ended)
        self.runs.append(run)


def what_if(
    station: ReadyStation,
    supervisor: Supervisor,
    present: Mapping[str, Value | None],
    seconds: float,
    deadline: float,
) -> WhatIfView:
    """Simulate so many seconds from the state that `present` values lead to; it works until about `deadline` seconds
    have passed, and has simulated less then.
    """
    until, automaton = time.monotonic() + deadline, station.automaton
    state: State = transferred(automaton, present)
    execution = Executor(automaton, supervisor)
    execution.state = execution.published = state
    execution.start_production()
    simulated = SimulatedStation(station, execution, Planner(automaton, supervisor), Timestamp(0.0, 0.0))
    diary, done = Diary(execution, simulated), 0.0
    while done < seconds and len(diary.runs) < MOST_RUNS and time.monotonic() < until:
        simulated.run(step := min(SLICE, seconds - done))
        done += step
    diary.end()
    after = execution.state
    unplanned = simulated.unplanned or (execution.plan.reason if execution.plan.status is PlanStatus.NONE else "")
    return WhatIfView(
        seconds=done,
        safe=supervisor.safe.includes(state),
        runs=diary.runs,
        completed=diary.completed,
        before={name: state[name] for name in automaton.variables},
        after={name: after[name] for name in automaton.variables},
        active=sorted(execution.active),
        unplanned=unplanned,
        unplanned_message=reason_text(unplanned) if unplanned else None,
        obstacle=None,
        obstacle_message=None,
    )
