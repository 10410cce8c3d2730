"""Transport to ROS 1 nodes over rosbridge (protocol 2): reconnecting client and JSON conversion."""

from __future__ import annotations

import asyncio
import base64
import binascii
import json
import logging
import math
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from urllib.parse import urlsplit

import structlog
from roslibpy import Message
from roslibpy.comm.comm_asyncio import (
    AsyncioEventLoopManager,
    AsyncioRosBridgeClientFactory,
    AsyncioRosBridgeProtocol,
)

from sequence_planner.core.immutable import Immutable
from sequence_planner.ros.delivery import Delivery
from sequence_planner.ros.names import check_node_name, check_topic
from sequence_planner.ros.qos import Direction, QualityOfService
from sequence_planner.ros.transport import (
    Handler,
    NetworkEndpoint,
    OnBatch,
    OnQualityEvent,
    Sample,
    Sending,
    TransportError,
    unhindered,
)
from sequence_planner.ros.types.definitions import FieldType
from sequence_planner.ros.types.errors import MessageValueError
from sequence_planner.ros.types.messages import MessageRegistry

# A connection to a rosbridge server, which comes back by itself.
#
# roslibpy keeps it, on an event loop and a thread of its own that all connections of the process share. What it would
# do with messages it does not know (a traceback each), and with those sent while there is no connection (send them
# whenever there is one again), is not for commands to machines: messages are taken here as they come, and sent now or
# not at all.

FIRST_PAUSE = 0.3  # seconds before the first attempt to come back
LONGEST_PAUSE = 3.0  # seconds between two attempts
PING_EVERY = 2.0  # seconds
SILENCE = 3.0  # seconds without an answer to a ping after which the connection is lost
LONGEST_MESSAGE = 64 * 2**20  # bytes
LEAVE_TAKING = 1.0  # seconds to say goodbye to the server

# Its troubles are seen here, and said once.
logging.getLogger("roslibpy").setLevel(logging.CRITICAL)

_open: set[RosbridgeClient] = set()
_lock = threading.Lock()


class Events(Immutable):
    """The functions called on roslibpy's thread: when there is a connection, with each frame, and when there is
    none.
    """

    opened: Callable[[], None]
    frame: Callable[[bytes], None]
    closed: Callable[[], None]


class _Protocol(AsyncioRosBridgeProtocol):
    factory: _Factory

    def connection_made(self, transport: asyncio.Transport) -> None:
        super().connection_made(transport)
        self.factory.transport = transport

    def on_message(self, payload: bytes) -> None:
        self.factory.events.frame(payload)


class _Factory(AsyncioRosBridgeClientFactory):
    protocol = _Protocol

    def __init__(self, url: str, events: Events) -> None:
        super().__init__(url)
        self.events = events
        self.transport: asyncio.Transport | None = None  # the last one, which may still be shaking hands, or be closed
        self.setProtocolOptions(
            autoPingInterval=PING_EVERY,
            autoPingTimeout=SILENCE,
            openHandshakeTimeout=SILENCE,
            maxMessagePayloadSize=LONGEST_MESSAGE,
        )


_Factory.set_initial_delay(FIRST_PAUSE)
_Factory.set_max_delay(LONGEST_PAUSE)


class RosbridgeClient:
    """One connection. Its methods may be called on any thread but roslibpy's, and do not wait; only `close` does."""

    def __init__(self, url: str, events: Events) -> None:
        """Begin to connect to `url`, such as `ws://127.0.0.1:9090`; raises ValueError when it is no such address."""
        _check(url)
        self._protocol: AsyncioRosBridgeProtocol | None = None
        self._closing = False
        self._gone = threading.Event()
        self._gone.set()
        with _lock:
            self._factory = _Factory(url, events)
            _open.add(self)
        self._factory.on("ready", self._ready)
        self._factory.on("close", self._lost)
        self._factory.connect()

    @property
    def connected(self) -> bool:
        """True if there is a connection."""
        return self._protocol is not None

    def send(self, message: Mapping[str, object]) -> bool:
        """Send a message of the protocol; returns False, with nothing sent then or later, without a connection."""
        protocol = self._protocol
        if protocol is None:
            return False
        protocol.send_ros_message(Message(message))
        return True

    def close(self) -> None:
        """Take leave of the server; the last client to close ends roslibpy's thread. May be repeated."""
        self._closing = True
        self._factory.maxRetries = 0
        protocol = self._protocol
        if protocol is not None:
            protocol.send_close()
            self._gone.wait(LEAVE_TAKING)
        transport = self._factory.transport
        if transport is not None and not transport.is_closing():
            self._factory.manager.loop.call_soon_threadsafe(transport.abort)
        with _lock:
            if self in _open:
                _open.discard(self)
                if not _open:
                    _end(self._factory.manager)

    def _ready(self, protocol: AsyncioRosBridgeProtocol) -> None:
        if self._closing:
            protocol.send_close()
            return
        self._gone.clear()
        self._protocol = protocol
        self._factory.events.opened()

    def _lost(self, protocol: AsyncioRosBridgeProtocol) -> None:
        self._protocol = None
        if not self._closing:
            self._factory.events.closed()
        self._gone.set()


