"""The transport over rclpy, for computers with a ROS 2 installation.

rclpy speaks every vendor's DDS, and its security. It sends and receives raw bytes, so the codec stays ours, but it
still wants the generated code of each message type: the station's own messages must have been built by colcon and be
on the path. rclpy is given a context and a thread of its own here, and leaves the process's signals alone. Written for
rclpy 7 (Jazzy).
"""

from __future__ import annotations

import asyncio
import os
import threading
import time
from collections import Counter
from collections.abc import Collection
from contextlib import suppress
from typing import Literal

import rclpy
import structlog
from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.signals import SignalHandlerOptions
from rclpy.subscription import Subscription

from sequence_planner.ros import enclaves, environment, names
from sequence_planner.ros.both_sides import both_sides
from sequence_planner.ros.delivery import Delivery
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.quality import Direction
from sequence_planner.ros.rclpy_draining import messages_waiting
from sequence_planner.ros.rclpy_graph import endpoints, service_ends
from sequence_planner.ros.rclpy_qos import Tell, profile, publisher_events, subscription_events
from sequence_planner.ros.rclpy_services import RclpyServices
from sequence_planner.ros.rclpy_types import check_definition, guarded, message_class
from sequence_planner.ros.service_graph import ServiceEnd
from sequence_planner.ros.strangers import Strangers
from sequence_planner.ros.transport import (
    Endpoint,
    Handler,
    OnBatch,
    OnQualityEvent,
    QualityEvent,
    QualityOfService,
    Sample,
    Sending,
    TransportError,
    unhindered,
)

_log = structlog.get_logger(__name__)


