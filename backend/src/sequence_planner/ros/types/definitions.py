"""Parser of `.msg`, `.srv` and `.action` files: fields, constants and message references."""

from __future__ import annotations

import re
from collections.abc import Iterator, Set
from pathlib import Path
from typing import TYPE_CHECKING, Literal, cast

from rosbags.interfaces import Nodetype
from rosbags.typesys import TypesysError
from rosbags.typesys.base import BaseName, BaseType, create_field_desc, normalize_fieldname
from rosbags.typesys.msg import MSGParser

from sequence_planner.core.immutable import Immutable
from sequence_planner.ros.types.errors import MessageDefinitionError, nearest

if TYPE_CHECKING:
    from rosbags.interfaces.typing import (
        BaseDesc,
        Fielddefs,
        FieldDesc,
        NameDesc,
        ScalarValue,
        Value,
    )
    from rosbags.typesys.base import Field

# Reading `.msg`, `.srv` and `.action` files.
#
# A message definition is a list of lines: `type name [default]` declares a field, `type NAME=value` a constant, and `#`
# begins a comment. A service is two of them with a line `---` between (request and response), an action three (goal,
# result and feedback). The grammar is rosbags'; it is applied line by line here, so that an error can name its line,
# and with the stricter naming rules of ROS 2, so that what loads here is also built by colcon. rosbags drops default
# values; they are kept here, since a field left out of a message must have its default.

InterfaceKind = Literal["msg", "srv", "action"]

#: The suffixes of the messages that a file of each kind defines, in their order.
PARTS: dict[InterfaceKind, tuple[str, ...]] = {
    "msg": ("",),
    "srv": ("_Request", "_Response"),
    "action": ("_Goal", "_Result", "_Feedback"),
}

_PACKAGE = re.compile(r"(?!.*__)[a-z][a-z0-9_]*(?<!_)")
_INTERFACE = re.compile(r"[A-Z][A-Za-z0-9]*")
_FIELD = re.compile(r"(?!.*__)[a-z][a-z0-9_]*(?<!_)")
_SEPARATOR = "---"
_KIND_NAMES: dict[InterfaceKind, str] = {"msg": "a message", "srv": "a service", "action": "an action"}

#: Types people write that ROS 2 does not have, and what to write instead.
_INSTEAD = {
    "wstring": "wide strings are not supported; use string, which is UTF-8",
    "Header": "write std_msgs/Header",
    "time": "write builtin_interfaces/Time",
    "duration": "write builtin_interfaces/Duration",
    "float": "write float32 or float64",
    "double": "write float64",
    "int": "write int32 or another width",
    "str": "write string",
    "boolean": "write bool",
}


class FieldDeclaration(Immutable):
    """One field of a definition, with the line and column that declare it and the default as written, if any."""

    name: str
    description: FieldDesc
    default: Value | None
    line: int
    column: int


class ConstantDeclaration(Immutable):
    """One constant of a definition: its name, the name of its type and its value."""

    name: str
    type_name: str
    value: ScalarValue


class Definition(Immutable):
    """One message, read."""

    type_name: str
    path: Path
    fields: tuple[FieldDeclaration, ...]
    constants: tuple[ConstantDeclaration, ...]


class Interface(Immutable):
    """One file, read: `type_name` is written `package/msg/Name`, with `srv` or `action` for the other kinds.

    `messages` are the message itself, request and response, or goal, result and feedback.
    """

    type_name: str
    kind: InterfaceKind
    path: Path
    messages: tuple[Definition, ...]


def read_interfaces(messages_dir: Path) -> Iterator[Interface]:
    """Read every `<package>/<kind>/<Name>.<kind>` below `messages_dir`: messages, then services, then actions.

    Raises MessageDefinitionError for a bad name, an unreadable file or a line that is neither field nor constant.
    """
    if not messages_dir.is_dir():
        raise MessageDefinitionError(messages_dir, 1, "no such folder; it should hold <package>/msg/<Name>.msg")
    for kind in PARTS:
        for path in sorted(messages_dir.glob(f"*/{kind}/*.{kind}")):
            package = path.parent.parent.name
            if not _PACKAGE.fullmatch(package):
                raise MessageDefinitionError(
                    path, 1, f"{package!r} is not a package name: use lower case, digits and single underscores"
                )
            if not _INTERFACE.fullmatch(path.stem):
                raise MessageDefinitionError(
                    path, 1, f"{path.stem!r} is not {_KIND_NAMES[kind]} name: write it as in NutState"
                )
            try:
                text = path.read_text(encoding="utf-8")
            except (OSError, UnicodeDecodeError) as error:
                raise MessageDefinitionError(path, 1, f"cannot be read as UTF-8 text: {error}") from error
            yield read_interface(f"{package}/{kind}/{path.stem}", path, text)


def read_interface(type_name: str, path: Path, text: str) -> Interface:
    """Read the definition of `type_name`, whose `text` is from `path`; raises MessageDefinitionError."""
    kind = cast("InterfaceKind", type_name.split("/")[1])
    sections: list[list[tuple[int, str]]] = [[]]
    for line, source in enumerate(text.splitlines(), start=1):
        if kind != "msg" and source.strip() == _SEPARATOR:
            sections.append([])
            if len(sections) > len(PARTS[kind]):
                raise MessageDefinitionError(path, line, _sections_wanted(kind))
        else:
            sections[-1].append((line, source))
    if len(sections) < len(PARTS[kind]):
        raise MessageDefinitionError(path, max(len(text.splitlines()), 1), _sections_wanted(kind))
    messages = (_message(type_name + part, path, lines) for part, lines in zip(PARTS[kind], sections, strict=True))
    return Interface(type_name, kind, path, tuple(messages))


