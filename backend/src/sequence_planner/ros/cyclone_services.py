"""Services over cyclonedds, in the mapping of rmw_cyclonedds.

A service is two topics. Each request and reply begins with whose call it is and the call's number, and the user data of
an endpoint say to which client or server it belongs. Other vendors keep the call's number where cyclonedds does not
show it, and put no header before the body; but a request of ours would still reach such a server, which would then
execute what it makes of our header. So a request is written only while every reader that it would reach says that it
belongs to a server of this mapping, and a request that comes from anybody else is dropped.
"""

from __future__ import annotations

import asyncio
import secrets
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from uuid import UUID

import structlog
from cyclonedds.core import DDSException
from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.qos import Qos
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

from sequence_planner.ros import names
from sequence_planner.ros.call_header import CallHeader, split_header
from sequence_planner.ros.cyclone_call_end import CallEnd
from sequence_planner.ros.cyclone_network import release
from sequence_planner.ros.cyclone_qos import endpoint_qos, user_data
from sequence_planner.ros.cyclone_receiver import Receiver
from sequence_planner.ros.cyclone_types import RawTypes
from sequence_planner.ros.delivery import Delivery
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.quality import QualityOfService
from sequence_planner.ros.serving import Serving
from sequence_planner.ros.transport import (
    Handler,
    NoAnswerError,
    NoServerError,
    OnBatch,
    Sample,
    Sending,
    TransportError,
    unhindered,
)

_log = structlog.get_logger(__name__)

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
        told_on: Callable[[str], list[bytes]],
    ) -> None:
        """Begin without any; `told_on` gives the user data of all publishers of a topic of DDS."""
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
        """Whether the service has been called before."""
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
