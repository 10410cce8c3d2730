"""ROS 2 without a ROS installation: the transport over cyclonedds from PyPI.

To its peers it is an ordinary ROS 2 node. It uses ROS 2's names, policies and user data, so topics work both ways with
rmw_cyclonedds, rmw_fastrtps and anything else that speaks DDS; the bytes are made and read above, by the registry.
"""

from __future__ import annotations

import asyncio
from contextlib import suppress
from dataclasses import dataclass
from functools import partial

from cyclonedds.core import DDSException
from cyclonedds.pub import DataWriter
from cyclonedds.qos import Qos
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

from sequence_planner.ros import discovery_info, environment, names
from sequence_planner.ros.both_sides import both_sides
from sequence_planner.ros.cyclone_events import Change, EventWatch, Watched
from sequence_planner.ros.cyclone_found import fetch_description
from sequence_planner.ros.cyclone_graph import Discovery
from sequence_planner.ros.cyclone_log import hush
from sequence_planner.ros.cyclone_network import join, release
from sequence_planner.ros.cyclone_qos import endpoint_qos
from sequence_planner.ros.cyclone_receiver import Receiver
from sequence_planner.ros.cyclone_services import CycloneServices
from sequence_planner.ros.cyclone_types import RawSample, raw_types
from sequence_planner.ros.delivery import Delivery
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.quality import Direction
from sequence_planner.ros.service_graph import ServiceEnd
from sequence_planner.ros.strangers import Strangers
from sequence_planner.ros.transport import (
    Endpoint,
    Handler,
    OnBatch,
    OnQualityEvent,
    QualityEvent,
    QualityOfService,
    Sending,
    TransportError,
    unhindered,
)
from sequence_planner.ros.type_description import TypeDescription


@dataclass(frozen=True)
class _Publisher:
    writer: DataWriter[RawSample]
    raw: type[RawSample]
    type_name: str
    qos: QualityOfService


