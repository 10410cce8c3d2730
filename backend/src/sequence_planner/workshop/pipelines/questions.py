"""What is asked about the pipelines of a draft."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, JsonValue

from sequence_planner.workshop.asking import Changed
from sequence_planner.workshop.edits import Edit
from sequence_planner.workshop.pipelines.view import (
    DraftPipelinesView,
    FitsView,
    PreviewView,
    RecordingView,
    RunsView,
)

PipelineId = Annotated[str, Field(min_length=1, max_length=500)]
Given = Annotated[dict[str, JsonValue], Field(max_length=1000)]


class Question(BaseModel):
    """Base of all questions."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Everything(Question):
    """The graph of all pipelines."""


class Fitting(Question):
    """What could be put at an edge, which counts from 0. With a `field` of it, what that could become is told too."""

    pipeline: PipelineId
    edge: Annotated[int, Field(ge=0, le=100_000, strict=True)]
    field: Annotated[str, Field(min_length=1, max_length=500)] | None = None


class Preview(Question):
    """What edits would bring about."""

    edits: Annotated[list[Edit], Field(min_length=1, max_length=100)]


class Examples(Question):
    """How the examples of a pipeline end: all of them, or those of that name."""

    pipeline: PipelineId
    name: Annotated[str, Field(min_length=1, max_length=500)] | None = None


class TrialStep(Question):
    """A moment of a trial: what comes, as an example has it; without it only time passes."""

    at: Annotated[float, Field(ge=0, le=86_400)] = 0.0
    given: Given | None = None


class Trial(Question):
    """What comes of these records."""

    pipeline: PipelineId
    steps: Annotated[list[TrialStep], Field(min_length=1, max_length=100)]


class Recording(Question):
    """The example that a record of the station makes, by what stood at the beginning of the pipeline and at its end."""

    pipeline: PipelineId
    name: str
    first: dict[str, JsonValue]
    last: dict[str, JsonValue] | None


PipelineQuestion = Everything | Fitting | Preview | Examples | Trial | Recording
PipelineAnswer = DraftPipelinesView | FitsView | PreviewView | RunsView | RecordingView


@dataclass(frozen=True)
class Asked:
    """A question about the draft after change `number`: `changed` are files that are others since the last one, and
    `running` such of the model that runs; none is a file that is gone. `stages` is the model with the Python stages. A
    question that is not read yet is a `Preview`. Unless it is `as_json` the answer stays a view.
    """

    number: int
    changed: Changed
    running: Changed
    stages: Path
    question: PipelineQuestion | bytes
    as_json: bool
