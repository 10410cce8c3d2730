"""The message types of a station: which there are, their fields, their bytes and their hashes.

A type is known either from ROS 2 Jazzy's standard packages or from the station's own `messages/<package>/msg/*.msg`.
Its values travel as CDR (the encoding of DDS), and its hash (RIHS01 of REP 2016) tells whether a peer was built with
the same definition: peers match on the name alone, and a stale definition silently loses or garbles every sample.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from rosbags.interfaces import Nodetype
from rosbags.serde import SerdeError
from rosbags.typesys import Stores, TypesysError, get_typestore
from rosbags.typesys.store import Typestore

from sequence_planner.ros import names, values
from sequence_planner.ros.definitions import Definition, FieldDeclaration, read_definitions
from sequence_planner.ros.errors import (
    MalformedMessageError,
    MessageDefinitionError,
    MessageValueError,
    UnknownMessageTypeError,
)
from sequence_planner.ros.fields import PLACEHOLDER, FieldType, field_type
from sequence_planner.ros.nesting import check_references

if TYPE_CHECKING:
    from rosbags.interfaces.typing import BaseDesc, Fielddefs, FieldDesc, NameDesc

__all__ = [
    "FieldType",
    "MalformedMessageError",
    "MessageDefinitionError",
    "MessageRegistry",
    "MessageValueError",
    "UnknownMessageTypeError",
]

#: The defaults other than zero in Jazzy's standard packages, which rosbags does not keep.
_STANDARD_DEFAULTS: dict[str, dict[str, object]] = {
    "geometry_msgs/msg/Quaternion": {"w": 1.0},
    "sensor_msgs/msg/NavSatStatus": {"status": -2},
}

#: The types that are uint8 on the wire.
_ON_THE_WIRE = {"char", "byte"}


class MessageRegistry:
    """All message types that a station can use, written `package/msg/Name`."""

    def __init__(self) -> None:
        self._store = get_typestore(Stores.ROS2_JAZZY)
        self._defaults = dict(_STANDARD_DEFAULTS)
        # Hashes are made from the declared types, so they have a store of their own.
        self._declared = Typestore()
        for name, (_, fields) in list(self._store.fielddefs.items()):
            self._declare(name, fields)
        self._shape = cache(self._find_shape)
        self._hash = cache(self._declared.hash_rihs01)

    @classmethod
    def from_folder(cls, messages_dir: Path | None) -> MessageRegistry:
        """Return the standard types and those of `messages_dir`, which holds `<package>/msg/<Name>.msg`.

        Raises MessageDefinitionError for a definition that cannot be used, with its file and line.
        """
        registry = cls()
        if messages_dir is not None:
            registry._add(list(read_definitions(messages_dir)))
        return registry

    def type_names(self) -> list[str]:
        """Return the names of all known types, sorted."""
        return sorted(self._store.fielddefs)

    def fields(self, type_name: str) -> dict[str, FieldType]:
        """Return the fields of a type in their order; raises UnknownMessageTypeError."""
        return {name: field for name, field in self._shape(type_name).fields.items() if name != PLACEHOLDER}

    def type_hash(self, type_name: str) -> str:
        """Return the hash of a type, `RIHS01_` and 64 hexadecimal digits; raises UnknownMessageTypeError."""
        self._shape(type_name)
        return self._hash(type_name)

    def dds_name(self, type_name: str) -> str:
        """Return the name of a type in DDS; raises UnknownMessageTypeError."""
        self._shape(type_name)
        return names.dds_type(type_name)

    def encode(self, type_name: str, fields: Mapping[str, object]) -> bytes:
        """Return the CDR bytes (header included) of a message with these field values.

        A field left out has its declared default, else zero or empty. Raises MessageValueError for a value that does
        not fit its field exactly (an integer serves as a float), and UnknownMessageTypeError.
        """
        message = values.build(self._shape, type_name, fields)
        return bytes(self._store.serialize_cdr(message, type_name, little_endian=True))

    def decode(self, type_name: str, data: bytes) -> dict[str, object]:
        """Return the field values of the CDR bytes `data`, which may carry up to three bytes of padding.

        Raises MalformedMessageError when they are not such a message, and UnknownMessageTypeError.
        """
        self._shape(type_name)
        try:
            message = self._store.deserialize_cdr(data, type_name)
        except (SerdeError, IndexError) as error:
            raise MalformedMessageError(type_name, str(error)) from error
        return values.read(self._shape, type_name, message)

    def _find_shape(self, type_name: str) -> values.MessageShape:
        if type_name not in self._store.fielddefs:
            raise UnknownMessageTypeError(type_name, self._store.fielddefs)
        fields = {name: field_type(description) for name, description in self._store.fielddefs[type_name][1]}
        return values.MessageShape(type_name, fields, self._defaults.get(type_name, {}), self._store.types[type_name])

    def _add(self, definitions: list[Definition]) -> None:
        check_references(definitions, set(self._store.fielddefs))
        for definition in definitions:
            # Constants are for people and code generators; nothing on the wire has them.
            fields = [(field.name, field.description) for field in definition.fields]
            if not fields:
                fields = [(PLACEHOLDER, (Nodetype.BASE, ("uint8", 0)))]
            try:
                self._store.register({definition.type_name: ([], _as_uint8(fields, _ON_THE_WIRE))})
            except TypesysError as error:
                text = f"{definition.type_name} differs from the standard one; give the package another name"
                raise MessageDefinitionError(definition.path, 1, text) from error
            self._declare(definition.type_name, fields)
            self._defaults[definition.type_name] = {}
        for definition in definitions:
            for field in definition.fields:
                if field.default is not None:
                    self._set_default(definition, field)

    def _declare(self, type_name: str, fields: Fielddefs) -> None:
        """Enter a type: for hashes as rosidl sees it, to which `char` is uint8; for the codec as it is on the wire."""
        self._declared.fielddefs[type_name] = ([], _as_uint8(fields, {"char"}))
        # rosbags would read `byte` as signed.
        self._store.fielddefs[type_name] = ([], _as_uint8(fields, _ON_THE_WIRE))

    def _set_default(self, definition: Definition, field: FieldDeclaration) -> None:
        wanted = field_type(field.description)
        default: object = field.default
        if wanted.kind == "bool" and wanted.array is None and default in (0, 1):
            default = bool(default)  # `bool ready 1` is allowed
        try:
            values.build(self._shape, definition.type_name, {field.name: default})
        except MessageValueError as error:
            text = f"the default of {field.name} should be {error.expected}, not {error.found!r}"
            raise MessageDefinitionError(definition.path, field.line, text) from error
        self._defaults[definition.type_name][field.name] = default


def _as_uint8(fields: Fielddefs, names_of_uint8: set[str]) -> Fielddefs:
    uint8: BaseDesc = (Nodetype.BASE, ("uint8", 0))

    def single(description: BaseDesc | NameDesc) -> BaseDesc | NameDesc:
        return uint8 if description[0] == Nodetype.BASE and description[1][0] in names_of_uint8 else description

    def any_of(description: FieldDesc) -> FieldDesc:
        if description[0] == Nodetype.BASE or description[0] == Nodetype.NAME:
            return single(description)
        inner, size = description[1]
        return (description[0], (single(inner), size))

    return [(name, any_of(description)) for name, description in fields]
