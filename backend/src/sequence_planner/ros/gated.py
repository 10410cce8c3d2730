"""A transport that speaks only while it may, and listens always."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from sequence_planner.ros.quality import QualityOfService
from sequence_planner.ros.service_graph import ServiceEnd, TellsServices
from sequence_planner.ros.transport import (
    Endpoint,
    Handler,
    OnBatch,
    OnQualityEvent,
    Sending,
    Transport,
    TransportError,
    unhindered,
)


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

    def graph(self) -> list[Endpoint]:
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
