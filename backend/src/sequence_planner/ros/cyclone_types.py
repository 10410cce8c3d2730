"""Raw CDR through cyclonedds.

cyclonedds for Python turns samples into bytes with classes generated from IDL, which is slow for large messages and
would be a second codec beside ours. But it only ever asks a class for `__idl__`, `serialize` and `deserialize`, so a
class that has them and holds the bytes themselves sends and receives raw CDR. Its `__idl__` describes the true fields
all the same: cyclonedds peers compare it, and do not match when the definitions differ.
"""

from __future__ import annotations

from typing import ClassVar, Protocol, Self

from cyclonedds.idl import IdlStruct, make_idl_struct, types
from cyclonedds.internal import SampleInfo

from sequence_planner.ros.fields import PLACEHOLDER, FieldType
from sequence_planner.ros.messages import MessageRegistry

_PRIMITIVES: dict[str, object] = {
    "bool": bool,
    "byte": types.uint8,
    "string": str,
    "float32": types.float32,
    "float64": types.float64,
    "int8": types.int8,
    "int16": types.int16,
    "int32": types.int32,
    "int64": types.int64,
    "uint8": types.uint8,
    "uint16": types.uint16,
    "uint32": types.uint32,
    "uint64": types.uint64,
}


class RawSample:
    """CDR bytes, header included, in the form cyclonedds hands about. Each message type has its subclass."""

    __idl__: ClassVar[object]
    __slots__ = ("data", "sample_info")
    sample_info: SampleInfo

    def __init__(self, data: bytes) -> None:
        self.data = data

    def serialize(self, use_version_2: bool | None = None) -> bytes:
        """Return the bytes as they are."""
        return self.data

    @classmethod
    def deserialize(cls, data: bytes) -> Self:
        """Return a sample of the bytes as they are."""
        return cls(data)

    @classmethod
    def deserialize_key(cls, data: bytes) -> Self:
        """Return a sample of the bytes of a key; ROS 2 has no keys, so there is nothing in it."""
        return cls(data)


#: What Cyclone's mapping of services puts before a request or a response: whose call it is, and the number of the call.
#: ROS 2 has no field with two underscores, so these names are free.
_CALL_HEADER: dict[str, object] = {"call__client": types.uint64, "call__number": types.int64}


class RawTypes(Protocol):
    """Gives a message type its class, made on first use; raises UnknownMessageTypeError.

    With `called`, it is that of a request or response, before which the header of a call stands.
    """

    def __call__(self, type_name: str, *, called: bool = False) -> type[RawSample]:
        """Return the class."""


def raw_types(registry: MessageRegistry) -> RawTypes:
    """Return the function that gives the types of `registry` their classes."""
    structs: dict[str, type[IdlStruct]] = {}
    classes: dict[tuple[str, bool], type[RawSample]] = {}

    def struct(type_name: str) -> type[IdlStruct]:
        if type_name not in structs:
            structs[type_name] = made(type_name, {})
        return structs[type_name]

    def made(type_name: str, header: dict[str, object]) -> type[IdlStruct]:
        fields = {name: annotation(field) for name, field in registry.fields(type_name).items()}
        dotted = registry.dds_name(type_name).replace("::", ".")
        # As a dataclass it could not have a field named like a Python keyword, and nobody makes an instance of it.
        name = type_name.replace("/", "__")
        return make_idl_struct(name, dotted, header | (fields or {PLACEHOLDER: types.uint8}), dataclassify=False)

    def annotation(field: FieldType) -> object:
        element: object
        if field.kind == "message":
            element = struct(field.type_name)
        elif field.max_length:
            element = types.bounded_str[field.max_length]
        else:
            element = _PRIMITIVES[field.type_name]
        if field.array is None:
            return element
        if field.array == "sequence":
            return types.sequence[element, field.max_items] if field.max_items else types.sequence[element]
        return types.array[element, field.array]

    def raw(type_name: str, *, called: bool = False) -> type[RawSample]:
        key = (type_name, called)
        if key not in classes:
            idl = (made(type_name, _CALL_HEADER) if called else struct(type_name)).__idl__
            classes[key] = type(type_name.replace("/", "__"), (RawSample,), {"__idl__": idl, "__slots__": ()})
        return classes[key]

    return raw
