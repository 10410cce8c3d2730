"""Outputs on their way out: those of a tick are published when its record is durable, and never before.

Ticks do not wait for that. Every state whose outputs are new waits in order, so that a device sees each command; only
what a person holds goes out at once, past all that waits, because neither a full nor a slow disk must keep anybody
from holding a station.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from sequence_planner.automaton.automaton import Automaton, State, target
from sequence_planner.execution.events import (
    CalledOff,
    Event,
    Heard,
    ModeChanged,
    OperatorPlanStarted,
    ProductionStarted,
    TickOutcome,
)
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Mode, Production
from sequence_planner.language.types import Value


@dataclass(frozen=True)
class _Waiting:
    number: int  # of the record that must be durable first
    state: State
    everything: bool  # whether each output is published, changed or not
    starting: frozenset[str]  # the outputs that starts have written
    since: float  # on the clock


class OutputGate:
    """Listens to `execution`, after whoever writes its records; `recorded` is the number of the last one.

    `publish` sends the outputs of a state, all of them or those that differ from what was sent before. As long as one
    is `owed`, which could not be sent, no other follows.
    """

    def __init__(
        self,
        execution: Executor,
        recorded: Callable[[], int],
        publish: Callable[[State, bool], None],
        owed: Callable[[], bool],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._execution = execution
        self._recorded = recorded
        self._publish = publish
        self._owed = owed
        self._durable = 0
        self._clock = clock
        self._waiting: deque[_Waiting] = deque()
        self._newest: State = execution.state
        self._kept_back: dict[str, Value] = {}  # what outputs shall be that stay as they are meanwhile
        self.released: State | None = None  # the state whose outputs went out last; None before any did
        execution.listeners.append(self._hear)

    @property
    def longest(self) -> float:
        """Seconds for which the outputs that wait longest have waited."""
        return self._clock() - self._waiting[0].since if self._waiting else 0.0

    def durable(self, number: int) -> None:
        """All records up to `number` are durable: publish what waited for them."""
        self._durable = number
        self.go_on()

    def go_on(self) -> None:
        """Publish what can be published by now."""
        while self._waiting and self._waiting[0].number <= self._durable and not self._owed():
            due = self._waiting.popleft()
            self.released = self._outgoing(due.state)
            self._publish(self.released, due.everything)

    def _outgoing(self, state: State) -> State:
        """The state as devices are to know it: without what is kept back, unless that was written anew since."""
        self._kept_back = {name: value for name, value in self._kept_back.items() if state[name] == value}
        if self.released is None or not self._kept_back:
            return state
        return {**state, **{name: self.released[name] for name in self._kept_back}}

    def _hear(self, heard: Heard) -> None:
        if self._execution.production is not Production.STARTED:
            return
        happening = heard.happening
        everything = isinstance(happening, ProductionStarted)
        changed = [n for n in self._execution.automaton.outputs if heard.after[n] != self._newest[n]]
        self._newest = heard.after
        due = bool(changed)
        if _holds(happening):
            due, everything = True, self._hold(heard.after, changed)
        elif self._kept_back and _goes_on(happening):
            due, self._kept_back = True, {}
        if everything or due:
            starting = _written(self._execution.automaton, heard.outcome)
            self._waiting.append(_Waiting(self._recorded(), heard.after, everything, starting, self._clock()))

    def _hold(self, after: State, changed: Sequence[str]) -> bool:
        """Send at once what calling off has changed; whether all outputs have still to be published."""
        everything = any(each.everything for each in self._waiting)
        if self.released is None:
            return False  # what waits is the first word to the devices, and holds no start
        # What still waits is older, and would start again what is called off here.
        starting = frozenset[str]().union(*(each.starting for each in self._waiting))
        self._waiting.clear()
        self.released = {**self.released, **{name: after[name] for name in changed}}
        self._kept_back |= {name: value for name in starting if (value := _known(after, name)) != self.released[name]}
        self._publish(self.released, False)
        return everything


def _holds(happening: Event) -> bool:
    return isinstance(happening, CalledOff) or (isinstance(happening, ModeChanged) and happening.mode is Mode.HOLD)


def _goes_on(happening: Event) -> bool:
    return isinstance(happening, OperatorPlanStarted) or (
        isinstance(happening, ModeChanged) and happening.mode is Mode.AUTOMATIC
    )


def _written(automaton: Automaton, outcome: TickOutcome | None) -> frozenset[str]:
    """The outputs that the starts of a tick have written."""
    started = () if outcome is None else outcome.started
    actions = (action for name in started for action in automaton.abilities[name].start_actions)
    return frozenset(target(action) for action in actions) & automaton.outputs


def _known(state: State, output: str) -> Value:
    value = state[output]
    assert value is not None, "outputs are what the station writes"
    return value
