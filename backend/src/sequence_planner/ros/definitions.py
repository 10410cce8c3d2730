"""Reading `.msg` files.

A message definition is a list of lines: `type name [default]` declares a field, `type NAME=value` a constant, and `#`
begins a comment. The grammar is rosbags'; it is applied line by line here, so that an error can name its line, and with
the stricter naming rules of ROS 2, so that what loads here is also built by colcon. rosbags drops default values; they
are kept here, since a field left out of a message must have its default.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from rosbags.typesys import TypesysError
from rosbags.typesys.base import BaseName, BaseType, create_field_desc, normalize_fieldname
from rosbags.typesys.msg import MSGParser

from sequence_planner.ros.errors import MessageDefinitionError

if TYPE_CHECKING:
    from rosbags.interfaces.typing import FieldDesc, Value
    from rosbags.typesys.base import Field

_PACKAGE = re.compile(r"(?!.*__)[a-z][a-z0-9_]*(?<!_)")
_MESSAGE = re.compile(r"[A-Z][A-Za-z0-9]*")
_FIELD = re.compile(r"(?!.*__)[a-z][a-z0-9_]*(?<!_)")

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


@dataclass(frozen=True)
class FieldDeclaration:
    """One field of a definition, with the line that declares it and the default as written, if any."""

    name: str
    description: FieldDesc
    default: Value | None
    line: int


@dataclass(frozen=True)
class Definition:
    """One `.msg` file, read."""

    type_name: str
    path: Path
    fields: tuple[FieldDeclaration, ...]


def read_definitions(messages_dir: Path) -> Iterator[Definition]:
    """Read every `<package>/msg/<Name>.msg` below `messages_dir`, in the order of their names.

    Raises MessageDefinitionError for a bad name, an unreadable file or a line that is neither field nor constant.
    """
    if not messages_dir.is_dir():
        raise MessageDefinitionError(messages_dir, 1, "no such folder; it should hold <package>/msg/<Name>.msg")
    for path in sorted(messages_dir.glob("*/msg/*.msg")):
        package = path.parent.parent.name
        if not _PACKAGE.fullmatch(package):
            raise MessageDefinitionError(
                path, 1, f"{package!r} is not a package name: use lower case, digits and single underscores"
            )
        if not _MESSAGE.fullmatch(path.stem):
            raise MessageDefinitionError(path, 1, f"{path.stem!r} is not a message name: write it as in NutState")
        yield read_definition(path, f"{package}/msg/{path.stem}")


def read_definition(path: Path, type_name: str) -> Definition:
    """Read the definition of `type_name` from `path`; raises MessageDefinitionError."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise MessageDefinitionError(path, 1, f"cannot be read as UTF-8 text: {error}") from error
    fields: list[FieldDeclaration] = []
    taken: dict[str, int] = {}
    for line, source in enumerate(text.splitlines(), start=1):
        declared = _declaration(path, line, type_name, source)
        if declared is None:
            continue
        name, field = declared
        # rosbags keeps a field as an attribute, where `from` and `from_` would meet.
        attribute = normalize_fieldname(name)
        if attribute in taken:
            raise MessageDefinitionError(path, line, f"{name} is already declared in line {taken[attribute]}")
        taken[attribute] = line
        if field is not None:
            fields.append(field)
    return Definition(type_name, path, tuple(fields))


def _declaration(path: Path, line: int, type_name: str, source: str) -> tuple[str, FieldDeclaration | None] | None:
    """Return what a line declares: its name, and the field unless it is a constant; None for an empty line."""
    text = source.strip()
    if not text or text.startswith("#"):
        return None
    written_type = re.split(r"[\s\[<]", text, maxsplit=1)[0]
    if written_type in _INSTEAD:
        raise MessageDefinitionError(path, line, f"ROS 2 has no type {written_type}: {_INSTEAD[written_type]}")
    try:
        [message] = MSGParser(f"MSG: {type_name}\n{text}\n").specification()
    except TypesysError as error:
        wanted = "`type name`, `type name default` or `type NAME=value`"
        raise MessageDefinitionError(path, line, f"cannot read {text!r}: write {wanted}") from error
    if message.constants:
        return message.constants[0].name, None
    if not message.fields:
        return None
    field = message.fields[0]
    if not _FIELD.fullmatch(field.name):
        raise MessageDefinitionError(
            path, line, f"{field.name!r} is not a field name: use lower case, digits and single underscores"
        )
    _check_quoted(path, line, text, field)
    return field.name, FieldDeclaration(field.name, create_field_desc(field.typ), field.value, line)


def _check_quoted(path: Path, line: int, text: str, field: Field) -> None:
    """Refuse a string default without quotes: what belongs to it, and what to a comment, would be a guess."""
    if field.value is None or field.typ.ref != BaseType(BaseName.STRING):
        return
    for value in field.value if isinstance(field.value, list) else [field.value]:
        if f'"{value}"' not in text and f"'{value}'" not in text:
            raise MessageDefinitionError(path, line, f"put the default of {field.name} in quotes")
