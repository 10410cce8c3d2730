"""The way ROS 2 writes its names into DDS.

DDS knows topics and types by strings. ROS 2 prefixes a topic with `rt`, puts a type into the C++ namespace its
generated code has there, and hangs what DDS has no place for (type hashes, enclaves) on an entity's user data.

>>> dds_topic("/robot/state"), dds_type("std_msgs/msg/String")
('rt/robot/state', 'std_msgs::msg::dds_::String_')
"""

from __future__ import annotations

import re

_TOPIC = re.compile(r"(/[A-Za-z_][A-Za-z0-9_]*)+")
_NODE = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_DDS_TYPE = re.compile(r"(?P<package>\w+)::(?P<kind>msg|srv|action)::dds_::(?P<name>\w+)_")
_REQUEST = re.compile(r"rq(/.+)Request")
_TYPE_HASH = re.compile(rb"(?:^|;)typehash=(RIHS01_[0-9a-f]{64});")

#: rmw_cyclonedds writes the first byte of an identity in two places, and fills up with a blank.
_SERVER = re.compile(rb"(?:^|;)serviceid=([ 0-9a-f.]+);")
_CLIENT = re.compile(rb"(?:^|;)clientid=([ 0-9a-f.]+);")

#: Marks a topic of ROS 2 (services have `rq` and `rr`).
TOPIC_PREFIX = "rt"


def check_topic(topic: str) -> str:
    """Return `topic`; raises ValueError unless it is an absolute ROS 2 topic name such as `/robot/state`."""
    if not _TOPIC.fullmatch(topic) or "__" in topic:
        raise ValueError(
            f"{topic!r} is not a topic name: write it absolute, as in /robot/state, "
            "of letters, digits and single underscores, no part beginning with a digit"
        )
    return topic


def check_node_name(name: str) -> str:
    """Return `name`; raises ValueError unless ROS 2 accepts it as a node's name."""
    if not _NODE.fullmatch(name):
        raise ValueError(f"{name!r} is not a node name: use letters, digits and underscores, as in truck_station")
    return name


def dds_topic(topic: str) -> str:
    """Return the DDS topic of the ROS 2 topic `topic`; raises ValueError for a bad name."""
    return TOPIC_PREFIX + check_topic(topic)


def ros_topic(dds_name: str) -> str | None:
    """Return the ROS 2 topic of the DDS topic `dds_name`, or None when it is not one (a service, plain DDS)."""
    return dds_name.removeprefix(TOPIC_PREFIX) if dds_name.startswith(f"{TOPIC_PREFIX}/") else None


def dds_service(service: str) -> tuple[str, str]:
    """Return the DDS topics of requests and of replies of a ROS 2 service; raises ValueError for a bad name."""
    check_topic(service)
    return dds_requests(service), f"rr{service}Reply"


def dds_requests(service: str) -> str:
    """Return the DDS topic of requests of a ROS 2 service that is there, whatever its name."""
    return f"rq{service}Request"


def ros_service(dds_name: str, dds_type_name: str) -> tuple[str, str] | None:
    """Return the service, and its type, to which a DDS topic of requests belongs; None for any other topic.

    >>> ros_service("rq/arm/stopRequest", "std_srvs::srv::dds_::Trigger_Request_")
    ('/arm/stop', 'std_srvs/srv/Trigger')
    """
    match = _REQUEST.fullmatch(dds_name)
    return (match.group(1), ros_type(dds_type_name).removesuffix("_Request")) if match else None


def server_user_data(identity: bytes) -> bytes:
    """Return the user data by which both endpoints of a server tell that they belong together."""
    return f"serviceid={_dotted(identity)};".encode()


def client_user_data(identity: bytes) -> bytes:
    """Return the user data by which both endpoints of a client tell that they belong together."""
    return f"clientid={_dotted(identity)};".encode()


def server_of(user_data: bytes) -> str | None:
    """Return the identity of the server an endpoint belongs to, or None when it does not say."""
    match = _SERVER.search(user_data)
    return match.group(1).decode() if match else None


def client_of(user_data: bytes) -> str | None:
    """Return the identity of the client an endpoint belongs to, or None when it does not say."""
    match = _CLIENT.search(user_data)
    return match.group(1).decode() if match else None


def tells_mapping(user_data: bytes) -> bool:
    """Return whether an endpoint says that it belongs to a server or a client of rmw_cyclonedds."""
    return server_of(user_data) is not None or client_of(user_data) is not None


def _dotted(identity: bytes) -> str:
    first, *others = identity
    return ".".join([f"{first:2x}", *(f"{byte:x}" for byte in others)])


def dds_type(type_name: str) -> str:
    """Return the DDS name of the ROS 2 type `type_name`, which is written `package/msg/Name`."""
    package, kind, name = type_name.split("/")
    return f"{package}::{kind}::dds_::{name}_"


def ros_type(dds_name: str) -> str:
    """Return the ROS 2 name of the DDS type `dds_name`, or `dds_name` itself when ROS 2 did not make it."""
    match = _DDS_TYPE.fullmatch(dds_name)
    return "/".join(match.group("package", "kind", "name")) if match else dds_name


def type_hash_user_data(type_hash: str) -> bytes:
    """Return the user data by which an endpoint tells its peers the hash of its type."""
    return f"typehash={type_hash};".encode()


def type_hash_of(user_data: bytes) -> str | None:
    """Return the type hash found in the user data of an endpoint, or None when it does not say."""
    match = _TYPE_HASH.search(user_data)
    return match.group(1).decode() if match else None