class CycloneTransport:
    """One DDS participant that is one ROS 2 node."""

    name = "cyclonedds"

    def __init__(
        self,
        registry: MessageRegistry,
        node_name: str,
        loop: asyncio.AbstractEventLoop,
        domain_id: int | None = None,
    ) -> None:
        """Join the domain; raises TransportError when that cannot be done and ValueError for a bad node name."""
        names.check_node_name(node_name)
        self._registry = registry
        self._loop = loop
        self._raw = raw_types(registry)
        self._topics: dict[tuple[str, str], Topic[RawSample]] = {}
        self._publishers: dict[str, _Publisher] = {}
        self._readers: list[tuple[DataReader[RawSample], Delivery]] = []
        self._watchers: list[OnQualityEvent] = []
        self._closed = False
        domain = environment.domain_id(domain_id)
        self._domain, self._participant = join(domain, environment.discovery_range())
        raw = self._raw(discovery_info.TYPE_NAME)
        try:
            self._discovery = Discovery(self._participant, registry, raw, node_name)
            self._receiver = Receiver(self._participant, f"dds-{node_name}")
            self._events = EventWatch(self._participant, f"dds-events-{node_name}", self._changed)
        except DDSException as error:
            release(self._participant)
            raise TransportError(f"DDS cannot start on domain {domain}: {error}") from error
        self._services = CycloneServices(
            self._participant, registry, self._raw, self._receiver, loop, self._discovery.told_on
        )
        self._strangers = Strangers(loop, self._discovery.services_now, partial(hush, self._discovery))
        self._announce()

    def advertise(self, topic: str, type_name: str, qos: QualityOfService) -> None:
        """Announce a publisher; see `Transport.advertise`."""
        known = self._publishers.get(topic)
        if known is not None:
            if (known.type_name, known.qos) != (type_name, qos):
                raise TransportError(f"{topic} is already advertised as {known.type_name}, {known.qos}")
            return
        dds_topic = self._topic(topic, type_name)
        try:
            writer = DataWriter(self._participant, dds_topic, self._qos(type_name, qos))
        except DDSException as error:
            raise TransportError(f"DDS cannot advertise {topic}: {error}") from error
        self._publishers[topic] = _Publisher(writer, self._raw(type_name), type_name, qos)
        self._events.add(Watched(topic, qos, writer))
        self._announce()

    def publish(self, topic: str, type_name: str, data: bytes) -> None:
        """Send bytes; see `Transport.publish`."""
        publisher = self._publishers.get(topic)
        if publisher is None or publisher.type_name != type_name:
            raise TransportError(f"{topic} has not been advertised as {type_name}")
        try:
            publisher.writer.write(publisher.raw(data))
        except DDSException as error:
            raise TransportError(f"DDS cannot publish on {topic}: {error}") from error

    def subscribe(self, topic: str, type_name: str, qos: QualityOfService, on_batch: OnBatch) -> None:
        """Receive batches; see `Transport.subscribe`."""
        dds_topic = self._topic(topic, type_name)
        try:
            reader = DataReader(self._participant, dds_topic, self._qos(type_name, qos.of_a_reader))
        except DDSException as error:
            raise TransportError(f"DDS cannot subscribe to {topic}: {error}") from error
        delivery = Delivery(self._loop, topic, on_batch)
        self._readers.append((reader, delivery))
        self._receiver.add(topic, reader, delivery)
        self._events.add(Watched(topic, qos, reader))
        self._announce()

    def watch(self, on_event: OnQualityEvent) -> None:
        """Hear of qualities of service; see `Transport.watch`."""
        self._watchers.append(on_event)

    async def call(
        self, service: str, type_name: str, request: bytes, within: float, sending: Sending = unhindered
    ) -> bytes:
        """Call a service; see `Transport.call`."""
        self._check_open()
        if not self._services.has_client(service, type_name):
            self._services.add_client(service, type_name)
            self._strangers.add(service)
            self._announce()
        return await self._services.call(service, type_name, request, within, sending)

    def serve(self, service: str, type_name: str, handler: Handler) -> None:
        """Answer requests; see `Transport.serve`."""
        self._check_open()
        self._services.serve(service, type_name, handler)
        self._strangers.add(service)
        self._announce()

    async def describe(self, endpoint: Endpoint, within: float) -> TypeDescription | None:
        """Fetch the type of an endpoint; see `TellsTypes.describe`."""
        self._check_open()
        type_id = self._discovery.type_id(endpoint)
        if type_id is None:
            return None
        return await asyncio.to_thread(fetch_description, self._participant, type_id, within)

    def graph(self) -> list[Endpoint]:
        """Return all endpoints; see `Transport.graph`."""
        self._check_open()
        return self._discovery.endpoints()

    def services(self) -> list[ServiceEnd]:
        """Return the ends of services that were known at the last look at the graph; see `TellsServices`."""
        self._check_open()
        return self._discovery.services()

    def close(self) -> None:
        """Leave the domain; see `Transport.close`."""
        if self._closed:
            return
        self._closed = True
        for _, delivery in self._readers:
            delivery.close()
        self._watchers.clear()
        self._strangers.close()
        self._services.close()
        self._receiver.close()
        self._events.close()
        self._discovery.close()
        self._services.release()
        for entity in (
            *(reader for reader, _ in self._readers),
            *(publisher.writer for publisher in self._publishers.values()),
            *self._topics.values(),
            self._participant,
        ):
            release(entity)
        self._readers.clear()
        self._publishers.clear()
        self._topics.clear()
        self._domain = None

    def _check_open(self) -> None:
        if self._closed:
            raise TransportError("the transport is closed")

    def _topic(self, topic: str, type_name: str) -> Topic[RawSample]:
        """Return the DDS topic, made on first use: one participant may have it once."""
        self._check_open()
        key = (names.dds_topic(topic), type_name)
        if key not in self._topics:
            raw = self._raw(type_name)
            try:
                self._topics[key] = Topic(self._participant, key[0], raw)
            except DDSException as error:
                raise TransportError(f"DDS refuses {topic} as {type_name}: {error}") from error
        return self._topics[key]

    def _qos(self, type_name: str, qos: QualityOfService) -> Qos:
        return endpoint_qos(qos, names.type_hash_user_data(self._registry.type_hash(type_name)))

    def _changed(self, watched: Watched, change: Change) -> None:
        """Hand a change over to the event loop; called on a thread of the middleware."""
        with suppress(RuntimeError):  # The loop has been closed: nobody listens any more.
            self._loop.call_soon_threadsafe(self._tell, watched, change)

    def _tell(self, watched: Watched, change: Change) -> None:
        if self._closed or not self._watchers:
            return
        direction: Direction = "subscriber" if isinstance(watched.endpoint, DataReader) else "publisher"
        text = ""
        if change.kind == "incompatible":
            text = both_sides(self._discovery.endpoints(), watched.topic, direction, watched.quality)
        event = QualityEvent(
            change.topic, direction, change.kind, change.count, f"{change.topic}: {text or change.detail}"
        )
        for watcher in self._watchers:
            watcher(event)

    def _announce(self) -> None:
        readers, writers = self._services.guids
        try:
            self._discovery.announce(
                [*(reader.guid for reader, _ in self._readers), *readers],
                [*(publisher.writer.guid for publisher in self._publishers.values()), *writers],
            )
        except DDSException as error:
            raise TransportError(f"DDS cannot announce this node: {error}") from error
