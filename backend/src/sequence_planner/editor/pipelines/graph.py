"""Graph of a draft's pipelines: written and sound parts, located findings, and matching live edges."""

from __future__ import annotations

import json
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping
from difflib import SequenceMatcher
from typing import Literal

from sequence_planner.analysis.report import error_document
from sequence_planner.automaton.automaton import Kind
from sequence_planner.controller.io.pipeline_graph import summary_of
from sequence_planner.editor.pipelines.reader import STAGES, Sketch, pipeline_name
from sequence_planner.editor.pipelines.schemas import (
    DraftEdgeView,
    DraftEndView,
    DraftExampleView,
    DraftPipelineView,
    DraftQualityView,
    DraftStageView,
    DraftVariableView,
    EntryView,
    LiveEdgeView,
    Part,
    ReadVariableView,
    Soundness,
    SourceView,
    TypeKind,
    TypeView,
)
from sequence_planner.language.records.record import FieldType, ListType, NestedType, RealType, RecordType, TextType
from sequence_planner.language.types import BooleanType, EnumerationType, IntegerRange
from sequence_planner.model.source import Finding
from sequence_planner.model.stages.base import Stage
from sequence_planner.model.yaml.content import plain
from sequence_planner.model.yaml.reader import EntryPath, YamlDocument
from sequence_planner.pipelines.builder import flow_name
from sequence_planner.pipelines.chains import ChainBuilding
from sequence_planner.pipelines.graph import Flow, IncomingPipeline, OutgoingPipeline
from sequence_planner.ros.qos import QualityOfService

# Which edges of what runs those of a draft are: what has not been changed is found again, wherever it stands now.

Pipelines = Mapping[str, DraftPipelineView]


def with_live_edges(pipelines: Pipelines, running: Pipelines) -> dict[str, DraftPipelineView]:
    """The pipelines of a draft, whose edges name those of the `running` model; sources stand before what reads them."""
    found: dict[str, DraftPipelineView] = {}
    for id_, view in pipelines.items():
        other = running.get(id_)
        found[id_] = view if other is None else _with_live_edges(view, other, found)
    return found


def _with_live_edges(
    view: DraftPipelineView, other: DraftPipelineView, above: Mapping[str, DraftPipelineView]
) -> DraftPipelineView:
    begins = _beginning(view) == _beginning(other)
    if not begins and (view.role != other.role or view.message != other.message):
        return view
    here, there = (
        [_stage(view, index) for index in range(len(view.stages))],
        [_stage(other, index) for index in range(len(other.stages))],
    )
    edges: dict[int, int] = {0: 0}
    for block in SequenceMatcher(None, here, there, autojunk=False).get_matching_blocks():
        edges |= {block.a + offset + 1: block.b + offset + 1 for offset in range(block.size)}
    same = begins and all(_is_same(above.get(each.pipeline or "")) for each in view.sources)
    live = []
    for index, edge in enumerate(view.edges):
        same = same and edges.get(index) == index
        found = edges.get(index)
        named = None if found is None else LiveEdgeView(pipeline=other.id, edge=found, same=same)
        live.append(edge.model_copy(update={"live": named}))
    return view.model_copy(update={"edges": live})


def _is_same(view: DraftPipelineView | None) -> bool:
    """Return whether what comes out of a pipeline runs as the draft has it."""
    return view is not None and view.edges[-1].live is not None and view.edges[-1].live.same


def _beginning(view: DraftPipelineView) -> tuple[object, ...]:
    return view.role, view.message, view.joining, tuple((each.alias, each.written) for each in view.sources)


def _stage(view: DraftPipelineView, index: int) -> str:
    """Return what a stage does, as a text that is another one as soon as it does something else."""
    stage = view.stages[index]
    what = (stage.reads, stage.gives) if stage.written is None else stage.written
    return json.dumps([stage.kind, what])


# Where findings belong: from a line and column to the entry of a file that stands there.


