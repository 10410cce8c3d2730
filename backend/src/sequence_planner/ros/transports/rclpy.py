"""Transport over rclpy for a ROS 2 installation: topics, services, types, QoS and discovery."""

from __future__ import annotations

import asyncio
import json
import os
import threading
import time
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Set
from contextlib import suppress
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Literal, Protocol, TypeVar
from uuid import UUID

import rclpy
import structlog
from rclpy.client import Client
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_policy_name_from_kind,
)
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.service import Service
from rclpy.signals import SignalHandlerOptions
from rclpy.subscription import Subscription
from rclpy.task import Future
from rclpy.topic_endpoint_info import TopicEndpointInfo
from rosidl_runtime_py.get_interfaces import get_interface_path
from rosidl_runtime_py.utilities import get_action, get_message, get_service

from sequence_planner.ros import environment, names
from sequence_planner.ros import environment as enclaves
from sequence_planner.ros.delivery import Delivery, Serving, both_sides, check_hashes
from sequence_planner.ros.environment import vendor_of, worded
from sequence_planner.ros.incompatible_peers import Strangers
from sequence_planner.ros.qos import READER_DEPTH, Direction, QualityEvent, QualityOfService
from sequence_planner.ros.transport import (
    Handler,
    NetworkEndpoint,
    NoAnswerError,
    NoServerError,
    OnBatch,
    OnQualityEvent,
    Role,
    Sample,
    Sending,
    ServiceEnd,
    TransportError,
    unhindered,
)
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.ros.types.standard_types import ServiceType

if TYPE_CHECKING:
    from rclpy.event_handler import (
        QoSLivelinessChangedInfo,
        QoSLivelinessLostInfo,
        QoSOfferedDeadlineMissedInfo,
        QoSOfferedIncompatibleQoSInfo,
        QoSRequestedDeadlineMissedInfo,
        QoSRequestedIncompatibleQoSInfo,
    )

# Qualities of service as rclpy has them, and what it says about them.

#: Tells of an event: its kind, how often it has happened, and what it is in words.
Tell = Callable[[Literal["incompatible", "deadline", "liveliness"], int, str], None]

#: Nanoseconds that mean "never": rmw's infinite duration.
_INFINITE = 2**63 - 1


def profile(qos: QualityOfService) -> QoSProfile:
    """Return the profile of a publisher or subscription."""
    made = QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=qos.depth,
        reliability=ReliabilityPolicy.RELIABLE if qos.reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if qos.transient_local else DurabilityPolicy.VOLATILE,
    )
    if qos.deadline is not None:
        made.deadline = Duration(seconds=qos.deadline)
    if qos.liveliness is not None:
        made.liveliness = LivelinessPolicy.AUTOMATIC
        made.liveliness_lease_duration = Duration(seconds=qos.liveliness)
    return made


def seconds(duration: Duration) -> float | None:
    """Return a duration of a profile in s; None when it is infinite or not given."""
    return duration.nanoseconds / 1e9 if 0 < duration.nanoseconds < _INFINITE else None


def publisher_events(qos: QualityOfService, tell: Tell) -> PublisherEventCallbacks:
    """Return the callbacks of a publisher; a middleware is asked for no more of them than `qos` needs."""

    def incompatible(info: QoSOfferedIncompatibleQoSInfo) -> None:
        tell("incompatible", info.total_count, qos_policy_name_from_kind(info.last_policy_kind).lower())

    def missed(info: QoSOfferedDeadlineMissedInfo) -> None:
        tell("deadline", info.total_count, f"no sample published within its deadline of {qos.deadline or 0:g} s")

    def lost(info: QoSLivelinessLostInfo) -> None:
        detail = f"this publisher has not shown for {qos.liveliness or 0:g} s that it is alive"
        tell("liveliness", info.total_count, detail)

    return PublisherEventCallbacks(
        incompatible_qos=incompatible,
        deadline=missed if qos.deadline is not None else None,
        liveliness=lost if qos.liveliness is not None else None,
        use_default_callbacks=False,
    )


def subscription_events(qos: QualityOfService, tell: Tell) -> SubscriptionEventCallbacks:
    """Return the callbacks of a subscription, as `publisher_events` does."""

    def incompatible(info: QoSRequestedIncompatibleQoSInfo) -> None:
        tell("incompatible", info.total_count, qos_policy_name_from_kind(info.last_policy_kind).lower())

    def missed(info: QoSRequestedDeadlineMissedInfo) -> None:
        tell("deadline", info.total_count, f"no sample received within its deadline of {qos.deadline or 0:g} s")

    def changed(info: QoSLivelinessChangedInfo) -> None:
        if info.not_alive_count_change > 0:
            detail = f"a publisher has not shown for {qos.liveliness or 0:g} s that it is alive"
            tell("liveliness", info.not_alive_count, detail)

    return SubscriptionEventCallbacks(
        incompatible_qos=incompatible,
        deadline=missed if qos.deadline is not None else None,
        liveliness=changed if qos.liveliness is not None else None,
        use_default_callbacks=False,
    )


