"""Discovery over Cyclone DDS: peers, endpoints, types, QoS policies and QoS events."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Collection, Container, Iterable
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Literal, get_args
from uuid import UUID

import structlog
from cyclonedds.builtin import (
    BuiltinDataReader,
    BuiltinTopicDcpsPublication,
    BuiltinTopicDcpsSubscription,
    DcpsEndpoint,
)
from cyclonedds.core import DDSException, DDSStatus, GuardCondition, InstanceState, WaitSet
from cyclonedds.domain import DomainParticipant
from cyclonedds.dynamic import TypeIdentifier, get_types_for_typeid
from cyclonedds.idl import IdlStruct, types
from cyclonedds.pub import DataWriter
from cyclonedds.qos import Policy, Qos
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration
from rosbags.interfaces import Nodetype

from sequence_planner.core.immutable import Immutable
from sequence_planner.ros import discovery_info, names
from sequence_planner.ros.environment import vendor_of
from sequence_planner.ros.qos import Direction, QualityOfService
from sequence_planner.ros.transport import NetworkEndpoint, ServiceEnd
from sequence_planner.ros.transports.cyclonedds_network import RawSample, release, take_all
from sequence_planner.ros.types.errors import MalformedMessageError
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.ros.types.type_description import BadDescriptionError, TypeDescription, describe

if TYPE_CHECKING:
    from rosbags.interfaces.typing import BaseDesc, Basename, Fielddefs, FieldDesc, NameDesc

# What cyclonedds says about qualities of service: peers that do not agree, and promises that were not kept.
#
# Each endpoint has a status for each of these. A thread of its own sleeps until any of them changes, which is rare, so
# the thread that takes samples has nothing to do with it.

_log = structlog.get_logger(__name__)

_OF_READERS = DDSStatus.RequestedIncompatibleQos | DDSStatus.RequestedDeadlineMissed | DDSStatus.LivelinessChanged
_OF_WRITERS = DDSStatus.OfferedIncompatibleQos | DDSStatus.OfferedDeadlineMissed | DDSStatus.LivelinessLost

#: Names of policies by their number in the DDS specification.
_POLICIES = {2: "durability", 4: "deadline", 8: "liveliness", 11: "reliability"}


class StatusChange(Immutable):
    """A change of one endpoint's status; `detail` names the policy, where one was not agreed on, or says what it is."""

    topic: str
    kind: Literal["incompatible", "deadline", "liveliness"]
    count: int
    detail: str


class Watched(Immutable):
    """One of our own endpoints and its quality of service."""

    topic: str
    quality: QualityOfService
    endpoint: DataReader[RawSample] | DataWriter[RawSample]


class EventWatch:
    """One thread that watches all endpoints of a participant, and calls `on_change` on that thread."""

    def __init__(
        self, participant: DomainParticipant, name: str, on_change: Callable[[Watched, StatusChange], None]
    ) -> None:
        self._on_change = on_change
        self._waitset = WaitSet(participant)
        self._wake = GuardCondition(participant)
        self._waitset.attach(self._wake)
        self._joining: SimpleQueue[Watched] = SimpleQueue()
        self._watched: list[Watched] = []
        self._closing = False
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def add(self, watched: Watched) -> None:
        """Watch an endpoint from now on; what has happened to it already is told at once."""
        reading = isinstance(watched.endpoint, DataReader)
        watched.endpoint.set_status_mask(_OF_READERS if reading else _OF_WRITERS)
        self._joining.put(watched)
        self._wake.set(True)

    def close(self) -> None:
        """End the thread."""
        self._closing = True
        self._wake.set(True)
        self._thread.join()
        release(self._waitset)
        release(self._wake)

    def _run(self) -> None:
        while not self._closing:
            try:
                self._waitset.wait(duration(infinite=True))
                self._wake.take()
                self._admit()
                for watched in self._watched:
                    for change in _changes(watched):
                        self._on_change(watched, change)
            except DDSException:
                _log.exception("DDS failed while watching qualities of service")
                time.sleep(1.0)  # If it lasts, the log fills slowly and the processor stays free.

    def _admit(self) -> None:
        while True:
            try:
                watched = self._joining.get_nowait()
            except Empty:
                return
            self._watched.append(watched)
            self._waitset.attach(watched.endpoint)


