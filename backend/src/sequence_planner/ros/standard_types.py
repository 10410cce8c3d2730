"""The types of ROS 2 Jazzy's standard packages: what their fields are; a class is made of one when it is first used.

The fields are those that rosbags has. It makes classes of all of them, once for each edition of ROS 2 since Dashing, as
soon as it is asked for any, which takes longer than to read most models. To write `standard_messages.json` anew run
`python -m sequence_planner.ros.standard_types`, which prints it.
"""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from rosbags.interfaces import Nodetype
from rosbags.typesys.store import Typestore

from sequence_planner.ros.definitions import Interface, read_interface
from sequence_planner.ros.derived import derived_of
from sequence_planner.ros.fields import ON_THE_WIRE, as_uint8, carried
from sequence_planner.ros.standard_interfaces import STANDARD_INTERFACES

if TYPE_CHECKING:
    from rosbags.interfaces.typing import FieldDesc, Typesdict
    from rosbags.typesys.store import MsgType

MESSAGES = Path(__file__).with_name("standard_messages.json")


@cache
def standard_interfaces() -> tuple[Interface, ...]:
    """Return the services and actions; the messages are in the store."""
    return tuple(read_interface(name, Path(name), text) for name, text in STANDARD_INTERFACES.items())


def standard_store() -> Typestore:
    """Return a new store of the messages, and of those that make up the services and actions."""
    store = Typestore()
    store.fielddefs.update(_fields())
    store.types = _Classes()
    return store


class _Classes(dict[str, "type[MsgType]"]):
    """The classes of messages by their names; of standard ones there are those that were asked for."""

    def __missing__(self, name: str) -> type[MsgType]:
        found = self[name] = _standard_class(name)
        return found


@cache
def _standard_class(name: str) -> type[MsgType]:
    alone = Typestore()
    alone.register({name: _fields()[name]})
    return alone.types[name]


@cache
def _fields() -> Typesdict:
    """Return the constants and fields of all messages."""
    written: dict[str, Any] = json.loads(MESSAGES.read_text(encoding="utf-8"))
    found: Typesdict = {
        name: ([(c, type_name, value) for c, type_name, value in constants], [(f, _description(d)) for f, d in fields])
        for name, (constants, fields) in written.items()
    }
    messages = {
        message.type_name: carried([(field.name, field.description) for field in message.fields])
        for interface in standard_interfaces()
        for message in interface.messages
    }
    for interface in standard_interfaces():
        messages |= derived_of(interface).messages
    return found | {name: ([], as_uint8(fields, ON_THE_WIRE)) for name, fields in messages.items()}


def _description(written: Any) -> FieldDesc:  # noqa: ANN401 (as JSON has it)
    """Return what a field is: the name of a message, or of a plain type with its bound, or one of many of these."""
    kind, of = Nodetype(written[0]), written[1]
    if kind is Nodetype.NAME:
        return Nodetype.NAME, of
    if kind is Nodetype.BASE:
        return Nodetype.BASE, (of[0], of[1])
    many: Any = kind, (_description(of[0]), of[1])
    return cast("FieldDesc", many)


def known_to_rosbags() -> Typesdict:
    """Return the constants and fields of the messages as rosbags has them."""
    from rosbags.typesys import Stores, get_typestore  # noqa: PLC0415 - see above

    return get_typestore(Stores.ROS2_JAZZY).fielddefs


if __name__ == "__main__":
    lines = (f"{json.dumps(name)}: {json.dumps(each)}" for name, each in sorted(known_to_rosbags().items()))
    print("{", ",\n".join(lines), "}", sep="\n")  # noqa: T201
