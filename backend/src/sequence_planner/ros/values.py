"""Between dictionaries of plain values and message objects.

rosbags turns message objects into CDR bytes, but trusts them: an integer given for a float is written as wrong bits
without an error. So every value is checked against its field here, converted to exactly what rosbags expects, and a
field left out gets its default. What comes back is plain again: bool, int, float, str, list and dict.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeGuard

from rosbags.typesys.base import normalize_fieldname

from sequence_planner.counting import counted
from sequence_planner.ros.errors import MessageValueError, nearest
from sequence_planner.ros.fields import FLOAT32_MAX, PLACEHOLDER, FieldType

if TYPE_CHECKING:  # it takes a while to import, and whoever reads a model encodes nothing
    import numpy as np

_DTYPES = {"byte": "uint8", "char": "uint8"}


@dataclass(frozen=True)
class MessageShape:
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
    """Whether it is one; where numpy was never imported there are none."""
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
