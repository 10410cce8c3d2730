"""Outgoing topics: a message when a variable changes, and again at every interval the model asks for.

A message that could not be sent is owed: the device has not heard what the station believes it to have commanded. It is
tried again until it is out, and as long as one is owed nothing further should be started.
"""

from __future__ import annotations

from collections.abc import Container, Mapping
from dataclasses import dataclass
from typing import Protocol

from sequence_planner.automaton.automaton import State
from sequence_planner.controller.io.inputs import InputErrors
from sequence_planner.language.types import Value
from sequence_planner.pipelines.chain_runtime import RunningOutgoing
from sequence_planner.pipelines.graph import OutgoingPipeline, PipelineView
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import TransportError
from sequence_planner.ros.types.errors import MessageValueError
from sequence_planner.ros.types.messages import MessageRegistry


class Publisher(Protocol):
    """The part of a transport that carries commands."""

    def advertise(self, topic: str, type_name: str, qos: QualityOfService) -> None:
        """Announce a topic."""

    def publish(self, topic: str, type_name: str, data: bytes) -> None:
        """Send a message; raises `TransportError`."""


@dataclass
class OutputTopic:
    """One outgoing topic. `last` is on the clock of `time.monotonic`; `owed` says why its message is not out yet."""

    pipeline: OutgoingPipeline
    running: RunningOutgoing
    said: tuple[Value | None, ...] | None = None  # the values of its variables that were taken last
    message: dict[str, object] | None = None  # the last one that came of them
    last: float | None = None
    messages: int = 0
    owed: str | None = None

    def news(self, state: State) -> bool:
        """Return whether a variable has changed on which the message depends; from now on `state` is known."""
        said = tuple([state[name] for name in self.pipeline.variables])
        is_new, self.said = said != self.said, said
        return is_new


class Outputs:
    """Publishes the outputs. It has no will of its own: nothing is sent unless it is called, and no call raises."""

    def __init__(
        self, pipelines: Mapping[str, OutgoingPipeline], registry: MessageRegistry, transport: Publisher
    ) -> None:
        self.topics = {name: OutputTopic(pipeline, RunningOutgoing(pipeline)) for name, pipeline in pipelines.items()}
        self._registry = registry
        self._transport = transport
        self.reports = InputErrors()

    def advertise(self) -> None:
        """Announce the topics; before, nothing is sent."""
        for command in self.topics.values():
            topic = command.pipeline.topic
            self._transport.advertise(topic.name, topic.type_name, topic.quality)

    @property
    def owed(self) -> dict[str, str]:
        """The topics whose message is not out yet, and why."""
        return {name: command.owed for name, command in self.topics.items() if command.owed is not None}

    @property
    def due(self) -> float | None:
        """The time when `repeat` next makes a difference because a stage waits for it."""
        return min((due for c in self.topics.values() if (due := c.running.chain.due) is not None), default=None)

    def publish(self, state: State, now: float) -> None:
        """Send the messages that depend on a variable which has changed since they were last made."""
        for command in self.topics.values():
            if command.news(state):
                self._send(command, command.running.take(state, now), now)

    def publish_all(self, state: State, now: float) -> None:
        """Send every message."""
        for command in self.topics.values():
            command.news(state)
            self._send(command, command.running.take(state, now), now)

    def repeat(self, now: float) -> None:
        """Send the messages that are owed, those for which a stage has waited, and those whose interval has passed."""
        for command in self.topics.values():
            due = command.running.chain.due
            if due is not None and due <= now:
                for message in command.running.wake(now):
                    self._send(command, message, now)
            if command.owed is not None or _is_due(command, now):
                self._send(command, command.message, now)

    def set_override(self, topic: str, name: str, fields: Mapping[str, object], now: float, actor: str) -> None:
        """A person sets fields, and what comes of it is sent. Raises ValueError for what the model does not allow."""
        command = self.topics[topic]
        self._send(command, command.running.set_override(name, fields, now, actor), now)

    def clear_override(self, topic: str, name: str, now: float) -> None:
        """A person takes back what was set, and what comes of it is sent."""
        command = self.topics[topic]
        self._send(command, command.running.clear_override(name, now), now)

    def observed(self, among: Container[str] | None = None) -> dict[str, PipelineView]:
        """Return what has passed each edge of each pipeline, or of those `among` these."""
        chosen = ((name, each) for name, each in self.topics.items() if among is None or name in among)
        return {name: command.running.observed() for name, command in chosen}

    def close(self) -> None:
        """End what stages have started beside. May be repeated."""
        for command in self.topics.values():
            command.running.chain.close()

    def _send(self, command: OutputTopic, message: dict[str, object] | None, now: float) -> None:
        """Send a message, unless it is held back."""
        if message is None:
            return
        command.message = message
        topic = command.pipeline.topic
        for trouble in command.running.troubles:
            self.reports.note(topic.name, trouble, now)
        if not command.running.troubles:
            self.reports.settle(topic.name)
        try:
            data = self._registry.encode(topic.type_name, message)
            self._transport.publish(topic.name, topic.type_name, data)
        except (TransportError, MessageValueError) as error:
            command.owed = str(error)
            return
        command.owed = None
        command.last = now
        command.messages += 1


def _is_due(command: OutputTopic, now: float) -> bool:
    every = command.pipeline.every
    return every is not None and command.last is not None and now - command.last >= every
