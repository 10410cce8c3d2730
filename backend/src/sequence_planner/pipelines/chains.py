"""Chains from documents: each stage checked against the record before it, and every finding with its stage."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from sequence_planner.language.records.field_paths import NoFieldError, find_field
from sequence_planner.language.records.record import FieldType, RecordType
from sequence_planner.language.shorthand.vocabulary import NO_VOCABULARY, Vocabulary
from sequence_planner.language.types import EnumerationType, Place
from sequence_planner.model.documents import ResourceDocument
from sequence_planner.model.source import Finding, SourceText
from sequence_planner.model.stages.base import Context, Stage
from sequence_planner.model.stages.discretise import DiscretiseDocument
from sequence_planner.model.stages.map import MapDocument
from sequence_planner.model.stages.marks import NameUse, Scalar
from sequence_planner.model.stages.registry import StageDocument
from sequence_planner.model.stages.support import PassingStage
from sequence_planner.model.stages.timing import FoldDocument, OverrideDocument
from sequence_planner.pipelines.graph import Chain
from sequence_planner.texts.message import Message, message


@dataclass
class PipelineFindings:
    """The findings of all that is wrong with the pipelines."""

    found: list[Finding] = field(default_factory=list)

    def add(self, place: Place, message: str) -> None:
        """Note what is wrong at a place."""
        self.found.append(Finding(place, message))


@dataclass
class ChainBuilding:
    """A chain in the making: `name` is what findings call it, `wanted` what there is a use for at its end.

    Of one that `is_cut` more is written behind its documents, which nobody can read: it is never sound. `wrong` are the
    findings of the stage behind the last sound one.
    """

    name: SourceText
    is_incoming: bool
    wanted: RecordType
    folder: Path
    findings: PipelineFindings
    fields: list[RecordType]
    vocabulary: Vocabulary = NO_VOCABULARY
    resource: str = ""
    stages: list[Stage] = field(default_factory=list)
    documents: list[StageDocument] = field(default_factory=list)
    is_cut: bool = False
    is_sound: bool = True
    wrong: list[Finding] = field(default_factory=list)

    def add(self, documents: Iterable[StageDocument]) -> None:
        """Add stages as written. What comes behind one that is not sound is not looked at: it would only follow."""
        for document in documents:
            if self.is_sound:
                self._add(document)
        self.is_sound = self.is_sound and not self.is_cut

    def _add(self, document: StageDocument) -> None:
        number = len(self.stages) + 1
        before = len(self.findings.found)

        def found(place: Place, what: str) -> None:
            edge = message("wrong.edge", pipeline=str(self.name), number=number, kind=document.kind)
            self.findings.add(place, message("wrong.at", where=edge, what=what))

        fields = self.fields[-1]
        known = (self.vocabulary, self.resource)
        context = Context(self.is_incoming, fields, self.wanted, self.folder, document.place, found, *known)
        stage = document.check(context)
        if stage is None or len(self.findings.found) > before:
            self.is_sound = False
            self.wrong = self.findings.found[before:]
            return
        self.stages.append(stage)
        self.documents.append(document)
        self.fields.append({**fields, **stage.gives})

    def map_constants(self, field: str, variable: str, values: Mapping[str, object], place: Place) -> None:
        """Add the stage that maps numbers to the names which a message declares for them."""

        def text(word: str) -> SourceText:
            return SourceText(word, place, word)

        pairs: dict[SourceText, Scalar] = {}
        for name, number in values.items():
            assert isinstance(number, int)
            if self.is_incoming:
                pairs[text(str(number))] = text(name)
            else:
                pairs[text(name)] = number
        self._add(StageDocument.of(MapDocument(field=text(field), variable=text(variable), values=pairs)))

    @property
    def chain(self) -> Chain:
        """The chain that has been made."""
        return Chain(tuple(self.stages), tuple(self.fields))

    @property
    def given(self) -> dict[str, int]:
        """The names that stages have given, each with the index of the last one that did."""
        return {
            name: index
            for index, stage in enumerate(self.stages)
            if not self._is_about_all(index)
            for name in stage.gives
        }

    def _is_about_all(self, index: int) -> bool:
        """Return whether a stage is about every field there is: that is no use of any."""
        content = self.documents[index].content
        return isinstance(content, FoldDocument) and not content.fields

    @property
    def between(self) -> dict[str, str]:
        """The values that discretised names have between their points."""
        made = [each.content for each in self.documents if isinstance(each.content, DiscretiseDocument)]
        return {str(each.variable): str(each.otherwise) for each in made if each.otherwise is not None}

    def place_of(self, name: str) -> Place:
        """Return where a name that a stage has given is written, or the pipeline itself."""
        index = self.given.get(name)
        if index is None:
            return self.name.place
        document = self.documents[index]
        given = document.named(self.is_incoming, NameUse.GIVEN, NameUse.KEPT)
        return next((text.place for text in given if text == name), document.place)

    def edge(self, index: int) -> Message:
        """A stage, as findings name it."""
        kind = self.documents[index].kind
        return message("wrong.edge", pipeline=str(self.name), number=index + 1, kind=kind)

    def at_origin(self, name: str, what: str) -> str:
        """Say something of the stage that has given a name, if one has."""
        index = self.given.get(name)
        return what if index is None else message("wrong.at", where=self.edge(index), what=what)

    def unread(self, read_behind: frozenset[str]) -> Iterator[tuple[str, Message]]:
        """The names given for which there is no use, each with its stage: not wanted, and read by nothing later."""
        for name, index in self.given.items():
            behind = (each for each in range(index + 1, len(self.stages)) if not self._is_about_all(each))
            later = frozenset().union(*(self.keys_read(each) for each in behind))
            if name not in later | read_behind and not is_field(self.wanted, name):
                yield name, self.edge(index)

    def keys_read(self, index: int) -> frozenset[str]:
        """The keys of the record before a stage that it reads."""
        fields = self.fields[index]
        keys = set()
        for path in self.stages[index].reads:
            try:
                keys.add(find_field(fields, path)[0].key)
            except NoFieldError:
                keys.add(path)
        return frozenset(keys)

    def origins(self, names: Iterable[str]) -> dict[str, frozenset[str]]:
        """Of each key at the end, the keys at the beginning from which it comes; `names` are those there."""
        come = {name: frozenset({name}) for name in names}
        for index, stage in enumerate(self.stages):
            read = self.keys_read(index)
            together = frozenset().union(*(come.get(key, frozenset()) for key in read))
            for name in stage.gives:
                own = isinstance(stage, PassingStage) and name in come
                come[name] = come[name] if own else together
        return come


def used_up(stages: Iterable[StageDocument]) -> set[str]:
    """The fields of an incoming message that stages make something else of: they are no variables themselves."""
    return {str(field) for stage in stages for field in stage.named(True, NameUse.CONSUMED, NameUse.RENAMED)}


def renamed_in(stages: Iterable[StageDocument]) -> set[str]:
    """Those of them that go on under another name."""
    return {str(field) for stage in stages for field in stage.named(True, NameUse.RENAMED)}


def check_override_names(resources: Iterable[ResourceDocument], findings: PipelineFindings) -> None:
    """Note names that a resource gives to several overrides: a person sets them by resource and name."""
    for resource in resources:
        known: dict[str, SourceText] = {}
        pipelines = (
            *(each.pipeline for each in resource.topics.values()),
            *(each.pipeline for each in resource.flows.values()),
        )
        overrides = [each.content for pipeline in pipelines for each in pipeline]
        for name in (each.name for each in overrides if isinstance(each, OverrideDocument)):
            if (first := known.setdefault(name, name)) is not name:
                findings.add(name.place, message("wrong.override-name", name=str(name), line=first.place.line))


def is_field(fields: RecordType, name: str) -> bool:
    """Return whether there is such a field, by its path."""
    try:
        find_field(fields, name)
    except NoFieldError:
        return False
    return True


def names_of_constants(constants: Mapping[str, object], variable: FieldType) -> dict[str, object] | None:
    """The numbers of an enumeration whose values are names of constants in lower case; None where it is none such."""
    if not isinstance(variable, EnumerationType):
        return None
    named = {name.lower(): value for name, value in constants.items()}
    if not all(type(named.get(value)) is int for value in variable.values):
        return None
    numbers = {value: named[value] for value in variable.values}
    return numbers if len(set(numbers.values())) == len(numbers) else None
