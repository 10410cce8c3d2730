"""The jobs as far as they are durable: whoever ordered one puts it away once it is told that it has ended.

Were that told before its record is on the disk, a controller that is killed in between would begin the job's last
operations again, and nobody would ask for them any more.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from sequence_planner.control.execution import Execution
from sequence_planner.control.heard import Heard
from sequence_planner.control.jobs import Jobs


class KeptJobs:
    """Listens to `execution`, after whoever writes its records; `recorded` is the number of the last one."""

    def __init__(self, execution: Execution, recorded: Callable[[], int]) -> None:
        self._execution = execution
        self._recorded = recorded
        self._kept = self._newest = execution.conduct.jobs
        self._waiting: deque[tuple[int, Jobs]] = deque()
        execution.listeners.append(self._hear)

    def up_to(self, durable: int) -> Jobs:
        """As they are where all records up to this number are durable."""
        while self._waiting and self._waiting[0][0] <= durable:
            _, self._kept = self._waiting.popleft()
        return self._kept

    def _hear(self, heard: Heard) -> None:
        if self._execution.conduct.jobs is not self._newest:
            self._newest = self._execution.conduct.jobs
            self._waiting.append((self._recorded(), self._newest))
