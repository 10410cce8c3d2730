"""In-memory transport and network for tests."""

from __future__ import annotations

import asyncio
import time
from collections import Counter, deque
from dataclasses import dataclass, field
from typing import Literal

from sequence_planner.ros.delivery import Delivery, Serving, check_hashes
from sequence_planner.ros.names import check_node_name, check_topic
from sequence_planner.ros.qos import Direction, QualityEvent, QualityOfService, disagreements
from sequence_planner.ros.transport import (
    Handler,
    NetworkEndpoint,
    NoAnswerError,
    NoServerError,
    OnBatch,
    OnQualityEvent,
    Sample,
    Sending,
    ServiceEnd,
    TransportError,
    unhindered,
)
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.ros.types.standard_types import ServiceType

# What stands on a network inside one process: participants, their endpoints and servers.


@dataclass(eq=False)
class Participant:
    """One transport on the network, as the others see it."""

    registry: MessageRegistry
    node: str
    loop: asyncio.AbstractEventLoop
    watchers: list[OnQualityEvent] = field(default_factory=list)
    serving: Serving = field(default_factory=Serving)

    def tell(self, event: QualityEvent) -> None:
        """Have the watchers called with `event`."""
        for watcher in self.watchers:
            self.loop.call_soon(watcher, event)


@dataclass(eq=False)
class MemoryEndpoint:
    """One endpoint on the network; `kept` holds what a publisher keeps for late joiners."""

    owner: Participant
    topic: str
    type_name: str
    qos: QualityOfService
    direction: Direction
    delivery: Delivery | None = None
    kept: deque[bytes] = field(default_factory=deque)
    counts: Counter[str] = field(default_factory=Counter)
    timer: asyncio.TimerHandle | None = None

    def passed(self) -> None:
        """Note that a sample was published or received: the deadline begins anew."""
        if self.timer is not None:
            self.timer.cancel()
        if self.qos.deadline is not None:
            self.timer = self.owner.loop.call_later(self.qos.deadline, self._missed)

    def tell(self, kind: Literal["incompatible", "deadline"], text: str) -> None:
        """Have the transport's watchers told of an event."""
        self.counts[kind] += 1
        self.owner.tell(QualityEvent(self.topic, self.direction, kind, self.counts[kind], text))

    def _missed(self) -> None:
        done = "received" if self.direction == "subscriber" else "published"
        self.tell("deadline", f"{self.topic}: no sample {done} within its deadline of {self.qos.deadline:g} s")
        self.passed()


@dataclass(eq=False)
class Server:
    """A server that answers the requests to a service."""

    owner: Participant
    service: str
    type_name: str
    handler: Handler


def _meet(publisher: MemoryEndpoint, subscriber: MemoryEndpoint) -> bool:
    return (publisher.topic, publisher.type_name) == (subscriber.topic, subscriber.type_name)


def match(publisher: MemoryEndpoint, subscriber: MemoryEndpoint) -> bool:
    """Return whether samples of a publisher reach a subscriber."""
    return _meet(publisher, subscriber) and not disagreements(publisher.qos, subscriber.qos)


class Members:
    """All endpoints and servers."""

    def __init__(self) -> None:
        self.members: list[MemoryEndpoint] = []
        self.servers: list[Server] = []

    def add(self, member: MemoryEndpoint) -> None:
        """Let an endpoint join, and tell it and its peers where they do not agree."""
        self.members.append(member)
        for other in self.members:
            if other.direction == member.direction:
                continue
            publisher, subscriber = (member, other) if member.direction == "publisher" else (other, member)
            if _meet(publisher, subscriber) and (found := disagreements(publisher.qos, subscriber.qos)):
                for side in (publisher, subscriber):
                    side.tell("incompatible", f"{side.topic}: {'; '.join(found)}")

    def of(self, direction: Direction) -> list[MemoryEndpoint]:
        """Return the publishers or the subscribers."""
        return [member for member in self.members if member.direction == direction]


# The transport inside one process, for tests.
#
# It keeps the contract that DDS keeps: peers match on topic, type name and quality of service, a type hash tells a
# stale definition, late joiners of a latched topic get the last sample, and everything arrives later, on the event
# loop. A deadline is kept with a timer; a publisher here cannot lose its liveliness, since it is no program of its own.

_SERVER_POLL = 0.01  # seconds between two looks for a server


class MemoryNetwork(Members):
    """The network that transports join to meet one another."""

    def join(self, registry: MessageRegistry, node_name: str, loop: asyncio.AbstractEventLoop) -> MemoryTransport:
        """Return a new transport on this network; raises ValueError for a bad node name."""
        return MemoryTransport(self, registry, node_name, loop)