def _changes(watched: Watched) -> list[StatusChange]:
    """Return what has changed since the last time, which resets it."""
    topic, quality, endpoint = watched.topic, watched.quality, watched.endpoint
    found = []
    if isinstance(endpoint, DataReader):
        incompatible = endpoint.get_requested_incompatible_qos_status()
        missed = endpoint.get_requested_deadline_missed_status()
        alive = endpoint.get_liveliness_changed_status()
        if alive.not_alive_count_change > 0:
            detail = f"a publisher has not shown for {quality.liveliness or 0:g} s that it is alive"
            found.append(StatusChange(topic, "liveliness", alive.not_alive_count, detail))
        done = "received"
    else:
        incompatible = endpoint.get_offered_incompatible_qos_status()
        missed = endpoint.get_offered_deadline_missed_status()
        lost = endpoint.get_liveliness_lost_status()
        if lost.total_count_change > 0:
            detail = f"this publisher has not shown for {quality.liveliness or 0:g} s that it is alive"
            found.append(StatusChange(topic, "liveliness", lost.total_count, detail))
        done = "published"
    if incompatible.total_count_change > 0:
        policy = _POLICIES.get(incompatible.last_policy_id, f"policy {incompatible.last_policy_id}")
        found.append(StatusChange(topic, "incompatible", incompatible.total_count, policy))
    if missed.total_count_change > 0:
        detail = f"no sample {done} within its deadline of {quality.deadline or 0:g} s"
        found.append(StatusChange(topic, "deadline", missed.total_count, detail))
    return found


# What cyclonedds knows of the types of its peers.
#
# Programs that use Cyclone DDS tell with each endpoint a number for its type (DDS-XTypes), and DDS itself fetches from
# them what it stands for. cyclonedds for Python makes a class of it; here it becomes the description that ROS 2 has.

_PRIMITIVES: dict[str, Basename] = {
    "int8": "int8",
    "int16": "int16",
    "int32": "int32",
    "int64": "int64",
    "uint8": "uint8",
    "byte": "uint8",
    "uint16": "uint16",
    "uint32": "uint32",
    "uint64": "uint64",
    "float32": "float32",
    "float64": "float64",
}


def fetch_description(participant: DomainParticipant, type_id: TypeIdentifier, within: float) -> TypeDescription:
    """Return the description of the type with this number, fetched within so many seconds.

    It blocks, so call it on a thread of its own. Raises BadDescriptionError for what ROS 2 does not have, and when
    nobody tells.
    """
    try:
        struct, _ = get_types_for_typeid(participant, type_id, duration(seconds=within))
    except DDSException as error:
        raise BadDescriptionError(f"nobody tells it: {error}") from error
    except Exception as error:
        # The library builds classes of whatever a peer sends, and fails in many ways when that is nonsense.
        raise BadDescriptionError(f"it cannot be read: {error!r}") from error
    return description_of(struct)


def description_of(struct: type[IdlStruct]) -> TypeDescription:
    """Return the description of an IDL class; raises BadDescriptionError for what ROS 2 does not have."""
    fields: dict[str, Fielddefs] = {}
    return describe(fields, _struct(struct, fields))


def _struct(struct: type[IdlStruct], found: dict[str, Fielddefs]) -> str:
    """Enter the fields of a class and of those within it into `found`, and return its ROS 2 name."""
    dds_name = struct.__idl_typename__.replace(".", "::")
    name = names.ros_type(dds_name)
    if name == dds_name:
        raise BadDescriptionError(f"{dds_name} is no type of ROS 2")
    if name not in found:
        found[name] = []
        found[name] = [(field, _field(kind, found)) for field, kind in struct.__annotations__.items()]
    return name


def _field(kind: object, found: dict[str, Fielddefs]) -> FieldDesc:
    detail = get_args(kind)[-1] if get_args(kind) else None
    if isinstance(detail, types.array):
        return (Nodetype.ARRAY, (_single(detail.subtype, found), detail.length))
    if isinstance(detail, types.sequence):
        return (Nodetype.SEQUENCE, (_single(detail.subtype, found), detail.max_length or 0))
    return _single(kind, found)


def _single(kind: object, found: dict[str, Fielddefs]) -> BaseDesc | NameDesc:
    detail = get_args(kind)[-1] if get_args(kind) else None
    if kind is bool:
        return (Nodetype.BASE, ("bool", 0))
    if kind is str:
        return (Nodetype.BASE, ("string", 0))
    if isinstance(detail, types.bounded_str):
        return (Nodetype.BASE, ("string", detail.max_length))
    if isinstance(detail, str) and detail in _PRIMITIVES:
        return (Nodetype.BASE, (_PRIMITIVES[detail], 0))
    if isinstance(kind, type) and issubclass(kind, IdlStruct):
        return (Nodetype.NAME, _struct(kind, found))
    raise BadDescriptionError(f"ROS 2 has no fields of {kind}")


# ROS 2's qualities of service as DDS policies.

_INFINITE = duration(infinite=True)
_RELIABLE = Policy.Reliability.Reliable(max_blocking_time=_INFINITE)


