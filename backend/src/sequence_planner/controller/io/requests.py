"""Requests and goals from the state, as outgoing messages are made."""

from __future__ import annotations

from sequence_planner.automaton.automaton import State
from sequence_planner.language.types import Value
from sequence_planner.pipelines.chain_runtime import RunningOutgoing
from sequence_planner.pipelines.graph import OutgoingPipeline


class RequestMaker:
    """Makes one message each time it is asked, at once or when the stages let it through."""

    def __init__(self, pipeline: OutgoingPipeline) -> None:
        self._pipeline = pipeline
        self.running = RunningOutgoing(pipeline)
        self._said: tuple[Value | None, ...] | None = None

    def begin(self) -> None:
        """A message is wanted: `message` makes it, now or later."""
        self._said = None

    def message(self, state: State, now: float) -> dict[str, object] | None:
        """The fields of the message that is wanted; None when stages hold it back, until they do not."""
        said = tuple([state[name] for name in self._pipeline.variables])
        if said != self._said:
            self._said = said
            return self.running.take(state, now)
        due = self.running.chain.due
        made = list(self.running.wake(now)) if due is not None and due <= now else []
        return made[-1] if made else None

    def close(self) -> None:
        """End what stages have started beside. May be repeated."""
        self.running.chain.close()