class MemoryTransport:
    """One participant of a `MemoryNetwork`."""

    name = "memory"

    def __init__(
        self, network: MemoryNetwork, registry: MessageRegistry, node_name: str, loop: asyncio.AbstractEventLoop
    ) -> None:
        self._network = network
        self._me = Participant(registry, f"/{check_node_name(node_name)}", loop)
        self._own: dict[str, MemoryEndpoint] = {}
        self._closed = False

    def advertise(self, topic: str, type_name: str, qos: QualityOfService) -> None:
        """Announce a publisher; see `Transport.advertise`."""
        self._check_open()
        self._me.registry.type_hash(type_name)
        known = self._own.get(check_topic(topic))
        if known is None:
            self._own[topic] = MemoryEndpoint(
                self._me, topic, type_name, qos, "publisher", kept=deque(maxlen=qos.depth)
            )
            self._network.add(self._own[topic])
        elif (known.type_name, known.qos) != (type_name, qos):
            raise TransportError(f"{topic} is already advertised as {known.type_name}, {known.qos}")

    def publish(self, topic: str, type_name: str, data: bytes) -> None:
        """Send bytes; see `Transport.publish`."""
        publisher = self._own.get(topic)
        if publisher is None or publisher.type_name != type_name:
            raise TransportError(f"{topic} has not been advertised as {type_name}")
        publisher.passed()
        if publisher.qos.transient_local:
            publisher.kept.append(data)
        for subscriber in self._network.of("subscriber"):
            if subscriber.delivery is not None and match(publisher, subscriber):
                subscriber.delivery.push([Sample(topic, data, time.monotonic())])
                subscriber.passed()

    def subscribe(self, topic: str, type_name: str, qos: QualityOfService, on_batch: OnBatch) -> None:
        """Receive batches; see `Transport.subscribe`."""
        self._check_open()
        self._me.registry.type_hash(type_name)
        delivery = Delivery(self._me.loop, check_topic(topic), on_batch)
        subscriber = MemoryEndpoint(self._me, topic, type_name, qos, "subscriber", delivery)
        self._network.add(subscriber)
        if qos.transient_local:
            for publisher in self._network.of("publisher"):
                if match(publisher, subscriber):
                    delivery.push(Sample(topic, data, time.monotonic()) for data in publisher.kept)

    def watch(self, on_event: OnQualityEvent) -> None:
        """Hear of qualities of service; see `Transport.watch`."""
        self._me.watchers.append(on_event)

    async def call(
        self, service: str, type_name: str, request: bytes, within: float, sending: Sending = unhindered
    ) -> bytes:
        """Call a service; see `Transport.call`."""
        self._check_open()
        self._me.registry.service(type_name)
        check_topic(service)
        until = time.monotonic() + within
        while (server := self._server(service, type_name)) is None:
            if time.monotonic() > until:
                raise NoServerError(f"nobody serves {service} as {type_name}")
            await asyncio.sleep(_SERVER_POLL)
        sending()
        answer: asyncio.Future[bytes] = self._me.loop.create_future()

        def respond(response: bytes) -> None:
            if not answer.done():
                answer.set_result(response)

        server.owner.serving.answer(service, server.handler, request, respond)
        try:
            return await asyncio.wait_for(answer, until - time.monotonic())
        except TimeoutError:
            raise NoAnswerError(f"{service} gave no answer within {within:g} s") from None

    def serve(self, service: str, type_name: str, handler: Handler) -> None:
        """Answer requests; see `Transport.serve`."""
        self._check_open()
        self._me.registry.service(type_name)
        if any(server.owner is self._me and server.service == service for server in self._network.servers):
            raise TransportError(f"{service} is already served")
        self._network.servers.append(Server(self._me, check_topic(service), type_name, handler))

    def graph(self) -> list[NetworkEndpoint]:
        """Return all endpoints; see `Transport.graph`."""
        self._check_open()
        return [
            NetworkEndpoint(
                topic=member.topic,
                type_name=member.type_name,
                direction=member.direction,
                own=member.owner is self._me,
                type_hash=member.owner.registry.type_hash(member.type_name),
                node=member.owner.node,
                reliable=member.qos.reliable,
                transient_local=member.qos.transient_local,
                deadline=member.qos.deadline,
                liveliness=member.qos.liveliness,
            )
            for member in self._network.members
        ]

    def services(self) -> list[ServiceEnd]:
        """Return all servers; clients come and go with their calls. See `TellsServices`."""
        self._check_open()
        return [
            ServiceEnd(server.service, server.type_name, "server", server.owner is self._me, server.owner.node)
            for server in self._network.servers
        ]

    def close(self) -> None:
        """Leave the network; see `Transport.close`."""
        for member in [member for member in self._network.members if member.owner is self._me]:
            self._network.members.remove(member)
            if member.delivery is not None:
                member.delivery.close()
            if member.timer is not None:
                member.timer.cancel()
        self._network.servers[:] = [server for server in self._network.servers if server.owner is not self._me]
        self._me.serving.close()
        self._me.watchers.clear()
        self._own.clear()
        self._closed = True

    def _server(self, service: str, type_name: str) -> Server | None:
        """Return who serves; raises NoServerError for somebody whose definition is another one."""
        for server in self._network.servers:
            if (server.service, server.type_name) == (service, type_name):
                types, theirs, ours = ServiceType(type_name), server.owner.registry, self._me.registry
                for message in (types.request, types.response):
                    check_hashes(service, message, theirs.type_hash(message), ours.type_hash(message))
                return server
        return None

    def _check_open(self) -> None:
        if self._closed:
            raise TransportError("the transport is closed")
