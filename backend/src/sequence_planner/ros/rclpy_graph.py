"""Who is on the network, as rclpy tells it.

rclpy lists the endpoints of a topic with node, type, hash and policies, but does not say which are its caller's. Those
are known by the node's name; should another process have taken the same name, what exceeds our own number is foreign.
The endpoints of a service are found as those of the topics of DDS that it is made of.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Set
from uuid import UUID

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from rclpy.topic_endpoint_info import TopicEndpointInfo

from sequence_planner.ros import names
from sequence_planner.ros.derived import ServiceType
from sequence_planner.ros.rclpy_qos import seconds
from sequence_planner.ros.service_graph import Role, ServiceEnd
from sequence_planner.ros.serving import check_hashes
from sequence_planner.ros.transport import Direction, Endpoint, NoServerError
from sequence_planner.ros.vendors import vendor_of, worded

#: What the middleware calls a node that has not told its name yet.
_UNNAMED = "_NODE_NAME_UNKNOWN_"

#: What every rclpy node publishes unasked.
_UNASKED = "/parameter_events"


def endpoints(node: Node, own_name: str, published: Set[str], subscribed: Mapping[str, int]) -> list[Endpoint]:
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
        ends: list[tuple[Role, list[Endpoint]]] = [
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
) -> list[Endpoint]:
    """Return one topic's publishers or subscribers, `own` of which are the caller's."""
    found = []
    for info in infos:
        name = f"{info.node_namespace.rstrip('/')}/{info.node_name}"
        mine = own > 0 and name == own_name
        own -= mine
        found.append(
            Endpoint(
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
