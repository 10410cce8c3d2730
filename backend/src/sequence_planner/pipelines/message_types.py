"""The types of messages as those of records, and which fields and variables correspond."""

from __future__ import annotations

from sequence_planner.language.records.record import FieldType, ListType, NestedType, RealType, TextType
from sequence_planner.language.types import BOOLEAN, BooleanType, EnumerationType, IntegerRange, Type
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


def feeds(field: FieldType, variable: Type) -> bool:
    """Return whether values of a field can be those of a variable; which of them are none shows when they come."""
    match field, variable:
        case BooleanType(), BooleanType():
            return True
        case TextType(), EnumerationType():
            return True
        case EnumerationType(), EnumerationType():
            return set(field.values) <= set(variable.values)
        case IntegerRange(), IntegerRange():
            return _within(field, variable) or _within(variable, field)
    return False


def fills(value: FieldType, field: FieldType) -> bool:
    """Return whether values of the type of a record's field can be sent in a field of a message."""
    match value, field:
        case IntegerRange(), IntegerRange():
            return _within(value, field)
        case (IntegerRange(), RealType()) | (EnumerationType(), TextType()):
            return True
        case ListType(), ListType():
            return fills(value.element, field.element) and (None in (value.length, field.length) or _same(value, field))
        case NestedType(), NestedType():
            return value.name == field.name
    return type(value) is type(field) and not isinstance(field, EnumerationType)


def _same(value: ListType, field: ListType) -> bool:
    return value.length == field.length


def _within(inner: IntegerRange, outer: IntegerRange) -> bool:
    return outer.minimum <= inner.minimum and inner.maximum <= outer.maximum
