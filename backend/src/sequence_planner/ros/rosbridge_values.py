"""Between the values of a message and the JSON in which rosbridge writes it.

rosbridge writes a message as an object of its fields, as `rosbridge_library` does it: bytes (`uint8[]`) as base64, NaN
and the infinities as null, times as `secs` and `nsecs`, and a header with the `seq` that ROS 1 gives it. Values are
those of `MessageRegistry.decode`; whether each fits its field is for `encode` to check.
"""

from __future__ import annotations

import base64
import binascii
import math
from collections.abc import Mapping

from sequence_planner.ros.errors import MessageValueError
from sequence_planner.ros.fields import FieldType
from sequence_planner.ros.messages import MessageRegistry

_TIMES = {"builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration"}
_HEADER = "std_msgs/msg/Header"
_TO_ROS_1 = {"sec": "secs", "nanosec": "nsecs"}
_FROM_ROS_1 = {ours: theirs for theirs, ours in _TO_ROS_1.items()}


def ros_1_type(type_name: str) -> str:
    """Return the ROS 1 name of a message type: `std_msgs/String` for `std_msgs/msg/String`."""
    package, _, name = type_name.split("/")
    return f"{package}/{name}"


def to_json(registry: MessageRegistry, type_name: str, values: Mapping[str, object]) -> dict[str, object]:
    """Return a message as rosbridge takes it."""
    if type_name in _TIMES:
        return {_TO_ROS_1[name]: value for name, value in values.items()}
    return {name: _to_json(registry, field, values[name]) for name, field in registry.fields(type_name).items()}


def from_json(registry: MessageRegistry, type_name: str, message: object) -> dict[str, object]:
    """Return the values of a message as rosbridge gave it.

    Every field must be there and no other: a message of another definition is none. Raises MessageValueError.
    """
    return _message(registry, type_name, message, type_name, "")


def _to_json(registry: MessageRegistry, field: FieldType, value: object) -> object:
    if field.array is not None and field.range == (0, 255) and isinstance(value, list):
        return base64.b64encode(bytes(value)).decode("ascii")
    if isinstance(value, list):
        return [_to_json(registry, field.element, item) for item in value]
    if isinstance(value, Mapping):
        return to_json(registry, field.type_name, value)
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _message(registry: MessageRegistry, type_name: str, message: object, root: str, path: str) -> dict[str, object]:
    if not isinstance(message, Mapping):
        raise MessageValueError(root, path, f"the fields of a {type_name}", message)
    given = dict(message)
    if type_name in _TIMES:
        given = {_FROM_ROS_1.get(name, name): value for name, value in given.items()}
    elif type_name == _HEADER:
        given.pop("seq", None)
    fields = registry.fields(type_name)
    for name in given:
        if name not in fields:
            raise MessageValueError(root, path, f"a field of {type_name}", name)
    for name in fields:
        if name not in given:
            raise MessageValueError(root, _inner(path, name), f"a value of {fields[name]}", None)
    return {name: _value(registry, field, given[name], root, _inner(path, name)) for name, field in fields.items()}


def _value(registry: MessageRegistry, field: FieldType, value: object, root: str, path: str) -> object:
    if field.array is not None:
        if field.range == (0, 255) and isinstance(value, str):
            try:
                return list(base64.b64decode(value, validate=True))
            except (binascii.Error, ValueError):
                raise MessageValueError(root, path, "bytes in base64", value) from None
        if not isinstance(value, list):
            raise MessageValueError(root, path, f"a list for {field}", value)
        return [_value(registry, field.element, item, root, f"{path}[{index}]") for index, item in enumerate(value)]
    if field.kind == "message":
        return _message(registry, field.type_name, value, root, path)
    return math.nan if value is None and field.kind == "float" else value


def _inner(path: str, name: str) -> str:
    return f"{path}.{name}" if path else name
