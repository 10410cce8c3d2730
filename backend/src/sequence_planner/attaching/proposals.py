"""Stages for the fields of a message that are no variables by themselves: a beginning, for people to go on with."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from sequence_planner.attaching.network import InOut
from sequence_planner.expressions.types import BooleanType, IntegerRange
from sequence_planner.pipelines.inference import MOST_VALUES
from sequence_planner.pipelines.record import FieldType, ListType, NestedType, RealType, RecordType, TextType

DEEPEST = 3  # messages within messages that are looked into
MOST = 20  # proposals
_TIMES = ("std_msgs/msg/Header", "builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration")


@dataclass(frozen=True)
class Proposal:
    """A stage as a document has it, and the variable that it gives with its type, None where it gives none."""

    stage: Mapping[str, object]
    variable: str | None = None
    type: str | None = None


def is_variable(field: FieldType) -> bool:
    """Whether a field becomes a variable of its name by itself."""
    return isinstance(field, BooleanType) or (
        isinstance(field, IntegerRange) and field.maximum - field.minimum < MOST_VALUES
    )


def proposals(fields: RecordType, direction: InOut) -> list[Proposal]:
    """What could be made of the fields that are no variables by themselves, in their order."""
    make = _incoming if direction == "in" else _outgoing
    found = (each for path, field in _leaves(fields) if (each := make(path, field)) is not None)
    return [each for each, _ in zip(found, range(MOST), strict=False)]


def _leaves(fields: RecordType, above: str = "", depth: int = 0) -> Iterator[tuple[str, FieldType]]:
    """The fields that are no variables by themselves, those within messages too; times are left out."""
    for name, field in fields.items():
        path = f"{above}{name}"
        if isinstance(field, NestedType):
            if field.name not in _TIMES and depth < DEEPEST:
                yield from _leaves(field.fields, f"{path}.", depth + 1)
        elif depth > 0 or not is_variable(field):
            yield path, field


def _incoming(path: str, field: FieldType) -> Proposal | None:
    name = variable_name(path)
    match field:
        case BooleanType():
            return Proposal({"rename": {path: name}}, name, "bool")
        case IntegerRange() if is_variable(field):
            return Proposal({"rename": {path: name}}, name, str(field))
        case RealType() | IntegerRange():
            return Proposal({"expression": {f"{name}_is_positive": f"{path} > 0"}}, f"{name}_is_positive", "bool")
        case TextType():
            stage = {"match": {"field": path, "variable": f"{name}_is_ready", "equals": "ready"}}
            return Proposal(stage, f"{name}_is_ready", "bool")
        case ListType(TextType()):
            return Proposal(
                {"member": {"field": path, "item": "part", "variable": f"has_{name}"}}, f"has_{name}", "bool"
            )
        case ListType(RealType() | IntegerRange()):
            stage = {"expression": {f"{name}_0_is_positive": f"{path}[0] > 0"}}
            return Proposal(stage, f"{name}_0_is_positive", "bool")
        case ListType(BooleanType()):
            return Proposal({"rename": {f"{path}[0]": f"{name}_0"}}, f"{name}_0", "bool")
    return None


def _outgoing(path: str, field: FieldType) -> Proposal | None:
    match field:
        case BooleanType():
            return Proposal({"constant": {path: False}})
        case IntegerRange():
            return Proposal({"constant": {path: max(field.minimum, 0)}})
        case RealType():
            return Proposal({"constant": {path: 0.0}})
        case TextType():
            return Proposal({"constant": {path: "ready"}})
        case ListType(RealType(), int(length)):
            return Proposal({"constant": {path: [0.0] * length}})
    return None


def variable_name(path: str) -> str:
    """A name for what a field becomes: `pose.position.x` is `pose_position_x`."""
    return re.sub(r"\W+", "_", path).strip("_")
