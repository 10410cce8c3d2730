"""Stages, declarations and sources tried with the builder of pipelines, in the part of a draft that they concern."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property

from pydantic import ValidationError

from sequence_planner.automaton.grounding.station import ground_variables
from sequence_planner.expressions.place import Place
from sequence_planner.expressions.types import Type
from sequence_planner.model.documents import ResourceDocument, VariableDocument
from sequence_planner.model.flow_documents import FlowDocument
from sequence_planner.model.loading import Station
from sequence_planner.model.source import SourceText
from sequence_planner.model.stage_documents import StageDocument
from sequence_planner.model.validation import complaint
from sequence_planner.pipelines.building import build_what_is_sound
from sequence_planner.pipelines.inference import variables_inferred
from sequence_planner.workshop.pipelines.graph import Graph
from sequence_planner.workshop.pipelines.reading import pipeline_name, resource_of
from sequence_planner.workshop.pipelines.view import DraftPipelineView

NEW = Place("", 1, 1)  # where what is only tried stands
_STAGE = re.compile(r"^`[^`]*` → stage \d+ `\w+`: ")


class Trying:
    """Tries changes of one pipeline of a draft. What is wrong there already does not count."""

    def __init__(self, graph: Graph, view: DraftPipelineView) -> None:
        self._graph = graph
        self._view = view
        concerned = _concerned(graph, view)
        written = graph.sketch.written
        of = {view.resource, *(each.resource for each in graph.pipelines.values() if each.name in concerned)}
        resources = {
            name: document if name == view.resource else _only(name, document, concerned)
            for name, document in written.resources.items()
            if name in of
        }
        self._station = replace(written, resources=resources)
        self._concerned = concerned

    @cached_property
    def _before(self) -> tuple[frozenset[str], Mapping[str, Type]]:
        """What is found without any change, and the variables that there are with their types."""
        findings, variables = self._built(self._station)
        return frozenset(map(_bare, findings)), variables

    @property
    def document(self) -> ResourceDocument:
        """The document of the pipeline's resource."""
        return self._station.resources[self._view.resource]

    def with_stage(self, index: int, stage: Mapping[str, object], declares: Mapping[str, str]) -> str | None:
        """Why a stage cannot be inserted there, once these variables are declared; None where it can."""
        try:
            document = StageDocument.model_validate(_placed(stage))
        except ValidationError as error:
            return complaint(error, StageDocument)
        return self._why_not(self._inserted(index, document), declares)

    def with_sources(self, source: object) -> str | None:
        """Why a flow cannot have this `from`; None where it can."""
        name = self._view.place.path[1]
        flows = dict(self.document.flows)
        key = next(each for each in flows if each == name)
        try:
            read = FlowDocument.model_validate({_text("from"): _placed(source)})
        except ValidationError as error:
            return complaint(error, FlowDocument)
        flows[key] = flows[key].model_copy(update={"source": read.source})
        return self._why_not(self.document.model_copy(update={"flows": flows}), {})

    def _inserted(self, index: int, stage: StageDocument) -> ResourceDocument:
        section, name = map(str, self._view.place.path[:2])
        part = str((self._view.stages_path or ["pipeline"])[-1])
        entries = dict(getattr(self.document, section))
        key = next(each for each in entries if each == name)
        stages = list(getattr(entries[key], part))
        stages.insert(index, stage)
        entries[key] = entries[key].model_copy(update={part: stages})
        return self.document.model_copy(update={section: entries})

    def _why_not(self, document: ResourceDocument, declares: Mapping[str, str]) -> str | None:
        section = "output" if self._view.role == "outgoing" else "measured"
        variables = dict(getattr(document, section))
        for name, type_ in declares.items():
            if not any(each == name for each in variables):
                variables[_text(name)] = VariableDocument(type=_text(type_))
        changed = document.model_copy(update={section: variables})
        station = replace(self._station, resources={**self._station.resources, self._view.resource: changed})
        findings, there = self._built(station)
        known, before = self._before
        new = [each for each in findings if _bare(each) not in known]
        of_stages = [each for each in new if _STAGE.match(each)]
        if not of_stages and (gone := sorted(before.keys() - there.keys())):
            return f"`{gone[0]}` would be no variable any more: it follows from a field that the stage uses up"
        if not new and (others := [name for name, type_ in before.items() if there[name] != type_]):
            return f"`{others[0]}` would be {there[others[0]]}, and is {before[others[0]]}: declare its type first"
        return _STAGE.sub("", (of_stages or new)[0]) if new else None

    def _built(self, station: Station) -> tuple[Sequence[str], Mapping[str, Type]]:
        """What is wrong with a station, as the builder says it, and its variables with their types."""
        sketch = self._graph.sketch
        cut = [pipeline_name(resource_of(file), path) for file, path in sketch.cut]
        inferred, found = variables_inferred(station, sketch.registry)
        document = inferred.resources[self._view.resource]
        lost = {str(path[1]) for _, path in sketch.lost if path[0] == "topics"}
        own = _only(self._view.resource, document, self._concerned)
        kept = {name: topic for name, topic in own.topics.items() if str(name) not in lost}
        inferred = replace(
            inferred,
            resources={
                **inferred.resources,
                self._view.resource: own.model_copy(update={"topics": kept}),
            },
        )
        automaton, declared = ground_variables(inferred)
        built = build_what_is_sound(inferred, automaton, sketch.registry, cut)
        return [each.message for each in (*found, *declared, *built.findings)], {
            name: variable.type for name, variable in automaton.variables.items()
        }


def _concerned(graph: Graph, view: DraftPipelineView) -> frozenset[str]:
    """The pipelines behind one, and all that these come of; flows that may become its sources are among them."""
    behind, above = {view.id}, {view.id}
    for id_, each in graph.pipelines.items():  # sources stand before what reads them
        if any(source.pipeline in behind for source in each.sources):
            behind.add(id_)
    for id_ in reversed(graph.pipelines):
        if id_ in behind or id_ in above:
            above.update(source.pipeline for source in graph.pipelines[id_].sources if source.pipeline is not None)
    found = behind | above
    if view.role == "flow":
        found |= set(graph.pipelines)
    return frozenset(graph.pipelines[id_].name for id_ in found if id_ in graph.pipelines)


def _only(resource: str, document: ResourceDocument, concerned: frozenset[str]) -> ResourceDocument:
    """A resource with those of its topics and flows that are concerned."""
    return document.model_copy(
        update={
            "topics": {name: each for name, each in document.topics.items() if str(name) in concerned},
            "flows": {name: each for name, each in document.flows.items() if f"{resource}.{name}" in concerned},
            "services": {
                name: each
                for name, each in document.services.items()
                if any(part.startswith(f"{name} ") for part in concerned)
            },
            "actions": {
                name: each
                for name, each in document.actions.items()
                if any(part.startswith(f"{name} ") for part in concerned)
            },
        }
    )


def _text(text: str) -> SourceText:
    return SourceText(text, NEW, text)


def _placed(value: object) -> object:
    """The same with texts that have a place, as a document has them."""
    match value:
        case Mapping():
            return {_text(str(key)): _placed(each) for key, each in value.items()}
        case list() | tuple():
            return [_placed(each) for each in value]
        case str():
            return _text(value)
    return value


def _bare(message: str) -> str:
    """A finding without the number of its stage."""
    return re.sub(r"stage \d+", "stage", message)
