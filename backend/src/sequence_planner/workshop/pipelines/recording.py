"""Examples made of what a running station has heard or said."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import cast

from pydantic import JsonValue

from sequence_planner.control.observing import shown
from sequence_planner.model.paths import EditError
from sequence_planner.pipelines.benches import GivenError, Plain
from sequence_planner.pipelines.examples import agrees, bench_of, moment_of
from sequence_planner.pipelines.graph import Flow, IncomingPipeline, Joining, OutgoingPipeline
from sequence_planner.pipelines.record import Record
from sequence_planner.pipelines.running_outgoing import message_of
from sequence_planner.workshop.pipelines.graph import Graph
from sequence_planner.workshop.pipelines.questions import Recording
from sequence_planner.workshop.pipelines.runs import obstacle, pipeline_of
from sequence_planner.workshop.pipelines.view import LeftOutView, RecordingView

LONGEST = 20_000  # characters of an example as JSON


def recorded(graph: Graph, question: Recording) -> RecordingView:
    """The example that a record makes: what was given, and of what came of it whatever comes of it in the draft too.

    Raises `EditError` where there is none.
    """
    view = pipeline_of(graph, question.pipeline)
    if view.examples_path is None:
        raise EditError("examples are of topics and flows, and this is a part of a service or of an action")
    if any(each.name == question.name for each in view.examples):
        raise EditError(f"`{view.id}` has an example “{question.name}” already: choose another name")
    if (why := obstacle(graph, view)) is not None:
        raise EditError(f"the pipeline cannot be run as it is in the draft: {why}")
    made = graph.sketch.built.pipelines
    node = made.outgoing.get(view.name) or made.node(view.name)
    given = _given(graph, node, question.first)
    came = _came(graph, view.name, given)
    station = _station(node, question.last)
    gives = {name: value for name, value in station.items() if name in came and agrees(came[name], value)}
    left_out = [
        LeftOutView(name=name, station=shown(value), draft=shown(came.get(name)))
        for name, value in station.items()
        if name not in gives
    ]
    if not gives:
        said = "of this record alone comes nothing in the draft that came of it on the station"
        raise EditError(f"{said}: write an example with `steps` instead")
    example: dict[str, JsonValue] = {"name": question.name, "given": given, "gives": gives}
    if (length := len(json.dumps(example))) > LONGEST:
        raise EditError(f"the record is too large for an example: it has {length} characters, at most {LONGEST}")
    return RecordingView(file=view.place.file, path=view.examples_path, example=example, left_out=left_out)


def _given(
    graph: Graph, node: IncomingPipeline | OutgoingPipeline | Flow, first: Mapping[str, JsonValue]
) -> dict[str, JsonValue]:
    """What an example gives, without what is as it is by itself."""
    known: dict[str, JsonValue] = {name: value for name, value in first.items() if value is not None}
    match node:
        case Flow(joining=Joining.MERGE):
            aliases: dict[str, JsonValue] = {}
            for name, value in known.items():
                alias, _, rest = name.partition(".")
                within = aliases.setdefault(alias, {})
                assert isinstance(within, dict)
                within[rest] = value
            return aliases
        case Flow():
            return known
        case OutgoingPipeline():
            initial = {name: graph.sketch.automaton.variables[full].initial for name, full in node.read.items()}
            return {name: value for name, value in known.items() if initial.get(name) != value}
    if (path := _not_finite(first)) is not None:
        raise EditError(f"{path.lstrip('.')} is not finite: write an example with `.nan` or `.inf` by hand instead")
    registry, type_name = graph.sketch.registry, node.topic.type_name
    usual = registry.decode(type_name, registry.encode(type_name, {}))
    return {name: value for name, value in known.items() if not agrees(usual.get(name), value)}


def _not_finite(value: JsonValue | Mapping[str, JsonValue], path: str = "") -> str | None:
    """Where a message has a number that JSON has not; messages have no unknown values."""
    match value:
        case None:
            return path
        case Mapping():
            parts = ((f"{path}.{name}", each) for name, each in value.items())
        case list():
            parts = ((f"{path}[{index}]", each) for index, each in enumerate(value))
        case _:
            return None
    return next((found for at, each in parts if (found := _not_finite(each, at)) is not None), None)


def _came(graph: Graph, name: str, given: Plain | Mapping[str, JsonValue]) -> Plain:
    sketch = graph.sketch
    bench = bench_of(name, sketch.built.pipelines, sketch.automaton, sketch.registry)
    try:
        return moment_of(bench, 0.0, dict(given)).came
    except GivenError as error:
        raise EditError(f"the draft does not take the record: {error}") from error
    finally:
        bench.chain.close()


def _station(
    node: IncomingPipeline | OutgoingPipeline | Flow, last: Mapping[str, JsonValue] | None
) -> dict[str, JsonValue]:
    """What the station had at the end: variables or other fields that were given, or fields of the message."""
    if isinstance(node, OutgoingPipeline):
        # What it puts together are values of `last`, and so JSON.
        return cast("dict[str, JsonValue]", message_of(node, Record(dict(last or {}))))
    names = [each.field for each in node.writings]
    if not names:
        names = list(dict.fromkeys(name for stage in node.chain.stages for name in stage.gives)) or list(node.chain.end)
    return {name: (last or {}).get(name) for name in names}
