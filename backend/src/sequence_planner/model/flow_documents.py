"""What flows and the examples of pipelines may hold."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import Field, model_validator

from sequence_planner.model.document_part import DocumentPart, Given
from sequence_planner.model.source import SourceText
from sequence_planner.model.stage_documents import StageDocument

Moment = Annotated[float, Field(ge=0, le=86_400)]


class ExampleStepDocument(DocumentPart):
    """What happens at one moment of an example, and what is so then."""

    at: Moment
    """Seconds from the beginning of the example."""
    given: Given[Mapping[SourceText, Any]] = None
    """What comes; without it only time passes."""
    gives: Given[Mapping[SourceText, Any]] = None
    """What comes of it; `null` is unknown. What is not mentioned may be anything."""


class ExampleDocument(DocumentPart):
    """An example of what a pipeline does: `given` and `gives`, or `steps` with time."""

    name: SourceText
    """What it is an example of."""
    given: Given[Mapping[SourceText, Any]] = None
    """The fields of a message (incoming), the records by alias (a merge), or the variables (outgoing)."""
    gives: Given[Mapping[SourceText, Any]] = None
    """The variables (incoming) or fields of the message (outgoing) that come of it; `null` is unknown."""
    steps: Given[Annotated[list[ExampleStepDocument], Field(min_length=1)]] = None
    """What happens when, in the order of time."""

    @model_validator(mode="after")
    def _one_form(self) -> ExampleDocument:
        if (self.steps is None) == (self.given is None or self.gives is None):
            raise ValueError("an example has either `given` and `gives`, or `steps`")
        if self.steps is not None:
            if self.given is not None or self.gives is not None:
                raise ValueError("an example with `steps` has its `given` and `gives` in them")
            moments = [step.at for step in self.steps]
            if moments != sorted(moments):
                raise ValueError("the `steps` of an example are in the order of time")
        return self


class FlowDocument(DocumentPart):
    """Records of topics or other flows: of one, of several as they arrive, or of several as one."""

    source: SourceText | list[SourceText] | dict[SourceText, SourceText] = Field(alias="from")
    """A topic or flow; a list of them; or `{alias: topic or flow}`, whose fields are then `alias.field`."""
    pipeline: list[StageDocument] = Field(default_factory=list)
    """Stages."""
    examples: list[ExampleDocument] = Field(default_factory=list)
    """What comes of what, checked by `check`."""

    @model_validator(mode="after")
    def _has_sources(self) -> FlowDocument:
        if not isinstance(self.source, str) and not self.source:
            raise ValueError("`from` names at least one topic or flow")
        return self
