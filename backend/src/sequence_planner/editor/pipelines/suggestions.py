"""Suggestions of the pipeline editor: stages, declarations and sources that fit at an edge."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property

from pydantic import JsonValue, ValidationError

from sequence_planner.automaton.grounding.station import ground_variables
from sequence_planner.editor.draft import AddEntry, SetEntry
from sequence_planner.editor.pipelines.examples import pipeline_of
from sequence_planner.editor.pipelines.graph import DraftPipelines
from sequence_planner.editor.pipelines.reader import pipeline_name
from sequence_planner.editor.pipelines.schemas import (
    DraftPipelineView,
    EntryEdit,
    FitsView,
    Fitting,
    SourceOfferView,
    StageOfferView,
    TargetView,
)
from sequence_planner.language.lexer import KEYWORDS
from sequence_planner.language.records.record import FieldType, RecordType
from sequence_planner.language.types import Place, Type
from sequence_planner.model.documents import FlowDocument, ResourceDocument, VariableDocument
from sequence_planner.model.loader import Station
from sequence_planner.model.paths import EditError, resource_of
from sequence_planner.model.source import SourceText
from sequence_planner.model.stages.python import FOLDER
from sequence_planner.model.stages.registry import KINDS, StageDocument
from sequence_planner.model.stages.suggestions import Candidate, Spot
from sequence_planner.model.validation import complaint
from sequence_planner.pipelines.builder import build_what_is_sound
from sequence_planner.pipelines.inference import variables_inferred

# Stages, declarations and sources tried with the builder of pipelines, in the part of a draft that they concern.

NEW = Place("", 1, 1)  # where what is only tried stands
_STAGE = re.compile(r"^`[^`]*` → stage \d+ `\w+`: ")


class Trying:
    """Tries changes of one pipeline of a draft. What is wrong there already does not count."""

    def __init__(self, graph: DraftPipelines, view: DraftPipelineView) -> None:
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
        """The findings without any change, and the variables that there are with their types."""
        findings, variables = self._built(self._station)
        return frozenset(map(_bare, findings)), variables

    @property
    def document(self) -> ResourceDocument:
        """The document of the pipeline's resource."""
        return self._station.resources[self._view.resource]

    def with_stage(self, index: int, stage: Mapping[str, object], declares: Mapping[str, str]) -> str | None:
        """Say why a stage cannot be inserted there, once these variables are declared; None where it can."""
        try:
            document = StageDocument.model_validate(_placed(stage))
        except ValidationError as error:
            return complaint(error, StageDocument)
        return self._why_not(self._inserted(index, document), declares)

    def with_sources(self, source: object) -> str | None:
        """Say why a flow cannot have this `from`; None where it can."""
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
        """Return what is wrong with a station, as the builder says it, and its variables with their types."""
        sketch = self._graph.sketch
        cut = [pipeline_name(resource_of(file) or "", path) for file, path in sketch.cut]
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


def _concerned(graph: DraftPipelines, view: DraftPipelineView) -> frozenset[str]:
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


# What could be put at an edge of a draft's pipelines, as the builder of pipelines says.


def fits(number: int, graph: DraftPipelines, question: Fitting) -> FitsView:
    """Return what could be put there. Raises `EditError` where nobody can say."""
    view = pipeline_of(graph, question.pipeline)
    if question.edge >= len(view.edges):
        raise EditError(f"`{view.id}` has {len(view.edges)} edges, counted from 0")
    chain = graph.sketch.built.chains.get(view.name)
    if chain is None or view.id != view.name or view.edges[question.edge].fields is None:
        raise EditError("what passes here is unknown: mend first what stands before it")
    if view.stages_path is None:
        raise EditError("what becomes of a goal has no stages of its own")
    if question.edge > len(view.stages) or any(each.written is None for each in view.stages[: question.edge]):
        raise EditError("this stands behind a stage that follows from the message: put it before that one")
    fields = chain.fields[question.edge]
    trying = Trying(graph, view)
    spot = _spot(graph, view, fields, chain.wanted)
    return FitsView(
        number=number,
        stages=[_offer(kind, spot, question.edge, view, trying) for kind in KINDS],
        targets=[] if question.field is None else list(_targets(question.field, spot, question.edge, view, trying)),
        sources=list(_sources(graph, view, trying)) if view.role == "flow" else [],
    )


