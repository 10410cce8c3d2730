"""A draft read as far as it can be: its documents with their places, and the pipelines that are sound in it."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath

from pydantic import ValidationError

from sequence_planner.automaton.grounding.station import ground_variables
from sequence_planner.automaton.structure import Automaton
from sequence_planner.expressions.place import Place
from sequence_planner.model.documents import AbilityDocument, ResourceDocument, StationDocument
from sequence_planner.model.loading import Station
from sequence_planner.model.reading import Document, EntryPath, read_text
from sequence_planner.model.source import Finding, ModelError, SourceText
from sequence_planner.pipelines.building import Built, build_what_is_sound
from sequence_planner.pipelines.flow_building import flow_name
from sequence_planner.pipelines.inference import variables_inferred
from sequence_planner.ros.errors import MessageDefinitionError, UnknownMessageTypeError
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.workshop.files import Files, write_files
from sequence_planner.workshop.pipelines.pruning import STAGES, pruned

MESSAGES, STATION, NOTHING = "messages/", "station.yaml", "name: draft\n"
# Sections of a resource in which something has to do with pipelines.
OURS = frozenset({*STAGES, "measured", "output", "estimated"})


@dataclass(frozen=True)
class Sketch:
    """A draft as far as it makes sense. `documents` are its files as they are written, those of `unread` as they were
    when they could be read. `written` is the station without the variables that follow from messages. `cut` has of
    lists of stages the index of the first that is no stage, `lost` has topics and others that cannot be used at all.
    """

    documents: Mapping[str, Document]
    unread: tuple[str, ...]
    written: Station
    station: Station
    automaton: Automaton
    registry: MessageRegistry
    built: Built
    cut: Mapping[tuple[str, EntryPath], int]
    lost: frozenset[tuple[str, EntryPath]]
    findings: tuple[Finding, ...]

    @property
    def resources(self) -> Mapping[str, Document]:
        """The documents of resources, by their names."""
        return {resource_of(file): document for file, document in self.documents.items() if resource_of(file)}


def resource_of(file: str) -> str:
    """The resource that a file is about; nothing for other files."""
    at = PurePosixPath(file)
    return at.stem if at.parts[:1] == ("resources",) else ""


@dataclass
class Reader:
    """Reads drafts one after the other; what has not changed is not read again. `folder` is empty and its own; message
    definitions and Python stages are there for those who look for them.
    """

    folder: Path
    _read: dict[str, tuple[str, Document]] = field(default_factory=dict)
    _definitions: dict[str, str] | None = None
    _registry: MessageRegistry | None = None
    _wrong: list[Finding] = field(default_factory=list)

    def beside(self) -> Reader:
        """Another that knows the same, and of which this one learns nothing."""
        return replace(self, _read=dict(self._read))

    def sketch(self, files: Files) -> Sketch:
        """The draft that consists of these files."""
        registry, findings = self._messages(files)
        documents, unread, wrong = self._documents(files)
        return _sketch(self.folder, documents, unread, registry, [*findings, *wrong])

    def _documents(self, files: Files) -> tuple[dict[str, Document], tuple[str, ...], list[Finding]]:
        """The documents; one that cannot be read stands as it was when it could be."""
        found: dict[str, Document] = {}
        unread: list[str] = []
        findings: list[Finding] = []
        for path in sorted({STATION, *(each for each in files if resource_of(each))}):
            text = files.get(path, NOTHING)
            known = self._read.get(path)
            if known is None or known[0] != text:
                try:
                    self._read[path] = text, read_text(text, path)
                except ModelError as error:
                    findings += error.findings
                    unread.append(path)
            if path in self._read:
                found[path] = self._read[path][1]
        return found, tuple(unread), findings

    def _messages(self, files: Files) -> tuple[MessageRegistry, list[Finding]]:
        """The message types; definitions that cannot be used are left out."""
        definitions = {path: text for path, text in files.items() if path.startswith(MESSAGES)}
        if self._registry is None or self._definitions != definitions:
            self._definitions = definitions
            self._registry, self._wrong = self._defined(dict(definitions))
        return self._registry, self._wrong

    def _defined(self, definitions: dict[str, str]) -> tuple[MessageRegistry, list[Finding]]:
        findings: list[Finding] = []
        folder = self.folder / MESSAGES
        while True:
            shutil.rmtree(folder, ignore_errors=True)
            write_files(definitions, self.folder)
            try:
                return MessageRegistry.from_folder(folder if folder.is_dir() else None), findings
            except MessageDefinitionError as error:
                path = str(error.path).removeprefix(f"{self.folder}/")
                findings.append(Finding(Place(path, error.line, error.column), error.text))
                if definitions.pop(path, None) is None:
                    return MessageRegistry.from_folder(None), findings


def _sketch(
    folder: Path,
    documents: Mapping[str, Document],
    unread: tuple[str, ...],
    registry: MessageRegistry,
    findings: list[Finding],
) -> Sketch:
    cut: dict[tuple[str, EntryPath], int] = {}
    lost: set[tuple[str, EntryPath]] = set()
    resources: dict[str, ResourceDocument] = {}
    for file, document in documents.items():
        if name := resource_of(file):
            resources[name], said = _resource(file, document, cut, lost)
            findings += said
    written = Station(folder, _station(documents[STATION]), resources, {}, {}, {})
    station, inferred = variables_inferred(written, registry)
    names = _cut_names(cut)
    places = {documents[file].place(path[:2]) for file, path in cut}
    findings += [each for each in inferred if each.place not in places]  # what a cut pipeline uses up nobody knows
    station, unknown = _without_unknown(station, registry)
    for name, topic in unknown:
        lost.add((f"resources/{name}.yaml", ("topics", str(topic))))
    automaton, declared = ground_variables(station)
    findings += declared
    built = build_what_is_sound(station, automaton, registry, names)
    built = replace(built, findings=[_within(folder, each) for each in built.findings])
    found = tuple(_within(folder, each) for each in findings)
    return Sketch(documents, unread, written, station, automaton, registry, built, cut, frozenset(lost), found)


def _within(folder: Path, finding: Finding) -> Finding:
    """A finding with its file as it is called within the model."""
    place = finding.place
    return replace(finding, place=place._replace(file=place.file.removeprefix(f"{folder}/")))


def _resource(
    file: str, document: Document, cut: dict[tuple[str, EntryPath], int], lost: set[tuple[str, EntryPath]]
) -> tuple[ResourceDocument, list[Finding]]:
    """What a resource says of its pipelines and variables. Of its abilities only their names matter."""
    content = document.content if isinstance(document.content, dict) else {}
    own = {key: value for key, value in content.items() if key in OURS}
    read, said = pruned(document, own, ResourceDocument)
    cut.update({(file, path): index for path, index in said.cut.items()})
    lost.update((file, path) for path in said.lost)
    written = next((value for key, value in content.items() if key == "abilities"), None)
    abilities = dict.fromkeys(written, AbilityDocument()) if isinstance(written, dict) else {}
    return read.model_copy(update={"abilities": abilities}), said.findings


def _station(document: Document) -> StationDocument:
    """The names of the station; what is wrong with it is not said here, as it is no matter of pipelines."""
    content = document.content if isinstance(document.content, dict) else {}
    own = {key: value for key, value in content.items() if key in ("enumerations", "estimated")}
    place = document.place(())
    name = SourceText("draft", place, "draft")
    for keys in (("enumerations", "estimated"), ("enumerations",), ()):
        try:
            chosen = {key: value for key, value in own.items() if key in keys}
            return StationDocument.model_validate({SourceText("name", place, "name"): name, **chosen})
        except ValidationError:
            continue
    raise AssertionError("a station with a name is one")


def _cut_names(cut: Mapping[tuple[str, EntryPath], int]) -> list[str]:
    """What pipelines are called of which not all stages can be read."""
    return [pipeline_name(resource_of(file), path) for file, path in cut]


def pipeline_name(resource: str, path: EntryPath) -> str:
    """What a pipeline is called whose stages stand at `path`."""
    section, name, part = map(str, path[:3])
    if section == "flows":
        return flow_name(resource, name)
    return name if section == "topics" else f"{name} {part}"


def _without_unknown(station: Station, registry: MessageRegistry) -> tuple[Station, list[tuple[str, SourceText]]]:
    """The station without topics of types that nobody knows, and these."""
    unknown: list[tuple[str, SourceText]] = []
    resources = {}
    for resource, document in station.resources.items():
        without = [name for name, topic in document.topics.items() if not _is_known(registry, str(topic.type))]
        unknown += ((resource, name) for name in without)
        kept = {name: topic for name, topic in document.topics.items() if name not in without}
        resources[resource] = document.model_copy(update={"topics": kept}) if without else document
    return replace(station, resources=resources), unknown


def _is_known(registry: MessageRegistry, type_name: str) -> bool:
    try:
        registry.fields(type_name)
    except UnknownMessageTypeError:
        return False
    return True
