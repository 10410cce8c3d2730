"""An outgoing pipeline while it runs: from the state to records, and from a record to the message it says."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from sequence_planner.automaton.structure import State
from sequence_planner.pipelines.graph import OutgoingPipeline
from sequence_planner.pipelines.observation import PipelineView
from sequence_planner.pipelines.record import Record
from sequence_planner.pipelines.running_chain import RunningChain


class RunningOutgoing:
    """One outgoing topic. Nothing is sent here: messages are returned, as their fields.

    `troubles` say what made no sense in the record of which the last message came.
    """

    def __init__(self, pipeline: OutgoingPipeline, patient: bool = False) -> None:
        self.chain = RunningChain(pipeline.chain, patient)
        self.troubles: tuple[str, ...] = ()
        self._pipeline = pipeline

    def take(self, state: State, now: float) -> dict[str, object] | None:
        """The message that says `state`; None when a stage does not let it through, or not yet."""
        record = self.chain.take(Record({name: state[variable] for name, variable in self._pipeline.read.items()}), now)
        return None if record is None else self._message(record)

    def wake(self, now: float) -> Iterator[dict[str, object]]:
        """The messages that come because time has passed."""
        return map(self._message, self.chain.wake(now))

    def set_override(self, name: str, fields: Mapping[str, object], now: float, actor: str) -> dict[str, object] | None:
        """The message that comes because a person sets fields. Raises ValueError for what the model does not allow."""
        record = self.chain.set_override(name, fields, now, actor)
        return None if record is None else self._message(record)

    def clear_override(self, name: str, now: float) -> dict[str, object] | None:
        """The message that comes because a person takes back what was set."""
        record = self.chain.clear_override(name, now)
        return None if record is None else self._message(record)

    def _message(self, record: Record) -> dict[str, object]:
        self.troubles = tuple(record.troubles)
        return message_of(self._pipeline, record)

    def observed(self) -> PipelineView:
        """What has passed each edge."""
        overrides = {name: course.override for name, course in self.chain.overrides.items()}
        topic = self._pipeline.topic.name
        return PipelineView(topic, self._pipeline.variables, self.chain.edges(topic), 0, overrides)


def first_message(pipeline: OutgoingPipeline, state: State) -> dict[str, object] | None:
    """The message that says `state` when it is the first; None when a stage does not let it through."""
    running = RunningOutgoing(pipeline, patient=True)
    try:
        return running.take(state, 0.0)
    finally:
        running.chain.close()


def message_of(pipeline: OutgoingPipeline, record: Record) -> dict[str, object]:
    """The fields of the message that a record says. Those that are unknown keep their default."""
    message: dict[str, object] = {}
    for setting in pipeline.settings:
        value = record.values.get(setting.field)
        if value is not None:
            put(message, setting.field.split("."), value)
    return message


def put(message: dict[str, object], path: list[str], value: object) -> None:
    """Put a value at a path of a nested message, beside what is there."""
    for name in path[:-1]:
        inner = message.get(name)
        inner = dict(inner) if isinstance(inner, dict) else {}
        message[name] = inner
        message = inner
    message[path[-1]] = value
