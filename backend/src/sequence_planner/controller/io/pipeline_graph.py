"""The graph of a station's pipelines, described for those who look at it."""

from __future__ import annotations

from collections.abc import Iterable

from sequence_planner.controller.views.pipelines import (
    EndView,
    PipelineGraphView,
    PipelinesView,
    StageView,
    TypedEdgeView,
)
from sequence_planner.model.stages.base import Stage
from sequence_planner.pipelines.graph import (
    Chain,
    Flow,
    IncomingPipeline,
    Joining,
    OutgoingPipeline,
    StationPipelines,
    VariableField,
)

NAMED = 4  # fields that a summary names at most on each side


def pipelines_view(pipelines: StationPipelines) -> PipelinesView:
    """The whole graph."""
    found = {node.name: _node(node, [flow.name for flow in pipelines.readers(node.name)]) for node in pipelines.nodes}
    found |= {
        name: _outgoing(outgoing) for name, outgoing in (*pipelines.outgoing.items(), *pipelines.requests.items())
    }
    return PipelinesView(pipelines=found)


def _node(node: IncomingPipeline | Flow, readers: list[str]) -> PipelineGraphView:
    resource, message, joining, sources = _source(node)
    return PipelineGraphView(
        role="incoming" if joining is None else "flow",
        resource=resource,
        message=message,
        joining=None if joining is None else joining.value,
        sources=sources,
        stages=[_stage(stage) for stage in node.chain.stages],
        edges=_edges(node.chain, ", ".join((*node.variables, *readers))),
        ends=[_written(writing) for writing in node.writings],
        readers=readers,
    )


def _source(node: IncomingPipeline | Flow) -> tuple[str, str | None, Joining | None, dict[str, str]]:
    """Its resource, the type of its messages, how it joins which sources."""
    if isinstance(node, Flow):
        return node.resource, None, node.joining, dict(node.sources)
    return node.topic.resource, node.topic.type_name, None, {}


def _written(writing: VariableField) -> EndView:
    return EndView(field=writing.field, becomes=writing.variable, type=str(writing.type))


def _outgoing(outgoing: OutgoingPipeline) -> PipelineGraphView:
    end = outgoing.chain.end
    return PipelineGraphView(
        role="outgoing",
        resource=outgoing.topic.resource,
        message=outgoing.topic.type_name,
        joining=None,
        sources={name: variable for name, variable in outgoing.read.items() if variable in outgoing.depends},
        stages=[_stage(stage) for stage in outgoing.chain.stages],
        edges=_edges(outgoing.chain, outgoing.topic.name),
        ends=[EndView(field=s.field, becomes=s.field, type=str(end[s.field])) for s in outgoing.settings],
        readers=[],
    )


def _stage(stage: Stage) -> StageView:
    return StageView(
        kind=stage.kind,
        summary=summary_of(stage.reads, stage.gives),
        reads=sorted(stage.reads),
        gives={name: str(type_) for name, type_ in stage.gives.items()},
        file=stage.place.file,
        line=stage.place.line,
        column=stage.place.column,
    )


def summary_of(reads: Iterable[str], gives: Iterable[str]) -> str:
    """`joints → pose`, or one side alone where there is no other, or it is the same."""
    sides = [_named(sorted(reads)), _named(gives)]
    return " → ".join(dict.fromkeys(side for side in sides if side))


def _named(names: Iterable[str]) -> str:
    known = list(names)
    more = len(known) - NAMED
    return ", ".join(known[:NAMED]) + (f" and {more} more" if more > 0 else "")


def _edges(chain: Chain, end: str) -> list[TypedEdgeView]:
    names = [f"{number} {stage.kind}" for number, stage in enumerate(chain.stages, start=1)]
    return [
        TypedEdgeView(to=to, fields={name: str(type_) for name, type_ in fields.items()})
        for to, fields in zip((*names, end), chain.fields, strict=True)
    ]
