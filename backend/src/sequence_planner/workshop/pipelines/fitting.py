"""What could be put at an edge of a draft's pipelines, as the builder of pipelines says."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from pydantic import JsonValue

from sequence_planner.expressions.lexer import KEYWORDS
from sequence_planner.model.paths import EditError
from sequence_planner.model.stage_documents import StageDocument
from sequence_planner.pipelines.record import FieldType, RecordType
from sequence_planner.pipelines.stages.builders.own import FOLDER
from sequence_planner.workshop.edits import AddEntry, SetEntry
from sequence_planner.workshop.pipelines.candidates import Candidate, Spot, candidates
from sequence_planner.workshop.pipelines.graph import Graph
from sequence_planner.workshop.pipelines.questions import Fitting
from sequence_planner.workshop.pipelines.runs import pipeline_of
from sequence_planner.workshop.pipelines.trying import Trying
from sequence_planner.workshop.pipelines.view import (
    DraftPipelineView,
    EntryEdit,
    FitsView,
    SourceOfferView,
    StageOfferView,
    TargetView,
)

MOST_TRIED = 10  # stages of one kind


def fits(number: int, graph: Graph, question: Fitting) -> FitsView:
    """What could be put there. Raises `EditError` where nobody can say."""
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
        stages=[_offer(kind, spot, question.edge, view, trying) for kind in StageDocument.model_fields],
        targets=[] if question.field is None else list(_targets(question.field, spot, question.edge, view, trying)),
        sources=list(_sources(graph, view, trying)) if view.role == "flow" else [],
    )


def _spot(graph: Graph, view: DraftPipelineView, fields: RecordType, wanted: Mapping[str, FieldType]) -> Spot:
    sketch = graph.sketch
    own = f"{view.resource}."
    names = frozenset(name.removeprefix(own) for name in sketch.automaton.variables if name.startswith(own))
    document = sketch.written.resources[view.resource]
    enumerations = {str(name): tuple(map(str, values)) for name, values in sketch.station.station.enumerations.items()}
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
    if not (tried := candidates(kind, spot)[:MOST_TRIED]):
        reason = _nothing_left(kind, spot)
    for candidate in tried:
        why = trying.with_stage(index, candidate.stage, candidate.declares)
        if why is None:
            edits = _edits(view, index, candidate)
            return StageOfferView(kind=kind, fits=True, reason=None, stage=_json(candidate.stage), edits=edits)
        reason = reason or why
    return StageOfferView(kind=kind, fits=False, reason=reason, stage=None, edits=[])


def _nothing_left(kind: str, spot: Spot) -> str:
    """Why no stage of a kind can even be tried."""
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
    """What a field could become under another name."""
    for name, type_ in spot.wanted.items():
        pair = {field: name} if spot.is_incoming else {name: field}
        candidate = Candidate({"rename": pair})
        why = trying.with_stage(index, candidate.stage, {})
        edits = _edits(view, index, candidate) if why is None else []
        yield TargetView(field=field, name=name, type=str(type_), fits=why is None, reason=why, edits=edits)


def _sources(graph: Graph, view: DraftPipelineView, trying: Trying) -> Iterator[SourceOfferView]:
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
