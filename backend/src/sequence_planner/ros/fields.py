"""What a field of a ROS 2 message may hold.

ROS 2 has fifteen primitive types, nested messages, fixed arrays and sequences. A model only cares about five kinds of
value (`bool`, `int`, `float`, `string`, `message`) and the limits of each, so `FieldType` says just that.
`byte` and `char` are unsigned eight bit integers on the wire, and are treated as such.
"""

from __future__ import annotations

from collections.abc import Set
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from rosbags.interfaces import Nodetype

if TYPE_CHECKING:
    from rosbags.interfaces.typing import BaseDesc, Fielddefs, FieldDesc, NameDesc

Kind = Literal["bool", "int", "float", "string", "message"]

#: Inclusive limits of every integer type.
INTEGER_RANGES: dict[str, tuple[int, int]] = {
    "byte": (0, 2**8 - 1),
    "char": (0, 2**8 - 1),
    **{f"uint{bits}": (0, 2**bits - 1) for bits in (8, 16, 32, 64)},
    **{f"int{bits}": (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) for bits in (8, 16, 32, 64)},
}

#: The largest finite float32.
FLOAT32_MAX = (2 - 2**-23) * 2.0**127

#: The member DDS needs in a message without fields; nobody reads or writes it.
PLACEHOLDER = "structure_needs_at_least_one_member"


#: The types that are uint8 on the wire.
ON_THE_WIRE = frozenset({"char", "byte"})


@dataclass(frozen=True)
class FieldType:
    """The type of one field.

    `array` is None for a single value, the length of a fixed array, or "sequence". `type_name` is the primitive's name
    (`float64`) or the nested message's (`geometry_msgs/msg/Pose`). `range` holds the inclusive limits of an integer.
    `max_items` bounds a sequence and `max_length` a string (in bytes of UTF-8); 0 means unbounded.
    """

    kind: Kind
    type_name: str
    array: int | Literal["sequence"] | None = None
    range: tuple[int, int] | None = None
    max_items: int = 0
    max_length: int = 0

    def __str__(self) -> str:
        """The type as a `.msg` file writes it."""
        bound = f"<={self.max_length}" if self.max_length else ""
        if self.array is None:
            return f"{self.type_name}{bound}"
        if self.array == "sequence":
            return f"{self.type_name}{bound}[{f'<={self.max_items}' if self.max_items else ''}]"
        return f"{self.type_name}{bound}[{self.array}]"

    @property
    def element(self) -> FieldType:
        """The type of one element of an array or sequence, and the type itself otherwise."""
        return FieldType(self.kind, self.type_name, None, self.range, 0, self.max_length)


def field_type(description: FieldDesc) -> FieldType:
    """Return the field type that rosbags describes by `description`; raises KeyError for a type ROS 2 lacks."""
    if description[0] == Nodetype.BASE:
        name, max_length = description[1]
        return FieldType(_kind(name), name, None, INTEGER_RANGES.get(name), 0, max_length)
    if description[0] == Nodetype.NAME:
        return FieldType("message", description[1])
    inner, size = description[1]
    element = field_type(inner)
    is_sequence = description[0] == Nodetype.SEQUENCE
    return FieldType(
        element.kind,
        element.type_name,
        "sequence" if is_sequence else size,
        element.range,
        size if is_sequence else 0,
        element.max_length,
    )


def carried(fields: Fielddefs) -> Fielddefs:
    """Return the fields that DDS carries for a message with these: at least one."""
    return fields or [(PLACEHOLDER, (Nodetype.BASE, ("uint8", 0)))]


def as_uint8(fields: Fielddefs, names: Set[str]) -> Fielddefs:
    """Return `fields` with the primitives of these names, also in arrays, written as uint8."""
    uint8: BaseDesc = (Nodetype.BASE, ("uint8", 0))

    def single(description: BaseDesc | NameDesc) -> BaseDesc | NameDesc:
        return uint8 if description[0] == Nodetype.BASE and description[1][0] in names else description

    def any_of(description: FieldDesc) -> FieldDesc:
        if description[0] == Nodetype.BASE or description[0] == Nodetype.NAME:
            return single(description)
        inner, size = description[1]
        return (description[0], (single(inner), size))

    return [(name, any_of(description)) for name, description in fields]


def _kind(primitive: str) -> Kind:
    if primitive in INTEGER_RANGES:
        return "int"
    kinds: dict[str, Kind] = {"bool": "bool", "float32": "float", "float64": "float", "string": "string"}
    return kinds[primitive]
