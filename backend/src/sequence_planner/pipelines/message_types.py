"""The types of messages as those of records, and which fields and variables correspond."""

from __future__ import annotations

from sequence_planner.language.records.record import FieldType, ListType, NestedType, RealType, TextType
from sequence_planner.language.types import BOOLEAN, IntegerRange
from sequence_planner.ros.types import definitions as ros
from sequence_planner.ros.types.messages import MessageRegistry


def message_fields(registry: MessageRegistry, type_name: str) -> dict[str, FieldType]:
    """The fields of a message as those of a record, in their order. Raises `UnknownMessageTypeError`."""
    return {name: _field(registry, field) for name, field in registry.fields(type_name).items()}


def _field(registry: MessageRegistry, field: ros.FieldType) -> FieldType:
    single: FieldType
    match field.kind:
        case "bool":
            single = BOOLEAN
        case "int":
            assert field.range is not None
            single = IntegerRange(*field.range)
        case "float":
            single = RealType()
        case "string":
            single = TextType()
        case "message":
            single = NestedType(field.type_name, message_fields(registry, field.type_name))
    if field.array is None:
        return single
    return ListType(single, field.array if isinstance(field.array, int) else None)
