"""Types that were found on the network, as the `.msg` files that define them."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import PurePosixPath

from sequence_planner.attaching.errors import AttachError
from sequence_planner.ros.fields import FieldType
from sequence_planner.ros.messages import MessageRegistry


def definition_files(registry: MessageRegistry, type_names: Iterable[str], source: str) -> dict[PurePosixPath, str]:
    """The files, below the station's folder, with their text. Raises `AttachError` for a type that is no message."""
    files: dict[PurePosixPath, str] = {}
    for type_name in type_names:
        package, kind, name = type_name.split("/")
        if kind != "msg":
            raise AttachError("no-message", f"{type_name} belongs to a service or an action, and is no message")
        files[PurePosixPath("messages", package, "msg", f"{name}.msg")] = _text(registry, type_name, source)
    return files


def _text(registry: MessageRegistry, type_name: str, source: str) -> str:
    head = f"# As {source} describes it on the network, where constants, defaults and comments are not told."
    fields = (f"{_written(field)} {name}" for name, field in registry.fields(type_name).items())
    return "\n".join((head, *fields, ""))


def _written(field: FieldType) -> str:
    """A type as a `.msg` file has it: a message is named without the middle part."""
    return str(field).replace("/msg/", "/") if field.kind == "message" else str(field)
