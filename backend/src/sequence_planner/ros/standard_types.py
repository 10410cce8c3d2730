"""The types of ROS 2 Jazzy's standard packages, prepared once in a process: making a class of each takes a while."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from rosbags.typesys import Stores, get_typestore
from rosbags.typesys.store import Typestore

from sequence_planner.ros.definitions import Interface, read_interface
from sequence_planner.ros.derived import derived_of
from sequence_planner.ros.fields import ON_THE_WIRE, as_uint8, carried
from sequence_planner.ros.standard_interfaces import STANDARD_INTERFACES


@cache
def standard_interfaces() -> tuple[Interface, ...]:
    """Return the services and actions; the messages are in the store."""
    return tuple(read_interface(name, Path(name), text) for name, text in STANDARD_INTERFACES.items())


def standard_store() -> Typestore:
    """Return a new store of the messages, and of those that make up the services and actions."""
    prepared, store = _prepared(), Typestore()
    store.fielddefs.update(prepared.fielddefs)
    store.types.update(prepared.types)
    return store


@cache
def _prepared() -> Typestore:
    store = get_typestore(Stores.ROS2_JAZZY)
    messages = {
        message.type_name: carried([(field.name, field.description) for field in message.fields])
        for interface in standard_interfaces()
        for message in interface.messages
    }
    for interface in standard_interfaces():
        messages |= derived_of(interface).messages
    store.register({name: ([], as_uint8(fields, ON_THE_WIRE)) for name, fields in messages.items()})
    return store
