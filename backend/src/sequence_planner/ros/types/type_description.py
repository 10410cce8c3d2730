"""The way in which ROS 2 describes a type to who asks for it (REP 2016), and back.

A description holds the fields of the type and of all types within it, which is what its hash is made of; so whoever
knows the hash can tell a true description from any other. It has no constants, and its defaults are not used here.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING

from pydantic import BaseModel
from rosbags.interfaces import Nodetype
from rosbags.typesys.base import normalize_fieldname
from rosbags.typesys.store import Typestore

from sequence_planner.core.immutable import Immutable
from sequence_planner.ros.types.definitions import MAX_DEPTH

if TYPE_CHECKING:
    from rosbags.interfaces.typing import BaseDesc, Basename, Fielddefs, FieldDesc, NameDesc

#: What one message of a described type may hold when its sequences are empty: fixed arrays can be of any length.
MAX_VALUES = 10_000

_TYPE = re.compile(r"[a-z][a-z0-9_]*/(msg|srv|action)/[A-Za-z][A-Za-z0-9_]*")
_FIELD = re.compile(r"[A-Za-z][A-Za-z0-9_]*")

#: Primitive types by their numbers in type_description_interfaces/msg/FieldType.
_PRIMITIVES: dict[int, Basename] = {
    2: "int8",
    3: "uint8",
    4: "int16",
    5: "uint16",
    6: "int32",
    7: "uint32",
    8: "int64",
    9: "uint64",
    10: "float32",
    11: "float64",
    15: "bool",
    16: "byte",
    17: "string",
}
_NUMBERS = {name: number for number, name in _PRIMITIVES.items()}
_NESTED, _BOUNDED_STRING = 1, 21
_ARRAY, _BOUNDED_SEQUENCE, _SEQUENCE = 48, 96, 144  # added to the number of the element's type


class FoundType(Immutable):
    """A message type that no file defines: `source` has described it over the network, and `type_hash` proves it."""

    type_name: str
    type_hash: str
    source: str


class BadDescriptionError(ValueError):
    """A description of a type cannot be used; the text says why."""


class _FieldType(BaseModel):
    type_id: int
    capacity: int
    string_capacity: int
    nested_type_name: str


class _Field(BaseModel):
    name: str
    type: _FieldType


class _Type(BaseModel):
    type_name: str
    fields: list[_Field]


class TypeDescription(BaseModel):
    """type_description_interfaces/msg/TypeDescription."""

    type_description: _Type
    referenced_type_descriptions: list[_Type]


def describe(declared: Mapping[str, Fielddefs], type_name: str) -> TypeDescription:
    """Return the description of a type whose fields, and those of all types within it, are in `declared`."""
    within: set[str] = set()

    def visit(name: str) -> _Type:
        fields = [_Field(name=field, type=_described(description)) for field, description in declared[name]]
        for field in fields:
            if field.type.nested_type_name and field.type.nested_type_name not in within:
                within.add(field.type.nested_type_name)
                visit(field.type.nested_type_name)
        return _Type(type_name=name, fields=fields)

    main = visit(type_name)
    return TypeDescription(type_description=main, referenced_type_descriptions=[visit(name) for name in sorted(within)])


def read_description(description: TypeDescription, type_name: str) -> dict[str, Fielddefs]:
    """Return the fields of the type and of all types within it, by name.

    Raises BadDescriptionError unless they are those of `type_name`, and for a type that would have no end, or more than
    `MAX_VALUES` values when it is empty.
    """
    types = [description.type_description, *description.referenced_type_descriptions]
    described: dict[str, Fielddefs] = {}
    for each in types:
        if not _TYPE.fullmatch(each.type_name) or each.type_name in described:
            raise BadDescriptionError(f"{each.type_name!r} is no name of a type, or described twice")
        described[each.type_name] = [(_checked(field.name), _read(field.type)) for field in each.fields]
        if not each.fields or len({normalize_fieldname(field.name) for field in each.fields}) < len(each.fields):
            raise BadDescriptionError(f"{each.type_name} has no fields, or one of them twice")
    if types[0].type_name != type_name:
        raise BadDescriptionError(f"it describes {types[0].type_name}")
    _check_size(described, type_name)
    return described


def check_hash(described: Mapping[str, Fielddefs], type_name: str, type_hash: str) -> None:
    """Raise BadDescriptionError unless the types described make up one with this hash."""
    store = Typestore()
    store.fielddefs.update({name: ([], fields) for name, fields in described.items()})
    if (found := store.hash_rihs01(type_name)) != type_hash:
        raise BadDescriptionError(f"its hash is {found}, and the publisher tells {type_hash}")


def _check_size(described: Mapping[str, Fielddefs], type_name: str) -> None:
    sizes: dict[str, int] = {}

    def size(name: str, above: tuple[str, ...]) -> int:
        if name not in described:
            raise BadDescriptionError(f"{name} is used and not described")
        if name in above or len(above) >= MAX_DEPTH:
            raise BadDescriptionError(f"{name} stands within itself, or within more than {MAX_DEPTH} others")
        if name not in sizes:
            sizes[name] = sum(of(description, (*above, name)) for _, description in described[name])
            if sizes[name] > MAX_VALUES:
                raise BadDescriptionError(f"{name} has more than {MAX_VALUES} values")
        return sizes[name]

    def of(description: FieldDesc, above: tuple[str, ...]) -> int:
        if description[0] == Nodetype.BASE:
            return 1
        if description[0] == Nodetype.NAME:
            return size(description[1], above)
        inner, count = description[1]
        each = of(inner, above)
        return each * count if description[0] == Nodetype.ARRAY else 1

    size(type_name, ())


def _checked(name: str) -> str:
    if not _FIELD.fullmatch(name):
        raise BadDescriptionError(f"{name!r} is no name of a field")
    return name


def _described(description: FieldDesc) -> _FieldType:
    added = capacity = 0
    if description[0] == Nodetype.ARRAY:
        inner, capacity = description[1]
        added = _ARRAY
    elif description[0] == Nodetype.SEQUENCE:
        inner, capacity = description[1]
        added = _BOUNDED_SEQUENCE if capacity else _SEQUENCE
    else:
        inner = description
    number, string_capacity, nested = _NESTED, 0, ""
    if inner[0] == Nodetype.NAME:
        nested = inner[1]
    else:
        name, string_capacity = inner[1]
        number = _BOUNDED_STRING if string_capacity else _NUMBERS[name]
    return _FieldType(
        type_id=added + number, capacity=capacity, string_capacity=string_capacity, nested_type_name=nested
    )


def _read(described: _FieldType) -> FieldDesc:
    added, number = divmod(described.type_id - 1, _ARRAY)
    number += 1
    inner: BaseDesc | NameDesc
    if number == _NESTED:
        inner = (Nodetype.NAME, described.nested_type_name)
    elif number == _BOUNDED_STRING:
        inner = (Nodetype.BASE, ("string", described.string_capacity))
    elif number in _PRIMITIVES:
        inner = (Nodetype.BASE, (_PRIMITIVES[number], 0))
    else:
        raise BadDescriptionError(f"a field of the type {described.type_id}, which is not supported")
    match added * _ARRAY:
        case 0:
            return inner
        case 48 if described.capacity:
            return (Nodetype.ARRAY, (inner, described.capacity))
        case 96 if described.capacity:
            return (Nodetype.SEQUENCE, (inner, described.capacity))
        case 144:
            return (Nodetype.SEQUENCE, (inner, 0))
    raise BadDescriptionError(f"a field of the type {described.type_id}, which is not supported")
