"""What of a model has a name, and how each is told from all others."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from sequence_planner.model.paths import EditError

# What each kind is called in a sentence.
KINDS: Mapping[str, str] = {
    "enumeration": "the enumeration",
    "value": "the value",
    "resource": "the resource",
    "variable": "the variable",
    "ability": "the ability",
    "effect": "the effect",
    "operation": "the operation",
    "specification": "the specification",
    "work_master": "the work master",
    "parameter": "the parameter",
    "topic": "the topic",
    "flow": "the flow",
    "service": "the service",
    "action": "the action",
    "message": "the type of message",
}
# Kinds whose names are those of ROS 2, and known in the whole station.
ROS_KINDS = frozenset({"topic", "service", "action", "message"})
_OF_RESOURCE = frozenset({"variable", "ability", "flow"})
_WITHIN = frozenset({"effect", "parameter"})


class Part(NamedTuple):
    """Something with a name. `owner` is what it belongs to, without which the name does not tell it:

    the enumeration of a value; the resource of a variable, an ability or a flow; the ability of an effect; and for a
    parameter the full name of its ability or variable, or `operation:` or `specification:` and a name.
    """

    kind: str
    owner: str | None
    name: str

    @property
    def id(self) -> str:
        """Such as `variable:robot.pose`, `value:pose.home`, `parameter:robot.move.to` or `topic:/robot/state`."""
        return f"{self.kind}:{self.full}"

    @property
    def full(self) -> str:
        """The name with its owner, such as `robot.pose`."""
        return self.name if self.owner is None else f"{self.owner}.{self.name}"

    def __str__(self) -> str:
        return f"{KINDS[self.kind]} `{self.full.rpartition(':')[2]}`"


def parse_part(text: str) -> Part:
    """The part of an `id`. Raises `EditError` for a text that is none."""
    kind, _, full = text.partition(":")
    if kind not in KINDS or not full:
        known = ", ".join(KINDS)
        raise EditError(f"`{text}` names no part: write its kind and its name, as in variable:robot.pose ({known})")
    owner, _, name = ("", "", full) if kind in ROS_KINDS else full.rpartition(".")
    return Part(kind, owner or None, name)


def value_of(enumeration: str, name: str) -> Part:
    """A value of an enumeration."""
    return Part("value", enumeration, name)


def variable_of(resource: str | None, name: str) -> Part:
    """A variable of a resource, or of the station."""
    return Part("variable", resource, name)


def following(part: Part, old: Part, new: Part) -> Part:
    """What `part` is called when `old` is called `new`: the same, or with that name, or with an owner of that name."""
    if part == old:
        return new
    owner = part.owner
    if owner is None:
        return part
    match old.kind:
        case "resource":
            is_own = part.kind in _OF_RESOURCE and owner == old.name
            if is_own:
                return part._replace(owner=new.name)
            if part.kind in _WITHIN and owner.startswith(f"{old.name}."):
                return part._replace(owner=f"{new.name}{owner[len(old.name) :]}")
        case "enumeration" if part.kind == "value" and owner == old.name:
            return part._replace(owner=new.name)
        case "ability" | "variable" if part.kind in _WITHIN and owner == old.full:
            return part._replace(owner=new.full)
        case "operation" | "specification" if part.kind == "parameter" and owner == old.id:
            return part._replace(owner=new.id)
    return part


def belongs_to(part: Part, whole: Part) -> bool:
    """Whether `part` is `whole`, or goes with it when it is deleted."""
    return part == whole or following(part, whole, whole._replace(name=f"{whole.name}'")) != part
