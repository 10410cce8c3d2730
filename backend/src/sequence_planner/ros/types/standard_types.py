"""Standard message, service and action types of ROS 2 Jazzy, and the types derived from services."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast

from rosbags.interfaces import Nodetype
from rosbags.typesys.store import Typestore

from sequence_planner.core.immutable import Immutable
from sequence_planner.ros.types.definitions import ON_THE_WIRE, Interface, as_uint8, carried, read_interface

if TYPE_CHECKING:
    from rosbags.interfaces.typing import Fielddefs, FieldDesc, NameDesc, Typesdict
    from rosbags.typesys.store import MsgType

# What ROS 2 derives from a service or an action.
#
# Nobody writes these messages, and the wire carries them: every service has an event, and an action is made of two
# services and a feedback message that say to which goal they belong. Fields and names are those of rosidl (REP 2011
# and `rosidl_parser`), since type hashes depend on every one of them.

GOAL_ID = "unique_identifier_msgs/msg/UUID"
CANCEL_GOAL = "action_msgs/srv/CancelGoal"
GOAL_STATUSES = "action_msgs/msg/GoalStatusArray"


class ServiceType(Immutable):
    """The messages of the service `type_name`, by the names of their types."""

    type_name: str

    @property
    def request(self) -> str:
        """The message that a client sends."""
        return f"{self.type_name}_Request"

    @property
    def response(self) -> str:
        """The message that a server answers."""
        return f"{self.type_name}_Response"

    @property
    def event(self) -> str:
        """The message that says that a call happened."""
        return f"{self.type_name}_Event"


class ActionType(Immutable):
    """The messages and services of the action `type_name`, by the names of their types."""

    type_name: str

    @property
    def goal(self) -> str:
        """The message that says what is to be done."""
        return f"{self.type_name}_Goal"

    @property
    def result(self) -> str:
        """The message that says what came of it."""
        return f"{self.type_name}_Result"

    @property
    def feedback(self) -> str:
        """The message that says how it is going."""
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


# The services and actions of ROS 2 Jazzy's standard packages that a station can meet.
#
# rosbags knows the standard messages only. Each entry is what the package's own file declares, without its comments;
# the type hash proves it.

_SET_PARAMETERS: Final = "Parameter[] parameters\n---\n"

STANDARD_INTERFACES: Final[dict[str, str]] = {
    "action_msgs/srv/CancelGoal": """\
GoalInfo goal_info
---
int8 ERROR_NONE=0
int8 ERROR_REJECTED=1
int8 ERROR_UNKNOWN_GOAL_ID=2
int8 ERROR_GOAL_TERMINATED=3
int8 return_code
GoalInfo[] goals_canceling
""",
    "example_interfaces/srv/AddTwoInts": "int64 a\nint64 b\n---\nint64 sum\n",
    "example_interfaces/srv/SetBool": "bool data\n---\nbool success\nstring message\n",
    "example_interfaces/srv/Trigger": "---\nbool success\nstring message\n",
    "example_interfaces/action/Fibonacci": "int32 order\n---\nint32[] sequence\n---\nint32[] sequence\n",
    "lifecycle_msgs/srv/ChangeState": "Transition transition\n---\nbool success\n",
    "lifecycle_msgs/srv/GetAvailableStates": "---\nState[] available_states\n",
    "lifecycle_msgs/srv/GetAvailableTransitions": "---\nTransitionDescription[] available_transitions\n",
    "lifecycle_msgs/srv/GetState": "---\nState current_state\n",
    "rcl_interfaces/srv/DescribeParameters": "string[] names\n---\nParameterDescriptor[] descriptors\n",
    "rcl_interfaces/srv/GetLoggerLevels": "string[] names\n---\nLoggerLevel[] levels\n",
    "rcl_interfaces/srv/GetParameterTypes": "string[] names\n---\nuint8[] types\n",
    "rcl_interfaces/srv/GetParameters": "string[] names\n---\nParameterValue[] values\n",
    "rcl_interfaces/srv/ListParameters": (
        "uint64 DEPTH_RECURSIVE=0\nstring[] prefixes\nuint64 depth\n---\nListParametersResult result\n"
    ),
    "rcl_interfaces/srv/SetLoggerLevels": "LoggerLevel[] levels\n---\nSetLoggerLevelsResult[] results\n",
    "rcl_interfaces/srv/SetParameters": f"{_SET_PARAMETERS}SetParametersResult[] results\n",
    "rcl_interfaces/srv/SetParametersAtomically": f"{_SET_PARAMETERS}SetParametersResult result\n",
    "std_srvs/srv/Empty": "---\n",
    "std_srvs/srv/SetBool": "bool data\n---\nbool success\nstring message\n",
    "std_srvs/srv/Trigger": "---\nbool success\nstring message\n",
    "type_description_interfaces/srv/GetTypeDescription": """\
string type_name
string type_hash
bool include_type_sources true
---
bool successful
string failure_reason
TypeDescription type_description
TypeSource[] type_sources
KeyValue[] extra_information
""",
}


# The types of ROS 2 Jazzy's standard packages: what their fields are; a class is made of one when it is first used.
#
# The fields are those that rosbags has. It makes classes of all of them, once for each edition of ROS 2 since Dashing,
# as soon as it is asked for any, which takes longer than to read most models. To write `standard_messages.json` anew
# run `python -m sequence_planner.ros.standard_types`, which prints it.

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
