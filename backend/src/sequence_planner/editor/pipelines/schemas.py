"""Request and response schemas of the pipeline editor: graph, stage offers, previews and runs."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, JsonValue

from sequence_planner.analysis.report import FindingDocument
from sequence_planner.controller.views.part import View
from sequence_planner.editor.draft import AddEntry, Edit, MoveEntry, RemoveEntry, SetEntry
from sequence_planner.editor.processes import Changed
from sequence_planner.texts.message import Message

# What is shown of the pipelines of a draft: their graph as far as it is sound, what could be put where, and runs.

EntryEdit = Annotated[AddEntry | RemoveEntry | MoveEntry | SetEntry, Field(discriminator="kind")]


class Part(StrEnum):
    """The part of a resource that a pipeline belongs to."""

    TOPIC = "topic"
    FLOW = "flow"
    REQUEST = "request"
    RESPONSE = "response"
    GOAL = "goal"
    FEEDBACK = "feedback"
    RESULT = "result"
    STATUS = "status"


class Soundness(StrEnum):
    """Verdict on a part of a pipeline."""

    GOOD = "good"
    WRONG = "wrong"
    UNKNOWN = "unknown"  # it stands behind what is wrong, and nobody can say


class TypeKind(StrEnum):
    """Values of a type."""

    BOOL = "bool"
    ENUMERATION = "enumeration"
    INTEGER = "integer"
    REAL = "real"
    TEXT = "text"
    LIST = "list"
    MESSAGE = "message"


class TypeView(View):
    """A type of fields. `values` are those of an enumeration, `least` and `most` bound an integer, `element` and
    `length` are those of a list (null: of any length), `fields` those of a nested message; each names its type.
    """

    kind: TypeKind
    values: list[str] | None
    least: int | None
    most: int | None
    element: str | None
    length: int | None
    fields: dict[str, str] | None


class EntryView(View):
    """An entry of a file, as edits name it, and where it stands; lines and columns count from 1."""

    file: str
    path: list[str | int]
    line: int
    column: int


class LiveEdgeView(View):
    """The edge of what runs that this one is: the pipeline and the index of the edge, as `/pipelines/stream` has them.

    `same` says that everything before it runs as the draft has it; else what runs is made in another way.
    """

    pipeline: str
    edge: int
    same: bool


class DraftEdgeView(View):
    """An edge: the types of a record's fields, null where nobody can say; `id` stays when others come and go."""

    id: str
    fields: dict[str, str] | None
    live: LiveEdgeView | None


class DraftStageView(View):
    """A stage; `written` is its entry, as `was` of an edit has it.

    One that nobody wrote, such as the `map` of constants of the message, has neither `written` nor `place`. `reads` and
    `gives` are empty where it is not sound.
    """

    id: str
    kind: str
    place: EntryView | None
    written: JsonValue
    standing: Soundness
    findings: list[FindingDocument]
    summary: str
    reads: list[str]
    gives: dict[str, str]


class SourceView(View):
    """A source of a flow as it is `written`, and the id of its pipeline, null where there is none such.

    `path` is that of its entry; `alias` is that of a merge.
    """

    alias: str | None
    written: str
    pipeline: str | None
    place: EntryView
    findings: list[FindingDocument]


class DraftEndView(View):
    """End of a field: a variable of the station, or a field of the outgoing message."""

    field: str
    becomes: str
    type: str


class ReadVariableView(View):
    """A variable with which an outgoing record begins; `sent` says that the message depends on it."""

    field: str
    variable: str
    sent: bool


class DraftExampleView(View):
    """An example as it is written."""

    name: str
    place: EntryView
    written: JsonValue


class DraftQualityView(View):
    """The quality of service as it is meant; times are in seconds."""

    name: str
    reliable: bool
    transient_local: bool
    depth: int
    deadline: float | None
    liveliness: float | None


class DraftPipelineView(View):
    """The pipeline of one topic, flow, or part of a service or action.

    `id` is that of what runs under this name, and for a second one of the same name its resource stands before it.
    `place` is its entry, or that of the service or action; `stages_path` is where its stages stand, or would stand, and
    null for one that has none. `first` has the variables with which an outgoing record begins.
    """

    id: str
    name: str
    part: Part
    role: Literal["incoming", "outgoing", "flow"]
    resource: str
    message: str | None
    quality: DraftQualityView | None
    deadline: float | None
    every: float | None
    joining: Literal["branch", "interleave", "merge"] | None
    standing: Soundness
    place: EntryView
    stages_path: list[str | int] | None
    sources: list[SourceView]
    first: list[ReadVariableView]
    stages: list[DraftStageView]
    edges: list[DraftEdgeView]
    ends: list[DraftEndView]
    ignored: list[str]
    readers: list[str]
    examples: list[DraftExampleView]
    examples_path: list[str | int] | None
    findings: list[FindingDocument]