class Places:
    """The entries of one file in the order in which they stand."""

    def __init__(self, document: YamlDocument) -> None:
        # Where several begin at one place, the innermost is last; what an alias repeats belongs to its anchor.
        first: dict[tuple[int, int], EntryPath] = {}
        for path, place in document.places.items():
            if place.file != document.file:  # what an instance has of its type
                continue
            at = (place.line, place.column)
            known = first.get(at)
            if known is None or path[: len(known)] == known:
                first[at] = path
        self._starts = sorted(first)
        self._paths = [first[start] for start in self._starts]

    def at(self, line: int, column: int) -> EntryPath:
        """The path of the entry that stands at a place."""
        index = bisect_right(self._starts, (line, column)) - 1
        return self._paths[index] if index >= 0 else ()


class Located:
    """Findings by the entries they are about; each is taken by the first who asks for it."""

    def __init__(self, documents: Mapping[str, YamlDocument], findings: Iterable[Finding]) -> None:
        self._left: dict[str, list[tuple[EntryPath, Finding]]] = {}
        self._elsewhere: list[Finding] = []
        places: dict[str, Places] = {}
        for finding in dict.fromkeys(findings):
            file = finding.place.file
            if file not in documents:
                self._elsewhere.append(finding)
                continue
            if file not in places:
                places[file] = Places(documents[file])
            path = places[file].at(finding.place.line, finding.place.column)
            self._left.setdefault(file, []).append((path, finding))

    def take(self, file: str, path: EntryPath) -> list[Finding]:
        """Those about an entry or what is in it."""
        taken: list[tuple[EntryPath, Finding]] = []
        left: list[tuple[EntryPath, Finding]] = []
        for at, finding in self._left.get(file, ()):
            (taken if at[: len(path)] == path else left).append((at, finding))
        if taken:
            self._left[file] = left
        return [finding for _, finding in taken]

    @property
    def rest(self) -> list[Finding]:
        """Those that nobody has taken."""
        return [*self._elsewhere, *(finding for left in self._left.values() for _, finding in left)]


# The pipelines of a draft as they are written, whether they make sense or not.

_PARTS: Mapping[tuple[str, str], Part] = {("topics", "pipeline"): Part.TOPIC, ("flows", "pipeline"): Part.FLOW}
_OUT = frozenset({Part.REQUEST, Part.GOAL})
Role = Literal["incoming", "outgoing", "flow"]
Joining = Literal["branch", "interleave", "merge"]


class Written:
    """A pipeline as it is written: where, and what of it can be told without knowing whether it makes sense."""

    def __init__(
        self, sketch: Sketch, resource: str, document: YamlDocument, path: EntryPath, key: str, part: Part
    ) -> None:
        self.resource, self.document, self.path, self.part = resource, document, path, part
        self.file = document.file
        self.content = at(at(document.content, str(path[0])), str(path[1]))
        self.stages_path: EntryPath = (*path, key)
        self.stages = entries_of(self.content, key)
        self.cut = sketch.cut.get((self.file, self.stages_path))
        self.name = pipeline_name(resource, self.stages_path)
        self.id = self.name
        outgoing = part in _OUT or (part is Part.TOPIC and at(self.content, "direction") == "out")
        self.role: Role = "flow" if part is Part.FLOW else "outgoing" if outgoing else "incoming"
        type_ = at(self.content, "type")
        self.message = str(type_) if part is Part.TOPIC and type_ is not None else None


def written_pipelines(sketch: Sketch) -> Iterator[Written]:
    """All pipelines of all resources."""
    seen: set[str] = set()
    for resource, document in sketch.resources.items():
        for section, keys in STAGES.items():
            entries = at(document.content, section)
            for name in entries if isinstance(entries, dict) else ():
                for key in (*keys, "status") if section == "actions" else keys:
                    part = _PARTS.get((section, key)) or Part(key)
                    each = Written(sketch, resource, document, (section, str(name)), key, part)
                    if each.id in seen:
                        each.id = unique(f"{resource} {each.name}", seen)
                    seen.add(each.id)
                    if part is Part.STATUS:
                        each.stages = []
                    yield each


def sources_of(written: Written) -> Iterator[tuple[str | None, str, EntryPath]]:
    """The sources of a flow: alias, name and path."""
    if written.part is not Part.FLOW:
        return
    source, path = at(written.content, "from"), (*written.path, "from")
    match source:
        case dict():
            for alias, name in source.items():
                yield str(alias), str(name), (*path, str(alias))
        case list():
            for index, name in enumerate(source):
                yield None, str(name), (*path, index)
        case str():
            yield None, str(source), path


