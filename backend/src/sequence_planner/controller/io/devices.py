"""The station's devices, as the network shows them: what they say, and what they are told."""

from __future__ import annotations

import time
from collections.abc import Callable, Container, Iterator, Sequence

import structlog

from sequence_planner.automaton.automaton import State
from sequence_planner.controller.alarms.kinds import NOT_EMULATED, Cause
from sequence_planner.controller.io.clients import Clients
from sequence_planner.controller.io.inputs import Inbox, Inputs
from sequence_planner.controller.io.network import NetworkWatch
from sequence_planner.controller.io.outputs import Outputs
from sequence_planner.controller.io.overrides import Overrides
from sequence_planner.core.clock import Timestamp
from sequence_planner.pipelines.graph import PipelineView
from sequence_planner.ros.qos import QualityEvent
from sequence_planner.ros.transport import Sample, TellsServices, Transport
from sequence_planner.simulation.manual_interface import NODE as EMULATED_DEVICES
from sequence_planner.station import ReadyStation
from sequence_planner.texts.message import as_it_was, message

LOG = structlog.get_logger(__name__)

GRAPH_EVERY = 1.0  # seconds between two looks at the ROS graph


class Devices:
    """All that passes between a station and its devices; `wake` is called when something was heard."""

    def __init__(self, station: ReadyStation, transport: Transport, wake: Callable[[], None]) -> None:
        pipelines, registry = station.pipelines, station.registry
        self._transport = transport
        self._wake = wake
        self.feeds = Inputs(pipelines, registry, station.automaton.initial_valuation)
        self.network = NetworkWatch(pipelines, registry)
        self._inbox = Inbox(self.feeds.reports)
        self.clients = Clients(pipelines, registry, transport, self.feeds, self._hear)
        self.commander = Outputs(pipelines.outgoing, registry, transport)
        self.overrides = Overrides(pipelines, self.feeds, self.commander, self.clients)
        self.unemulated: Sequence[str] = ()
        """Why there are no emulated devices though there should be."""
        self._next_graph = 0.0
        self._awaited = frozenset(self.feeds.expected)
        transport.watch(self._hear_quality)
        for pipeline in pipelines.incoming.values():
            transport.subscribe(pipeline.topic.name, pipeline.topic.type_name, pipeline.topic.quality, self._hear)

    @property
    def waiting(self) -> bool:
        """True if something was heard and has not been looked at."""
        return bool(self._inbox)

    def heard(self) -> Iterator[list[Sample]]:
        """Yield what was heard, in parts of which no topic has more than one."""
        return self._inbox.parts()

    def due(self, is_released: bool) -> float | None:
        """Return when time alone makes a difference, on the clock of `time.monotonic`."""
        dues = (self.feeds.due, self.commander.due if is_released else None)
        return min((due for due in dues if due is not None), default=None)

    def take_command(self) -> None:
        """Say on the network that this station commands its devices. Until then it only listens.

        Raises `TransportError`.
        """
        self.commander.advertise()
        self.network.commands = True

    def wait_to_command(self) -> None:
        """This station is to command its devices, and only listens as long as somebody else does."""
        self.network.waits = True
        self.see_network()

    def publish(self, state: State, everything: bool) -> None:
        """Send the outputs of a state: all of them, or those that differ from what was sent before."""
        now = time.monotonic()
        if everything:
            self.commander.publish_all(state, now)
        else:
            self.commander.publish(state, now)
        self.clients.heed(state, now)

    def repeat(self, released: State, now: float) -> None:
        """Send again what is due, of outputs that are out."""
        self.commander.repeat(now)
        self.clients.heed(released, now)

    def look(self, moment: Timestamp) -> None:
        """Look at the network, every so often and when something is not heard in time: then it is known at once why."""
        before, self._awaited = self._awaited, frozenset(self.feeds.awaited(moment.monotonic))
        if moment.monotonic >= self._next_graph or not self._awaited <= before:
            self._next_graph = moment.monotonic + GRAPH_EVERY
            self.see_network()

    def see_network(self) -> None:
        """Look at the network now."""
        graph = self._transport.graph()
        ends = self._transport.services() if isinstance(self._transport, TellsServices) else None
        for topic in self.network.look(graph, ends):
            if topic in self.feeds.topics:
                self.feeds.abandon(topic)
        self.clients.look(graph)

    def strangers(self, node: str) -> list[str]:
        """Return what speaks against the station's devices being those of `node` alone, as the network is now."""
        return self.network.strangers(self._transport.graph(), node)

    def real_devices(self) -> list[str]:
        """Return what speaks against these being emulated ones."""
        return self.network.others(self._transport.graph(), f"/{EMULATED_DEVICES}")

    def obstacles(self) -> tuple[str, ...]:
        """Return what keeps every ability from starting."""
        owed = [message("waits.command", topic=topic) for topic in self.commander.owed]
        return (*self.network.rivals.values(), *owed)

    def causes(self, moment: Timestamp) -> Iterator[Cause]:
        """The causes of alarms that there are now."""
        if self.unemulated:
            parts = [*map(as_it_was, self.unemulated)]
            yield NOT_EMULATED.cause("", {"why": self.unemulated[0]}, parts=parts, past_parts=parts)

    def traffic(self, among: Container[str] | None) -> dict[str, PipelineView]:
        """Return what has passed the pipelines, or those `among` these."""
        outgoing = self.commander.observed(among) | self.clients.observed(among)
        return self.feeds.observed(among) | outgoing

    def close(self) -> None:
        """Hear and say nothing more."""
        self.clients.close()
        self.feeds.running.close()
        self.commander.close()

    def _hear(self, samples: Sequence[Sample]) -> None:
        if self._inbox.put(samples):
            self._wake()

    def _hear_quality(self, event: QualityEvent) -> None:
        """A quality of service is not kept; on what is not agreed on, `network` looks itself."""
        if event.kind == "incompatible":
            LOG.warning("a quality of service is not agreed on", topic=event.topic, text=event.text)
        elif event.topic in self.feeds.topics:
            self.feeds.abandon(event.topic, event.text)
            self._wake()
        else:
            self.feeds.reports.note(event.topic, event.text, time.monotonic(), lasting=False)
