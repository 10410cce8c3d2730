"""Services over rclpy.

rclpy takes and gives message objects here, never bytes, so they pass through the generated code of their types. Its
executor would keep a processor busy for as long as a coroutine waits for an answer; so the callback of a service only
hands the request over to the event loop, and the response is sent when it is there. What else has come by then is taken
in the same go: the executor builds its wait set anew for each turn.
"""

from __future__ import annotations

import asyncio
import threading
import time
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from functools import partial

from rclpy.client import Client
from rclpy.node import Node
from rclpy.service import Service
from rclpy.task import Future

from sequence_planner.ros import names
from sequence_planner.ros.derived import ServiceType
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.quality import QualityOfService
from sequence_planner.ros.rclpy_draining import requests_waiting, responses_waiting
from sequence_planner.ros.rclpy_graph import check_servers
from sequence_planner.ros.rclpy_qos import profile
from sequence_planner.ros.rclpy_types import (
    ServiceClass,
    check_definition,
    deserialize_message,
    guarded,
    serialize_message,
    service_class,
)
from sequence_planner.ros.serving import Serving
from sequence_planner.ros.transport import Handler, NoAnswerError, NoServerError, Sending, TransportError, unhindered

_POLL = 0.02  # seconds between two looks for a server

#: Seconds from when a client sees a server until it calls it. rmw_fastrtps says that a service is ready as soon as the
#: client knows the server; a call before the server knows the client is lost, or its response is.
_SETTLING = 0.2


class RclpyServices:
    """The clients and servers of one node. All methods belong on the event loop's thread."""

    def __init__(self, node: Node, registry: MessageRegistry, loop: asyncio.AbstractEventLoop) -> None:
        self._node = node
        self._registry = registry
        self._loop = loop
        self._clients: dict[tuple[str, str], tuple[Client, ServiceClass]] = {}
        self._met: set[tuple[str, str]] = set()  # the clients that have seen a server, and not lost it since
        self._servers: dict[str, Service] = {}
        self._waiting: set[asyncio.Future[bytes]] = set()
        self._serving = Serving()

    @property
    def served(self) -> set[str]:
        """The services that are served here."""
        return set(self._servers)

    @property
    def called(self) -> Counter[str]:
        """The clients here, by service."""
        return Counter(service for service, _ in self._clients)

    async def call(
        self, service: str, type_name: str, request: bytes, within: float, sending: Sending = unhindered
    ) -> bytes:
        """Call a service; see `Transport.call`."""
        client, types = self._client(service, type_name)
        until = time.monotonic() + within
        while True:
            there = client.service_is_ready()
            check_servers(self._node, service, type_name, self._registry.type_hash)
            if there and (service, type_name) in self._met:
                break
            if there:
                self._met.add((service, type_name))
                await asyncio.sleep(min(_SETTLING, within / 2))
                continue
            self._met.discard((service, type_name))
            if time.monotonic() > until:
                raise NoServerError(f"nobody serves {service} as {type_name}")
            await asyncio.sleep(_POLL)
        sending()
        answer: asyncio.Future[bytes] = self._loop.create_future()
        self._waiting.add(answer)

        def received(future: Future) -> None:
            """Hand the response over to the event loop; called on the executor's thread."""
            self._post(lambda: _settle(answer, future))
            responses_waiting(client, types)

        sent = guarded(f"call {service}", lambda: client.call_async(deserialize_message(request, types.Request)))
        sent.add_done_callback(received)
        try:
            return await asyncio.wait_for(answer, max(until - time.monotonic(), 0))
        except TimeoutError:
            client.remove_pending_request(sent)
            raise NoAnswerError(f"{service} gave no answer within {within:g} s") from None
        finally:
            self._waiting.discard(answer)

    def serve(self, service: str, type_name: str, handler: Handler) -> None:
        """Answer requests; see `Transport.serve`."""
        names.check_topic(service)
        self._registry.service(type_name)
        if service in self._servers:
            raise TransportError(f"{service} is already served")
        types = self._types(service, type_name)

        ready = threading.Event()

        def received(request: object, response: object) -> object:
            """Let the executor go on with the request itself, which `hand_over` then gets with its header."""
            ready.wait()
            return request

        def hand_over(request: object, header: object) -> None:
            for each, its_header in [(request, header), *requests_waiting(server, types)]:
                data = bytes(serialize_message(each))
                self._post(partial(self._serving.answer, service, handler, data, partial(respond, its_header)))

        def respond(header: object, answer: bytes) -> None:
            send(deserialize_message(answer, types.Response), header)

        server = guarded(
            f"serve {service}",
            lambda: self._node.create_service(types, service, received, qos_profile=profile(QualityOfService.CALLS)),
        )
        self._servers[service] = server
        send = server.send_response
        vars(server)["send_response"] = hand_over
        ready.set()

    def close(self) -> None:
        """Answer nothing any more, and let those who wait for an answer know."""
        self._serving.close()
        for answer in self._waiting:
            if not answer.done():
                answer.set_exception(TransportError("the transport is closed"))

    def _client(self, service: str, type_name: str) -> tuple[Client, ServiceClass]:
        names.check_topic(service)
        self._registry.service(type_name)
        key = (service, type_name)
        if key not in self._clients:
            types = self._types(service, type_name)
            calls = profile(QualityOfService.CALLS)
            client = guarded(f"call {service}", lambda: self._node.create_client(types, service, qos_profile=calls))
            self._clients[key] = (client, types)
        return self._clients[key]

    def _types(self, service: str, type_name: str) -> ServiceClass:
        """Return what rosidl generated for a service; raises TransportError where that is none, or another."""
        types, parts = service_class(service, type_name), ServiceType(type_name)
        for each in (parts.request, parts.response):
            check_definition(service, each, self._registry.type_hash(each))
        return types

    def _post(self, work: Callable[[], None]) -> None:
        with suppress(RuntimeError):  # The loop has been closed: nobody waits any more.
            self._loop.call_soon_threadsafe(work)


def _settle(answer: asyncio.Future[bytes], future: Future) -> None:
    if answer.done():
        return
    error = future.exception()
    if error is not None:
        answer.set_exception(TransportError(f"ROS 2 cannot call: {error}"))
    else:
        answer.set_result(bytes(serialize_message(future.result())))
