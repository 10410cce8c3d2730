"""Packages of types: what a package is, what is locked of it, and whether what a station has of it is that."""

from __future__ import annotations

import hashlib
import operator
import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, TypeVar

from pydantic import BaseModel, Field, ValidationError
from pydantic.types import StringConstraints

from sequence_planner.language.types import Place
from sequence_planner.model.documents import (
    EnumerationForm,
    NamedCondition,
    PackageSourceDocument,
    RelationDocument,
    SetDocument,
    StationDocument,
    ValueMapDocument,
)
from sequence_planner.model.fields import DocumentPart, Given
from sequence_planner.model.files import is_package_name, package_files
from sequence_planner.model.source import Finding, ModelError, SourceText
from sequence_planner.model.validation import findings_of
from sequence_planner.model.yaml.reader import YamlDocument, read_text
from sequence_planner.texts.message import message

# What a package declares for a station.
SECTIONS = ("enumerations", "sets", "relations", "maps", "predicates")
MANIFEST, LOCK, FOLDER = "package.yaml", "packages.lock", "packages"
VERSION = r"\d+(\.\d+)*"
_RANGE = rf"(?:==|>=|<=|>|<) *{VERSION}"
_NEEDS = re.compile(rf"{_RANGE}(?: *, *{_RANGE})*")
_HOLDS: Mapping[str, Callable[[list[int], list[int]], bool]] = {
    "==": operator.eq,
    ">=": operator.ge,
    "<=": operator.le,
    ">": operator.gt,
    "<": operator.lt,
}
D = TypeVar("D", bound=BaseModel)
Files = Mapping[str, str]  # of a package, by their paths in it


class PackageDocument(DocumentPart):
    """What a package is: types in `types`, definitions of messages in `messages`, and its enumerations."""

    name: SourceText
    """Its name, by which stations name its types: `name.type`."""
    version: SourceText
    """Its version, such as `1.2.0`, in quotes where YAML would read a number."""
    title: Given[SourceText] = None
    """For people."""
    needs: dict[SourceText, SourceText] = Field(default_factory=dict)
    """Other packages, each with its versions: `">=1.0, <2"`."""
    enumerations: dict[SourceText, EnumerationForm] = Field(default_factory=dict)
    """Enumerations that a station has with it."""
    sets: dict[SourceText, SetDocument] = Field(default_factory=dict)
    """Named sets of values that a station has with it."""
    relations: dict[SourceText, RelationDocument] = Field(default_factory=dict)
    """Relations between values that a station has with it."""
    maps: dict[SourceText, ValueMapDocument] = Field(default_factory=dict)
    """Maps of values that a station has with it."""
    predicates: dict[SourceText, NamedCondition] = Field(default_factory=dict)
    """Conditions with a name that a station has with it."""


class LockedPackage(DocumentPart):
    """What was brought of a package."""

    source: SourceText
    version: SourceText
    revision: Given[SourceText] = None
    hash: Annotated[str, StringConstraints(pattern="^[0-9a-f]{64}$")]


class PackageError(Exception):
    """A package that cannot be brought, or is not what is locked; the text says what to do."""