def _check(url: str) -> None:
    parts = urlsplit(url)
    if parts.scheme not in ("ws", "wss"):
        raise ValueError("it begins with ws:// or wss://")
    if not parts.hostname or parts.port == 0:
        raise ValueError("it has a host, and a port other than 0")


def _end(manager: AsyncioEventLoopManager) -> None:
    """Give up what is under way on roslibpy's loop, and end its thread."""

    async def give_up() -> None:
        tasks = asyncio.all_tasks() - {asyncio.current_task()}
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        await asyncio.sleep(0)  # in which connections that were broken off are closed

    asyncio.run_coroutine_threadsafe(give_up(), manager.loop).result(LEAVE_TAKING)
    manager.terminate()


# Between the values of a message and the JSON in which rosbridge writes it.
#
# rosbridge writes a message as an object of its fields, as `rosbridge_library` does it: bytes (`uint8[]`) as base64,
# NaN and the infinities as null, times as `secs` and `nsecs`, and a header with the `seq` that ROS 1 gives it. Values
# are those of `MessageRegistry.decode`; whether each fits its field is for `encode` to check.

_TIMES = {"builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration"}
_HEADER = "std_msgs/msg/Header"
_TO_ROS_1 = {"sec": "secs", "nanosec": "nsecs"}
_FROM_ROS_1 = {ours: theirs for theirs, ours in _TO_ROS_1.items()}


def ros_1_type(type_name: str) -> str:
    """Return the ROS 1 name of a message type: `std_msgs/String` for `std_msgs/msg/String`."""
    package, _, name = type_name.split("/")
    return f"{package}/{name}"


def to_json(registry: MessageRegistry, type_name: str, values: Mapping[str, object]) -> dict[str, object]:
    """Return a message as rosbridge takes it."""
    if type_name in _TIMES:
        return {_TO_ROS_1[name]: value for name, value in values.items()}
    return {name: _to_json(registry, field, values[name]) for name, field in registry.fields(type_name).items()}


def from_json(registry: MessageRegistry, type_name: str, message: object) -> dict[str, object]:
    """Return the values of a message as rosbridge gave it.

    Every field must be there and no other: a message of another definition is none. Raises MessageValueError.
    """
    return _message(registry, type_name, message, type_name, "")


def _to_json(registry: MessageRegistry, field: FieldType, value: object) -> object:
    if field.array is not None and field.range == (0, 255) and isinstance(value, list):
        return base64.b64encode(bytes(value)).decode("ascii")
    if isinstance(value, list):
        return [_to_json(registry, field.element, item) for item in value]
    if isinstance(value, Mapping):
        return to_json(registry, field.type_name, value)
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _message(registry: MessageRegistry, type_name: str, message: object, root: str, path: str) -> dict[str, object]:
    if not isinstance(message, Mapping):
        raise MessageValueError(root, path, f"the fields of a {type_name}", message)
    given = dict(message)
    if type_name in _TIMES:
        given = {_FROM_ROS_1.get(name, name): value for name, value in given.items()}
    elif type_name == _HEADER:
        given.pop("seq", None)
    fields = registry.fields(type_name)
    for name in given:
        if name not in fields:
            raise MessageValueError(root, path, f"a field of {type_name}", name)
    for name in fields:
        if name not in given:
            raise MessageValueError(root, _inner(path, name), f"a value of {fields[name]}", None)
    return {name: _value(registry, field, given[name], root, _inner(path, name)) for name, field in fields.items()}


def _value(registry: MessageRegistry, field: FieldType, value: object, root: str, path: str) -> object:
    if field.array is not None:
        if field.range == (0, 255) and isinstance(value, str):
            try:
                return list(base64.b64decode(value, validate=True))
            except (binascii.Error, ValueError):
                raise MessageValueError(root, path, "bytes in base64", value) from None
        if not isinstance(value, list):
            raise MessageValueError(root, path, f"a list for {field}", value)
        return [_value(registry, field.element, item, root, f"{path}[{index}]") for index, item in enumerate(value)]
    if field.kind == "message":
        return _message(registry, field.type_name, value, root, path)
    return math.nan if value is None and field.kind == "float" else value


def _inner(path: str, name: str) -> str:
    return f"{path}.{name}" if path else name


