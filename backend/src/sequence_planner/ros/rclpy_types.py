"""The Python classes that rosidl generated for messages, services and actions, by the names of their types."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeVar

from rclpy.serialization import deserialize_message, serialize_message
from rosidl_runtime_py.utilities import get_action, get_message, get_service

from sequence_planner.ros.transport import TransportError

T = TypeVar("T")

__all__ = [
    "ServiceClass",
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
