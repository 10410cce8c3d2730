"""Ticks of a running station: which are due, and what each is told of what devices, people and the journal say."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from typing import Final

import structlog

from sequence_planner.controller.alarms.kinds import RESTLESS, Cause
from sequence_planner.controller.features.failures import Failures
from sequence_planner.controller.features.records import Records
from sequence_planner.controller.features.tasks import TaskHandler
from sequence_planner.controller.io.devices import Devices
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.distribution import Distribution
from sequence_planner.execution.events import TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Production
from sequence_planner.language.types import Value
from sequence_planner.ros.transport import Sample

LOG = structlog.get_logger(__name__)

TICKS: Final = (0.0001, 0.00025, 0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 1.0)  # seconds
MOST_TICKS = 100  # in a row without anything new; then the station is taken to be restless


class Ticker:
    """Takes the ticks of `execution` that are due; `took` is how long each was, and `wake` is called when one is due at
    once.

    A tick that raises has not happened, and is tried again at the next look at the clock.
    """

    def __init__(
        self,
        execution: Executor,
        devices: Devices,
        tasks: TaskHandler,
        records: Records,
        failures: Failures,
        wake: Callable[[], None],
    ) -> None:
        self._execution, self._devices, self._tasks, self._records = execution, devices, tasks, records
        self._failures, self._wake = failures, wake
        self.took = Distribution(TICKS)
        self._measured: dict[str, Value | None] = {}
        self._again = False
        self._due = True  # a tick is wanted whatever the measurements say
        self._in_a_row = 0  # ticks that only followed from the one before
        self.restless: tuple[str, ...] = ()
        """The abilities that finish again and again although nothing new is measured."""
        self.listeners: list[Callable[[TickOutcome, Timestamp], None]] = []
        """Hear of each tick, in order."""

    @property
    def goes_on(self) -> bool:
        """True if the next tick is due at once."""
        return self._again and self._in_a_row < MOST_TICKS

    def again(self) -> None:
        """A tick is due whatever the measurements say."""
        self._due = self._again = True
        self._in_a_row = 0
        self._wake()

    def take_due(self, moment: Timestamp) -> None:
        """All ticks that are due: one for each part of what was heard, and one for the look at the clock."""
        self._again = False
        for part in self._devices.heard():
            # What a message says counts from when it was received, however late its turn comes.
            self._attempt(part, moment, part[-1].received)
        self._attempt((), moment, moment.monotonic)

    def causes(self, moment: Timestamp) -> Iterator[Cause]:
        """The causes of alarms that there are now."""
        if self.restless:
            yield RESTLESS.cause("", {"abilities": ", ".join(self.restless)})

    def _attempt(self, samples: Sequence[Sample], moment: Timestamp, monotonic: float) -> None:
        self._failures.attempt("a tick", lambda: self._tick(samples, moment, monotonic))

    def _tick(self, samples: Sequence[Sample], moment: Timestamp, monotonic: float) -> None:
        """Take messages of `monotonic`, of which no topic has more than one, and tick if that is something new."""
        execution, feeds = self._execution, self._devices.feeds
        feeds.take(samples)
        feeds.wake(monotonic)
        measured = feeds.measured(monotonic) | self._tasks.measured()
        obstacles, silent = self._records.obstacles(), feeds.offline(monotonic)
        known = (self._measured, execution.obstacles, execution.conduct.silent)
        news = (measured, obstacles, silent) != known or execution.is_due(moment)
        if (not news and not self._due) or self._records.is_full:
            return
        self._measured = measured
        self._due = True  # until it is done
        began = time.perf_counter()
        outcome = execution.tick(measured, moment, obstacles, silent)
        self.took.note(time.perf_counter() - began)
        self._due = outcome.changed  # what a tick changed can make another possible at once
        self._again = self._again or self._due
        self._in_a_row = self._in_a_row + 1 if outcome.changed and not news else 0
        self.restless = outcome.finished if self._in_a_row >= MOST_TICKS else ()
        if execution.production is Production.STARTED:  # a task, too, is something to be done
            self._tasks.update(execution.state, outcome.finished, outcome.ended, moment.epoch)
        for listener in self.listeners:
            listener(outcome, moment)
        _log(outcome)


def _log(outcome: TickOutcome) -> None:
    for name in outcome.ended:
        LOG.info("finished", ability=name)
    for name in outcome.started:
        LOG.info("started", ability=name)
    for name in sorted(outcome.completed):
        LOG.info("completed", operation=name)
