"""How long operations take, and on which resources: as their last runs did, which the run journal tells."""

from __future__ import annotations

import json
from collections import defaultdict, deque
from collections.abc import Mapping, Sequence
from statistics import median
from typing import Any, Final

from sqlalchemy import Connection

from sequence_planner.journal import run_journal
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.mes.sequencing.instance import LONGEST

REMEMBERED_RUNS: Final = 5  # of an operation; devices change their pace
UNKNOWN_SECONDS: Final = 60.0  # that an operation is expected to take of which nothing is known
_LOOK_BACK: Final = 20_000  # records that are read at most: nobody asks for days, and then for all of them at once
_PAGE: Final = 1000
_TICKED, _BEGUN = "ticked", "begun"


class KnownTimes:
    """Reads on in the run journal. `resource_of` has the resource of each ability."""

    def __init__(self, resource_of: Mapping[str, str]) -> None:
        self._resource_of = resource_of
        self._number: int | None = None  # of the last record that was read
        self._active: dict[str, tuple[float, set[str]]] = {}  # since when, and what was used
        self._seconds: dict[str, deque[float]] = defaultdict(lambda: deque(maxlen=REMEMBERED_RUNS))
        self._used: dict[str, deque[frozenset[str]]] = defaultdict(lambda: deque(maxlen=REMEMBERED_RUNS))

    def seconds(self, operation: str, planned: float | None = None) -> float:
        """How long it takes: the median of the last runs; before the first as long as is `planned`, or a minute."""
        if runs := self._seconds.get(operation):
            return median(runs)
        return UNKNOWN_SECONDS if planned is None else planned

    def resources(self, operation: str, of_goal: frozenset[str]) -> frozenset[str]:
        """Those of the abilities that started in the last runs; before the first those that its goal depends on.

        A run in which no ability started says nothing.
        """
        if runs := self._used.get(operation):
            return frozenset().union(*runs)
        return of_goal

    def read_on(self, connection: Connection) -> bool:
        """Read what has happened since, or the last of it where that is too much; whether it changes what is known."""
        if (bounds := run_journal.bounds(connection)) is None:
            return False
        begin = max(bounds[0].number - 1, bounds[1].number - _LOOK_BACK)
        if self._number is None or self._number < begin:
            self._number = begin
            self._active.clear()  # what has become of it is among what is passed over
        before = self._known()
        while page := run_journal.after(connection, self._number, _PAGE):
            self._number = page[-1].number
            self.hear(page)
        return self._known() != before

    def hear(self, records: Sequence[RunRecord]) -> None:
        """What these records tell, which follow on those before."""
        for record in records:
            if record.kind == _BEGUN:
                self._active.clear()  # the controller has started anew, after a time in which nothing was worked
            elif record.kind == _TICKED:
                self._hear_tick(record.time, json.loads(record.content))

    def _hear_tick(self, time: float, told: dict[str, Any]) -> None:
        """Operations are completed and activated before abilities start."""
        for name in told.get("completed", ()):
            # Where the clock was set meanwhile, as after a start without one, it is not known.
            if (run := self._active.pop(name, None)) is not None and 0 <= time - run[0] <= LONGEST:
                self._seconds[name].append(time - run[0])
                if run[1]:
                    self._used[name].append(frozenset(run[1]))
        for name in told.get("activated", ()):
            self._active[name] = time, set()
        resources = {self._resource_of[name] for name in told.get("started", ()) if name in self._resource_of}
        for _, used in self._active.values():
            used |= resources

    def _known(self) -> dict[str, tuple[float, frozenset[str]]]:
        return {name: (median(runs), self.resources(name, frozenset())) for name, runs in self._seconds.items()}
