"""Message registry of a station: types, CDR serialization, type hashes, and conversion from and to dicts."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, TypeGuard

from rosbags.serde import SerdeError
from rosbags.typesys import TypesysError
from rosbags.typesys.base import normalize_fieldname
from rosbags.typesys.store import Typestore

from sequence_planner.core.immutable import Immutable
from sequence_planner.core.numerals import counted
from sequence_planner.ros import names
from sequence_planner.ros.types.definitions import (
    FLOAT32_MAX,
    ON_THE_WIRE,
    PLACEHOLDER,
    Definition,
    FieldDeclaration,
    FieldType,
    Interface,
    as_uint8,
    carried,
    check_references,
    field_type,
    read_interfaces,
)
from sequence_planner.ros.types.errors import (
    MalformedMessageError,
    MessageDefinitionError,
    MessageValueError,
    UnknownMessageTypeError,
    nearest,
)
from sequence_planner.ros.types.standard_types import (
    ActionType,
    ServiceType,
    derived_of,
    standard_interfaces,
    standard_store,
)
from sequence_planner.ros.types.type_description import FoundType

if TYPE_CHECKING:
    import numpy as np
    from rosbags.interfaces.typing import Fielddefs, ScalarValue

# Between dictionaries of plain values and message objects.
#
# rosbags turns message objects into CDR bytes, but trusts them: an integer given for a float is written as wrong bits
# without an error. So every value is checked against its field here, converted to exactly what rosbags expects, and a
# field left out gets its default. What comes back is plain again: bool, int, float, str, list and dict.

_DTYPES = {"byte": "uint8", "char": "uint8"}


class MessageShape(Immutable):
    """One message type: its fields in order, the defaults that are not zero, and the class that holds its values."""

    type_name: str
    fields: dict[str, FieldType]
    defaults: dict[str, object]
    new: Callable[..., object]


Shapes = Callable[[str], MessageShape]


def build(shapes: Shapes, type_name: str, values: Mapping[str, object]) -> object:
    """Return the message object of `type_name` with `values`; raises MessageValueError naming the field."""
    return _message(shapes, type_name, values, type_name, "")


def read(shapes: Shapes, type_name: str, message: object) -> dict[str, object]:
    """Return the plain values of a message object of `type_name`; raises MessageValueError where a bound is exceeded.

    rosbags does not look at the bounds of strings and sequences when it reads bytes.
    """
    return {
        name: _plain(shapes, field, getattr(message, normalize_fieldname(name)))
        for name, field in shapes(type_name).fields.items()
        if name != PLACEHOLDER
    }


def _message(shapes: Shapes, type_name: str, values: object, root: str, path: str) -> object:
    shape = shapes(type_name)
    if not isinstance(values, Mapping):
        raise MessageValueError(root, path, f"the fields of a {type_name}", values)
    for name in values:
        if name not in shape.fields or name == PLACEHOLDER:
            near = nearest(str(name), set(shape.fields) - {PLACEHOLDER})
            hint = f" (did you mean {near}?)" if near else ""
            raise MessageValueError(root, path, f"a field of {type_name}{hint}", name)
    attributes = {}
    for name, field in shape.fields.items():
        given = values[name] if name in values else shape.defaults.get(name, _UNSET)
        inner = f"{path}.{name}" if path else name
        attributes[normalize_fieldname(name)] = (
            _zero(shapes, field) if given is _UNSET else _value(shapes, field, given, root, inner)
        )
    return shape.new(**attributes)


_UNSET = object()


def _zero(shapes: Shapes, field: FieldType) -> object:
    """Return the value ROS 2 gives a field nobody set."""
    count = field.array if isinstance(field.array, int) else 0
    if field.kind == "message":
        if field.array is None:
            return _message(shapes, field.type_name, {}, field.type_name, "")
        return [_message(shapes, field.type_name, {}, field.type_name, "") for _ in range(count)]
    if field.kind == "string":
        return "" if field.array is None else [""] * count
    if field.array is not None:
        return _array([0] * count, field)
    return {"bool": False, "int": 0, "float": 0.0}[field.kind]


def _value(shapes: Shapes, field: FieldType, value: object, root: str, path: str) -> object:
    if field.array is None:
        return _single(shapes, field, value, root, path)
    if isinstance(value, (bytes, bytearray)) and field.range == (0, 255):
        value = list(value)
    if not isinstance(value, Sequence) or isinstance(value, (str, bytes, bytearray)):
        raise MessageValueError(root, path, f"a list for {field}", value)
    if isinstance(field.array, int) and len(value) != field.array:
        raise MessageValueError(root, path, f"exactly {counted(field.array, 'item')}", value)
    if field.max_items and len(value) > field.max_items:
        raise MessageValueError(root, path, f"at most {counted(field.max_items, 'item')}", value)
    element = field.element
    items = [_single(shapes, element, item, root, f"{path}[{index}]") for index, item in enumerate(value)]
    return items if field.kind in ("string", "message") else _array(items, field)


def _single(shapes: Shapes, field: FieldType, value: object, root: str, path: str) -> object:
    if field.kind == "message":
        return _message(shapes, field.type_name, value, root, path)
    if field.kind == "bool":
        if isinstance(value, bool):
            return value
    elif field.kind == "string":
        return _string(field, value, root, path)
    elif isinstance(value, int) and not isinstance(value, bool):
        if field.kind == "float":
            return _float(field, value, root, path)
        if field.range and field.range[0] <= value <= field.range[1]:
            return value
    elif isinstance(value, float) and field.kind == "float":
        return _float(field, value, root, path)
    expected = f"{field} ({field.range[0]} to {field.range[1]})" if field.range else f"{field}"
    raise MessageValueError(root, path, expected, value)


def _float(field: FieldType, value: float, root: str, path: str) -> float:
    try:
        number = float(value)
    except OverflowError:
        raise MessageValueError(root, path, f"{field}", value) from None
    # NaN and the infinities have their own bits in both widths; only a finite number can be too large.
    if field.type_name == "float32" and FLOAT32_MAX < abs(number) < float("inf"):
        raise MessageValueError(root, path, f"float32 (at most {FLOAT32_MAX:.7g} in size)", value)
    return number


def _string(field: FieldType, value: object, root: str, path: str) -> str:
    if not isinstance(value, str):
        raise MessageValueError(root, path, f"{field}", value)
    try:
        length = len(value.encode())
    except UnicodeEncodeError:
        raise MessageValueError(root, path, "text that UTF-8 can encode", value) from None
    if field.max_length and length > field.max_length:
        raise MessageValueError(root, path, f"at most {counted(field.max_length, 'byte')} of UTF-8", value)
    if "\0" in value:  # A CDR string ends there for every peer written in C or C++.
        raise MessageValueError(root, path, "text without a NUL character", value)
    return value


def _array(items: list[object], field: FieldType) -> np.ndarray:
    import numpy as np  # noqa: PLC0415 - see above

    return np.array(items, dtype=_DTYPES.get(field.type_name, field.type_name))


def _is_array(value: object) -> TypeGuard[np.ndarray]:
    """Return whether it is one; where numpy was never imported there are none."""
    np = sys.modules.get("numpy")
    return np is not None and isinstance(value, np.ndarray)


def _plain(shapes: Shapes, field: FieldType, value: object) -> object:
    if field.max_items or field.max_length:
        _check_bounds(field, value)
    if field.kind == "message":
        if isinstance(value, list):
            return [read(shapes, field.type_name, item) for item in value]
        return read(shapes, field.type_name, value)
    if _is_array(value):
        return value.tolist()
    return list(value) if isinstance(value, list) else value


def _check_bounds(field: FieldType, value: object) -> None:
    if field.max_items and (isinstance(value, list) or _is_array(value)) and len(value) > field.max_items:
        raise MessageValueError(str(field), "", f"at most {counted(field.max_items, 'item')}", len(value))
    if field.max_length:
        for text in value if isinstance(value, list) else [value]:
            if isinstance(text, str) and len(text.encode()) > field.max_length:
                raise MessageValueError(str(field), "", f"at most {counted(field.max_length, 'byte')} of UTF-8", text)


# The message types of a station: which there are, their fields, their bytes and their hashes.
#
# A type is known either from ROS 2 Jazzy's standard packages or from the station's own `messages/<package>`, where
# `msg/*.msg`, `srv/*.srv` and `action/*.action` lie; what ROS 2 derives from services and actions is known with them.
# Its values travel as CDR (the encoding of DDS), and its hash (RIHS01 of REP 2016) tells whether a peer was built with
# the same definition: peers match on the name alone, and a stale definition silently loses or garbles every sample.


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
    def from_folder(cls, messages_dir: Path | None, *others: Path) -> MessageRegistry:
        """Return the standard types and those of `messages_dir` and of the `others`.

        Each holds `<package>/msg/<Name>.msg`, and `srv` and `action` likewise. Raises MessageDefinitionError for a
        definition that cannot be used, with its file, line and column.
        """
        registry = cls()
        folders = others if messages_dir is None else (messages_dir, *others)
        if folders:
            registry._add(tuple(each for folder in folders for each in read_interfaces(folder)))
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
        message = build(self._shape, type_name, fields)
        return bytes(self._store.serialize_cdr(message, type_name, little_endian=True))

    def decode(self, type_name: str, data: bytes) -> dict[str, object]:
        """Return the field values of the CDR bytes `data`, which may carry up to three bytes of padding.

        Raises MalformedMessageError when they are not such a message, and UnknownMessageTypeError.
        """
        self._shape(type_name)
        try:
            return read(self._shape, type_name, self._store.deserialize_cdr(data, type_name))
        except (SerdeError, IndexError, MessageValueError) as error:
            raise MalformedMessageError(type_name, str(error)) from error

    def _find_shape(self, type_name: str) -> MessageShape:
        if type_name not in self._store.fielddefs:
            raise UnknownMessageTypeError(type_name, self._store.fielddefs)
        fields = {name: field_type(description) for name, description in self._store.fielddefs[type_name][1]}
        return MessageShape(type_name, fields, self._defaults.get(type_name, {}), self._store.types[type_name])

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
            build(self._shape, definition.type_name, {field.name: default})
        except MessageValueError as error:
            text = f"the default of {field.name} should be {error.expected}, not {error.found!r}"
            raise MessageDefinitionError(definition.path, field.line, text, field.column) from error
        self._defaults[definition.type_name][field.name] = default
