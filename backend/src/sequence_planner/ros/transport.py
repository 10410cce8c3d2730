"""Port to a network: publishers, subscribers, services and the graph of nodes; bytes only."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Sequence
from dataclasses import dataclass
from typing import Literal, Protocol, runtime_checkable

from sequence_planner.core.immutable import Immutable
from sequence_planner.ros.qos import Direction, QualityEvent, QualityOfService

# Who serves and who calls services, where a transport can tell.

Role = Literal["server", "client"]


class ServiceEnd(Immutable):
    """A server or a client of a service, `type_name` as in `package/srv/Name`; `own` is this transport's.

    `node` and `vendor` (of its middleware) are None where it does not tell. It is `understood` where it puts the number
    of a call in the same place as this transport does.
    """

    service: str
    type_name: str
    role: Role
    own: bool
    node: str | None
    vendor: str | None = None
    understood: bool = True


@runtime_checkable
class TellsServices(Protocol):
    """A transport that knows the ends of services, those of actions among them."""

    def services(self) -> list[ServiceEnd]:
        """Return the servers and clients that were known when the graph was last asked for."""


# The port through which a station speaks ROS 2: bytes on topics, calls of services, and who else is there.
#
# A transport knows topics, services, type names and qualities of service, and carries CDR bytes; what they mean is for
# `sequence_planner.ros.messages`. Actions stand above it, in `sequence_planner.ros.actions`. All methods are called on
# the event loop's thread, and so are the callbacks: the threads of the middleware never show. Discovery takes time (a
# tenth of a second to several seconds, by vendor), so `graph` tells what is known now, and whoever needs a peer waits.


class TransportError(Exception):
    """A transport cannot start or carry on; the text says why and what to do."""


class NoServerError(TransportError):
    """Nobody serves a service, or nobody that can be understood; nothing has been sent."""


class NoAnswerError(TransportError):
    """A request was sent and no answer came in time; whether it was carried out is unknown."""


@dataclass(frozen=True, slots=True)
class Sample:
    """One message as received: its CDR bytes, and when, in seconds of `time.monotonic()`.

    `source` tells publishers apart where the middleware does, and is 0 elsewhere. `trouble` says why there are no
    bytes, where a transport reads messages itself and could not read this one.
    """

    topic: str
    data: bytes
    received: float
    source: int = 0
    trouble: str = ""


OnBatch = Callable[[Sequence[Sample]], None]
OnQualityEvent = Callable[[QualityEvent], None]

#: What answers a request: from its CDR bytes to those of the response.
Handler = Callable[[bytes], Awaitable[bytes]]

#: What is called right before a request is sent, and may raise.
Sending = Callable[[], None]


def unhindered() -> None:
    """Let a request go out whenever it can."""


class NetworkEndpoint(Immutable):
    """A publisher or subscriber on the network.

    `own` tells this transport's endpoints from everybody else's. `type_name` is `package/msg/Name`, or whatever the
    peer calls it when ROS 2 did not make the name. `type_hash`, `node` (as in `/cell/robot`) and `vendor` (of its
    middleware) are None where the peer does not tell, or not yet.
    """

    topic: str
    type_name: str
    direction: Direction
    own: bool
    type_hash: str | None
    node: str | None
    reliable: bool
    transient_local: bool
    deadline: float | None = None
    liveliness: float | None = None
    vendor: str | None = None

    @property
    def quality(self) -> QualityOfService:
        """The quality that it offers or wants; how many samples it keeps is nobody else's affair."""
        return QualityOfService(self.reliable, self.transient_local, deadline=self.deadline, liveliness=self.liveliness)


class Transport(Protocol):
    """A way to the ROS 2 network.

    Types of services are written `package/srv/Name`, or `package/action/Name_SendGoal` and the like. Methods raise
    ValueError for a name ROS 2 does not allow, UnknownMessageTypeError for a type the station does not know, and
    TransportError when the middleware refuses.
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

    def watch(self, on_event: OnQualityEvent) -> None:
        """Have `on_event` called when a quality of service is not agreed on or not kept, from now on."""

    async def call(
        self, service: str, type_name: str, request: bytes, within: float, sending: Sending = unhindered
    ) -> bytes:
        """Return the CDR bytes that the server of `service` answers to `request`, within so many seconds.

        A server is waited for as long as that; `sending` is called at the last moment before the request goes out, and
        what it raises is raised instead. Raises NoServerError and NoAnswerError.
        """

    def serve(self, service: str, type_name: str, handler: Handler) -> None:
        """Have `handler` answer the requests to `service`, on the event loop, several at a time.

        Where it fails, the log says so and the client gets no answer.
        """

    def graph(self) -> list[NetworkEndpoint]:
        """Return the endpoints of all topics known now, this transport's own among them."""

    def close(self) -> None:
        """Leave the network and end the transport's threads; nothing is delivered afterwards. May be repeated."""
