"""The transport inside one process, for tests.

It keeps the contract that DDS keeps: peers match on topic, type name and quality of service, a type hash tells a stale
definition, late joiners of a latched topic get the last sample, and everything arrives later, on the event loop.
"""

from __future__ import annotations

import asyncio
import time
from collections import deque
from dataclasses import dataclass, field

from sequence_planner.ros.delivery import Delivery
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.names import check_node_name, check_topic
from sequence_planner.ros.transport import Direction, Endpoint, OnBatch, QualityOfService, Sample, TransportError


@dataclass(eq=False)
class _Member:
    """One endpoint on the network; `kept` holds what a publisher keeps for late joiners."""

    transport: MemoryTransport
    topic: str
    type_name: str
    qos: QualityOfService
    direction: Direction
    delivery: Delivery | None = None
    kept: deque[bytes] = field(default_factory=deque)


def _match(publisher: _Member, subscriber: _Member) -> bool:
    return (
        publisher.topic == subscriber.topic
        and publisher.type_name == subscriber.type_name
        and publisher.qos.reliable >= subscriber.qos.reliable
        and publisher.qos.transient_local >= subscriber.qos.transient_local
    )


class MemoryNetwork:
    """What transports join to meet one another."""

    def __init__(self) -> None:
        self.members: list[_Member] = []

    def join(self, registry: MessageRegistry, node_name: str, loop: asyncio.AbstractEventLoop) -> MemoryTransport:
        """Return a new transport on this network; raises ValueError for a bad node name."""
        return MemoryTransport(self, registry, node_name, loop)

    def of(self, direction: Direction) -> list[_Member]:
        """Return the publishers or the subscribers."""
        return [member for member in self.members if member.direction == direction]


class MemoryTransport:
    """One participant of a `MemoryNetwork`."""

    name = "memory"

    def __init__(
        self, network: MemoryNetwork, registry: MessageRegistry, node_name: str, loop: asyncio.AbstractEventLoop
    ) -> None:
        self._network = network
        self._registry = registry
        self._node = f"/{check_node_name(node_name)}"
        self._loop = loop
        self._own: dict[str, _Member] = {}
        self._closed = False

    def advertise(self, topic: str, type_name: str, qos: QualityOfService) -> None:
        """Announce a publisher; see `Transport.advertise`."""
        self._check_open()
        self._registry.type_hash(type_name)
        known = self._own.get(check_topic(topic))
        if known is None:
            self._own[topic] = _Member(self, topic, type_name, qos, "publisher", kept=deque(maxlen=qos.depth))
            self._network.members.append(self._own[topic])
        elif (known.type_name, known.qos) != (type_name, qos):
            raise TransportError(f"{topic} is already advertised as {known.type_name}, {known.qos}")

    def publish(self, topic: str, type_name: str, data: bytes) -> None:
        """Send bytes; see `Transport.publish`."""
        publisher = self._own.get(topic)
        if publisher is None or publisher.type_name != type_name:
            raise TransportError(f"{topic} has not been advertised as {type_name}")
        if publisher.qos.transient_local:
            publisher.kept.append(data)
        for subscriber in self._network.of("subscriber"):
            if subscriber.delivery is not None and _match(publisher, subscriber):
                subscriber.delivery.push([Sample(topic, data, time.monotonic())])

    def subscribe(self, topic: str, type_name: str, qos: QualityOfService, on_batch: OnBatch) -> None:
        """Receive batches; see `Transport.subscribe`."""
        self._check_open()
        self._registry.type_hash(type_name)
        delivery = Delivery(self._loop, check_topic(topic), on_batch)
        subscriber = _Member(self, topic, type_name, qos, "subscriber", delivery)
        self._network.members.append(subscriber)
        if qos.transient_local:
            for publisher in self._network.of("publisher"):
                if _match(publisher, subscriber):
                    delivery.push(Sample(topic, data, time.monotonic()) for data in publisher.kept)

    def graph(self) -> list[Endpoint]:
        """Return all endpoints; see `Transport.graph`."""
        self._check_open()
        return [
            Endpoint(
                topic=member.topic,
                type_name=member.type_name,
                direction=member.direction,
                own=member.transport is self,
                type_hash=member.transport._registry.type_hash(member.type_name),
                node=member.transport._node,
                reliable=member.qos.reliable,
                transient_local=member.qos.transient_local,
            )
            for member in self._network.members
        ]

    def close(self) -> None:
        """Leave the network; see `Transport.close`."""
        for member in [member for member in self._network.members if member.transport is self]:
            self._network.members.remove(member)
            if member.delivery is not None:
                member.delivery.close()
        self._own.clear()
        self._closed = True

    def _check_open(self) -> None:
        if self._closed:
            raise TransportError("the transport is closed")