def joining_of(written: Written) -> Joining | None:
    """Return how a flow comes of its sources; None for what is none."""
    if written.part is not Part.FLOW:
        return None
    match at(written.content, "from"):
        case dict():
            return "merge"
        case list():
            return "interleave"
    return "branch"


def unique(id_: str, taken: set[str]) -> str:
    """The id, with a number where it is taken."""
    number, found = 2, id_
    while found in taken:
        number, found = number + 1, f"{id_} #{number}"
    taken.add(found)
    return found


def at(content: object, name: str) -> object:
    """The entry of a mapping; None where there is none."""
    return content.get(name) if isinstance(content, dict) else None


def entries_of(content: object, name: str) -> list[object]:
    """The list that an entry of a mapping is; empty where it is none."""
    found = at(content, name)
    return found if isinstance(found, list) else []


# The graph of a draft's pipelines as it is shown: what is written, and of that what is sound.


class DraftPipelines:
    """The pipelines of one draft, by id."""

    def __init__(self, sketch: Sketch) -> None:
        self.sketch = sketch
        self.types: dict[str, TypeView] = {}
        built = sketch.built
        stages = [finding for chain in built.chains.values() for finding in chain.wrong]
        others = [each for each in (*sketch.findings, *built.findings) if each not in set(stages)]
        self._located = Located(sketch.documents, others)
        written = {each.id: each for each in written_pipelines(sketch)}
        self._ids = {each.name: each.id for each in reversed(written.values())}
        found = {id_: self._pipeline(each) for id_, each in written.items()}
        self.pipelines = dict(sorted(found.items(), key=lambda each: self._depth(each[0], found, frozenset())))
        readers: dict[str, list[str]] = {}
        for id_, view in self.pipelines.items():
            for source in view.sources:
                if source.pipeline is not None:
                    readers.setdefault(source.pipeline, []).append(id_)
        self.pipelines = {
            id_: view.model_copy(update={"readers": readers[id_]}) if id_ in readers else view
            for id_, view in self.pipelines.items()
        }
        self.findings = [error_document(each) for each in sorted(self._located.rest) if _is_ours(each)]

    @property
    def variables(self) -> list[DraftVariableView]:
        """All variables of resources."""
        feeds = self.sketch.built.pipelines.feeds
        files = self.sketch.resources
        found = []
        for name, variable in self.sketch.automaton.variables.items():
            if variable.resource is None:
                continue
            short = name.removeprefix(f"{variable.resource}.")
            place = _entry(files[variable.resource], (variable.kind.value, short.partition("[")[0]))
            fed = feeds.get(name) if variable.kind is Kind.MEASURED else None
            found.append(
                DraftVariableView(
                    name=name,
                    resource=variable.resource,
                    kind=_kind(variable.kind),
                    type=self._typed(variable.type),
                    place=place,
                    fed=None if fed is None else self._ids.get(fed, fed),
                )
            )
        return found

    def _depth(self, id_: str, found: Mapping[str, DraftPipelineView], above: frozenset[str]) -> int:
        """Return how many flows a pipeline stands behind."""
        if id_ in above or not found[id_].sources:
            return 0
        behind = (each.pipeline for each in found[id_].sources if each.pipeline in found)
        return 1 + max((self._depth(str(each), found, above | {id_}) for each in behind), default=0)

    def _pipeline(self, written: Written) -> DraftPipelineView:
        document, path = written.document, written.path
        node, chain = self._built(written)
        stages = self._stages(written, chain)
        sources = self._sources(written)
        findings = [error_document(each) for each in self._findings(written)]
        edges = self._edges(written, stages, chain)
        wrong = (
            bool(findings)
            or any(each.findings for each in stages)
            or any(each.findings for each in sources)
            or chain is None
        )
        unknown = any(each.standing is Soundness.UNKNOWN for each in stages) or edges[-1].fields is None
        examples = entries_of(written.content, "examples")
        return DraftPipelineView(
            id=written.id,
            name=written.name,
            part=written.part,
            role=written.role,
            resource=written.resource,
            message=_message(node) or written.message,
            quality=None if written.part is Part.FLOW else _quality(node),
            deadline=_number(written.content, "deadline") if written.role != "outgoing" else None,
            every=_number(written.content, "every"),
            joining=joining_of(written),
            standing=Soundness.WRONG if wrong else Soundness.UNKNOWN if unknown else Soundness.GOOD,
            place=_there(document, path),
            stages_path=None if written.part is Part.STATUS else list(written.stages_path),
            sources=sources,
            first=_first(node) if isinstance(node, OutgoingPipeline) else [],
            stages=stages,
            edges=edges,
            ends=self._ends(node),
            ignored=[str(each) for each in entries_of(written.content, "ignore")],
            readers=[],
            examples=[
                DraftExampleView(
                    name=str(at(each, "name") or ""),
                    place=_there(document, (*path, "examples", index)),
                    written=plain(each),
                )
                for index, each in enumerate(examples)
            ],
            examples_path=[*path, "examples"] if written.part in (Part.TOPIC, Part.FLOW) else None,
            findings=findings,
        )

    def _built(
        self, written: Written
    ) -> tuple[IncomingPipeline | OutgoingPipeline | Flow | None, ChainBuilding | None]:
        """Return what was made of it, unless another of the same name was."""
        chain = self.sketch.built.chains.get(written.name)
        if chain is None or self._ids[written.name] != written.id:
            return None, None
        made = self.sketch.built.pipelines
        for group in (made.flows, made.incoming, made.outgoing, made.answers, made.requests):
            if written.name in group:
                return group[written.name], chain
        return None, chain

    def _stages(self, written: Written, chain: ChainBuilding | None) -> list[DraftStageView]:
        made = () if chain is None else chain.stages
        count = len(made) if chain is None or written.part is Part.STATUS else max(len(made), len(written.stages))
        count = max(count, len(written.stages))
        is_good = chain is not None
        found: list[DraftStageView] = []
        taken: set[str] = set()
        for index in range(count):
            entry = written.stages[index] if index < len(written.stages) else None
            path = (*written.stages_path, index)
            said = self._located.take(written.file, path) if entry is not None else []
            stage = made[index] if index < len(made) else None
            if stage is None and chain is not None and index == len(made):
                said = [*chain.wrong, *said]
            is_wrong = bool(said) or (stage is None and is_good and index == written.cut)
            kind = stage.kind if stage is not None else _stage_kind(entry)
            id_ = unique(f"{written.id} {kind} {_label(entry, stage)}".rstrip(), taken)
            found.append(
                DraftStageView(
                    id=id_,
                    kind=kind,
                    place=None if entry is None else _there(written.document, path),
                    written=plain(entry),
                    standing=Soundness.WRONG if is_wrong else Soundness.UNKNOWN if stage is None else Soundness.GOOD,
                    findings=[error_document(each) for each in said],
                    summary="" if stage is None else summary_of(stage.reads, stage.gives),
                    reads=[] if stage is None else sorted(stage.reads),
                    gives={} if stage is None else {name: self._typed(type_) for name, type_ in stage.gives.items()},
                )
            )
        return found

    def _edges(
        self, written: Written, stages: list[DraftStageView], chain: ChainBuilding | None
    ) -> list[DraftEdgeView]:
        fields = [] if chain is None else chain.fields
        ids = [f"{written.id} begins", *(f"{stage.id} gives" for stage in stages)]
        return [
            DraftEdgeView(id=id_, fields=self._record(fields[index]) if index < len(fields) else None, live=None)
            for index, id_ in enumerate(ids)
        ]

    def _sources(self, written: Written) -> list[SourceView]:
        return [
            SourceView(
                alias=alias,
                written=name,
                pipeline=(id_ := self._source_id(written.resource, name)),
                place=_there(written.document, path),
                findings=[
                    error_document(each)
                    for each in self._located.take(written.file, path)
                    if id_ is None or not each.message.startswith("there is no topic or flow")  # it is, and is wrong
                ],
            )
            for alias, name, path in sources_of(written)
        ]

    def _source_id(self, resource: str, name: str) -> str | None:
        found = (self._ids.get(each) for each in (name, flow_name(resource, name)))
        return next((each for each in found if each is not None), None)

    def _findings(self, written: Written) -> list[Finding]:
        """Return what is wrong with the pipeline as a whole; what is said of a client is said of its first part."""
        return self._located.take(written.file, written.path)

    def _ends(self, node: IncomingPipeline | OutgoingPipeline | Flow | None) -> list[DraftEndView]:
        if isinstance(node, OutgoingPipeline):
            end = node.chain.end
            return [
                DraftEndView(field=each.field, becomes=each.field, type=self._typed(end[each.field]))
                for each in node.settings
            ]
        return [
            DraftEndView(field=each.field, becomes=each.variable, type=self._typed(each.type))
            for each in (node.writings if node is not None else ())
        ]

    def _record(self, fields: RecordType) -> dict[str, str]:
        return {name: self._typed(type_) for name, type_ in fields.items()}

    def _typed(self, type_: FieldType) -> str:
        """A type's name, with what it means noted."""
        name = str(type_)
        if name not in self.types:
            self.types[name] = type_view(type_)
            inner = [type_.element] if isinstance(type_, ListType) else []
            for each in (*inner, *(type_.fields.values() if isinstance(type_, NestedType) else ())):
                self._typed(each)
        return name


