"""The port through which a station speaks ROS 2: bytes on topics, and who else is there.

A transport knows topics, type names and qualities of service, and carries CDR bytes; what they mean is for
`sequence_planner.ros.messages`. All methods are called on the event loop's thread, and so are the callbacks: the
threads of the middleware never show. Discovery takes time (a tenth of a second to several seconds, by vendor), so
`graph` tells what is known now, and whoever needs a peer waits for it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Literal, Protocol

Direction = Literal["publisher", "subscriber"]


class TransportError(Exception):
    """A transport cannot start or carry on; the text says why and what to do."""


class QualityOfService(StrEnum):
    """How samples of a topic are kept and delivered; both sides must agree.

    A subscriber that asks for more than a publisher offers (reliable of best effort, latched of volatile) gets nothing.
    """

    RELIABLE = "reliable"  # reliable, volatile, keep last 10: commands and states
    SENSOR_DATA = "sensor_data"  # best effort, volatile, keep last 5: fast streams where only the newest counts
    LATCHED = "latched"  # reliable, transient local, keep last 1: late joiners get the last sample

    @property
    def reliable(self) -> bool:
        """Whether lost samples are sent again."""
        return self is not QualityOfService.SENSOR_DATA

    @property
    def transient_local(self) -> bool:
        """Whether a late joiner gets the samples kept."""
        return self is QualityOfService.LATCHED

    @property
    def depth(self) -> int:
        """How many samples are kept."""
        return {QualityOfService.RELIABLE: 10, QualityOfService.SENSOR_DATA: 5, QualityOfService.LATCHED: 1}[self]


@dataclass(frozen=True, slots=True)
class Sample:
    """One message as received: its CDR bytes, and when, in seconds of `time.monotonic()`."""

    topic: str
    data: bytes
    received: float


OnBatch = Callable[[Sequence[Sample]], None]


@dataclass(frozen=True)
class Endpoint:
    """A publisher or subscriber on the network.

    `own` tells this transport's endpoints from everybody else's. `type_name` is `package/msg/Name`, or whatever the
    peer calls it when ROS 2 did not make the name. `type_hash` and `node` (as in `/cell/robot`) are None where the peer
    does not tell, or not yet.
    """

    topic: str
    type_name: str
    direction: Direction
    own: bool
    type_hash: str | None
    node: str | None
    reliable: bool
    transient_local: bool


class Transport(Protocol):
    """A way to the ROS 2 network.

    Methods raise ValueError for a name ROS 2 does not allow, UnknownMessageTypeError for a type the station does not
    know, and TransportError when the middleware refuses.
    """

    @property
    def name(self) -> str:
        """The name of the transport, as configuration gives it."""

    def advertise(self, topic: str, type_name: str, qos: QualityOfService) -> None:
        """Announce that this transport will publish on `topic`; repeating it changes nothing."""

    def publish(self, topic: str, type_name: str, data: bytes) -> None:
        """Send the CDR bytes `data` on a topic that was advertised with this type."""

    def subscribe(self, topic: str, type_name: str, qos: QualityOfService, on_batch: OnBatch) -> None:
        """Have `on_batch` called with the samples of `topic`, oldest first, as they arrive."""

    def graph(self) -> list[Endpoint]:
        """Return the endpoints of all topics known now, this transport's own among them."""

    def close(self) -> None:
        """Leave the network and end the transport's threads; nothing is delivered afterwards. May be repeated."""