def endpoint_qos(qos: QualityOfService, user_data: bytes = b"") -> Qos:
    """Return the policies of a reader or writer that ROS 2 would give it, with `user_data` for its peers to read."""
    history = Policy.History.KeepLast(qos.depth)
    policies = [
        _RELIABLE if qos.reliable else Policy.Reliability.BestEffort,
        history,
        # ROS 2 writes the first version of XCDR only.
        Policy.DataRepresentation(use_cdrv0_representation=True),
        # A publisher that leaves says nothing about its last sample.
        Policy.WriterDataLifecycle(autodispose=False),
    ]
    if qos.transient_local:
        policies += [Policy.Durability.TransientLocal, Policy.DurabilityService(0, history, -1, -1, -1)]
    if qos.deadline is not None:
        policies.append(Policy.Deadline(duration(seconds=qos.deadline)))
    if qos.liveliness is not None:
        policies.append(Policy.Liveliness.Automatic(duration(seconds=qos.liveliness)))
    if user_data:
        policies.append(Policy.Userdata(user_data))
    return Qos(*policies)


def discovery_qos(user_data: bytes, *, reader: bool) -> Qos:
    """Return the policies of `ros_discovery_info`, on which participants tell their nodes."""
    history = Policy.History.KeepAll if reader else Policy.History.KeepLast(1)
    return Qos(
        _RELIABLE,
        history,
        Policy.Durability.TransientLocal,
        Policy.DurabilityService(0, Policy.History.KeepLast(1), -1, -1, -1),
        Policy.DataRepresentation(use_cdrv0_representation=True),
        Policy.WriterDataLifecycle(autodispose=False),
        Policy.Userdata(user_data),
    )


def user_data(qos: Qos) -> bytes:
    """Return what a peer wrote into its user data."""
    return qos[Policy.Userdata].data if Policy.Userdata in qos else b""


def deadline(qos: Qos) -> float | None:
    """Return how often (s) a peer sends or wants a sample; None when it says nothing of that."""
    return _seconds(qos[Policy.Deadline].deadline) if Policy.Deadline in qos else None


def liveliness(qos: Qos) -> float | None:
    """Return how often (s) a peer shows that it is alive, or wants that shown; None when it says nothing of that."""
    # Asked for by one class, the library finds the policy of any kind.
    kind = Policy.Liveliness.Automatic
    return _seconds(qos[kind].lease_duration) if kind in qos else None


def _seconds(nanoseconds: int) -> float | None:
    return None if nanoseconds >= _INFINITE else nanoseconds / 1e9


def is_reliable(qos: Qos) -> bool:
    """Return whether a peer sends lost samples again, or wants them again."""
    return Policy.Reliability.BestEffort not in qos


def is_transient_local(qos: Qos) -> bool:
    """Return whether a peer keeps samples for late joiners, or wants the kept ones."""
    return Policy.Durability.Volatile not in qos


# Who is on the DDS network.
#
# DDS announces every endpoint with its topic, type and policies on built-in topics, and `discovery_info` says to which
# node it belongs. We publish that too, which makes this process a node that `ros2 node list` shows.

_CHUNK = 256