# Who is on the network, as rclpy tells it.
#
# rclpy lists the endpoints of a topic with node, type, hash and policies, but does not say which are its caller's.
# Those are known by the node's name; should another process have taken the same name, what exceeds our own number is
# foreign. The endpoints of a service are found as those of the topics of DDS that it is made of.

#: What the middleware calls a node that has not told its name yet.
_UNNAMED = "_NODE_NAME_UNKNOWN_"

#: What every rclpy node publishes unasked.
_UNASKED = "/parameter_events"


def endpoints(node: Node, own_name: str, published: Set[str], subscribed: Mapping[str, int]) -> list[NetworkEndpoint]:
    """Return the endpoints of all topics that `node` knows.

    `own_name` is the node's full name, `published` are the topics it publishes, and `subscribed` counts its
    subscriptions by topic.
    """
    found = []
    for topic, _ in node.get_topic_names_and_types():
        publishers = int(topic in published or topic == _UNASKED)
        found += _of_topic(topic, "publisher", node.get_publishers_info_by_topic(topic), own_name, publishers)
        subscribers = subscribed.get(topic, 0)
        found += _of_topic(topic, "subscriber", node.get_subscriptions_info_by_topic(topic), own_name, subscribers)
    return found


def service_ends(
    node: Node, own_name: str, served: Set[str], called: Mapping[str, int], among: Collection[str] | None = None
) -> list[ServiceEnd]:
    """Return the servers and clients of all services that `node` knows, or of those `among` these.

    `own_name` is the node's full name, `served` are the services that it serves, and `called` counts its clients by
    service. A server reads the topic of requests, and a client writes it.
    """
    services = [name for name, _ in node.get_service_names_and_types()] if among is None else among
    unasked = _of_topic(_UNASKED, "publisher", node.get_publishers_info_by_topic(_UNASKED), own_name, 1)
    vendor = next((each.vendor for each in unasked if each.own), None)
    found = []
    for service in services:
        requests = names.dds_requests(service)
        readers = node.get_subscriptions_info_by_topic(requests, no_mangle=True)
        writers = node.get_publishers_info_by_topic(requests, no_mangle=True)
        ends: list[tuple[Role, list[NetworkEndpoint]]] = [
            ("server", _of_topic(requests, "subscriber", readers, own_name, int(service in served))),
            ("client", _of_topic(requests, "publisher", writers, own_name, called.get(service, 0))),
        ]
        for role, endpoints_ in ends:
            for each in endpoints_:
                named = names.ros_service(requests, each.type_name)
                if named is not None:
                    found.append(ServiceEnd(*named, role, each.own, each.node, each.vendor, each.vendor == vendor))
    return found


def check_servers(node: Node, service: str, type_name: str, hash_of: Callable[[str], str]) -> None:
    """Raise NoServerError when a request would reach somebody who would not understand it.

    Vendors of DDS write the number of a call in different places, and rclpy tells who serves by the topics alone.
    `hash_of` gives the hash of a message.
    """
    requests, replies = names.dds_service(service)
    types = ServiceType(type_name)
    ours = node.get_subscriptions_info_by_topic(replies, no_mangle=True)
    vendors = {_vendor(info) for info in ours if info.node_name == node.get_name()}
    for info in node.get_subscriptions_info_by_topic(requests, no_mangle=True):
        if vendors and _vendor(info) not in vendors:
            raise NoServerError(
                f"{service} is served by a program on {worded(_vendor(info))}, which cannot tell apart calls "
                f"that come from {' or '.join(sorted(map(worded, vendors)))}; it would execute garbage, so nothing was "
                "sent. Run both with the same RMW_IMPLEMENTATION"
            )
        check_hashes(service, types.request, _hash(info), hash_of(types.request))
    for info in node.get_publishers_info_by_topic(replies, no_mangle=True):
        check_hashes(service, types.response, _hash(info), hash_of(types.response))


def _vendor(info: TopicEndpointInfo) -> str | None:
    return vendor_of(UUID(bytes=bytes(info.endpoint_gid[:16])))


def _hash(info: TopicEndpointInfo) -> str | None:
    return str(info.topic_type_hash) if info.topic_type_hash.version > 0 else None


def _of_topic(
    topic: str, direction: Direction, infos: list[TopicEndpointInfo], own_name: str, own: int
) -> list[NetworkEndpoint]:
    """Return one topic's publishers or subscribers, `own` of which are the caller's."""
    found = []
    for info in infos:
        name = f"{info.node_namespace.rstrip('/')}/{info.node_name}"
        mine = own > 0 and name == own_name
        own -= mine
        found.append(
            NetworkEndpoint(
                topic=topic,
                type_name=info.topic_type,
                direction=direction,
                own=mine,
                type_hash=_hash(info),
                node=None if info.node_name == _UNNAMED else name,
                reliable=info.qos_profile.reliability == ReliabilityPolicy.RELIABLE,
                transient_local=info.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL,
                deadline=seconds(info.qos_profile.deadline),
                liveliness=seconds(info.qos_profile.liveliness_lease_duration),
                vendor=_vendor(info),
            )
        )
    return found


# The Python classes that rosidl generated for messages, services and actions, by the names of their types.

T = TypeVar("T")


