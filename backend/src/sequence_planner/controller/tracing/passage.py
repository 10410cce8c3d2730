"""The way of one variable through pipelines: which fields of each record bear on it, and what these said last."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

from sequence_planner.controller.io.inputs import Inputs
from sequence_planner.controller.io.monitor import shown
from sequence_planner.controller.io.outputs import Outputs
from sequence_planner.controller.io.pipeline_graph import summary_of
from sequence_planner.controller.tracing.schemas import TracedPipelineView, TracedStepView
from sequence_planner.controller.views.details import WrittenPlaceView
from sequence_planner.core.clock import Timestamp
from sequence_planner.pipelines.graph import (
    Chain,
    EdgeView,
    Flow,
    IncomingPipeline,
    Joining,
    OutgoingPipeline,
    PipelineView,
    StationPipelines,
)

Fields = frozenset[str]
_STEP = re.compile(r"\.([^.\[]+)|\[(\d+)\]")  # of a path: `.position`, `[0]`
MOST_TROUBLES = 4  # of a record that are told


class Passages:
    """Knows what `inputs` have heard and `outputs` have sent by way of `pipelines`."""

    def __init__(self, pipelines: StationPipelines, inputs: Inputs, outputs: Outputs) -> None:
        self._pipelines, self._inputs, self._outputs = pipelines, inputs, outputs
        self._outgoing = {**pipelines.outgoing, **pipelines.requests}

    def carrying(self, name: str) -> list[str]:
        """The outgoing pipelines by which a variable leaves."""
        return [pipeline for pipeline, each in self._outgoing.items() if name in each.depends]

    def sent(self, pipeline: str, moment: Timestamp) -> float | None:
        """Return when a topic was sent last; None where that is not known."""
        topic = self._outputs.topics.get(pipeline)
        return None if topic is None else moment.epoch_of(topic.last)

    def on_the_way(self, name: str) -> frozenset[str]:
        """All pipelines by which a variable comes or leaves."""
        feed = self._pipelines.feeds.get(name)
        coming = () if feed is None else (each.name for each in self._pipelines.passed_through(feed))
        return frozenset((*coming, *self.carrying(name)))

    def incoming(
        self, name: str, observed: Mapping[str, PipelineView], moment: Timestamp
    ) -> Iterator[TracedPipelineView]:
        """Yield the pipelines by which a measured variable comes, from its topics on."""
        feed = self._pipelines.feeds.get(name)
        if feed is None:
            return
        way = self._pipelines.passed_through(feed)
        wanted = _wanted(way, feed, name)
        for node in way:
            ends = {writing.field: writing.variable for writing in node.writings if writing.variable == name}
            fields = list(_needed(node.chain, wanted[node.name]))
            yield self._incoming(node, fields, ends, observed[node.name], moment)

    def outgoing(
        self, name: str, observed: Mapping[str, PipelineView], moment: Timestamp
    ) -> Iterator[TracedPipelineView]:
        """Yield the pipelines by which a variable leaves, each from the state to its message."""
        for pipeline in self.carrying(name):
            each = self._outgoing[pipeline]
            own = frozenset(local for local, variable in each.read.items() if variable == name)
            fields = list(_reached(each.chain, own))
            ends = {setting.field: setting.field for setting in each.settings if name in setting.depends}
            yield self._sent(each, fields, ends, observed[pipeline], moment)

    def _incoming(
        self,
        node: IncomingPipeline | Flow,
        fields: list[Fields],
        ends: Mapping[str, str],
        seen: PipelineView,
        moment: Timestamp,
    ) -> TracedPipelineView:
        feed = self._inputs.topics.get(node.name) or self._inputs.answers.get(node.name)
        return TracedPipelineView(
            name=node.name,
            role="flow" if isinstance(node, Flow) else "incoming",
            resource=node.resource if isinstance(node, Flow) else node.topic.resource,
            message=None if isinstance(node, Flow) else node.topic.type_name,
            sources=list(node.sources.values()) if isinstance(node, Flow) else [],
            last=None if feed is None else moment.epoch_of(feed.last),
            fresh=None if feed is None else feed.fresh(moment.monotonic),
            deadline=None if isinstance(node, Flow) else node.deadline,
            trouble=None if feed is None else feed.trouble,
            steps=list(_steps(node.chain, fields, seen, moment)),
            becomes=dict(ends),
        )

    def _sent(
        self,
        each: OutgoingPipeline,
        fields: list[Fields],
        ends: Mapping[str, str],
        seen: PipelineView,
        moment: Timestamp,
    ) -> TracedPipelineView:
        topic = self._outputs.topics.get(each.topic.name)
        return TracedPipelineView(
            name=each.topic.name,
            role="outgoing",
            resource=each.topic.resource,
            message=each.topic.type_name,
            sources=[],
            last=self.sent(each.topic.name, moment),
            fresh=None,
            deadline=None,
            trouble=None if topic is None else topic.owed,
            steps=list(_steps(each.chain, fields, seen, moment)),
            becomes=dict(ends),
        )


def _wanted(way: Iterable[IncomingPipeline | Flow], feed: str, name: str) -> dict[str, Fields]:
    """The fields at the end of each pipeline from which a variable comes."""
    wanted: dict[str, Fields] = {}
    for node in reversed(tuple(way)):
        own = (writing.field for writing in node.writings if node.name == feed and writing.variable == name)
        wanted[node.name] = wanted.get(node.name, frozenset()) | frozenset(own)
        if isinstance(node, Flow):
            first = next(iter(_needed(node.chain, wanted[node.name])))
            for alias, source in node.sources.items():
                theirs = _of_source(first, alias) if node.joining is Joining.MERGE else first
                wanted[source] = wanted.get(source, frozenset()) | theirs
    return wanted


def _of_source(fields: Fields, alias: str) -> Fields:
    """The fields of one source of a merge, which stand there behind its alias."""
    return frozenset(each.removeprefix(f"{alias}.") for each in fields if each.startswith(f"{alias}."))


def _needed(chain: Chain, wanted: Fields) -> Iterable[Fields]:
    """The fields before each stage, and at the end, from which those that are `wanted` there come."""
    found = [wanted]
    for stage in reversed(chain.stages):
        behind = found[-1]
        whole = _made(behind, stage.gives)
        is_made = whole or any(given.startswith((f"{each}.", f"{each}[")) for each in behind for given in stage.gives)
        found.append(behind - whole | (stage.reads if is_made else frozenset()))
    return reversed(found)


def _made(fields: Fields, gives: Iterable[str]) -> Fields:
    """Those fields that a stage gives, or that lie in what it gives."""
    given = tuple(gives)
    return frozenset(
        each for each in fields if any(each == one or each.startswith((f"{one}.", f"{one}[")) for one in given)
    )


def _reached(chain: Chain, given: Fields) -> Iterable[Fields]:
    """The fields before each stage, and at the end, that are made of those `given` in the beginning."""
    found = given
    yield found
    for stage in chain.stages:
        found |= frozenset() if found.isdisjoint(stage.reads) else frozenset(stage.gives)
        yield found


def _steps(chain: Chain, fields: list[Fields], seen: PipelineView, moment: Timestamp) -> Iterator[TracedStepView]:
    """Yield the beginning and what each stage has made; what a stage has made is seen on the edge behind it."""
    yield _step(None, "", None, False, fields[0], seen.edges[0], 0, moment)
    for number, stage in enumerate(chain.stages):
        before, behind = fields[number], fields[number + 1]
        made = _made(behind, stage.gives)
        bears = bool(made) or before != behind
        place = WrittenPlaceView(file=stage.place.file, line=stage.place.line)
        summary, held = summary_of(stage.reads, stage.gives), seen.edges[number].held
        yield _step(stage.kind, summary, place, not bears, made or behind, seen.edges[number + 1], held, moment)


def _step(
    kind: str | None,
    summary: str,
    place: WrittenPlaceView | None,
    passes: bool,
    fields: Fields,
    edge: EdgeView,
    held: int,
    moment: Timestamp,
) -> TracedStepView:
    last = None if edge.last is None else dict(_bearing(edge.last, fields))
    return TracedStepView(
        kind=kind,
        summary=summary,
        place=place,
        passes=passes,
        fields=None if last is None else {name: shown(value) for name, value in last.items()},
        at=moment.epoch_of(edge.at),
        held=held,
        troubles=list(edge.troubles[:MOST_TROUBLES]),
    )


def _bearing(record: Mapping[str, object], fields: Fields) -> Iterator[tuple[str, object]]:
    """Yield what a record has at these paths. One that leads into a field is followed there, or else all of it told."""
    for name, value in record.items():
        within = sorted(each for each in fields if each.startswith((f"{name}.", f"{name}[")))
        if name in fields or any(name.startswith(f"{each}.") for each in fields):
            yield name, value
        else:
            yield from (_inside(name, value, path) for path in within)


def _inside(name: str, value: object, path: str) -> tuple[str, object]:
    """The value at a path in a field, with the path; the field itself where that cannot be followed."""
    found = value
    for key, index in _STEP.findall(path.removeprefix(name)):
        if isinstance(found, Mapping) and key in found:
            found = found[key]
        elif isinstance(found, list | tuple) and index and int(index) < len(found):
            found = found[int(index)]
        else:
            return name, value
    return path, found
