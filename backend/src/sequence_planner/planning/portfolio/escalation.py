"""Engines that take turns in this process, and lanes in processes of their own where that takes too long.

Most of what a station asks is answered in hundredths of a second: lanes that stand by for the rest would hold the
memory of several processes for nothing. They are started for a question that no engine has answered soon, go on with
it beside each other, and end when they are not needed for a while.
"""

from __future__ import annotations

import contextlib
import faulthandler
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from sequence_planner.planning.planner import PlanningAttempt
from sequence_planner.planning.portfolio.engines import Engines
from sequence_planner.planning.portfolio.race import Portfolio
from sequence_planner.process.budget import Budget

ALONE_FOR = 2.0  # seconds of a question, and half of its time at most, until lanes are started for it
PATIENCE = 5.0  # seconds an engine may take to come back from its turn, on a busy machine too; then this process ends
RESTS_AFTER = 30.0  # seconds without such a question, after which the lanes end


class Escalation:
    """Solves alone first, by `engines`, and then by a race; None where an engine has ended such a process before.

    One question at a time. To be closed.
    """

    def __init__(self, engines: Engines | None, race: Callable[[], Portfolio]) -> None:
        self._engines = engines
        self._make_race = race
        self._lock = threading.Lock()
        self._race: Portfolio | None = None
        self._rest: threading.Timer | None = None

    def solve(self, attempt: PlanningAttempt, budget: Budget) -> None:
        """As `Solvers.solve`."""
        if self._engines is not None and not self._has_more(self._engines, attempt):
            return
        with self._racing() as race:
            race.solve(attempt, budget)

    def close(self) -> None:
        """End the lanes, if there are any."""
        with self._lock:
            if self._rest is not None:
                self._rest.cancel()
            if self._race is not None:
                self._race.close()
            self._race = self._rest = None

    def _has_more(self, engines: Engines, attempt: PlanningAttempt) -> bool:
        """Return whether it is worth while to ask lanes, after the engines had their turns here.

        A plan that could be better is not: whoever follows it can wait.
        """
        share = attempt.share
        alone = share.part(min(0.5, ALONE_FOR / max(share.remaining, ALONE_FOR)))
        for budget in (alone, share):
            with _ended_after(budget.remaining + PATIENCE):
                for report in engines.work(attempt.task, budget, lambda: attempt.patience):
                    attempt.take(report)
                    if attempt.answered or not attempt.patience:
                        return False
            if not budget.spent:
                return False  # all have said what they know
            if attempt.plan is None:
                return True
        return False

    @contextmanager
    def _racing(self) -> Iterator[Portfolio]:
        with self._lock:
            if self._rest is not None:
                self._rest.cancel()
            self._rest = None
            race = self._race = self._race or self._make_race()
        try:
            yield race
        finally:
            with self._lock:
                self._rest = threading.Timer(RESTS_AFTER, self._end)
                self._rest.daemon = True
                self._rest.start()

    def _end(self) -> None:
        with self._lock:
            if self._rest is not None and self._race is not None:  # or it is needed again just now
                self._race.close()
                self._race = self._rest = None


@contextmanager
def _ended_after(seconds: float) -> Iterator[None]:
    """The process ends, and says where it stood, unless the body is left in time, even if it keeps all threads out."""
    with contextlib.suppress(ValueError, OSError):  # there is nowhere to say it
        faulthandler.dump_traceback_later(seconds, exit=True, file=sys.stderr)
    try:
        yield
    finally:
        faulthandler.cancel_dump_traceback_later()