def _spot(graph: DraftPipelines, view: DraftPipelineView, fields: RecordType, wanted: Mapping[str, FieldType]) -> Spot:
    sketch = graph.sketch
    own = f"{view.resource}."
    names = frozenset(name.removeprefix(own) for name in sketch.automaton.variables if name.startswith(own))
    document = sketch.written.resources[view.resource]
    enumerations = {
        str(name): tuple(map(str, values)) for name, values in sketch.station.station.enumeration_values().items()
    }
    values = frozenset(value for each in enumerations.values() for value in each)
    if view.role == "outgoing":
        done = {end.field for end in view.ends}
        still = dict(sorted(wanted.items(), key=lambda each: each[0] in done))
        taken = names | values
    else:
        fed = {name.removeprefix(own) for name in sketch.built.pipelines.feeds if name.startswith(own)}
        still = {name: type_ for name, type_ in wanted.items() if name not in fed}
        taken = names | values | frozenset(map(str, document.abilities)) | KEYWORDS
    return Spot(view.role != "outgoing", fields, wanted, still, taken, enumerations, sketch.station.folder)


def _offer(kind: str, spot: Spot, index: int, view: DraftPipelineView, trying: Trying) -> StageOfferView:
    reason: str | None = None
    if not (tried := KINDS[kind].suggest(spot)):
        reason = _nothing_left(kind, spot)
    for candidate in tried:
        why = trying.with_stage(index, candidate.stage, candidate.declares)
        if why is None:
            edits = _edits(view, index, candidate)
            return StageOfferView(kind=kind, fits=True, reason=None, stage=_json(candidate.stage), edits=edits)
        reason = reason or why
    return StageOfferView(kind=kind, fits=False, reason=reason, stage=None, edits=[])


def _nothing_left(kind: str, spot: Spot) -> str:
    """Say why no stage of a kind can even be tried."""
    if kind == "python":
        return (
            f"no file in the folder `{FOLDER}` on the server has a function whose parameters are fields of this record"
        )
    if spot.is_incoming:
        return "every variable of the resource is given already: declare one first that this can give"
    return "every field of the message is given already"


def _edits(view: DraftPipelineView, index: int, candidate: Candidate) -> list[EntryEdit]:
    """The stage inserted, and what it needs declared."""
    file, stages = view.place.file, view.stages_path or []
    written = sum(stage.written is not None for stage in view.stages)
    beside = {"before": index} if index < written else {}
    made: list[EntryEdit] = [
        AddEntry.model_validate(
            {"file": file, "path": [*stages, index if beside else 0], "value": _json(candidate.stage), **beside}
        )
    ]
    section = "output" if view.role == "outgoing" else "measured"
    for name, type_ in candidate.declares.items():
        made.append(AddEntry(file=file, path=[section, name], value={"type": type_}))
    return made


def _targets(field: str, spot: Spot, index: int, view: DraftPipelineView, trying: Trying) -> Iterator[TargetView]:
    """Yield what a field could become under another name."""
    for name, type_ in spot.wanted.items():
        pair = {field: name} if spot.is_incoming else {name: field}
        candidate = Candidate({"rename": pair})
        why = trying.with_stage(index, candidate.stage, {})
        edits = _edits(view, index, candidate) if why is None else []
        yield TargetView(field=field, name=name, type=str(type_), fits=why is None, reason=why, edits=edits)


def _sources(graph: DraftPipelines, view: DraftPipelineView, trying: Trying) -> Iterator[SourceOfferView]:
    """The topics and flows that a flow could have beside those it has: one more of a merge or of those in order of
    arrival; a flow of a single source becomes a merge only by hand, since its fields are called otherwise then.
    """
    path, own = [*view.place.path, "from"], {view.id, *(each.pipeline for each in view.sources)}
    for id_, other in graph.pipelines.items():
        if id_ in own or other.part.value not in ("topic", "flow"):
            continue
        name = id_.removeprefix(f"{view.resource}.") if other.role == "flow" else id_
        written: object
        edit: EntryEdit
        match view.joining:
            case "merge":
                alias = _alias(name, {str(each.alias) for each in view.sources})
                written = {**{str(each.alias): each.written for each in view.sources}, alias: name}
                edit = AddEntry(file=view.place.file, path=[*path, alias], value=name)
            case "interleave":
                written = [*(each.written for each in view.sources), name]
                edit = AddEntry(file=view.place.file, path=[*path, len(view.sources)], value=name)
            case _:
                only = view.sources[0].written
                written = [only, name]
                edit = SetEntry(file=view.place.file, path=path, was=only, value=[only, name])
        why = trying.with_sources(written)
        yield SourceOfferView(pipeline=id_, fits=why is None, reason=why, edits=[edit] if why is None else [])


def _alias(name: str, taken: set[str]) -> str:
    stem = "".join(each if each.isalnum() else "_" for each in name.rpartition("/")[2].rpartition(".")[2]) or "source"
    if stem[0].isdigit() or stem in KEYWORDS:
        stem = f"source_{stem}"
    names = (stem, *(f"{stem}_{number}" for number in range(2, 1000)))
    return next(each for each in names if each not in taken)


def _json(value: object) -> JsonValue:
    match value:
        case Mapping():
            return {str(key): _json(each) for key, each in value.items()}
        case list() | tuple():
            return [_json(each) for each in value]
        case None | bool() | int() | float():
            return value
    return str(value)