class Discovery:
    """The endpoints and nodes of one domain, as seen by one participant, and this participant as others see it."""

    def __init__(
        self, participant: DomainParticipant, registry: MessageRegistry, raw: type[RawSample], node_name: str
    ) -> None:
        self._registry = registry
        self._raw = raw
        self._node_name = node_name
        self._own = participant.guid
        self._builtin: dict[Direction, BuiltinDataReader] = {
            "publisher": BuiltinDataReader(participant, BuiltinTopicDcpsPublication),
            "subscriber": BuiltinDataReader(participant, BuiltinTopicDcpsSubscription),
        }
        self._known: dict[Direction, dict[UUID, DcpsEndpoint]] = {"publisher": {}, "subscriber": {}}
        self._nodes: dict[UUID, dict[UUID, str]] = {}  # participant -> endpoint -> node
        self._made: dict[UUID, NetworkEndpoint] = {}  # by endpoint
        self._topic = Topic(participant, discovery_info.TOPIC, raw)
        # Peers look for a hash at endpoints of every topic, and warn where there is none.
        data = names.type_hash_user_data(registry.type_hash(discovery_info.TYPE_NAME))
        self._reader = DataReader(participant, self._topic, discovery_qos(data, reader=True))
        self._writer = DataWriter(participant, self._topic, discovery_qos(data, reader=False))

    @property
    def own_endpoints(self) -> tuple[DataReader[RawSample], DataWriter[RawSample]]:
        """The endpoints by which participants tell one another their nodes."""
        return self._reader, self._writer

    def announce(self, readers: Iterable[UUID], writers: Iterable[UUID]) -> None:
        """Tell the network that these endpoints belong to this participant's node."""
        note = discovery_info.encode(self._registry, self._own, self._node_name, readers, writers)
        self._writer.write(self._raw(note))

    def endpoints(self) -> list[NetworkEndpoint]:
        """Return the endpoints of ROS 2 topics that are on the network now."""
        self._look()
        return [
            self._endpoint(topic, direction, seen)
            for direction, known in self._known.items()
            for seen in known.values()
            if (topic := names.ros_topic(seen.topic_name)) is not None
        ]

    def services_now(self, services: Collection[str]) -> list[ServiceEnd]:
        """Return the servers and clients of these services that are on the network now."""
        self._look()
        return self.services(set(map(names.dds_requests, services)))

    def services(self, among: Container[str] | None = None) -> list[ServiceEnd]:
        """Return the servers and clients of ROS 2 services that were on the network at the last look at endpoints.

        With `among`, those alone whose DDS topic of requests is among these.
        """
        return [
            ServiceEnd(
                *service,
                "server" if direction == "subscriber" else "client",
                seen.participant_key == self._own,
                self._node(seen),
                vendor_of(seen.participant_key),
                names.tells_mapping(user_data(seen.qos)),
            )
            for direction, known in self._known.items()
            for seen in known.values()
            if among is None or seen.topic_name in among
            if (service := names.ros_service(seen.topic_name, seen.type_name)) is not None
        ]

    def told_on(self, dds_topic: str) -> list[bytes]:
        """Return the user data of all publishers of a topic of DDS, whether or not its readers here match them."""
        self._refresh("publisher")
        return [user_data(seen.qos) for seen in self._known["publisher"].values() if seen.topic_name == dds_topic]

    def type_id(self, endpoint: NetworkEndpoint) -> TypeIdentifier | None:
        """Return the number that foreign endpoints like this one tell for their type, or None when they tell none."""
        self._refresh(endpoint.direction)
        for seen in self._known[endpoint.direction].values():
            is_there = seen.type_id is not None and names.ros_topic(seen.topic_name) == endpoint.topic
            if is_there and self._endpoint(endpoint.topic, endpoint.direction, seen) == endpoint:
                return seen.type_id
        return None

    def close(self) -> None:
        """Delete the entities of discovery."""
        for entity in (*self._builtin.values(), self._reader, self._writer, self._topic):
            release(entity)

    def _node(self, seen: DcpsEndpoint) -> str | None:
        return self._nodes.get(seen.participant_key, {}).get(seen.key)

    def _endpoint(self, topic: str, direction: Direction, seen: DcpsEndpoint) -> NetworkEndpoint:
        """Return what is told of an endpoint, made once: the graph is asked for every second."""
        made, node = self._made.get(seen.key), self._node(seen)
        if made is None or made.node != node:
            made = self._made[seen.key] = NetworkEndpoint(
                topic=topic,
                type_name=names.ros_type(seen.type_name),
                direction=direction,
                own=seen.participant_key == self._own,
                type_hash=names.type_hash_of(user_data(seen.qos)),
                node=node,
                reliable=is_reliable(seen.qos),
                transient_local=is_transient_local(seen.qos),
                deadline=deadline(seen.qos),
                liveliness=liveliness(seen.qos),
                vendor=vendor_of(seen.participant_key),
            )
        return made

    def _refresh(self, direction: Direction) -> None:
        """Take the announcements that have come since the last time."""
        known, reader = self._known[direction], self._builtin[direction]
        while True:
            taken = reader.take(_CHUNK)
            for seen in taken:
                self._made.pop(seen.key, None)
                if seen.sample_info.valid_data and seen.sample_info.instance_state == InstanceState.Alive:
                    known[seen.key] = seen
                else:
                    known.pop(seen.key, None)
            if len(taken) < _CHUNK:
                return

    def _look(self) -> None:
        """Take all that was announced since the last time."""
        # In this order: a participant announces its nodes once, and what it is known by before that. One that comes
        # while endpoints are taken would have said its nodes too early, and would have no names from then on.
        self._take_nodes()
        for direction in self._known:
            self._refresh(direction)
        present = {seen.participant_key for known in self._known.values() for seen in known.values()}
        self._nodes = {participant: nodes for participant, nodes in self._nodes.items() if participant in present}

    def _take_nodes(self) -> None:
        for sample in take_all(self._reader):
            try:
                participant, nodes = discovery_info.decode(self._registry, sample.data)
            except MalformedMessageError as error:
                _log.debug("a participant announces its nodes in a form unknown here", reason=str(error))
                continue
            self._nodes[participant] = nodes
