"""What measured variables were when they were known last."""

from __future__ import annotations

from collections.abc import Mapping

from sequence_planner.control.execution import Execution
from sequence_planner.control.happenings import Ticked
from sequence_planner.control.heard import Heard
from sequence_planner.expressions.types import Value


class LastKnown:
    """Listens to an execution, and remembers each value that is lost."""

    def __init__(self, execution: Execution) -> None:
        self._execution = execution
        self._lost: dict[str, Value] = {}
        execution.listeners.append(self._hear)

    @property
    def values(self) -> Mapping[str, Value]:
        """Of those that are unknown now, and were known once."""
        state = self._execution.state
        return {name: value for name, value in self._lost.items() if state[name] is None}

    def _hear(self, heard: Heard) -> None:
        if isinstance(heard.happening, Ticked):
            for name, value in heard.happening.measured.items():
                if value is None and (before := heard.before[name]) is not None:
                    self._lost[name] = before
