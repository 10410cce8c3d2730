"""Pipelines as documents: the typed graph, which stays as it is, and what passes its edges."""

from __future__ import annotations

from typing import Literal

from pydantic import JsonValue

from sequence_planner.controller.views.part import View


class StageView(View):
    """A stage: its kind, what it makes of what in short, and where it was written."""

    kind: str
    summary: str
    reads: list[str]
    gives: dict[str, str]
    file: str
    line: int
    column: int


class TypedEdgeView(View):
    """An edge: the stage it leads to (`3 discretise`) or what stands at the end, and the types of a record's fields."""

    to: str
    fields: dict[str, str]


class EndView(View):
    """End of a field: a variable of the station, or a field of the outgoing message."""

    field: str
    becomes: str
    type: str


class PipelineGraphView(View):
    """The pipeline of one topic or flow.

    `sources` are a flow's topics and flows by alias; without a merge each is its own alias. An incoming topic has
    none, and those of an outgoing topic are variables. There is one edge more than stages. `readers` are flows.
    """

    role: Literal["incoming", "flow", "outgoing"]
    resource: str
    message: str | None
    joining: Literal["branch", "interleave", "merge"] | None
    sources: dict[str, str]
    stages: list[StageView]
    edges: list[TypedEdgeView]
    ends: list[EndView]
    readers: list[str]


class PipelinesView(View):
    """All pipelines of a station, by topic or flow; each flow stands behind its sources."""

    pipelines: dict[str, PipelineGraphView]


class EdgeFlowView(View):
    """What has passed an edge since the controller began.

    `held` records were dropped by the stage, held back, or made one of several. `rate` is in records per second over
    the last seconds, and null before it is known. `last` is the last record, with long lists and texts cut short, `at`
    when it passed (seconds since the epoch).
    """

    to: str
    records: int
    held: int
    rate: float | None
    last: dict[str, JsonValue] | None
    troubles: list[str]
    at: float | None


class PipelineFlowView(View):
    """What has passed a pipeline. `repeated` messages said nothing new and went no further; `rate` counts them too."""

    edges: list[EdgeFlowView]
    repeated: int
    rate: float | None


class FlowsView(View):
    """What has passed all pipelines, by topic or flow, at `time` (seconds since the epoch)."""

    time: float
    pipelines: dict[str, PipelineFlowView]


class RecordView(View):
    """The last record at the beginning of a pipeline and at its end, in full, and when they passed (seconds since the
    epoch). What JSON has not, such as NaN, is null. `last` is null where nothing has come to the end since.
    """

    first: dict[str, JsonValue]
    last: dict[str, JsonValue] | None
    at: float | None
