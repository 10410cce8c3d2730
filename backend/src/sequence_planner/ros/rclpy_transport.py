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
from collections.abc import Callable
from typing import TypeVar

import rclpy
import structlog
from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.signals import SignalHandlerOptions
from rosidl_runtime_py.utilities import get_message

from sequence_planner.ros import environment, names
from sequence_planner.ros.delivery import Delivery
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.rclpy_graph import endpoints
from sequence_planner.ros.transport import Endpoint, OnBatch, QualityOfService, Sample, TransportError

_log = structlog.get_logger(__name__)

T = TypeVar("T")


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
        self._closing = False
        domain = environment.domain_id(domain_id)
        # The middleware reads the range itself; left unset it would be the whole subnet.
        os.environ[environment.DISCOVERY_RANGE] = environment.discovery_range()
        self._context = Context()
        try:
            # Our command line is not ROS's, so its arguments are kept from it.
            rclpy.init(args=[], context=self._context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO)
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
        publisher = _guarded(f"advertise {topic}", lambda: self._node.create_publisher(message, topic, _profile(qos)))
        self._publishers[topic] = (publisher, type_name, qos)

    def publish(self, topic: str, type_name: str, data: bytes) -> None:
        """Send bytes; see `Transport.publish`."""
        known = self._publishers.get(topic)
        if known is None or known[1] != type_name:
            raise TransportError(f"{topic} has not been advertised as {type_name}")
        _guarded(f"publish on {topic}", lambda: known[0].publish(data))

    def subscribe(self, topic: str, type_name: str, qos: QualityOfService, on_batch: OnBatch) -> None:
        """Receive batches; see `Transport.subscribe`."""
        message = self._message_class(topic, type_name)
        delivery = Delivery(self._loop, topic, on_batch)

        def received(data: bytes) -> None:
            delivery.push([Sample(topic, data, time.monotonic())])

        _guarded(
            f"subscribe to {topic}",
            lambda: self._node.create_subscription(message, topic, received, _profile(qos), raw=True),
        )
        self._subscriptions.append((topic, delivery))

    def graph(self) -> list[Endpoint]:
        """Return all endpoints; see `Transport.graph`."""
        self._check_open()
        subscribed = Counter(topic for topic, _ in self._subscriptions)
        return endpoints(self._node, f"/{self._node_name}", set(self._publishers), subscribed)

    def close(self) -> None:
        """Leave the domain; see `Transport.close`."""
        if self._closing:
            return
        for _, delivery in self._subscriptions:
            delivery.close()
        self._closing = True
        self._executor.create_task(lambda: None)  # Work of any kind lets `spin_once` return.
        self._thread.join()
        self._executor.remove_node(self._node)
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()
        self._publishers.clear()
        self._subscriptions.clear()

    def _check_open(self) -> None:
        if self._closing:
            raise TransportError("the transport is closed")

    def _message_class(self, topic: str, type_name: str) -> type:
        """Return the class that rosidl generated for a type; raises TransportError where there is none."""
        self._check_open()
        names.check_topic(topic)
        self._registry.type_hash(type_name)
        try:
            return get_message(type_name)
        except (ImportError, AttributeError, ValueError) as error:
            package = type_name.split("/", maxsplit=1)[0]
            raise TransportError(
                f"{topic}: ROS 2 has no generated code for {type_name} ({error}). Build the package {package}: "
                "write it with `sequence-planner messages --ament`, build it with colcon, source its install/setup.bash"
            ) from error

    def _spin(self) -> None:
        while not self._closing:
            try:
                self._executor.spin_once()
            except ExternalShutdownException:
                return
            except Exception:
                _log.exception("ROS 2 failed while receiving")
                time.sleep(1.0)  # If it lasts, the log fills slowly and the processor stays free.


def _profile(qos: QualityOfService) -> QoSProfile:
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=qos.depth,
        reliability=ReliabilityPolicy.RELIABLE if qos.reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if qos.transient_local else DurabilityPolicy.VOLATILE,
    )


def _guarded(what: str, action: Callable[[], T]) -> T:
    """Return what `action` returns; rclpy's many unrelated exceptions become TransportError."""
    try:
        return action()
    except Exception as error:
        raise TransportError(f"ROS 2 cannot {what}: {error}") from error