def type_view(type_: FieldType) -> TypeView:
    """Values of a type."""
    kind, values, least, most, element, length, fields = TypeKind.REAL, None, None, None, None, None, None
    match type_:
        case BooleanType():
            kind = TypeKind.BOOL
        case EnumerationType():
            kind, values = TypeKind.ENUMERATION, list(type_.values)
        case IntegerRange():
            kind, least, most = TypeKind.INTEGER, type_.minimum, type_.maximum
        case RealType():
            kind = TypeKind.REAL
        case TextType():
            kind = TypeKind.TEXT
        case ListType():
            kind, element, length = TypeKind.LIST, str(type_.element), type_.length
        case NestedType():
            kind, fields = TypeKind.MESSAGE, {name: str(each) for name, each in type_.fields.items()}
    return TypeView(kind=kind, values=values, least=least, most=most, element=element, length=length, fields=fields)


def _label(entry: object, stage: Stage | None) -> str:
    """Return what a stage is recognised by among those of its kind: what it gives, as it is written."""
    if isinstance(entry, dict) and entry:
        settings = next(iter(entry.values()))
        named = [at(settings, key) for key in ("variable", "name", "function")]
        named = [each for each in named if each is not None]
        if named:
            return str(named[0])
        for key in ("variables", "fields"):
            if names := entries_of(settings, key):
                return ",".join(map(str, names))
        if isinstance(settings, dict):
            return ",".join(map(str, settings))
        if isinstance(settings, list):
            return ",".join(map(str, settings))
        return ""
    return "" if stage is None else ",".join(stage.gives)


