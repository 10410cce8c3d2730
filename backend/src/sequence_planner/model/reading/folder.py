"""The files of a station's folder, each read once for its text."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar, cast

from pydantic import BaseModel, ValidationError

from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.types import Place
from sequence_planner.model.documents import (
    OperationDocument,
    ResourceDocument,
    StationDocument,
)
from sequence_planner.model.paths import DEFINITIONS, DRAWING, DRAWINGS, FILES, FOLDERS, TESTS, has_scenarios
from sequence_planner.model.sequences import SequenceDocument, is_sequence
from sequence_planner.model.source import Finding, ModelError, SourceText
from sequence_planner.model.validation import findings_of, shown
from sequence_planner.model.yaml.reader import EntryPath, YamlDocument, read_text, text_of
from sequence_planner.texts.message import message

if TYPE_CHECKING:
    from sequence_planner.model.mimic.documents import MimicDocument
    from sequence_planner.model.scenarios.documents import ScenarioDocument
    from sequence_planner.model.shifts.documents import ShiftDocument
    from sequence_planner.model.types.instances import InstancesBefore
    from sequence_planner.model.types.layers import Layer, UnusedType, WrittenInstance

D = TypeVar("D", bound=BaseModel)


class ReadBefore:
    """The contents found in the files of one station, each for its text: what is the same is not read again."""

    def __init__(self) -> None:
        self._known: dict[tuple[str, type[BaseModel]], tuple[str, object, tuple[Finding, ...]]] = {}
        self.instances: InstancesBefore | None = None
        self.with_sets: dict[str, tuple[ResourceDocument, ResourceDocument]] = {}

    def find(self, name: str, kind: type[BaseModel], text: str) -> tuple[object, tuple[Finding, ...]] | None:
        """Return what the file `name` holds as `kind`, and what is wrong with it; None unless it was read with this
        text.
        """
        known = self._known.get((name, kind))
        return None if known is None or known[0] != text else known[1:]

    def keep(self, name: str, kind: type[BaseModel], text: str, found: object, wrong: tuple[Finding, ...]) -> None:
        """Remember that."""
        self._known[name, kind] = text, found, wrong

    def forget_others(self, names: Collection[str]) -> None:
        """Let go what files were read that are not among these."""
        self._known = {key: known for key, known in self._known.items() if key[0] in names}


def unread_files(folder: Path) -> Iterator[Finding]:
    """Yield the files in the folder of a station that are no part of it, though their names are almost right."""
    for path in sorted(each for below in ("", "resources/", "types/") for each in folder.glob(f"{below}*.yml")):
        yield Finding(Place(str(path), 1, 1), message("wrong.rename-to-yaml", name=path.stem))
    for below in ("resources", "types"):
        for path in sorted((folder / below).glob("*")):
            if path.suffix not in (".yaml", ".yml") and not path.name.startswith("."):
                yield Finding(Place(str(path), 1, 1), message(f"wrong.not-read.{below}"))
    for kind in DEFINITIONS:
        for path in sorted((folder / "messages").rglob(f"*.{kind}")):
            if len(path.relative_to(folder).parts) != 4 or path.parent.name != kind:
                yield Finding(
                    Place(str(path), 1, 1), message(f"wrong.not-read.{kind}", form=f"<package>/{kind}/<Name>.{kind}")
                )
    for path in sorted(each for each in folder.glob("*") if each.is_dir() and each.name not in FOLDERS):
        if near := suggestion(path.name, FOLDERS, likeness=0.75):
            yield Finding(Place(str(path), 1, 1), message("wrong.folder-not-read", hint=near))
    for path in sorted(folder.glob("*.yaml")):
        if path.name not in FILES:
            said = message("wrong.file-not-read", hint=suggestion(path.name, FILES))
            yield Finding(Place(str(path), 1, 1), said)


_SCENARIO_NAME = re.compile(r"\w{1,100}")


def is_scenario_file(path: Path, folder: Path) -> bool:
    """Return whether a file in the folder of a station is one of scenarios."""
    return path.is_file() and has_scenarios(path.relative_to(folder).as_posix())


_OF_INSTANCES = frozenset({"type", "arguments", "remove"})  # keys that no other resource has

# The content of a file and what is wrong with it, from the file as it was read.
_Reading = Callable[[YamlDocument], tuple[object, list[Finding]]]


class FolderDocuments:
    """Reads the documents of a station's folder, and gathers what is wrong with their form."""

    def __init__(self, folder: Path, before: ReadBefore | None) -> None:
        self._folder = folder
        self._before = before or ReadBefore()
        self._names: set[str] = set()
        self._brought: dict[str, list[str]] = {}
        self.findings: list[Finding] = []
        self.empty: list[Place] = []
        self.layers: Mapping[str, Sequence[Layer]] = {}
        self.unused: Mapping[str, UnusedType] = {}

    def whole(self, name: str, kind: type[D]) -> D | None:
        """A file that is one document."""
        found = self._once(name, kind, lambda document: _validated(document, document.content, (), kind))
        return cast("D | None", found)

    def mimic(self) -> tuple[MimicDocument | None, tuple[Finding, ...], dict[str, SourceText]]:
        """The picture, what is wrong with its form, and the drawings for it."""
        if not (self._folder / "mimic.yaml").exists():
            return None, (), {}
        from sequence_planner.model.mimic.documents import MimicDocument  # noqa: PLC0415 (few stations have one)

        before = len(self.findings)
        document = self.whole("mimic.yaml", MimicDocument)
        drawings: dict[str, SourceText] = {}
        for path in sorted((self._folder / DRAWINGS).glob("[!.]*")):
            place = Place(str(path), 1, 1)
            if not DRAWING.fullmatch(path.name):
                self.findings.append(Finding(place, message("wrong.not-read.drawing")))
                continue
            try:
                text = text_of(path, str(path))
            except ModelError as error:
                self.findings += error.findings
            else:
                drawings[f"{DRAWINGS}/{path.name}"] = SourceText(text, place, text)
        undrawn = tuple(self.findings[before:])
        del self.findings[before:]
        return document, undrawn, drawings

    def shifts(self) -> dict[SourceText, ShiftDocument]:
        """The shifts; none where the station has no such file."""
        if not (self._folder / "shifts.yaml").exists():
            return {}
        from sequence_planner.model.shifts.documents import ShiftDocument, unfit_times  # noqa: PLC0415

        found = self.entries("shifts.yaml", ShiftDocument)
        self.findings += unfit_times(found)
        return found

    def scenarios(self) -> tuple[dict[SourceText, ScenarioDocument], tuple[Finding, ...]]:
        """The scenarios of all files, and what is wrong with their form; of one name the first is taken."""
        within = (self._folder / TESTS).rglob("[!.]*")
        written = sorted(each for each in within if each.suffix in (".yaml", ".yml"))
        if not written:
            return {}, ()
        from sequence_planner.model.scenarios.documents import ScenarioDocument  # noqa: PLC0415

        before, empty = len(self.findings), len(self.empty)
        paths = [each for each in written if is_scenario_file(each, self._folder)]
        unread = (each for each in written if each not in paths)
        self.findings += [Finding(Place(str(each), 1, 1), message("wrong.not-read.tests")) for each in unread]
        found: dict[SourceText, ScenarioDocument] = {}
        places: dict[str, Place] = {}
        for path in paths:
            for name, each in self.entries(f"{TESTS}/{path.name}", ScenarioDocument).items():
                if not _SCENARIO_NAME.fullmatch(name):
                    self.findings.append(Finding(name.place, message("wrong.scenario-name")))
                    continue
                if (first := places.setdefault(str(name), name.place)) is not name.place:
                    said = message("wrong.scenario-twice", name=str(name), place=str(first))
                    self.findings.append(Finding(name.place, said))
                else:
                    found[name] = each
        unreadable = tuple(self.findings[before:])
        del self.findings[before:], self.empty[empty:]
        return found, unreadable

    def packaged(
        self, station: StationDocument | None
    ) -> tuple[StationDocument | None, dict[str, WrittenInstance | None]]:
        """The station with the enumerations of its packages, and the types of these."""
        if station is None or not (station.packages or (self._folder / "packages").is_dir()):
            return station, {}
        from sequence_planner.model.types.layers import read_type  # noqa: PLC0415 (few stations have packages)
        from sequence_planner.model.types.packages import UsedPackages  # noqa: PLC0415

        used = UsedPackages(self._folder, station)
        self.findings.extend(used.findings)
        self._brought = used.brought
        types: dict[str, WrittenInstance | None] = {
            f"{package}.*": None for package in station.packages if package not in used.packages
        }
        for package in used.packages:
            for file in used.files_of(package):
                found = self._once(file, BaseModel, partial(read_type, package=package))
                types[f"{package}.{Path(file).stem}"] = cast("WrittenInstance | None", found)
        declared = {section: {**brought, **getattr(station, section)} for section, brought in used.declared.items()}
        return station.model_copy(update=declared), types

    def all_resources(
        self, station: StationDocument | None, of_packages: dict[str, WrittenInstance | None]
    ) -> dict[str, ResourceDocument]:
        """The resources, those that are instances of types as if they were written out."""
        paths = sorted((self._folder / "resources").glob("*.yaml"))
        found = {path.stem: self._once(f"resources/{path.name}", ResourceDocument, _resource) for path in paths}
        types = {**self._types(), **of_packages}
        if types or not all(each is None or isinstance(each, ResourceDocument) for each in found.values()):
            found = self._instantiated(found, types, station)
        known = cast("dict[str, ResourceDocument]", {name: each for name, each in found.items() if each is not None})
        return self._with_own_sets(known)

    def _with_own_sets(self, resources: dict[str, ResourceDocument]) -> dict[str, ResourceDocument]:
        """The same, with sets of resources by their full names."""
        if not any(each.sets for each in resources.values()):
            return resources
        from sequence_planner.model.types.own_sets import with_own_sets  # noqa: PLC0415 (few resources have some)

        before, self._before.with_sets = self._before.with_sets, {}
        for name, each in resources.items():
            known = before.get(name)
            made = known[1] if known is not None and known[0] is each else with_own_sets(name, each)
            self._before.with_sets[name] = each, made
        return {name: made for name, (_, made) in self._before.with_sets.items()}

    def _types(self) -> dict[str, WrittenInstance | None]:
        """The types of the station, by their names; None where one cannot be read."""
        paths = sorted((self._folder / "types").glob("*.yaml"))
        if not paths:
            return {}
        from sequence_planner.model.types.layers import read_type  # noqa: PLC0415 (few stations have one)

        found = {
            path.stem: self._once(f"types/{path.name}", BaseModel, partial(read_type, package="")) for path in paths
        }
        return cast("dict[str, WrittenInstance | None]", found)

    def _instantiated(
        self, found: dict[str, object], types: dict[str, WrittenInstance | None], station: StationDocument | None
    ) -> dict[str, object]:
        from sequence_planner.model.types.instances import Instances, InstancesBefore  # noqa: PLC0415
        from sequence_planner.model.types.layers import WrittenInstance  # noqa: PLC0415

        if station is None:  # nobody knows its enumerations
            return {}
        self._before.instances = self._before.instances or InstancesBefore()
        instances = Instances(types, station, found, self._before.instances, self._brought)
        made = {
            name: instances.made_of(name, each) if isinstance(each, WrittenInstance) else each
            for name, each in found.items()
        }
        self.unused = instances.read_unused()
        self.findings.extend(instances.findings)
        self.layers = instances.layers
        return made

    def entries(
        self, name: str, kind: type[D], kind_of: Callable[[object], type[D]] | None = None
    ) -> dict[SourceText, D]:
        """A file that maps names to documents, each of a `kind` that may depend on what it holds; it may be missing."""
        if not (self._folder / name).exists():
            return {}
        found = self._once(name, kind, lambda document: _validated_entries(document, kind_of or (lambda _: kind)))
        entries = cast("dict[SourceText, D] | None", found) or {}
        if not entries:
            self.empty.append(Place(str(self._folder / name), 1, 1))
        return entries

    def end(self) -> None:
        """All files were asked for."""
        self._before.forget_others(self._names)

    def _once(self, name: str, kind: type[BaseModel], reading: _Reading) -> object:
        """Return what the file holds, read now unless it was with the same text before; None where it cannot be
        read.
        """
        self._names.add(name)
        called = str(self._folder / name)
        try:
            text = text_of(self._folder / name, called)
        except ModelError as error:
            self.findings.extend(error.findings)
            return None
        known = self._before.find(name, kind, text)
        if known is None:
            try:
                found, wrong = reading(read_text(text, called))
            except ModelError as error:
                found, wrong = None, error.findings
            known = found, tuple(wrong)
            self._before.keep(name, kind, text, *known)
        self.findings.extend(known[1])
        return known[0]


