"""Who is on the network, as rclpy tells it.

rclpy lists the endpoints of a topic with node, type, hash and policies, but does not say which are its caller's. Those
are known by the node's name; should another process have taken the same name, what exceeds our own number is foreign.
"""

from __future__ import annotations

from collections.abc import Mapping, Set

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from rclpy.topic_endpoint_info import TopicEndpointInfo

from sequence_planner.ros.rclpy_qos import seconds
from sequence_planner.ros.service_graph import ServiceEnd
from sequence_planner.ros.transport import Direction, Endpoint

#: What the middleware calls a node that has not told its name yet.
_UNNAMED = "_NODE_NAME_UNKNOWN_"

#: What every rclpy node publishes unasked.
_UNASKED = {"/parameter_events"}


def endpoints(node: Node, own_name: str, published: Set[str], subscribed: Mapping[str, int]) -> list[Endpoint]:
    """Return the endpoints of all topics that `node` knows.

    `own_name` is the node's full name, `published` are the topics it publishes, and `subscribed` counts its
    subscriptions by topic.
    """
    found = []
    for topic, _ in node.get_topic_names_and_types():
        publishers = int(topic in published or topic in _UNASKED)
        found += _of_topic(topic, "publisher", node.get_publishers_info_by_topic(topic), own_name, publishers)
        subscribers = subscribed.get(topic, 0)
        found += _of_topic(topic, "subscriber", node.get_subscriptions_info_by_topic(topic), own_name, subscribers)
    return found


def service_ends(node: Node) -> list[ServiceEnd]:
    """Return a server for each service that `node` knows; rclpy does not say whose it is, nor who calls it."""
    return [
        ServiceEnd(service, type_name, "server", False, None)
        for service, type_names in node.get_service_names_and_types()
        for type_name in type_names
    ]


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
                type_hash=str(info.topic_type_hash) if info.topic_type_hash.version > 0 else None,
                node=None if info.node_name == _UNNAMED else name,
                reliable=info.qos_profile.reliability == ReliabilityPolicy.RELIABLE,
                transient_local=info.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL,
                deadline=seconds(info.qos_profile.deadline),
                liveliness=seconds(info.qos_profile.liveliness_lease_duration),
            )
        )
    return found