class DraftVariableView(View):
    """A variable of a resource; `fed` is the id of the pipeline that writes it. `place` is null for one that follows
    from a message alone.
    """

    name: str
    resource: str
    kind: Literal["measured", "output", "estimated"]
    type: str
    place: EntryView | None
    fed: str | None


class DraftPipelinesView(View):
    """All pipelines of the draft after its change `number`, by id, each flow behind its sources.

    `findings` are those that belong to none of them. `unread` are files shown as they were when they could be read.
    """

    number: int
    pipelines: dict[str, DraftPipelineView]
    types: dict[str, TypeView]
    variables: list[DraftVariableView]
    resources: dict[str, str]
    findings: list[FindingDocument]
    unread: list[str]


class StageOfferView(View):
    """A kind of stage at an edge. Where it `fits`, `edits` put it there as `stage`, to be filled in further, and
    declare what it needs; else `reason` says why no such stage can stand there.
    """

    kind: str
    fits: bool
    reason: str | None
    stage: JsonValue
    edits: list[EntryEdit]


class TargetView(View):
    """Possible end of a field at an edge: a variable, or a field of the outgoing message; `edits` make it so."""

    field: str
    name: str
    type: str
    fits: bool
    reason: str | None
    edits: list[EntryEdit]


class SourceOfferView(View):
    """A topic or flow that a flow could have as a further source; `edits` make it so."""

    pipeline: str
    fits: bool
    reason: str | None
    edits: list[EntryEdit]


class FitsView(View):
    """Suggestions at an edge of a pipeline: stages, ends of its fields, and further sources."""

    number: int
    stages: list[StageOfferView]
    targets: list[TargetView]
    sources: list[SourceOfferView]


class PreviewView(View):
    """What the edits would bring about: pipelines that are others then, those that are gone, and what is found that was
    not there before. `refused` says why the edits cannot be made at all.
    """

    number: int
    refused: str | None
    pipelines: dict[str, DraftPipelineView]
    gone: list[str]
    types: dict[str, TypeView]
    findings: list[FindingDocument]


class ValueView(View):
    """What came of a run under a name, null for unknown, and what was expected; `right` is null where nothing was."""

    name: str
    came: JsonValue
    expected: JsonValue
    right: bool | None


class RunEdgeView(View):
    """The last record that has passed an edge in a run, and how many have."""

    id: str
    records: int
    last: dict[str, JsonValue] | None
    troubles: list[str]


class RunStepView(View):
    """A moment of a run, in seconds from its beginning: what was given, what had come of it then, and each edge."""

    at: float
    given: JsonValue
    values: list[ValueView]
    trouble: str | None
    edges: list[RunEdgeView]


class RunView(View):
    """A run of a pipeline on its own. `passed` is null where nothing was expected; `refused` says why what was given
    cannot be taken.
    """

    name: str | None
    place: EntryView | None
    passed: bool | None
    refused: str | None
    steps: list[RunStepView]
    findings: list[FindingDocument]


class RunsView(View):
    """Runs of a pipeline of the draft; `obstacle` says why it cannot be run, and its message for readers of other
    languages, null where there is none.
    """

    number: int
    pipeline: str
    obstacle: str | None
    obstacle_message: Message | None
    runs: list[RunView]


class LeftOutView(View):
    """What the station had and the draft makes otherwise of the same record alone."""

    name: str
    station: JsonValue
    draft: JsonValue


class RecordingView(View):
    """An example as it could be added to the list at `path`, and what is left out of it."""

    file: str
    path: list[str | int]
    example: dict[str, JsonValue]
    left_out: list[LeftOutView]


class RecordedView(View):
    """An example that was made of what the station has heard or said last. `left_out` is not expected in it: it came of
    what was before, or the draft makes something else of it.
    """

    number: int
    example: dict[str, JsonValue]
    run: RunView
    left_out: list[LeftOutView]


# What is asked about the pipelines of a draft.

PipelineId = Annotated[str, Field(min_length=1, max_length=500)]
Given = Annotated[dict[str, JsonValue], Field(max_length=1000)]


class Question(BaseModel):
    """Base of all questions."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Everything(Question):
    """The graph of all pipelines."""


class Fitting(Question):
    """Suggestions at an edge, counted from 0; with a `field` of it, its possible ends too."""

    pipeline: PipelineId
    edge: Annotated[int, Field(ge=0, le=100_000, strict=True)]
    field: Annotated[str, Field(min_length=1, max_length=500)] | None = None


class Preview(Question):
    """Preview of edits."""

    edits: Annotated[list[Edit], Field(min_length=1, max_length=100)]


class Examples(Question):
    """Results of a pipeline's examples: all, or those of that name."""

    pipeline: PipelineId
    name: Annotated[str, Field(min_length=1, max_length=500)] | None = None


class TrialStep(Question):
    """A moment of a trial: what comes, as an example has it; without it only time passes."""

    at: Annotated[float, Field(ge=0, le=86_400)] = 0.0
    given: Given | None = None


class Trial(Question):
    """Results of these records."""

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
class DraftQuestion:
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
