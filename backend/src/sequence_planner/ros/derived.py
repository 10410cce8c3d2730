"""What ROS 2 derives from a service or an action.

Nobody writes these messages, and the wire carries them: every service has an event, and an action is made of two
services and a feedback message that say to which goal they belong. Fields and names are those of rosidl (REP 2011
and `rosidl_parser`), since type hashes depend on every one of them.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosbags.interfaces import Nodetype

from sequence_planner.ros.definitions import Interface

if TYPE_CHECKING:
    from rosbags.interfaces.typing import Fielddefs, NameDesc

GOAL_ID = "unique_identifier_msgs/msg/UUID"
CANCEL_GOAL = "action_msgs/srv/CancelGoal"
GOAL_STATUSES = "action_msgs/msg/GoalStatusArray"


@dataclass(frozen=True)
class ServiceType:
    """The messages of the service `type_name`, by the names of their types."""

    type_name: str

    @property
    def request(self) -> str:
        """What a client sends."""
        return f"{self.type_name}_Request"

    @property
    def response(self) -> str:
        """What a server answers."""
        return f"{self.type_name}_Response"

    @property
    def event(self) -> str:
        """What says that a call happened."""
        return f"{self.type_name}_Event"


@dataclass(frozen=True)
class ActionType:
    """The messages and services of the action `type_name`, by the names of their types."""

    type_name: str

    @property
    def goal(self) -> str:
        """What is to be done."""
        return f"{self.type_name}_Goal"

    @property
    def result(self) -> str:
        """What came of it."""
        return f"{self.type_name}_Result"

    @property
    def feedback(self) -> str:
        """How it is going."""
        return f"{self.type_name}_Feedback"

    @property
    def send_goal(self) -> ServiceType:
        """The service that takes a goal."""
        return ServiceType(f"{self.type_name}_SendGoal")

    @property
    def get_result(self) -> ServiceType:
        """The service that answers when a goal has ended."""
        return ServiceType(f"{self.type_name}_GetResult")

    @property
    def feedback_message(self) -> str:
        """The feedback with the goal it belongs to."""
        return f"{self.type_name}_FeedbackMessage"


@dataclass
class Derived:
    """Types by name: `messages` travel, `structures` (services and actions themselves) only have a hash."""

    messages: dict[str, Fielddefs] = field(default_factory=dict)
    structures: dict[str, Fielddefs] = field(default_factory=dict)


def derived_of(interface: Interface) -> Derived:
    """Return what is derived from what a file defines; nothing from a message."""
    if interface.kind == "srv":
        return _of_service(ServiceType(interface.type_name))
    return _of_action(ActionType(interface.type_name)) if interface.kind == "action" else Derived()


def _of_service(service: ServiceType) -> Derived:
    event: Fielddefs = [
        ("info", _named("service_msgs/msg/ServiceEventInfo")),
        ("request", (Nodetype.SEQUENCE, (_named(service.request), 1))),
        ("response", (Nodetype.SEQUENCE, (_named(service.response), 1))),
    ]
    structure: Fielddefs = [
        ("request_message", _named(service.request)),
        ("response_message", _named(service.response)),
        ("event_message", _named(service.event)),
    ]
    return Derived({service.event: event}, {service.type_name: structure})


def _of_action(action: ActionType) -> Derived:
    goal_id = ("goal_id", _named(GOAL_ID))
    derived = Derived(
        {
            action.send_goal.request: [goal_id, ("goal", _named(action.goal))],
            action.send_goal.response: [
                ("accepted", (Nodetype.BASE, ("bool", 0))),
                ("stamp", _named("builtin_interfaces/msg/Time")),
            ],
            action.get_result.request: [goal_id],
            action.get_result.response: [
                ("status", (Nodetype.BASE, ("int8", 0))),
                ("result", _named(action.result)),
            ],
            action.feedback_message: [goal_id, ("feedback", _named(action.feedback))],
        },
        {
            action.type_name: [
                ("goal", _named(action.goal)),
                ("result", _named(action.result)),
                ("feedback", _named(action.feedback)),
                ("send_goal_service", _named(action.send_goal.type_name)),
                ("get_result_service", _named(action.get_result.type_name)),
                ("feedback_message", _named(action.feedback_message)),
            ]
        },
    )
    for service in (action.send_goal, action.get_result):
        more = _of_service(service)
        derived.messages |= more.messages
        derived.structures |= more.structures
    return derived


def _named(type_name: str) -> NameDesc:
    return (Nodetype.NAME, type_name)
