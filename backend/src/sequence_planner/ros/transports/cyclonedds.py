"""Transport over Cyclone DDS without a ROS installation: topics, services (rmw_cyclonedds), logging."""

from __future__ import annotations

import asyncio
import secrets
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from ctypes import CDLL
from dataclasses import dataclass, field
from functools import partial
from typing import Final
from uuid import UUID

import structlog
from cyclonedds.core import DDSException
from cyclonedds.domain import DomainParticipant
from cyclonedds.internal import load_cyclonedds
from cyclonedds.pub import DataWriter
from cyclonedds.qos import Policy, Qos
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

from sequence_planner.core.immutable import Immutable
from sequence_planner.ros import discovery_info, environment, names
from sequence_planner.ros.call_header import CallHeader, split_header, with_header
from sequence_planner.ros.delivery import Delivery, Serving, both_sides, check_hashes
from sequence_planner.ros.incompatible_peers import Strangers
from sequence_planner.ros.qos import Direction, QualityEvent, QualityOfService
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
from sequence_planner.ros.transports.cyclonedds_discovery import (
    Discovery,
    EventWatch,
    StatusChange,
    Watched,
    endpoint_qos,
    fetch_description,
    user_data,
)
from sequence_planner.ros.transports.cyclonedds_network import (
    RawSample,
    RawTypes,
    Receiver,
    join,
    leave,
    raw_types,
    release,
)
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.ros.types.standard_types import ServiceType
from sequence_planner.ros.types.type_description import TypeDescription

_log = structlog.get_logger(__name__)

# Peers are told of endpoints more than once.

TOLD_AGAIN: Final = (1.0, 3.0, 15.0)
"""Seconds after which peers are told of an endpoint once more.

Discovery is reliable, and yet a peer that joins in just the moment in which an endpoint is made has been seen never to
hear of it; where that is the one that tells a participant's nodes, all others of that participant have no node. An
endpoint whose user data changes is told anew; ROS 2 reads no key there that it does not know.
"""


class Reminder:
    """Tells peers of endpoints once more. All methods belong on the event loop's thread."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._closed = False

    def keep_telling(self, *endpoints: DataReader[RawSample] | DataWriter[RawSample]) -> None:
        """Tell of endpoints that have just been made."""
        for endpoint in endpoints:
            data = user_data(endpoint.get_qos())
            for times, seconds in enumerate(TOLD_AGAIN, 2):
                self._loop.call_later(seconds, self._tell, endpoint, data + f"told={times};".encode())

    def close(self) -> None:
        """Tell no more: endpoints may be deleted now."""
        self._closed = True

    def _tell(self, endpoint: DataReader[RawSample] | DataWriter[RawSample], data: bytes) -> None:
        if self._closed:
            return
        try:
            endpoint.set_qos(Qos(Policy.Userdata(data)))
        except DDSException:
            _log.exception("DDS cannot tell of an endpoint again")


# A client or a server of a service over cyclonedds: what it writes and what it reads.


@dataclass(eq=False)
class CallEnd:
    """Two endpoints: a client writes requests and reads replies, a server the other way round."""

    service: str
    types: ServiceType
    writer: DataWriter[RawSample]
    raw: type[RawSample]
    reader: DataReader[RawSample]
    delivery: Delivery
    topics: tuple[Topic[RawSample], Topic[RawSample]]

    def write(self, header: CallHeader, message: bytes) -> None:
        """Send the CDR bytes of a request or a response; raises DDSException."""
        self.writer.write(self.raw(with_header(header, message)))

    def reaches(self, client: str) -> bool:
        """Return whether what is written now would be read by the client of this identity."""
        readers = map(self.writer.get_matched_subscription_data, self.writer.get_matched_subscriptions())
        return any(reader is not None and names.client_of(user_data(reader.qos)) == client for reader in readers)

    def server_there(self, registry: MessageRegistry, told_on: Callable[[str], list[bytes]]) -> bool:
        """Return whether there is a server whose reply would reach us.

        `told_on` gives the user data of all publishers of a topic of DDS. Raises NoServerError when a request would
        also reach somebody who would not understand it.
        """
        request, response = registry.type_hash(self.types.request), registry.type_hash(self.types.response)
        readers, writers = set(), set()
        for handle in self.writer.get_matched_subscriptions():
            reader = self.writer.get_matched_subscription_data(handle)
            if reader is None:
                continue
            data = user_data(reader.qos)
            server = names.server_of(data)
            if server is None:
                raise NoServerError(
                    f"{self.service} is served by a program whose DDS cannot tell calls apart from here "
                    "(no serviceid); it would execute garbage, so nothing was sent. "
                    "Run it with RMW_IMPLEMENTATION=rmw_cyclonedds_cpp, or run this station with rclpy"
                )
            check_hashes(self.service, self.types.request, names.type_hash_of(data), request)
            readers.add(server)
        for handle in self.reader.get_matched_publications():
            writer = self.reader.get_matched_publication_data(handle)
            if writer is not None:
                writers.add(names.server_of(user_data(writer.qos)))
        there = readers & writers
        # DDS does not match a reply of another definition, so we ask who announces one.
        for data in told_on(names.dds_service(self.service)[1]) if readers and not there else []:
            if names.server_of(data) in readers:
                check_hashes(self.service, self.types.response, names.type_hash_of(data), response)
        return bool(there)


# What Cyclone DDS itself writes to the log.
#
# It writes a line for every sample that it cannot read. A peer that is known to write otherwise, and of which the
# station has told in its own words, would fill the log so; as long as one is there these lines are left out. Errors
# never are.

_LIBRARY: CDLL = load_cyclonedds()

_FATAL, _ERROR, _WARNING = 1, 2, 4  # of its log.h

_lock = threading.Lock()
_hushed: set[object] = set()


def hush(whose: object, known: bool) -> None:
    """Leave out Cyclone's warnings as long as anybody in this process has `known` reasons for them; else write them."""
    with _lock:
        (_hushed.add if known else _hushed.discard)(whose)
        _LIBRARY.dds_set_log_mask(_FATAL | _ERROR if _hushed else _FATAL | _ERROR | _WARNING)