def _sections_wanted(kind: InterfaceKind) -> str:
    parts = ", ".join(part.strip("_").lower() for part in PARTS[kind])
    return f"{_KIND_NAMES[kind]} has {len(PARTS[kind])} parts ({parts}) with a line {_SEPARATOR} between them"


def _message(type_name: str, path: Path, lines: list[tuple[int, str]]) -> Definition:
    fields: list[FieldDeclaration] = []
    constants: list[ConstantDeclaration] = []
    taken: dict[str, int] = {}
    for line, source in lines:
        declared = _declaration(path, line, type_name, source)
        if declared is None:
            continue
        # rosbags keeps a field as an attribute, where `from` and `from_` would meet.
        attribute = normalize_fieldname(declared.name)
        if attribute in taken:
            text = f"{declared.name} is already declared in line {taken[attribute]}"
            raise MessageDefinitionError(path, line, text, _column(source, declared.name))
        taken[attribute] = line
        if isinstance(declared, FieldDeclaration):
            fields.append(declared)
        else:
            constants.append(declared)
    return Definition(type_name, path, tuple(fields), tuple(constants))


def _declaration(path: Path, line: int, type_name: str, source: str) -> FieldDeclaration | ConstantDeclaration | None:
    """Return what a line declares; None for an empty line."""
    text = source.strip()
    if not text or text.startswith("#"):
        return None
    column = _column(source, text)
    written_type = re.split(r"[\s\[<]", text, maxsplit=1)[0]
    if written_type in _INSTEAD:
        raise MessageDefinitionError(path, line, f"ROS 2 has no type {written_type}: {_INSTEAD[written_type]}", column)
    try:
        # The parts of services and actions see the messages of their package as messages do.
        [message] = MSGParser(f"MSG: {type_name.split('/', 1)[0]}/msg/Any\n{text}\n").specification()
    except TypesysError as error:
        wanted = "`type name`, `type name default` or `type NAME=value`"
        raise MessageDefinitionError(path, line, f"cannot read {text!r}: write {wanted}", column) from error
    if message.constants:
        constant = message.constants[0]
        return ConstantDeclaration(constant.name, constant.typ.value, constant.value)
    if not message.fields:
        return None
    field = message.fields[0]
    if not _FIELD.fullmatch(field.name):
        reason = f"{field.name!r} is not a field name: use lower case, digits and single underscores"
        raise MessageDefinitionError(path, line, reason, _column(source, field.name))
    _check_quoted(path, line, source, field)
    return FieldDeclaration(field.name, create_field_desc(field.typ), field.value, line, column)


def _check_quoted(path: Path, line: int, source: str, field: Field) -> None:
    """Refuse a string default without quotes: what belongs to it, and what to a comment, would be a guess."""
    if field.value is None or field.typ.ref != BaseType(BaseName.STRING):
        return
    for value in field.value if isinstance(field.value, list) else [field.value]:
        if f'"{value}"' not in source and f"'{value}'" not in source:
            reason = f"put the default of {field.name} in quotes"
            raise MessageDefinitionError(path, line, reason, _column(source, str(value)))


def _column(source: str, token: str) -> int:
    """Return the column, from 1, in which `token` begins in the line `source`; 1 where it is not written so."""
    return max(source.find(token), 0) + 1


# What a field of a ROS 2 message may hold.
#
# ROS 2 has fifteen primitive types, nested messages, fixed arrays and sequences. A model only cares about five kinds of
# value (`bool`, `int`, `float`, `string`, `message`) and the limits of each, so `FieldType` says just that.
# `byte` and `char` are unsigned eight bit integers on the wire, and are treated as such.

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


class FieldType(Immutable):
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


# Which messages contain which.
#
# A field may hold another message, so a definition is only as good as those it refers to: each must exist, and none may
# contain itself, since such a message would never end.

#: Messages within messages: far more than anybody writes, and few enough for every program that walks them.
MAX_DEPTH = 64


def check_references(definitions: list[Definition], standard: set[str]) -> None:
    """Raise MessageDefinitionError for a field of a type nobody defines, and for a message without an end.

    `standard` are the names of the types known beside `definitions`.
    """
    own = {definition.type_name: definition for definition in definitions}
    depths: dict[str, int] = {}  # of what has been visited: how many messages stand within one another

    def visit(definition: Definition, above: tuple[str, ...]) -> int:
        if definition.type_name not in depths:
            depths[definition.type_name] = 1 + visit_fields(definition, above)
        return depths[definition.type_name]

    def visit_fields(definition: Definition, above: tuple[str, ...]) -> int:
        deepest = 0
        for field in definition.fields:
            nested = field_type(field.description)
            if nested.kind != "message":
                continue
            name = nested.type_name
            if name in (*above, definition.type_name):
                chain = " in ".join((name, definition.type_name, *reversed(above)))
                raise MessageDefinitionError(
                    definition.path, field.line, f"a message within itself: {chain}", field.column
                )
            if name in own:
                too_deep = len(above) >= MAX_DEPTH  # Asked before going on, for a long chain has to end somewhere.
                deepest = deepest if too_deep else max(deepest, visit(own[name], (*above, definition.type_name)))
                if too_deep or deepest >= MAX_DEPTH:
                    text = f"more than {MAX_DEPTH} messages within one another"
                    raise MessageDefinitionError(definition.path, field.line, text, field.column)
            elif name not in standard:
                near = nearest(name, {*standard, *own})
                hint = f", did you mean {near}?" if near else ""
                text = f"no message type {name}{hint} (its file belongs below the station's messages folder)"
                raise MessageDefinitionError(definition.path, field.line, text, field.column)
        return deepest

    for definition in definitions:
        visit(definition, ())
