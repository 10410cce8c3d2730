"""Fault-tolerant reader of a draft: documents without invalid entries, and the pipelines of the rest."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.grounding.station import ground_variables
from sequence_planner.language.types import Place
from sequence_planner.model.documents import AbilityDocument, ResourceDocument, StationDocument
from sequence_planner.model.files import Files, write_files
from sequence_planner.model.loader import Station
from sequence_planner.model.paths import resource_of, type_of
from sequence_planner.model.source import Finding, ModelError, SourceText
from sequence_planner.model.types.layers import WrittenOut
from sequence_planner.model.validation import findings_of
from sequence_planner.model.yaml.reader import EntryPath, YamlDocument, read_text
from sequence_planner.pipelines.builder import Built, build_what_is_sound, flow_name
from sequence_planner.pipelines.inference import variables_inferred
from sequence_planner.ros.types.errors import MessageDefinitionError, UnknownMessageTypeError
from sequence_planner.ros.types.messages import MessageRegistry

# Documents of a draft without what cannot be used in them: what is wrong in one place keeps nothing else from being
# read.
#
# pydantic alone says what is wrong. It is taken out, and the rest is looked at again.

D = TypeVar("D", bound=BaseModel)

# Where the stages of an entry of each section stand.
STAGES: Mapping[str, tuple[str, ...]] = {
    "topics": ("pipeline",),
    "flows": ("pipeline",),
    "services": ("request", "response"),
    "actions": ("goal", "feedback", "result"),
}
# What an entry of each section cannot be without.
_NEEDED: Mapping[str, frozenset[str]] = {
    "topics": frozenset({"type", "direction"}),
    "flows": frozenset({"from"}),
    "services": frozenset({"type"}),
    "actions": frozenset({"type", "when", "status"}),
}
_OWN_NAMES = 2  # a section and the name of an entry


@dataclass
class Pruned:
    """The faults of a document, the lists of stages that are `cut` with the index of the first that is gone, and the
    entries that are `lost` as a whole.
    """

    findings: list[Finding] = field(default_factory=list)
    cut: dict[EntryPath, int] = field(default_factory=dict)
    lost: set[EntryPath] = field(default_factory=set)


def pruned(document: YamlDocument, content: dict[SourceText, object], kind: type[D]) -> tuple[D, Pruned]:
    """The document with what is usable of `content`, which is one of `kind` but for what is wrong in it."""
    result = Pruned()
    while True:
        try:
            return kind.model_validate(content), result
        except ValidationError as error:
            if not result.findings:
                result.findings += findings_of(error, document, (), kind)
            before = content
            for each in {tuple(map(_step, details["loc"])) for details in error.errors()}:
                content = _without(content, each, result)
            if content == before:
                return kind.model_validate({}), result


def _step(part: str | int) -> str | int:
    return str(part) if isinstance(part, str) else part


def _without(content: dict[SourceText, object], at: EntryPath, result: Pruned) -> dict[SourceText, object]:
    """Without the smallest part around a place that can be left out."""
    section = str(at[0]) if at else ""
    entries = _at(content, section)
    if len(at) < _OWN_NAMES or not isinstance(entries, dict):
        return {key: value for key, value in content.items() if key != section}
    name = str(at[1])
    entry = _at(entries, name)
    if isinstance(entry, dict):
        shorter = _without_part(section, entry, at, result)
        if shorter is not None:
            return {**content, _key(content, section): {**entries, _key(entries, name): shorter}}
    result.lost.add((section, name))
    left = {key: value for key, value in entries.items() if key != name}
    return {**content, _key(content, section): left}


def _without_part(
    section: str, entry: dict[SourceText, object], at: EntryPath, result: Pruned
) -> dict[SourceText, object] | None:
    """The entry without the part, or None where it is nothing without it."""
    if len(at) == _OWN_NAMES:  # what its parts say together makes no sense: those remain without which it is none
        kept = {*_NEEDED.get(section, ()), *STAGES.get(section, ()), "ignore"}
        left = {key: value for key, value in entry.items() if key in kept}
        return left if section in STAGES and len(left) < len(entry) else None
    part = at[_OWN_NAMES]
    stages = _at(entry, str(part))
    if part in STAGES.get(section, ()) and isinstance(stages, list) and len(at) > _OWN_NAMES + 1:
        index = at[_OWN_NAMES + 1]
        if isinstance(index, int):
            path = (*at[:_OWN_NAMES], part)
            result.cut[path] = min(index, result.cut.get(path, index))
            return {**entry, _key(entry, str(part)): stages[: result.cut[path]]}
    if part in entry and part not in _NEEDED.get(section, ()) and section in STAGES:
        if part in STAGES[section]:
            result.cut[(*at[:_OWN_NAMES], part)] = 0
        return {key: value for key, value in entry.items() if key != part}
    return None


def _at(mapping: Mapping[SourceText, object], name: str) -> object:
    return next((value for key, value in mapping.items() if key == name), None)


def _key(mapping: Mapping[SourceText, object], name: str) -> SourceText:
    """The key as it is written, with its place."""
    return next(key for key in mapping if key == name)


# A draft read as far as it can be: its documents with their places, and the pipelines that are sound in it.

MESSAGES, STATION, NOTHING = "messages/", "station.yaml", "name: draft\n"
_OF_PACKAGE = f"/{MESSAGES}"  # in `packages/<name>/messages/`
# Sections of a resource in which something has to do with pipelines.
OURS = frozenset({*STAGES, "measured", "output", "estimated", "relations", "maps"})


@dataclass(frozen=True)
class Sketch:
    """A draft as far as it makes sense. `documents` are its files as they are written, those of `unread` as they were
    when they could be read. `written` is the station without the variables that follow from messages. `cut` has of
    lists of stages the index of the first that is no stage, `lost` has topics and others that cannot be used at all.
    """

    documents: Mapping[str, YamlDocument]
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
    def resources(self) -> Mapping[str, YamlDocument]:
        """The documents of resources, by their names."""
        return {name: document for file, document in self.documents.items() if (name := resource_of(file))}


@dataclass
class DraftReader:
    """Reads drafts one after the other; what has not changed is not read again. `folder` is empty and its own; message
    definitions and Python stages are there for those who look for them.
    """

    folder: Path
    _read: dict[str, tuple[str, YamlDocument]] = field(default_factory=dict)
    _definitions: dict[str, str] | None = None
    _registry: MessageRegistry | None = None
    _wrong: list[Finding] = field(default_factory=list)

    def beside(self) -> DraftReader:
        """Another that knows the same, and of which this one learns nothing."""
        return replace(self, _read=dict(self._read))

    def sketch(self, files: Files) -> Sketch:
        """The draft that consists of these files."""
        registry, findings = self._messages(files)
        documents, unread, wrong = self._documents(files)
        return _sketch(self.folder, WrittenOut(documents).documents, unread, registry, [*findings, *wrong])

    def _documents(self, files: Files) -> tuple[dict[str, YamlDocument], tuple[str, ...], list[Finding]]:
        """The documents; one that cannot be read stands as it was when it could be."""
        found: dict[str, YamlDocument] = {}
        unread: list[str] = []
        findings: list[Finding] = []
        for path in sorted({STATION, *(each for each in files if resource_of(each) or type_of(each))}):
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
        if STATION not in found:  # as it could never be read
            found[STATION] = read_text(NOTHING, STATION)
        return found, tuple(unread), findings

    def _messages(self, files: Files) -> tuple[MessageRegistry, list[Finding]]:
        """The message types; definitions that cannot be used are left out."""
        definitions = {path: text for path, text in files.items() if path.startswith(MESSAGES) or _OF_PACKAGE in path}
        if self._registry is None or self._definitions != definitions:
            self._definitions = definitions
            self._registry, self._wrong = self._defined(dict(definitions))
        return self._registry, self._wrong

    def _defined(self, definitions: dict[str, str]) -> tuple[MessageRegistry, list[Finding]]:
        findings: list[Finding] = []
        folder = self.folder / MESSAGES
        while True:
            shutil.rmtree(folder, ignore_errors=True)
            shutil.rmtree(self.folder / "packages", ignore_errors=True)
            write_files(definitions, self.folder)
            folders = [each for each in (folder, *self.folder.glob(f"packages/*/{MESSAGES}")) if each.is_dir()]
            try:
                return MessageRegistry.from_folder(None, *folders), findings
            except MessageDefinitionError as error:
                path = str(error.path).removeprefix(f"{self.folder}/")
                findings.append(Finding(Place(path, error.line, error.column), error.text))
                if definitions.pop(path, None) is None:
                    return MessageRegistry.from_folder(None), findings


def _sketch(
    folder: Path,
    documents: Mapping[str, YamlDocument],
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
    file: str, document: YamlDocument, cut: dict[tuple[str, EntryPath], int], lost: set[tuple[str, EntryPath]]
) -> tuple[ResourceDocument, list[Finding]]:
    """Return what a resource says of its pipelines and variables. Of its abilities only their names matter."""
    content = document.content if isinstance(document.content, dict) else {}
    own = {key: value for key, value in content.items() if key in OURS}
    read, said = pruned(document, own, ResourceDocument)
    cut.update({(file, path): index for path, index in said.cut.items()})
    lost.update((file, path) for path in said.lost)
    written = next((value for key, value in content.items() if key == "abilities"), None)
    abilities = dict.fromkeys(written, AbilityDocument()) if isinstance(written, dict) else {}
    return read.model_copy(update={"abilities": abilities}), said.findings


def _station(document: YamlDocument) -> StationDocument:
    """The names of the station; what is wrong with it is not said here, as it is no matter of pipelines."""
    content = document.content if isinstance(document.content, dict) else {}
    whole = ("enumerations", "estimated", "sets", "maps", "relations")
    own = {key: value for key, value in content.items() if key in whole}
    place = document.place(())
    name = SourceText("draft", place, "draft")
    for keys in (whole[:end] for end in range(len(whole), -1, -1)):
        try:
            chosen = {key: value for key, value in own.items() if key in keys}
            return StationDocument.model_validate({SourceText("name", place, "name"): name, **chosen})
        except ValidationError:
            continue
    raise AssertionError("a station with a name is one")


def _cut_names(cut: Mapping[tuple[str, EntryPath], int]) -> list[str]:
    """Return what pipelines are called of which not all stages can be read."""
    return [pipeline_name(resource_of(file) or "", path) for file, path in cut]


def pipeline_name(resource: str, path: EntryPath) -> str:
    """Return what a pipeline is called whose stages stand at `path`."""
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