class UsedPackages:
    """The packages of a station, as far as they are what they should be; `findings` has what is wrong.

    Nothing of them is read from anywhere else than the station's folder.
    """

    def __init__(self, folder: Path, station: StationDocument) -> None:
        self._folder = folder
        self.findings: list[Finding] = []
        self.declared: dict[str, dict[SourceText, Any]] = {section: {} for section in SECTIONS}
        self.brought: dict[str, list[str]] = {}  # the enumerations of each package
        self.packages: dict[str, PackageDocument] = {}
        self._files: dict[str, Files] = {}
        locked = self._locked()
        for name in station.packages:
            self._add(name, station, locked)
        for each, package in self.packages.items():
            self._check_needs(each, station)
            self._add_declared(each, package, station)
        self._require_named(station)

    def files_of(self, name: str) -> Iterator[str]:
        """The types of a package, as files of the station."""
        yield from sorted(f"{FOLDER}/{name}/{each}" for each in self._files[name] if each.startswith("types/"))

    def _locked(self) -> dict[str, LockedPackage]:
        try:
            return read_lock(self._folder)
        except ModelError as error:
            self.findings += error.findings
            return {}

    def _add(self, name: SourceText, station: StationDocument, locked: Mapping[str, LockedPackage]) -> None:
        if not is_package_name(name):
            self._note(name.place, f"`{name}` is no name of a package: use letters, digits and `_`")
            return
        home = self._folder / FOLDER / name
        if not (home / MANIFEST).is_file() or name not in locked:
            what = "is not here" if name in locked else "is not locked"
            self._note(name.place, f"the package `{name}` {what}: bring it with `sequence-planner packages fetch`")
            return
        try:
            files = package_files(home)
        except OSError as error:
            self._note(name.place, f"the package `{name}` cannot be read: {error.strerror}")
            return
        if (source := source_of(station.packages[name])) != locked[name].source:
            said = f"{LOCK} has the package `{name}` from {locked[name].source}, and not from {source}"
            self._note(name.place, f"{said}: bring it with `sequence-planner packages fetch`")
            return
        if digest_of(files) != locked[name].hash:
            ways = (
                "`packages fetch` brings back what is locked if its source still has that, "
                f"`packages update {name}` locks what its source has now"
            )
            where = Place(str(home / MANIFEST), 1, 1)
            self._note(where, f"the package `{name}` is not what {LOCK} has the hash of: {ways}")
            return
        self._files[str(name)] = files
        try:
            package = read_manifest(files[MANIFEST], str(home / MANIFEST))
        except ModelError as error:
            self.findings += error.findings
            return
        if package.name != name:
            said = f"this is the package `{package.name}`, and {FOLDER}/{name} has the name of another one"
            self._note(
                package.name.place, f"{said}: two packages of one name; call it `{package.name}` in station.yaml"
            )
            return
        self.packages[str(name)] = package

    def _check_needs(self, name: str, station: StationDocument) -> None:
        for other, wanted in self.packages[name].needs.items():
            if other not in station.packages:
                self._note(other.place, f"`{name}` needs the package `{other}` {wanted}: name it in station.yaml")
            elif (found := self.packages.get(other)) is not None and not satisfies(found.version, wanted):
                self._note(wanted.place, f"`{name}` needs `{other}` {wanted}, and {found.version} is here: update it")

    def _add_declared(self, name: str, package: PackageDocument, station: StationDocument) -> None:
        """What a package declares becomes the station's, unless that or another package has something of the name."""
        self.brought[name] = list(map(str, package.enumerations))
        for section, known in self.declared.items():
            for each, document in getattr(package, section).items():
                others = [*known, *getattr(station, section)]
                if (other := next((one for one in others if one == each), None)) is not None:
                    self._note(each.place, f"duplicate name `{each}`, first declared at {other.place}: rename one")
                known[each] = document

    def _require_named(self, station: StationDocument) -> None:
        for manifest in sorted((self._folder / FOLDER).glob(f"*/{MANIFEST}")):
            if (name := manifest.parent.name) not in station.packages:
                what = f"the package `{name}` is not read: name it in `packages` of station.yaml, or remove its folder"
                self._note(Place(str(manifest), 1, 1), what)

    def _note(self, place: Place, message: str) -> None:
        self.findings.append(Finding(place, message))


def source_of(source: PackageSourceDocument) -> str:
    """Where a package is brought from, in words."""
    return str(source.path) if source.git is None else f"{source.git} {source.revision}"


def digest_of(files: Files) -> str:
    """The hash of a package: 64 hexadecimal digits over its files and their names."""
    total = hashlib.sha256()
    for name, text in sorted(files.items()):
        for each in (name.encode(), text.encode()):
            total.update(len(each).to_bytes(8) + each)
    return total.hexdigest()


def read_manifest(text: str, called: str) -> PackageDocument:
    """What a package says of itself. Raises `ModelError`."""
    document = read_text(text, called)
    package = _validated(document, document.content, PackageDocument)
    findings = []
    if not re.fullmatch(VERSION, package.version):
        findings.append(Finding(package.version.place, message("wrong.no-version", version=str(package.version))))
    for wanted in package.needs.values():
        if not _NEEDS.fullmatch(wanted):
            findings.append(Finding(wanted.place, message("wrong.no-versions", range=str(wanted))))
    if findings:
        raise ModelError(findings)
    return package


def read_lock(folder: Path) -> dict[str, LockedPackage]:
    """What is locked of the packages of a station, by their names. Raises `ModelError`."""
    path = folder / LOCK
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        return {}
    except (OSError, UnicodeDecodeError) as error:
        raise ModelError([Finding(Place(str(path), 1, 1), message("wrong.unreadable", why=str(error)))]) from error
    document = read_text(text, str(path))
    content = document.content if isinstance(document.content, dict) else {}
    return {str(name): _validated(document, each, LockedPackage, (str(name),)) for name, each in content.items()}


def _validated(document: YamlDocument, content: object, kind: type[D], at: tuple[str, ...] = ()) -> D:
    try:
        return kind.model_validate(content)
    except ValidationError as error:
        raise ModelError(findings_of(error, document, at, kind)) from error


def satisfies(version: str, wanted: str) -> bool:
    """Return whether a version is in a range such as `>=1.0, <2`."""
    numbers = _numbers(version)
    parts = (re.fullmatch(rf" *([=<>]+) *({VERSION}) *", each) for each in wanted.split(","))
    return all(each is not None and _HOLDS[each[1]](*_alike(numbers, _numbers(each[2]))) for each in parts)


def _numbers(version: str) -> list[int]:
    return [int(each) for each in version.split(".")]


def _alike(one: list[int], other: list[int]) -> tuple[list[int], list[int]]:
    longest = max(len(one), len(other))
    return one + [0] * (longest - len(one)), other + [0] * (longest - len(other))