def _stage_kind(entry: object) -> str:
    return str(next(iter(entry))) if isinstance(entry, dict) and entry else "?"


def _first(node: OutgoingPipeline) -> list[ReadVariableView]:
    return [ReadVariableView(field=name, variable=full, sent=full in node.depends) for name, full in node.read.items()]


def _message(node: IncomingPipeline | OutgoingPipeline | Flow | None) -> str | None:
    return None if node is None or isinstance(node, Flow) else node.topic.type_name


def _quality(node: IncomingPipeline | OutgoingPipeline | Flow | None) -> DraftQualityView | None:
    if node is None or isinstance(node, Flow):
        return None
    quality: QualityOfService = node.topic.quality
    return DraftQualityView(
        name=str(quality),
        reliable=quality.reliable,
        transient_local=quality.transient_local,
        depth=quality.depth,
        deadline=quality.deadline,
        liveliness=quality.liveliness,
    )


def _is_ours(finding: Finding) -> bool:
    """Return whether it may have to do with pipelines."""
    return finding.place.file.startswith(("resources/", "messages/"))


def _kind(kind: Kind) -> Literal["measured", "output", "estimated"]:
    match kind:
        case Kind.MEASURED:
            return "measured"
        case Kind.OUTPUT:
            return "output"
    return "estimated"


def _there(document: YamlDocument, path: EntryPath) -> EntryView:
    """An entry that is there."""
    place = document.place(path)
    return EntryView(file=document.file, path=list(path), line=place.line, column=place.column)


def _entry(document: YamlDocument, path: EntryPath) -> EntryView | None:
    """An entry, where there is one."""
    return _there(document, path) if path in document.places else None


def _number(content: object, name: str) -> float | None:
    found = at(content, name)
    return float(found) if isinstance(found, int | float) and not isinstance(found, bool) else None
