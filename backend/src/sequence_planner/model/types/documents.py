"""What types of resources, and their instances, say beside what is in any resource."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, model_validator

from sequence_planner.model.fields import DocumentPart, Given
from sequence_planner.model.source import SourceText
from sequence_planner.texts.message import message

ParameterKind = Literal["text", "number", "enumeration", "value", "resource"]
Argument = SourceText | Annotated[int | float, Field(allow_inf_nan=False)]


class ParameterDocument(DocumentPart):
    """What an instance of the type gives: a text, a number, an enumeration, a value of one, or another resource."""

    kind: ParameterKind
    """`text`, `number`, `enumeration`, `value` or `resource`."""
    of: Given[SourceText] = None
    """For a value: the enumeration that it is of, or the parameter that is given that."""
    default: Given[Argument] = None
    """What it is where an instance does not give it."""

    @model_validator(mode="after")
    def _is_of_something(self) -> ParameterDocument:
        if (self.kind == "value") != (self.of is not None):
            raise ValueError(message("form.of"))
        return self


def _long(written: object) -> object:
    return {"kind": written} if isinstance(written, str) else written


class InstanceHead(DocumentPart):
    """What an instance says of its type."""

    type: Given[SourceText] = None
    """The type: a file of the folder `types` by its name, or `package.name`."""
    arguments: dict[SourceText, Argument] = Field(default_factory=dict)
    """What the parameters of the type are for this instance."""
    remove: list[SourceText] = Field(default_factory=list)
    """Entries of the type that the instance does not have, such as `abilities.open.effects.slips`."""


class TypeHead(InstanceHead):
    """What a type says before it is a resource."""

    parameters: dict[
        SourceText,
        Annotated[ParameterDocument, BeforeValidator(_long, json_schema_input_type=ParameterKind | ParameterDocument)],
    ] = Field(default_factory=dict)
    """What an instance gives: `{name: kind}`, or more of it."""