# Services over cyclonedds, in the mapping of rmw_cyclonedds.
#
# A service is two topics. Each request and reply begins with whose call it is and the call's number, and the user data
# of an endpoint say to which client or server it belongs. Other vendors keep the call's number where cyclonedds does
# not show it, and put no header before the body; but a request of ours would still reach such a server, which would
# then execute what it makes of our header. So a request is written only while every reader that it would reach says
# that it belongs to a server of this mapping, and a request that comes from anybody else is dropped.


_POLL = 0.02  # seconds between two looks for a peer
_LOOKS = 100  # for a client that has called, as a reader of the answer


@dataclass(eq=False)
class _Client:
    end: CallEnd
    number: int  # a client's own, which its calls bear
    calls: int = 0
    waiting: dict[int, asyncio.Future[bytes]] = field(default_factory=dict)


class CycloneServices:
    """The clients and servers of one participant. All methods belong on the event loop's thread."""

    def __init__(
        self,
        participant: DomainParticipant,
        registry: MessageRegistry,
        raw: RawTypes,
        receiver: Receiver,
        loop: asyncio.AbstractEventLoop,
        reminder: Reminder,
        told_on: Callable[[str], list[bytes]],
    ) -> None:
        """Begin without any; `told_on` gives the user data of all publishers of a topic of DDS."""
        self._reminder = reminder
        self._told_on = told_on
        self._participant = participant
        self._registry = registry
        self._raw = raw
        self._receiver = receiver
        self._loop = loop
        self._clients: dict[tuple[str, str], _Client] = {}
        self._servers: dict[str, CallEnd] = {}
        self._serving = Serving()
        self._strangers: set[int] = set()

    @property
    def guids(self) -> tuple[list[UUID], list[UUID]]:
        """The readers and the writers of all clients and servers."""
        ends = self._ends()
        return [end.reader.guid for end in ends], [end.writer.guid for end in ends]

    def has_client(self, service: str, type_name: str) -> bool:
        """Return whether the service has been called before."""
        return (service, type_name) in self._clients

    def add_client(self, service: str, type_name: str) -> None:
        """Make what calls need; raises TransportError."""
        number, identity = secrets.randbits(64), secrets.token_bytes(16)
        waiting: dict[int, asyncio.Future[bytes]] = {}

        def receive(batch: Sequence[Sample]) -> None:
            for sample in batch:
                match split_header(sample.data):
                    case (CallHeader(client, call), body) if client == number and call in waiting:
                        answer = waiting.pop(call)
                        if not answer.done():
                            answer.set_result(body)

        end = self._end(service, type_name, names.client_user_data(identity), True, receive)
        self._clients[service, type_name] = _Client(end, number, waiting=waiting)

    async def call(
        self, service: str, type_name: str, request: bytes, within: float, sending: Sending = unhindered
    ) -> bytes:
        """Call a service that has a client; see `Transport.call`."""
        client, until = self._clients[service, type_name], time.monotonic() + within
        while not client.end.server_there(self._registry, self._told_on):
            if time.monotonic() > until:
                raise NoServerError(f"nobody serves {service} as {type_name}")
            await asyncio.sleep(_POLL)
        sending()
        client.calls += 1
        call = client.calls
        answer = client.waiting[call] = self._loop.create_future()
        try:
            client.end.write(CallHeader(client.number, call), request)
            return await asyncio.wait_for(answer, max(until - time.monotonic(), 0))
        except TimeoutError:
            raise NoAnswerError(f"{service} gave no answer within {within:g} s") from None
        except DDSException as error:
            raise TransportError(f"DDS cannot call {service}: {error}") from error
        finally:
            client.waiting.pop(call, None)

    def serve(self, service: str, type_name: str, handler: Handler) -> None:
        """Answer requests; see `Transport.serve`."""
        if service in self._servers:
            raise TransportError(f"{service} is already served")

        def receive(batch: Sequence[Sample]) -> None:
            for sample in batch:
                request, client = split_header(sample.data), self._client_of(service, end, sample.source)
                if request is not None and client is not None:
                    answer = _when_reachable(end, client, handler)
                    self._serving.answer(service, answer, request[1], _responder(service, end, request[0]))

        end = self._end(service, type_name, names.server_user_data(secrets.token_bytes(16)), False, receive)
        self._servers[service] = end

    def close(self) -> None:
        """Answer nothing any more, and let those who wait for an answer know."""
        self._serving.close()
        for client in self._clients.values():
            for answer in client.waiting.values():
                if not answer.done():
                    answer.set_exception(TransportError("the transport is closed"))
        for end in self._ends():
            end.delivery.close()

    def release(self) -> None:
        """Delete the entities; nothing may take samples from them any more."""
        for end in self._ends():
            for entity in (end.reader, end.writer, *end.topics):
                release(entity)
        self._clients.clear()
        self._servers.clear()

    def _ends(self) -> list[CallEnd]:
        return [*(client.end for client in self._clients.values()), *self._servers.values()]

    def _end(self, service: str, type_name: str, identity: bytes, calling: bool, on_batch: OnBatch) -> CallEnd:
        """Make the two endpoints of a client or a server."""
        types = self._registry.service(type_name)
        request, reply = names.dds_service(service)
        outward, inward = (request, types.request), (reply, types.response)
        if not calling:
            outward, inward = inward, outward

        def quality(message: str) -> Qos:
            """Each endpoint tells the hash of what passes through it, and not that of the service."""
            return endpoint_qos(
                QualityOfService.CALLS, identity + names.type_hash_user_data(self._registry.type_hash(message))
            )

        try:
            topics = tuple(
                Topic(self._participant, topic, self._raw(name, called=True)) for topic, name in (outward, inward)
            )
            writer = DataWriter(self._participant, topics[0], quality(outward[1]))
            reader = DataReader(self._participant, topics[1], quality(inward[1]))
        except DDSException as error:
            raise TransportError(f"DDS refuses {service} as {type_name}: {error}") from error
        delivery = Delivery(self._loop, service, on_batch)
        self._receiver.add(service, reader, delivery)
        self._reminder.keep_telling(writer, reader)
        return CallEnd(
            service, types, writer, self._raw(outward[1], called=True), reader, delivery, (topics[0], topics[1])
        )

    def _client_of(self, service: str, end: CallEnd, source: int) -> str | None:
        """Return which client of this mapping sent a request; None for others, of which the log tells once each."""
        writer = end.reader.get_matched_publication_data(source)
        if writer is None:  # It has gone, and nobody waits for the answer.
            return None
        client = names.client_of(user_data(writer.qos))
        if client is None and source not in self._strangers:
            self._strangers.add(source)
            _log.warning("requests dropped: their sender cannot be answered (no clientid)", service=service)
        return client


