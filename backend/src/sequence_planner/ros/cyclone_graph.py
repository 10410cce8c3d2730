"""Who is on the DDS network.

DDS announces every endpoint with its topic, type and policies on built-in topics, and `discovery_info` says to which
node it belongs. We publish that too, which makes this process a node that `ros2 node list` shows.
"""

from __future__ import annotations

from collections.abc import Collection, Container, Iterable
from uuid import UUID

import structlog
from cyclonedds.builtin import (
    BuiltinDataReader,
    BuiltinTopicDcpsPublication,
    BuiltinTopicDcpsSubscription,
    DcpsEndpoint,
)
from cyclonedds.core import InstanceState
from cyclonedds.domain import DomainParticipant
from cyclonedds.dynamic import TypeIdentifier
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

from sequence_planner.ros import discovery_info, names
from sequence_planner.ros.cyclone_network import release
from sequence_planner.ros.cyclone_qos import (
    deadline,
    discovery_qos,
    is_reliable,
    is_transient_local,
    liveliness,
    user_data,
)
from sequence_planner.ros.cyclone_receiver import take_all
from sequence_planner.ros.cyclone_types import RawSample
from sequence_planner.ros.messages import MalformedMessageError, MessageRegistry
from sequence_planner.ros.service_graph import ServiceEnd
from sequence_planner.ros.transport import Direction, Endpoint
from sequence_planner.ros.vendors import vendor_of

_log = structlog.get_logger(__name__)

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
        self._made: dict[UUID, Endpoint] = {}  # by endpoint
        self._topic = Topic(participant, discovery_info.TOPIC, raw)
        # Peers look for a hash at endpoints of every topic, and warn where there is none.
        data = names.type_hash_user_data(registry.type_hash(discovery_info.TYPE_NAME))
        self._reader = DataReader(participant, self._topic, discovery_qos(data, reader=True))
        self._writer = DataWriter(participant, self._topic, discovery_qos(data, reader=False))

    def announce(self, readers: Iterable[UUID], writers: Iterable[UUID]) -> None:
        """Tell the network that these endpoints belong to this participant's node."""
        note = discovery_info.encode(self._registry, self._own, self._node_name, readers, writers)
        self._writer.write(self._raw(note))

    def endpoints(self) -> list[Endpoint]:
        """Return the endpoints of ROS 2 topics that are on the network now."""
        for direction in self._known:
            self._refresh(direction)
        self._refresh_nodes()
        return [
            self._endpoint(topic, direction, seen)
            for direction, known in self._known.items()
            for seen in known.values()
            if (topic := names.ros_topic(seen.topic_name)) is not None
        ]

    def services_now(self, services: Collection[str]) -> list[ServiceEnd]:
        """Return the servers and clients of these services that are on the network now."""
        for direction in self._known:
            self._refresh(direction)
        self._refresh_nodes()
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

    def type_id(self, endpoint: Endpoint) -> TypeIdentifier | None:
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

    def _endpoint(self, topic: str, direction: Direction, seen: DcpsEndpoint) -> Endpoint:
        """Return what is told of an endpoint, made once: the graph is asked for every second."""
        made, node = self._made.get(seen.key), self._node(seen)
        if made is None or made.node != node:
            made = self._made[seen.key] = Endpoint(
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

    def _refresh_nodes(self) -> None:
        for sample in take_all(self._reader):
            try:
                participant, nodes = discovery_info.decode(self._registry, sample.data)
            except MalformedMessageError as error:
                _log.debug("a participant announces its nodes in a form unknown here", reason=str(error))
                continue
            self._nodes[participant] = nodes
        present = {seen.participant_key for known in self._known.values() for seen in known.values()}
        self._nodes = {participant: nodes for participant, nodes in self._nodes.items() if participant in present}
