"""ROS 2's note of which node an endpoint belongs to.

DDS has participants and endpoints and no nodes. So every participant of ROS 2 publishes on `ros_discovery_info` which
of its endpoints belong to which of its nodes, all named by their 16 byte GUIDs.
"""

from __future__ import annotations

from collections.abc import Iterable
from uuid import UUID

from pydantic import BaseModel

from sequence_planner.ros.types.messages import MessageRegistry

TOPIC = "ros_discovery_info"
TYPE_NAME = "rmw_dds_common/msg/ParticipantEntitiesInfo"


class _Gid(BaseModel):
    data: list[int]

    @classmethod
    def of(cls, guid: UUID) -> _Gid:
        return cls(data=list(guid.bytes))

    @property
    def guid(self) -> UUID:
        return UUID(bytes=bytes(self.data))


class _Node(BaseModel):
    node_namespace: str
    node_name: str
    reader_gid_seq: list[_Gid]
    writer_gid_seq: list[_Gid]


class _Announcement(BaseModel):
    gid: _Gid
    node_entities_info_seq: list[_Node]


def encode(
    registry: MessageRegistry, participant: UUID, node_name: str, readers: Iterable[UUID], writers: Iterable[UUID]
) -> bytes:
    """Return the note that a participant has one node, to which all these endpoints belong."""
    node = _Node(
        node_namespace="/",
        node_name=node_name,
        reader_gid_seq=[_Gid.of(guid) for guid in readers],
        writer_gid_seq=[_Gid.of(guid) for guid in writers],
    )
    announcement = _Announcement(gid=_Gid.of(participant), node_entities_info_seq=[node])
    return registry.encode(TYPE_NAME, announcement.model_dump())


def decode(registry: MessageRegistry, data: bytes) -> tuple[UUID, dict[UUID, str]]:
    """Return the participant of a note, and the node (as in `/cell/robot`) of each of its endpoints.

    Raises MalformedMessageError for bytes that are no such note.
    """
    announcement = _Announcement.model_validate(registry.decode(TYPE_NAME, data))
    nodes = {
        gid.guid: f"{node.node_namespace.rstrip('/')}/{node.node_name}"
        for node in announcement.node_entities_info_seq
        for gid in (*node.reader_gid_seq, *node.writer_gid_seq)
    }
    return announcement.gid.guid, nodes
