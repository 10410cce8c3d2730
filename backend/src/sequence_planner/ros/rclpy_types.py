"""The Python classes that rosidl generated for messages, services and actions, by the names of their types."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Protocol, TypeVar

from rclpy.serialization import deserialize_message, serialize_message
from rosidl_runtime_py.get_interfaces import get_interface_path
from rosidl_runtime_py.utilities import get_action, get_message, get_service

from sequence_planner.ros.transport import TransportError

T = TypeVar("T")

__all__ = [
    "ServiceClass",
    "check_definition",
    "deserialize_message",
    "guarded",
    "message_class",
    "serialize_message",
    "service_class",
]


class ServiceClass(Protocol):
    """What rosidl generates for a service."""

    Request: type
    Response: type


def message_class(where: str, type_name: str) -> type:
    """Return the class of a message, or of what is derived from an action and published on a topic.

    `where` is the topic, for the message. Raises TransportError where there is no generated code, saying how to get it.
    """
    whole, _, part = type_name.rpartition("_")
    if type_name.split("/")[1] == "action" and part == "FeedbackMessage":
        return _generated(where, type_name, lambda: get_action(whole).Impl.FeedbackMessage)
    return _generated(where, type_name, lambda: get_message(type_name))


def service_class(where: str, type_name: str) -> ServiceClass:
    """Return the class of a service, those of an action among them; raises as `message_class` does."""
    whole, _, part = type_name.rpartition("_")
    if type_name.split("/")[1] != "action":
        return _generated(where, type_name, lambda: get_service(type_name))
    if part == "SendGoal":
        return _generated(where, type_name, lambda: get_action(whole).Impl.SendGoalService)
    return _generated(where, type_name, lambda: get_action(whole).Impl.GetResultService)


def check_definition(where: str, type_name: str, ours: str) -> None:
    """Raise TransportError when the code of a message was generated from another definition than that with hash `ours`.

    It would announce the old definition while the bytes are of the new one, and whoever reads them gets garbage.
    """
    folder, _, name = type_name.rpartition("/")
    theirs = _hashes(f"{folder}/{name.split('_')[0]}").get(type_name, ours)
    if theirs != ours:
        package = type_name.split("/", maxsplit=1)[0]
        raise TransportError(
            f"{where}: the code that ROS 2 has for {type_name} was generated from another definition than the model's "
            f"({theirs}, not {ours}). Build the package {package} again: write it with `sequence-planner messages "
            "--ament`, build it with colcon, source its install/setup.bash, and start again"
        )


@cache
def _hashes(interface: str) -> dict[str, str]:
    """Return the hash of each type that was generated from an interface; empty where the installation does not tell."""
    try:
        described = Path(get_interface_path(interface)).with_suffix(".json").read_text(encoding="utf-8")
    except (LookupError, OSError):
        return {}
    return {each["type_name"]: each["hash_string"] for each in json.loads(described)["type_hashes"]}


def _generated(where: str, type_name: str, find: Callable[[], T]) -> T:
    try:
        return find()
    except (ImportError, AttributeError, ValueError) as error:
        package = type_name.split("/", maxsplit=1)[0]
        raise TransportError(
            f"{where}: ROS 2 has no generated code for {type_name} ({error}). Build the package {package}: "
            "write it with `sequence-planner messages --ament`, build it with colcon, source its install/setup.bash"
        ) from error


def guarded(what: str, action: Callable[[], T]) -> T:
    """Return what `action` returns; rclpy's many unrelated exceptions become TransportError."""
    try:
        return action()
    except Exception as error:
        raise TransportError(f"ROS 2 cannot {what}: {error}") from error
