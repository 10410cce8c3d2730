"""Composite transports: routing of `ros: 1` topics to rosbridge, and gated publishing for a standby."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Collection
from contextlib import ExitStack
from dataclasses import dataclass
from typing import TYPE_CHECKING

from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import (
    Handler,
    NetworkEndpoint,
    OnBatch,
    OnQualityEvent,
    Sending,
    ServiceEnd,
    TellsServices,
    Transport,
    TransportError,
    unhindered,
)

if TYPE_CHECKING:
    from sequence_planner.ros.types.messages import MessageRegistry

# A transport that speaks only while it may, and listens always.


@dataclass(frozen=True)
class Gated:
    """Speaks only as long as `may_speak`, which is asked at the last moment; else it raises `TransportError`."""

    transport: Transport
    may_speak: Callable[[], bool]

    @property
    def name(self) -> str:
        """That of the transport."""
        return self.transport.name

    def advertise(self, topic: str, type_name: str, qos: QualityOfService) -> None:
        """See `Transport`: this says nothing to a device yet."""
        self.transport.advertise(topic, type_name, qos)

    def publish(self, topic: str, type_name: str, data: bytes) -> None:
        """See `Transport`."""
        self._require()
        self.transport.publish(topic, type_name, data)

    def subscribe(self, topic: str, type_name: str, qos: QualityOfService, on_batch: OnBatch) -> None:
        """See `Transport`."""
        self.transport.subscribe(topic, type_name, qos, on_batch)

    def watch(self, on_event: OnQualityEvent) -> None:
        """See `Transport`."""
        self.transport.watch(on_event)

    async def call(
        self, service: str, type_name: str, request: bytes, within: float, sending: Sending = unhindered
    ) -> bytes:
        """See `Transport`."""
        self._require()

        def may_send() -> None:
            # Its server was waited for, and the lease may have ended meanwhile.
            self._require()
            sending()

        return await self.transport.call(service, type_name, request, within, may_send)

    def serve(self, service: str, type_name: str, handler: Handler) -> None:
        """See `Transport`."""
        self.transport.serve(service, type_name, handler)

    def graph(self) -> list[NetworkEndpoint]:
        """See `Transport`."""
        return self.transport.graph()

    def close(self) -> None:
        """See `Transport`."""
        self.transport.close()

    def _require(self) -> None:
        if not self.may_speak():
            raise TransportError("this station does not hold the lease of the command at this moment")


@dataclass(frozen=True)
class _GatedWithServices(Gated):
    tells: TellsServices

    def services(self) -> list[ServiceEnd]:
        return self.tells.services()


def gated(transport: Transport, may_speak: Callable[[], bool]) -> Transport:
    """The same transport, which speaks only as long as `may_speak`."""
    if isinstance(transport, TellsServices):
        return _GatedWithServices(transport, may_speak, transport)
    return Gated(transport, may_speak)


# One transport over two: the topics that a model marks `ros: 1` go through a rosbridge server, all others do not.

#: The environment variable that holds the address of the rosbridge server, such as `ws://127.0.0.1:9090`.
ROSBRIDGE = "SEQUENCE_PLANNER_ROSBRIDGE"


def open_routed(
    ros_2: Callable[[], Transport],
    ros_1_topics: Collection[str],
    url: str | None,
    registry: MessageRegistry,
    node_name: str,
    loop: asyncio.AbstractEventLoop,
) -> Transport:
    """Return the transport that `ros_2` opens, and where the station has topics of ROS 1, one that routes these.

    `url` is the rosbridge server's address; None takes that of the environment. Raises TransportError, saying what to
    do, when there is none or roslibpy is not installed, and whatever opening raises; nothing stays open then.
    """
    if not ros_1_topics:
        return ros_2()
    address = url or os.environ.get(ROSBRIDGE)
    if not address:
        raise TransportError(
            f"the station has topics of ROS 1 ({', '.join(sorted(ros_1_topics))}), which are reached through a "
            f"rosbridge server: give its address by --rosbridge or {ROSBRIDGE}, as in ws://127.0.0.1:9090"
        )
    try:
        # A station without ROS 1 needs no roslibpy.
        from sequence_planner.ros.transports.rosbridge import RosbridgeTransport  # noqa: PLC0415
    except ImportError as error:
        raise TransportError(
            f"topics of ROS 1 need roslibpy ({error}): install the extra, as in pip install 'sequence-planner[ros1]'"
        ) from error
    with ExitStack() as opened:
        bridge = RosbridgeTransport(address, registry, node_name, loop)
        opened.callback(bridge.close)
        routed = RoutedTransport(ros_2(), bridge, ros_1_topics)
        opened.pop_all()
    return routed


class RoutedTransport:
    """Two transports as one; every topic belongs to exactly one of them, services to that of ROS 2."""

    def __init__(self, ros_2: Transport, ros_1: Transport, ros_1_topics: Collection[str]) -> None:
        self._ros_2 = ros_2
        self._ros_1 = ros_1
        self._ros_1_topics = frozenset(ros_1_topics)

    @property
    def name(self) -> str:
        """Both names."""
        return f"{self._ros_2.name} + {self._ros_1.name}"

    def advertise(self, topic: str, type_name: str, qos: QualityOfService) -> None:
        """Announce a publisher; see `Transport.advertise`."""
        self._of(topic).advertise(topic, type_name, qos)

    def publish(self, topic: str, type_name: str, data: bytes) -> None:
        """Send bytes; see `Transport.publish`."""
        self._of(topic).publish(topic, type_name, data)

    def subscribe(self, topic: str, type_name: str, qos: QualityOfService, on_batch: OnBatch) -> None:
        """Receive batches; see `Transport.subscribe`."""
        self._of(topic).subscribe(topic, type_name, qos, on_batch)

    def watch(self, on_event: OnQualityEvent) -> None:
        """Hear of qualities of service; see `Transport.watch`."""
        self._ros_2.watch(on_event)
        self._ros_1.watch(on_event)

    async def call(
        self, service: str, type_name: str, request: bytes, within: float, sending: Sending = unhindered
    ) -> bytes:
        """Call a service of ROS 2; see `Transport.call`."""
        return await self._ros_2.call(service, type_name, request, within, sending)

    def serve(self, service: str, type_name: str, handler: Handler) -> None:
        """Answer requests from ROS 2; see `Transport.serve`."""
        self._ros_2.serve(service, type_name, handler)

    def graph(self) -> list[NetworkEndpoint]:
        """Return the endpoints of both networks; see `Transport.graph`."""
        return [*self._ros_2.graph(), *self._ros_1.graph()]

    def services(self) -> list[ServiceEnd]:
        """Return the ends of services of ROS 2, where its transport can tell; see `TellsServices`."""
        return self._ros_2.services() if isinstance(self._ros_2, TellsServices) else []

    def close(self) -> None:
        """Leave both networks; see `Transport.close`."""
        self._ros_2.close()
        self._ros_1.close()

    def _of(self, topic: str) -> Transport:
        return self._ros_1 if topic in self._ros_1_topics else self._ros_2