class ServiceClass(Protocol):
    """The class that rosidl generates for a service."""

    Request: type
    Response: type


def message_class(where: str, type_name: str) -> type:
    """Return the class of a message, or of what is derived from an action and published on a topic.

    `where` is the topic, for the message. Raises TransportError where there is no generated code, saying how to get it.
    """
    whole, _, part = type_name.rpartition("_")
    if type_name.split("/")[1] == "action" and part == "FeedbackMessage":
        return _generated(where, type_name, lambda: get_action(whole).Impl.FeedbackMessage)
    return _generated(where, type_name, lambda: get_message(type_name))


def service_class(where: str, type_name: str) -> ServiceClass:
    """Return the class of a service, those of an action among them; raises as `message_class` does."""
    whole, _, part = type_name.rpartition("_")
    if type_name.split("/")[1] != "action":
        return _generated(where, type_name, lambda: get_service(type_name))
    if part == "SendGoal":
        return _generated(where, type_name, lambda: get_action(whole).Impl.SendGoalService)
    return _generated(where, type_name, lambda: get_action(whole).Impl.GetResultService)


def check_definition(where: str, type_name: str, ours: str) -> None:
    """Raise TransportError when the code of a message was generated from another definition than that with hash `ours`.

    It would announce the old definition while the bytes are of the new one, and whoever reads them gets garbage.
    """
    folder, _, name = type_name.rpartition("/")
    theirs = _hashes(f"{folder}/{name.split('_')[0]}").get(type_name, ours)
    if theirs != ours:
        package = type_name.split("/", maxsplit=1)[0]
        raise TransportError(
            f"{where}: the code that ROS 2 has for {type_name} was generated from another definition than the model's "
            f"({theirs}, not {ours}). Build the package {package} again: write it with `sequence-planner messages "
            "--ament`, build it with colcon, source its install/setup.bash, and start again"
        )


@cache
def _hashes(interface: str) -> dict[str, str]:
    """Return the hash of each type that was generated from an interface; empty where the installation does not tell."""
    try:
        described = Path(get_interface_path(interface)).with_suffix(".json").read_text(encoding="utf-8")
    except (LookupError, OSError):
        return {}
    return {each["type_name"]: each["hash_string"] for each in json.loads(described)["type_hashes"]}


def _generated(where: str, type_name: str, find: Callable[[], T]) -> T:
    try:
        return find()
    except (ImportError, AttributeError, ValueError) as error:
        package = type_name.split("/", maxsplit=1)[0]
        raise TransportError(
            f"{where}: ROS 2 has no generated code for {type_name} ({error}). Build the package {package}: "
            "write it with `sequence-planner messages --ament`, build it with colcon, source its install/setup.bash"
        ) from error


def guarded(what: str, action: Callable[[], T]) -> T:
    """Return what `action` returns; rclpy's many unrelated exceptions become TransportError."""
    try:
        return action()
    except Exception as error:
        raise TransportError(f"ROS 2 cannot {what}: {error}") from error


# Taking all that waits, once rclpy's executor has taken the first.
#
# The executor takes one message of each subscription, one request of each server and one response of each client, and
# then builds its wait set anew; a busy station would fall behind. Whoever was called takes the rest, on the same
# thread.

#: What is taken in one go, so that a flood on one topic leaves the others their turn.
_GO = range(READER_DEPTH)


def messages_waiting(subscription: Subscription, message: type) -> Iterator[bytes]:
    """Yield the messages that wait in a subscription of raw bytes."""
    for _ in _GO:
        with subscription.handle:
            taken = subscription.handle.take_message(message, True)
        if taken is None:
            return
        yield taken[0]


def requests_waiting(server: Service, types: ServiceClass) -> Iterator[tuple[object, object]]:
    """Yield the requests that wait for a server, each with its header."""
    for _ in _GO:
        with server.handle:
            request, header = server.handle.service_take_request(types.Request)
        if header is None:
            return
        yield request, header


def responses_waiting(client: Client, types: ServiceClass) -> None:
    """Settle the calls whose responses wait for a client."""
    for _ in _GO:
        with client.handle:
            header, response = client.handle.take_response(types.Response)
        if header is None:
            return
        try:
            call = client.get_pending_request(header.request_id.sequence_number)
        except KeyError:  # Nobody waits for it any more.
            continue
        call.set_result(response)


# Services over rclpy.
#
# rclpy takes and gives message objects here, never bytes, so they pass through the generated code of their types. Its
# executor would keep a processor busy for as long as a coroutine waits for an answer; so the callback of a service only
# hands the request over to the event loop, and the response is sent when it is there. What else has come by then is
# taken in the same go: the executor builds its wait set anew for each turn.

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


# The transport over rclpy, for computers with a ROS 2 installation.
#
# rclpy speaks every vendor's DDS, and its security. It sends and receives raw bytes, so the codec stays ours, but it
# still wants the generated code of each message type: the station's own messages must have been built by colcon and be
# on the path. rclpy is given a context and a thread of its own here, and leaves the process's signals alone. Written
# for rclpy 7 (Jazzy).

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

    def graph(self) -> list[NetworkEndpoint]:
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
