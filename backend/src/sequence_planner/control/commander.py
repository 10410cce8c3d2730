"""Outgoing topics: a message when a variable changes, and again at every interval the model asks for.

A message that could not be sent is owed: the device has not heard what the station believes it to have commanded. It is
tried again until it is out, and as long as one is owed nothing further should be started.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Set
from dataclasses import dataclass

from sequence_planner.automaton.structure import State
from sequence_planner.pipelines.pipeline import OutgoingPipeline
from sequence_planner.ros.errors import MessageValueError
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.transport import Transport, TransportError


@dataclass
class Command:
    """One outgoing topic. `last` is on the clock of `time.monotonic`; `owed` says why its message is not out yet."""

    pipeline: OutgoingPipeline
    last: float | None = None
    messages: int = 0
    owed: str | None = None


class Commander:
    """Publishes the outputs. It has no will of its own: nothing is sent unless it is called, and no call raises."""

    def __init__(
        self, pipelines: Mapping[str, OutgoingPipeline], registry: MessageRegistry, transport: Transport
    ) -> None:
        self.topics = {name: Command(pipeline) for name, pipeline in pipelines.items()}
        self._registry = registry
        self._transport = transport
        for pipeline in pipelines.values():
            transport.advertise(pipeline.topic.name, pipeline.topic.type_name, pipeline.topic.quality)

    @property
    def owed(self) -> dict[str, str]:
        """The topics whose message is not out yet, and why."""
        return {name: command.owed for name, command in self.topics.items() if command.owed is not None}

    def publish(self, state: State, changed: Set[str], now: float) -> None:
        """Send the messages in which one of the `changed` variables stands."""
        self._send((c for c in self.topics.values() if not changed.isdisjoint(c.pipeline.variables)), state, now)

    def publish_all(self, state: State, now: float) -> None:
        """Send every message."""
        self._send(self.topics.values(), state, now)

    def repeat(self, state: State, now: float) -> None:
        """Send the messages that are owed, and those whose interval has passed since they were last sent."""
        self._send((c for c in self.topics.values() if c.owed is not None or _is_due(c, now)), state, now)

    def _send(self, commands: Iterable[Command], state: State, now: float) -> None:
        for command in commands:
            topic = command.pipeline.topic
            try:
                data = self._registry.encode(topic.type_name, command.pipeline.write(state))
                self._transport.publish(topic.name, topic.type_name, data)
            except (TransportError, MessageValueError) as error:
                command.owed = str(error)
                continue
            command.owed = None
            command.last = now
            command.messages += 1


def _is_due(command: Command, now: float) -> bool:
    every = command.pipeline.every
    return every is not None and command.last is not None and now - command.last >= every
