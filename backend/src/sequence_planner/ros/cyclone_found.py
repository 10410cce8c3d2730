"""What cyclonedds knows of the types of its peers.

Programs that use Cyclone DDS tell with each endpoint a number for its type (DDS-XTypes), and DDS itself fetches from
them what it stands for. cyclonedds for Python makes a class of it; here it becomes the description that ROS 2 has.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, get_args

from cyclonedds.core import DDSException
from cyclonedds.domain import DomainParticipant
from cyclonedds.dynamic import TypeIdentifier, get_types_for_typeid
from cyclonedds.idl import IdlStruct, types
from cyclonedds.util import duration
from rosbags.interfaces import Nodetype

from sequence_planner.ros import names
from sequence_planner.ros.type_description import BadDescriptionError, TypeDescription, describe

if TYPE_CHECKING:
    from rosbags.interfaces.typing import BaseDesc, Basename, Fielddefs, FieldDesc, NameDesc

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
