"""Alarms of how the controller has begun: at rest, not with all that it knew, not as it was deployed."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.controller.alarms.kinds import BEGINS_AT_REST, DEPLOYMENT_UNDONE, NOT_RESTORED, Cause
from sequence_planner.controller.restore import RestoredState
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Production
from sequence_planner.texts.message import as_it_was, message


class Beginning:
    """Tells it of `execution`, as long as it matters. `known` says what was known before, and why it begins at rest."""

    def __init__(self, execution: Executor, known: RestoredState) -> None:
        self._execution = execution
        self._left_out = known.left_out
        self._halted, self._begins = known.halted, execution.mode
        self._undone = known.deployment if known.deployment and known.deployment.why is not None else None

    def causes(self, moment: Timestamp) -> Iterator[Cause]:
        """The causes of alarms that there are now."""
        if self._halted is not None and self._execution.mode is not self._begins:
            self._halted = None  # somebody has decided otherwise
        if self._halted is not None:
            yield BEGINS_AT_REST.cause("", {"mode": message(f"at-rest.{self._begins}"), "why": self._halted})
        started = self._execution.production is Production.STARTED
        if self._left_out and not started:
            first_lost, *others = self._left_out
            parts = [*map(as_it_was, self._left_out)]
            more = message("not-restored.more", count=len(others)) if others else ""
            yield NOT_RESTORED.cause("", {"first": first_lost, "more": more}, parts=parts, past_parts=parts)
        if self._undone is not None and not started:
            yield DEPLOYMENT_UNDONE.cause("", {"revision": self._undone.name, "why": self._undone.why or ""})
