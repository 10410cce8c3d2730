"""Nodes of ROS 1, reached through a rosbridge server: the transport over its protocol, version 2.

Above it carries CDR bytes as every transport does, below it JSON. rosbridge tells nobody who is there, so the graph
holds the publishers that have been heard since the connection came about, and none without a connection: what is lost
with it is unknown at once. Only topics pass; services, and qualities of service other than latching, do not.
"""

from __future__ import annotations

import asyncio
import json
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass, field

import structlog

from sequence_planner.ros.delivery import Delivery
from sequence_planner.ros.messages import MessageRegistry, MessageValueError
from sequence_planner.ros.names import check_node_name, check_topic
from sequence_planner.ros.rosbridge_client import Events, RosbridgeClient
from sequence_planner.ros.rosbridge_values import from_json, ros_1_type, to_json
from sequence_planner.ros.transport import (
    Direction,
    Endpoint,
    Handler,
    OnBatch,
    OnQualityEvent,
    QualityOfService,
    Sample,
    Sending,
    TransportError,
    unhindered,
)

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

    def graph(self) -> list[Endpoint]:
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

    def _own(self, topic: str, type_name: str, direction: Direction, qos: QualityOfService) -> Endpoint:
        type_hash = self._registry.type_hash(type_name)
        return Endpoint(topic, type_name, direction, True, type_hash, self._node, qos.reliable, qos.transient_local)

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


def _heard(topic: str, type_name: str, qos: QualityOfService) -> Endpoint:
    """Return who was heard on a topic; rosbridge agrees on no quality, so that of our subscription is taken."""
    return Endpoint(
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
