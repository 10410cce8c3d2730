"""The pipelines of a station, for people: what a record has on each edge."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from sequence_planner.controller.views.pipelines import PipelineGraphView, PipelinesView

SHOWN = 8  # fields of an edge that are written out


def chosen(view: PipelinesView, names: Sequence[str]) -> PipelinesView:
    """Those of these topics, flows and resources; all when nothing is named."""
    kept = {n: each for n, each in view.pipelines.items() if not names or n in names or each.resource in names}
    return PipelinesView(pipelines=kept)


def pipeline_lines(view: PipelinesView) -> Iterator[str]:
    """All of them, with a blank line between."""
    for number, (name, pipeline) in enumerate(view.pipelines.items()):
        if number:
            yield ""
        yield from _lines(name, pipeline)


def _lines(name: str, pipeline: PipelineGraphView) -> Iterator[str]:
    what = pipeline.message or f"{pipeline.joining} of {_sources(pipeline.sources)}"
    yield f"{name}  {pipeline.role}, {pipeline.resource}: {what}"
    if pipeline.role == "outgoing":
        yield f"  from  {', '.join(pipeline.sources.values()) or 'no variable'}"
    known: Mapping[str, str] = {}
    for edge, stage in zip(pipeline.edges, [*pipeline.stages, None], strict=True):
        new = {field: type_ for field, type_ in edge.fields.items() if known.get(field) != type_}
        if new:
            yield f"  {'edge' if not known else 'new':5} {_fields(new)}"
        known = edge.fields
        if stage is not None:
            yield f"  {edge.to}  {stage.summary}  ({stage.file}:{stage.line})"
    for end in pipeline.ends:
        renamed = "" if end.field == end.becomes else f" from {end.field}"
        yield f"  {'sets' if pipeline.role == 'outgoing' else 'writes'}  {end.becomes}: {end.type}{renamed}"
    if pipeline.readers:
        yield f"  read by  {', '.join(pipeline.readers)}"


def _sources(sources: Mapping[str, str]) -> str:
    return ", ".join(name if alias == name else f"{name} as {alias}" for alias, name in sources.items())


def _fields(fields: Mapping[str, str]) -> str:
    shown = [f"{name}: {type_}" for name, type_ in list(fields.items())[:SHOWN]]
    more = len(fields) - SHOWN
    return ", ".join(shown) + (f" and {more} more" if more > 0 else "")