def _resource(document: YamlDocument) -> tuple[object, list[Finding]]:
    """A resource, or an instance of a type, which is made one when that is known."""
    if isinstance(document.content, dict) and not _OF_INSTANCES.isdisjoint(document.content):
        from sequence_planner.model.types.layers import read_instance  # noqa: PLC0415

        return read_instance(document)
    return _validated(document, document.content, (), ResourceDocument)


def station_packages(document: YamlDocument) -> StationDocument:
    """A station of which only its name and its packages are looked at. Raises `ModelError`."""
    content = document.content
    if isinstance(content, dict):
        content = {key: each for key, each in content.items() if key in ("name", "packages")}
    station, findings = _validated(document, content, (), StationDocument)
    if findings:
        raise ModelError(findings)
    return cast(StationDocument, station)


def operation_kind(content: object) -> type[OperationDocument | SequenceDocument]:
    """Return what an entry of `operations.yaml` is meant to be."""
    return SequenceDocument if is_sequence(content) else OperationDocument


def _validated_entries(
    document: YamlDocument, kind_of: Callable[[object], type[BaseModel]]
) -> tuple[object, list[Finding]]:
    if not isinstance(document.content, dict):
        said = message("wrong.expected", wanted=message("expected.names"), found=shown(document.content), hint="")
        return {}, [Finding(document.place(()), said)]
    entries: dict[SourceText, object] = {}
    findings: list[Finding] = []
    for key, content in document.content.items():
        entry, wrong = _validated(document, content, (str(key),), kind_of(content))
        findings += wrong
        if entry is not None:
            entries[key] = entry
    return entries, findings


def _validated(
    document: YamlDocument, content: object, at: EntryPath, kind: type[BaseModel]
) -> tuple[BaseModel | None, list[Finding]]:
    try:
        return kind.model_validate(content), []
    except ValidationError as error:
        return None, findings_of(error, document, at, kind)