def _when_reachable(end: CallEnd, client: str, handler: Handler) -> Handler:
    """Return `handler` with an answer that waits until DDS would carry it to the client, which can take a moment."""

    async def answer(request: bytes) -> bytes:
        response = await handler(request)
        for _ in range(_LOOKS):
            if end.reaches(client):
                break
            await asyncio.sleep(_POLL)
        return response

    return answer


def _responder(service: str, end: CallEnd, header: CallHeader) -> Callable[[bytes], None]:
    def respond(response: bytes) -> None:
        try:
            end.write(header, response)
        except DDSException:
            _log.exception("DDS cannot answer", service=service)

    return respond


# ROS 2 without a ROS installation: the transport over cyclonedds from PyPI.
#
# To its peers it is an ordinary ROS 2 node. It uses ROS 2's names, policies and user data, so topics work both ways
# with rmw_cyclonedds, rmw_fastrtps and anything else that speaks DDS; the bytes are made and read above, by the
# registry.


class _Publisher(Immutable):
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
            leave(self._participant)
            raise TransportError(f"DDS cannot start on domain {domain}: {error}") from error
        self._reminder = Reminder(loop)
        self._reminder.keep_telling(*self._discovery.own_endpoints)
        self._services = CycloneServices(
            self._participant, registry, self._raw, self._receiver, loop, self._reminder, self._discovery.told_on
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
        self._reminder.keep_telling(writer)
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
        self._reminder.keep_telling(reader)
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

    async def describe(self, endpoint: NetworkEndpoint, within: float) -> TypeDescription | None:
        """Fetch the type of an endpoint; see `TellsTypes.describe`."""
        self._check_open()
        type_id = self._discovery.type_id(endpoint)
        if type_id is None:
            return None
        return await asyncio.to_thread(fetch_description, self._participant, type_id, within)

    def graph(self) -> list[NetworkEndpoint]:
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
        self._reminder.close()
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
        ):
            release(entity)
        leave(self._participant)
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

    def _changed(self, watched: Watched, change: StatusChange) -> None:
        """Hand a change over to the event loop; called on a thread of the middleware."""
        with suppress(RuntimeError):  # The loop has been closed: nobody listens any more.
            self._loop.call_soon_threadsafe(self._tell, watched, change)

    def _tell(self, watched: Watched, change: StatusChange) -> None:
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
