"""An error in one piece of the controller's work takes nothing else down: it is logged, and an alarm says so."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import structlog

from sequence_planner.controller.alarms.kinds import CONTROLLER, Cause
from sequence_planner.core.clock import Timestamp

LOG = structlog.get_logger(__name__)


class Failures:
    """The pieces of work that fail, `known` by what each is, with how it failed last."""

    def __init__(self) -> None:
        self.known: dict[str, str] = {}

    def causes(self, moment: Timestamp) -> Iterator[Cause]:
        """The causes of alarms that there are now."""
        for what, how in self.known.items():
            yield CONTROLLER.cause(what, {"what": what, "how": how})

    def attempt(self, what: str, act: Callable[[], None]) -> None:
        """Do a piece of work. One that fails is shown and logged, once for each way in which it fails."""
        try:
            act()
        except Exception as error:
            how = f"{type(error).__name__}: {error}"
            if self.known.get(what) != how:
                LOG.exception("the controller fails", at=what)
            self.known[what] = how
        else:
            self.known.pop(what, None)