class RclpyTransport:
    """One rclpy node with its own context and executor thread."""

    name = "rclpy"

    def __init__(
        self,
        registry: MessageRegistry,
        node_name: str,
        loop: asyncio.AbstractEventLoop,
        domain_id: int | None = None,
    ) -> None:
        """Join the domain; raises TransportError when that cannot be done and ValueError for a bad node name."""
        self._registry = registry
        self._node_name = names.check_node_name(node_name)
        self._loop = loop
        self._publishers: dict[str, tuple[Publisher, str, QualityOfService]] = {}
        self._subscriptions: list[tuple[str, Delivery]] = []
        self._watchers: list[OnQualityEvent] = []
        self._closing = False
        domain = environment.domain_id(domain_id)
        environment.refuse_interface()
        # The middleware reads the range itself; left unset it would be the whole subnet.
        os.environ[environment.DISCOVERY_RANGE] = environment.discovery_range()
        self._context = Context()
        try:
            # Our command line is not ROS's, so its arguments are kept from it.
            told = enclaves.arguments(node_name)
            rclpy.init(
                args=told, context=self._context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO
            )
            self._node = Node(
                node_name,
                context=self._context,
                use_global_arguments=False,
                enable_rosout=False,
                start_parameter_services=False,
            )
            self._executor = SingleThreadedExecutor(context=self._context)
        except RuntimeError as error:  # RCLError is one
            self._context.try_shutdown()
            raise TransportError(f"ROS 2 cannot start on domain {domain}: {error}") from error
        self._services = RclpyServices(self._node, registry, loop)
        self._strangers = Strangers(loop, self._service_ends)
        self._executor.add_node(self._node)
        self._thread = threading.Thread(target=self._spin, name=f"rclpy-{node_name}", daemon=True)
        self._thread.start()

    def advertise(self, topic: str, type_name: str, qos: QualityOfService) -> None:
        """Announce a publisher; see `Transport.advertise`."""
        known = self._publishers.get(topic)
        if known is not None:
            if known[1:] != (type_name, qos):
                raise TransportError(f"{topic} is already advertised as {known[1]}, {known[2]}")
            return
        message = self._message_class(topic, type_name)
        events = publisher_events(qos, self._teller(topic, "publisher", qos))
        publisher = guarded(
            f"advertise {topic}",
            lambda: self._node.create_publisher(message, topic, profile(qos), event_callbacks=events),
        )
        self._publishers[topic] = (publisher, type_name, qos)

    def publish(self, topic: str, type_name: str, data: bytes) -> None:
        """Send bytes; see `Transport.publish`."""
        known = self._publishers.get(topic)
        if known is None or known[1] != type_name:
            raise TransportError(f"{topic} has not been advertised as {type_name}")
        guarded(f"publish on {topic}", lambda: known[0].publish(data))

    def subscribe(self, topic: str, type_name: str, qos: QualityOfService, on_batch: OnBatch) -> None:
        """Receive batches; see `Transport.subscribe`."""
        message = self._message_class(topic, type_name)
        delivery = Delivery(self._loop, topic, on_batch)

        made: list[Subscription] = []  # empty as long as rclpy makes it

        def received(data: bytes) -> None:
            batch = [data, *(each for subscription in made for each in messages_waiting(subscription, message))]
            now = time.monotonic()
            delivery.push(Sample(topic, each, now) for each in batch)

        events = subscription_events(qos, self._teller(topic, "subscriber", qos))
        made += guarded(
            f"subscribe to {topic}",
            lambda: [
                self._node.create_subscription(
                    message, topic, received, profile(qos.of_a_reader), event_callbacks=events, raw=True
                )
            ],
        )
        self._subscriptions.append((topic, delivery))

    def watch(self, on_event: OnQualityEvent) -> None:
        """Hear of qualities of service; see `Transport.watch`."""
        self._watchers.append(on_event)

    async def call(
        self, service: str, type_name: str, request: bytes, within: float, sending: Sending = unhindered
    ) -> bytes:
        """Call a service; see `Transport.call`."""
        self._check_open()
        self._strangers.add(service)
        return await self._services.call(service, type_name, request, within, sending)

    def serve(self, service: str, type_name: str, handler: Handler) -> None:
        """Answer requests; see `Transport.serve`."""
        self._check_open()
        self._services.serve(service, type_name, handler)
        self._strangers.add(service)

    def graph(self) -> list[Endpoint]:
        """Return all endpoints; see `Transport.graph`."""
        self._check_open()
        subscribed = Counter(topic for topic, _ in self._subscriptions)
        return endpoints(self._node, f"/{self._node_name}", set(self._publishers), subscribed)

    def services(self) -> list[ServiceEnd]:
        """Return the services known; see `TellsServices`."""
        self._check_open()
        return self._service_ends()

    def close(self) -> None:
        """Leave the domain; see `Transport.close`."""
        if self._closing:
            return
        for _, delivery in self._subscriptions:
            delivery.close()
        self._watchers.clear()
        self._strangers.close()
        self._services.close()
        self._closing = True
        self._executor.create_task(lambda: None)  # Work of any kind lets `spin_once` return.
        self._thread.join()
        self._executor.remove_node(self._node)
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()
        self._publishers.clear()
        self._subscriptions.clear()

    def _service_ends(self, among: Collection[str] | None = None) -> list[ServiceEnd]:
        services = self._services
        return service_ends(self._node, f"/{self._node_name}", services.served, services.called, among)

    def _check_open(self) -> None:
        if self._closing:
            raise TransportError("the transport is closed")

    def _message_class(self, topic: str, type_name: str) -> type:
        """Return the class that rosidl generated for a type; raises TransportError where there is none."""
        self._check_open()
        names.check_topic(topic)
        ours = self._registry.type_hash(type_name)
        generated = message_class(topic, type_name)
        check_definition(topic, type_name, ours)
        return generated

    def _teller(self, topic: str, direction: Direction, qos: QualityOfService) -> Tell:
        """Return what tells the event loop of an event, on whichever thread it is called."""

        def tell(kind: Literal["incompatible", "deadline", "liveliness"], count: int, detail: str) -> None:
            def told() -> None:
                if self._closing or not self._watchers:
                    return
                text = both_sides(self.graph(), topic, direction, qos) if kind == "incompatible" else ""
                for watcher in self._watchers:
                    watcher(QualityEvent(topic, direction, kind, count, f"{topic}: {text or detail}"))

            with suppress(RuntimeError):  # The loop has been closed: nobody listens any more.
                self._loop.call_soon_threadsafe(told)

        return tell

    def _spin(self) -> None:
        while not self._closing:
            try:
                self._executor.spin_once()
            except ExternalShutdownException:
                return
            except Exception:
                _log.exception("ROS 2 failed while receiving")
                time.sleep(1.0)  # If it lasts, the log fills slowly and the processor stays free.
