"""The message types of a station: which there are, their fields, their bytes and their hashes.

A type is known either from ROS 2 Jazzy's standard packages or from the station's own `messages/<package>`, where
`msg/*.msg`, `srv/*.srv` and `action/*.action` lie; what ROS 2 derives from services and actions is known with them.
Its values travel as CDR (the encoding of DDS), and its hash (RIHS01 of REP 2016) tells whether a peer was built with
the same definition: peers match on the name alone, and a stale definition silently loses or garbles every sample.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from rosbags.serde import SerdeError
from rosbags.typesys import TypesysError
from rosbags.typesys.store import Typestore

from sequence_planner.ros import names, values
from sequence_planner.ros.definitions import Definition, FieldDeclaration, Interface, read_interfaces
from sequence_planner.ros.derived import ActionType, ServiceType, derived_of
from sequence_planner.ros.errors import (
    MalformedMessageError,
    MessageDefinitionError,
    MessageValueError,
    UnknownMessageTypeError,
)
from sequence_planner.ros.fields import ON_THE_WIRE, PLACEHOLDER, FieldType, as_uint8, carried, field_type
from sequence_planner.ros.nesting import check_references
from sequence_planner.ros.standard_types import standard_interfaces, standard_store
from sequence_planner.ros.type_description import FoundType

if TYPE_CHECKING:
    from rosbags.interfaces.typing import Fielddefs, ScalarValue

__all__ = [
    "ActionType",
    "FieldType",
    "FoundType",
    "MalformedMessageError",
    "MessageDefinitionError",
    "MessageRegistry",
    "MessageValueError",
    "ServiceType",
    "UnknownMessageTypeError",
]

#: The defaults other than zero in Jazzy's standard packages, which rosbags does not keep.
_STANDARD_DEFAULTS: dict[str, dict[str, object]] = {
    "geometry_msgs/msg/Quaternion": {"w": 1.0},
    "sensor_msgs/msg/NavSatStatus": {"status": -2},
}


class MessageRegistry:
    """All message types that a station can use, written `package/msg/Name`."""

    def __init__(self) -> None:
        self._store = standard_store()
        self._defaults = dict(_STANDARD_DEFAULTS)
        self._constants: dict[str, dict[str, ScalarValue]] = {}
        self._services: dict[str, ServiceType] = {}
        self._actions: dict[str, ActionType] = {}
        self._found: dict[str, FoundType] = {}
        # Hashes are made from the declared types, so they have a store of their own.
        self._declared = Typestore()
        for name, (constants, fields) in list(self._store.fielddefs.items()):
            self._constants[name] = {constant: value for constant, _, value in constants}
            self._declare(name, fields)
        self._shape = cache(self._find_shape)
        self._hash = cache(self._declared.hash_rihs01)
        self._add(standard_interfaces())

    @classmethod
    def from_folder(cls, messages_dir: Path | None) -> MessageRegistry:
        """Return the standard types and those of `messages_dir`.

        It holds `<package>/msg/<Name>.msg`, and `srv` and `action` likewise. Raises MessageDefinitionError for a
        definition that cannot be used, with its file, line and column.
        """
        registry = cls()
        if messages_dir is not None:
            registry._add(tuple(read_interfaces(messages_dir)))
        return registry

    def type_names(self) -> list[str]:
        """Return the names of all known messages (`package/msg/Name`), sorted; parts of services are left out."""
        return sorted(name for name in self._store.fielddefs if name.split("/")[1] == "msg")

    def service_names(self) -> list[str]:
        """Return the names of all known services (`package/srv/Name`), sorted; those of actions are left out."""
        return sorted(name for name in self._services if name.split("/")[1] == "srv")

    def action_names(self) -> list[str]:
        """Return the names of all known actions (`package/action/Name`), sorted."""
        return sorted(self._actions)

    def service(self, type_name: str) -> ServiceType:
        """Return the messages of a service, those of actions among them; raises UnknownMessageTypeError."""
        if type_name not in self._services:
            raise UnknownMessageTypeError(type_name, self._services, "service")
        return self._services[type_name]

    def action(self, type_name: str) -> ActionType:
        """Return the messages and services of an action; raises UnknownMessageTypeError."""
        if type_name not in self._actions:
            raise UnknownMessageTypeError(type_name, self._actions, "action")
        return self._actions[type_name]

    def constants(self, type_name: str) -> dict[str, ScalarValue]:
        """Return the constants of a message by name, as enumerations use them; raises UnknownMessageTypeError."""
        self._shape(type_name)
        return dict(self._constants.get(type_name, {}))

    def fields(self, type_name: str) -> dict[str, FieldType]:
        """Return the fields of a type in their order; raises UnknownMessageTypeError."""
        return {name: field for name, field in self._shape(type_name).fields.items() if name != PLACEHOLDER}

    def type_hash(self, type_name: str) -> str:
        """Return the hash of a message, service or action, `RIHS01_` and 64 hexadecimal digits.

        Raises UnknownMessageTypeError.
        """
        if type_name not in self._declared.fielddefs:
            raise UnknownMessageTypeError(type_name, self._declared.fielddefs)
        return self._hash(type_name)

    def dds_name(self, type_name: str) -> str:
        """Return the name of a type in DDS; raises UnknownMessageTypeError."""
        self._shape(type_name)
        return names.dds_type(type_name)

    def declared(self) -> dict[str, Fielddefs]:
        """Return the fields of every message, service and action as type hashes see them."""
        return {name: fields for name, (_, fields) in self._declared.fielddefs.items()}

    def found(self) -> dict[str, FoundType]:
        """Return the types that were found on the network, by name."""
        return dict(self._found)

    def enter_found(self, types: Mapping[str, Fielddefs], source: str) -> dict[str, FoundType]:
        """Enter types that `source` has described, none of which may be known; `found_types` sees to that."""
        for name, fields in types.items():
            self._register(name, fields)
        found = {name: FoundType(name, self._hash(name), source) for name in types}
        self._found |= found
        return found

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
            return values.read(self._shape, type_name, self._store.deserialize_cdr(data, type_name))
        except (SerdeError, IndexError, MessageValueError) as error:
            raise MalformedMessageError(type_name, str(error)) from error

    def _find_shape(self, type_name: str) -> values.MessageShape:
        if type_name not in self._store.fielddefs:
            raise UnknownMessageTypeError(type_name, self._store.fielddefs)
        fields = {name: field_type(description) for name, description in self._store.fielddefs[type_name][1]}
        return values.MessageShape(type_name, fields, self._defaults.get(type_name, {}), self._store.types[type_name])

    def _add(self, interfaces: tuple[Interface, ...]) -> None:
        definitions = [message for interface in interfaces for message in interface.messages]
        check_references(definitions, set(self._store.fielddefs))
        for definition in definitions:
            fields = [(field.name, field.description) for field in definition.fields]
            try:
                self._register(definition.type_name, fields)
            except TypesysError as error:
                text = f"{definition.type_name} differs from the standard one; give the package another name"
                raise MessageDefinitionError(definition.path, 1, text) from error
            self._defaults[definition.type_name] = {}
            self._constants[definition.type_name] = {c.name: c.value for c in definition.constants}
        for interface in interfaces:
            self._derive(interface)
        for definition in definitions:
            for field in definition.fields:
                if field.default is not None:
                    self._set_default(definition, field)

    def _derive(self, interface: Interface) -> None:
        name = interface.type_name
        if interface.kind == "srv":
            self._services[name] = ServiceType(name)
        elif interface.kind == "action":
            action = self._actions[name] = ActionType(name)
            self._services |= {service.type_name: service for service in (action.send_goal, action.get_result)}
        derived = derived_of(interface)
        for message, fields in derived.messages.items():
            self._register(message, fields)
        for structure, fields in derived.structures.items():
            self._declared.fielddefs[structure] = ([], fields)

    def _register(self, type_name: str, fields: Fielddefs) -> None:
        """Enter a message; raises TypesysError when one of this name is known and differs."""
        # Constants are for people and code generators; nothing on the wire has them.
        fields = carried(fields)
        wanted, known = as_uint8(fields, ON_THE_WIRE), self._store.fielddefs.get(type_name)
        if known is None or known[1] != wanted:
            self._store.register({type_name: ([], wanted)})
        self._declare(type_name, fields)

    def _declare(self, type_name: str, fields: Fielddefs) -> None:
        """Enter a type: for hashes as rosidl sees it, to which `char` is uint8; for the codec as it is on the wire."""
        self._declared.fielddefs[type_name] = ([], as_uint8(fields, {"char"}))
        # rosbags would read `byte` as signed.
        self._store.fielddefs[type_name] = ([], as_uint8(fields, ON_THE_WIRE))

    def _set_default(self, definition: Definition, field: FieldDeclaration) -> None:
        wanted = field_type(field.description)
        default: object = field.default
        if wanted.kind == "bool" and wanted.array is None and default in (0, 1):
            default = bool(default)  # `bool ready 1` is allowed
        try:
            values.build(self._shape, definition.type_name, {field.name: default})
        except MessageValueError as error:
            text = f"the default of {field.name} should be {error.expected}, not {error.found!r}"
            raise MessageDefinitionError(definition.path, field.line, text, field.column) from error
        self._defaults[definition.type_name][field.name] = default