# Nodes of ROS 1, reached through a rosbridge server: the transport over its protocol, version 2.
#
# Above it carries CDR bytes as every transport does, below it JSON. rosbridge tells nobody who is there, so the graph
# holds the publishers that have been heard since the connection came about, and none without a connection: what is lost
# with it is unknown at once. Only topics pass; services, and qualities of service other than latching, do not.

_log = structlog.get_logger(__name__)

_MOST_TROUBLES = 100  # of one connection, after which no new ones are said
_PATIENCE = 5.0  # seconds without a first connection after which the log says so


@dataclass
class _Publisher:
    type_name: str
    qos: QualityOfService
    last: dict[str, object] | None = None  # what a latched topic has said, for a server that comes back


@dataclass
class _Subscriptions:
    """All subscriptions of one topic."""

    type_name: str
    qos: list[QualityOfService] = field(default_factory=list)
    deliveries: list[Delivery] = field(default_factory=list)
    heard: bool = False  # since there has been a connection


class RosbridgeTransport:
    """One client of a rosbridge server, which comes back when the server does."""

    name = "rosbridge"

    def __init__(self, url: str, registry: MessageRegistry, node_name: str, loop: asyncio.AbstractEventLoop) -> None:
        """Begin to connect to the server at `url`, such as `ws://127.0.0.1:9090`, and wait for nothing.

        Raises TransportError for an address that is none, and ValueError for a bad node name.
        """
        self._node = f"/{check_node_name(node_name)}"
        self._url = url
        self._registry = registry
        self._loop = loop
        self._publishers: dict[str, _Publisher] = {}
        self._subscribed: dict[str, _Subscriptions] = {}
        self._troubles: set[tuple[str, str]] = set()
        self._saying = threading.Lock()  # so that a server that comes back hears nothing old after something new
        self._closed = False
        try:
            self._client = RosbridgeClient(url, Events(self._opened, self._take, self._lost))
        except ValueError as error:
            raise TransportError(
                f"{url!r} is not the address of a rosbridge server ({error}): write it as ws://127.0.0.1:9090"
            ) from error
        self._reminder = loop.call_later(_PATIENCE, self._remind)

    def advertise(self, topic: str, type_name: str, qos: QualityOfService) -> None:
        """Announce a publisher; see `Transport.advertise`."""
        self._check(topic, type_name)
        known = self._publishers.get(topic)
        if known is None:
            self._publishers[topic] = _Publisher(type_name, qos)
            self._client.send(self._advertisement(topic))
        elif (known.type_name, known.qos) != (type_name, qos):
            raise TransportError(f"{topic} is already advertised as {known.type_name}, {known.qos}")

    def publish(self, topic: str, type_name: str, data: bytes) -> None:
        """Send bytes; see `Transport.publish`. Without a connection only a latched topic's last sample is kept."""
        publisher = self._publishers.get(topic)
        if publisher is None or publisher.type_name != type_name:
            raise TransportError(f"{topic} has not been advertised as {type_name}")
        message = to_json(self._registry, type_name, self._registry.decode(type_name, data))
        with self._saying:
            if publisher.qos.transient_local:
                publisher.last = message
            self._client.send({"op": "publish", "topic": topic, "msg": message})

    def subscribe(self, topic: str, type_name: str, qos: QualityOfService, on_batch: OnBatch) -> None:
        """Receive batches; see `Transport.subscribe`. One topic is subscribed to with one type."""
        self._check(topic, type_name)
        subscriptions = self._subscribed.get(topic) or _Subscriptions(type_name)
        if subscriptions.type_name != type_name:
            raise TransportError(f"{topic} is already subscribed to as {subscriptions.type_name}")
        subscriptions.qos.append(qos)
        subscriptions.deliveries.append(Delivery(self._loop, topic, on_batch))
        self._subscribed[topic] = subscriptions
        # Also when it is subscribed to already: the server then gives this connection the latched sample again.
        self._client.send(self._subscription(topic))

    def watch(self, on_event: OnQualityEvent) -> None:
        """Hear of nothing: rosbridge knows no qualities of service."""

    async def call(
        self, service: str, type_name: str, request: bytes, within: float, sending: Sending = unhindered
    ) -> bytes:
        """Refuse: only topics pass."""
        raise TransportError(f"{service}: services of ROS 1 are not reached; call it on ROS 2")

    def serve(self, service: str, type_name: str, handler: Handler) -> None:
        """Refuse: only topics pass."""
        raise TransportError(f"{service}: ROS 1 nodes are served no services; serve it on ROS 2")

    def graph(self) -> list[NetworkEndpoint]:
        """Return our endpoints and the publishers heard; see `Transport.graph`."""
        self._check_open()
        found = [self._own(topic, p.type_name, "publisher", p.qos) for topic, p in self._publishers.items()]
        for topic, subscriptions in self._subscribed.items():
            found += [self._own(topic, subscriptions.type_name, "subscriber", qos) for qos in subscriptions.qos]
            if subscriptions.heard:
                found += [_heard(topic, subscriptions.type_name, qos) for qos in subscriptions.qos[:1]]
        return found

    def close(self) -> None:
        """Leave the server; see `Transport.close`."""
        if self._closed:
            return
        self._closed = True
        self._reminder.cancel()
        for subscriptions in self._subscribed.values():
            for delivery in subscriptions.deliveries:
                delivery.close()
        self._client.close()
        self._publishers.clear()
        self._subscribed.clear()

    def _check(self, topic: str, type_name: str) -> None:
        self._check_open()
        check_topic(topic)
        self._registry.type_hash(type_name)

    def _check_open(self) -> None:
        if self._closed:
            raise TransportError("the transport is closed")

    def _own(self, topic: str, type_name: str, direction: Direction, qos: QualityOfService) -> NetworkEndpoint:
        type_hash = self._registry.type_hash(type_name)
        return NetworkEndpoint(
            topic, type_name, direction, True, type_hash, self._node, qos.reliable, qos.transient_local
        )

    def _advertisement(self, topic: str) -> dict[str, object]:
        publisher = self._publishers[topic]
        return {
            "op": "advertise",
            "topic": topic,
            "type": ros_1_type(publisher.type_name),
            "latch": publisher.qos.transient_local,
            "queue_size": publisher.qos.depth,
        }

    def _subscription(self, topic: str) -> dict[str, object]:
        # No throttle and no queue of the server's own: every message, at once.
        type_name = ros_1_type(self._subscribed[topic].type_name)
        return {"op": "subscribe", "topic": topic, "type": type_name, "throttle_rate": 0, "queue_length": 0}

    def _remind(self) -> None:
        if not self._client.connected:
            _log.warning("no rosbridge server answers; it is sought on", url=self._url)

    # What follows happens on roslibpy's thread.

    def _opened(self) -> None:
        self._troubles.clear()
        for topic, publisher in list(self._publishers.items()):
            self._client.send(self._advertisement(topic))
            with self._saying:
                if publisher.last is not None:
                    self._client.send({"op": "publish", "topic": topic, "msg": publisher.last})
        for topic in list(self._subscribed):
            self._client.send(self._subscription(topic))
        _log.info("connected to rosbridge", url=self._url)

    def _lost(self) -> None:
        for subscriptions in list(self._subscribed.values()):
            subscriptions.heard = False
        _log.warning("the connection to rosbridge is lost; it is sought again", url=self._url)

    def _take(self, frame: bytes) -> None:
        try:
            message = json.loads(frame)
        except (ValueError, RecursionError) as error:
            self._report("", "not JSON", str(error))
            return
        match message:
            case {"op": "publish", "topic": str(topic), "msg": content} if topic in self._subscribed:
                self._deliver(topic, content)
            case {"op": "publish"}:  # of a topic that was given up, or never asked for
                pass
            case {"op": "status", "level": str(level), "msg": text}:
                if level in ("error", "warning"):
                    self._report("", f"the server says: {str(text)[:200]}", "")
            case Mapping():
                self._report("", f"the operation {str(message.get('op'))[:40]!r} is not understood", "")
            case _:
                self._report("", "not an operation", "")

    def _deliver(self, topic: str, content: object) -> None:
        """Pass a message on; of one that is not of the topic's type, that there was one."""
        subscriptions = self._subscribed[topic]
        received, trouble = time.monotonic(), ""
        try:
            values = from_json(self._registry, subscriptions.type_name, content)
            data = self._registry.encode(subscriptions.type_name, values)
        except (MessageValueError, RecursionError) as error:
            place = error.path if isinstance(error, MessageValueError) else "nesting"
            self._report(topic, f"not a {subscriptions.type_name}: {place}", str(error))
            data, trouble = b"", str(error)
        subscriptions.heard = True
        for delivery in list(subscriptions.deliveries):
            delivery.push([Sample(topic, data, received, trouble=trouble)])

    def _report(self, topic: str, trouble: str, detail: str) -> None:
        """Say a trouble, once for each connection."""
        if (topic, trouble) not in self._troubles and len(self._troubles) < _MOST_TROUBLES:
            self._troubles.add((topic, trouble))
            _log.warning(
                "message of rosbridge not understood", url=self._url, topic=topic, trouble=trouble, detail=detail
            )


def _heard(topic: str, type_name: str, qos: QualityOfService) -> NetworkEndpoint:
    """Return who was heard on a topic; rosbridge agrees on no quality, so that of our subscription is taken."""
    return NetworkEndpoint(
        topic,
        type_name,
        "publisher",
        False,
        None,
        None,
        qos.reliable,
        qos.transient_local,
        qos.deadline,
        qos.liveliness,
    )
