"""A station's folder, brought together.

station.yaml  resources/*.yaml  operations.yaml  specifications.yaml  work_masters.yaml  messages/<package>/msg/*.msg
messages/<package>/srv/*.srv  messages/<package>/action/*.action
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from sequence_planner.expressions.place import Place
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.model.documents import (
    OperationDocument,
    ResourceDocument,
    SpecificationDocument,
    StationDocument,
    WorkMasterDocument,
)
from sequence_planner.model.reading import Document, EntryPath, read_yaml
from sequence_planner.model.source import Finding, ModelError, SourceText
from sequence_planner.model.validation import findings_of, shown

D = TypeVar("D", bound=BaseModel)

FOLDERS = ("resources", "messages", "stages")
# What files below `messages` define, by what their names end with.
DEFINITIONS = {"msg": "message", "srv": "service", "action": "action"}
# The documents of a station beside its resources.
FILES = ("station.yaml", "operations.yaml", "specifications.yaml", "work_masters.yaml")


@dataclass(frozen=True)
class Station:
    """A station as written. `messages` is the folder of its message definitions."""

    folder: Path
    station: StationDocument
    resources: dict[str, ResourceDocument]
    operations: dict[SourceText, OperationDocument]
    specifications: dict[SourceText, SpecificationDocument]
    work_masters: dict[SourceText, WorkMasterDocument]

    @property
    def messages(self) -> Path:
        """The folder of message definitions; it need not exist."""
        return self.folder / "messages"

    @property
    def title(self) -> str:
        """What people call it."""
        return self.station.title or self.station.name


def load_station(folder: Path) -> Station:
    """Read a station. Raises `ModelError` with every finding of every file."""
    if not _is_file(folder / "station.yaml"):
        message = "a station is a folder with a station.yaml: there is none here"
        raise ModelError([Finding(Place(str(folder / "station.yaml"), 1, 1), message)])
    reader = _FolderReader(folder)
    reader.require_names()
    station = reader.whole("station.yaml", StationDocument)
    resources = {
        path.stem: reader.whole(f"resources/{path.name}", ResourceDocument)
        for path in sorted((folder / "resources").glob("*.yaml"))
    }
    operations = reader.entries("operations.yaml", OperationDocument)
    specifications = reader.entries("specifications.yaml", SpecificationDocument)
    work_masters = reader.entries("work_masters.yaml", WorkMasterDocument)
    if reader.findings or station is None:
        raise ModelError(reader.findings)
    present = {name: resource for name, resource in resources.items() if resource is not None}
    return Station(folder, station, present, operations, specifications, work_masters)


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # a folder that must not be entered, a name that is too long
        return False


class _FolderReader:
    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.findings: list[Finding] = []

    def require_names(self) -> None:
        """Note files whose name is almost right: they would be left out without a word."""
        for path in sorted((*self._folder.glob("*.yml"), *self._folder.glob("resources/*.yml"))):
            self.findings.append(Finding(Place(str(path), 1, 1), f"rename it to {path.stem}.yaml: this is not read"))
        for path in sorted((self._folder / "resources").glob("*")):
            if path.suffix not in (".yaml", ".yml") and not path.name.startswith("."):
                message = "this is not read: each resource is a file <name>.yaml in this folder"
                self.findings.append(Finding(Place(str(path), 1, 1), message))
        for kind, what in DEFINITIONS.items():
            for path in sorted((self._folder / "messages").rglob(f"*.{kind}")):
                if len(path.relative_to(self._folder).parts) != 4 or path.parent.name != kind:
                    message = f"this is not read: {what} definitions are files messages/<package>/{kind}/<Name>.{kind}"
                    self.findings.append(Finding(Place(str(path), 1, 1), message))
        for path in sorted(each for each in self._folder.glob("*") if each.is_dir() and each.name not in FOLDERS):
            if near := suggestion(path.name, FOLDERS, likeness=0.75):
                self.findings.append(Finding(Place(str(path), 1, 1), f"this folder is not read{near}"))
        for path in sorted(self._folder.glob("*.yaml")):
            if path.name not in FILES:
                message = f"this file is not read{suggestion(path.name, FILES)}"
                self.findings.append(Finding(Place(str(path), 1, 1), message))

    def whole(self, name: str, kind: type[D]) -> D | None:
        """A file that is one document."""
        document = self._read(name)
        return None if document is None else self._validate(document, document.content, (), kind)

    def entries(self, name: str, kind: type[D]) -> dict[SourceText, D]:
        """A file that maps names to documents; it may be missing."""
        if not (self._folder / name).exists() or (document := self._read(name)) is None:
            return {}
        if not isinstance(document.content, dict):
            message = f"expected names with their definitions, found {shown(document.content)}"
            self.findings.append(Finding(document.place(()), message))
            return {}
        read = {key: self._validate(document, content, (str(key),), kind) for key, content in document.content.items()}
        return {key: entry for key, entry in read.items() if entry is not None}

    def _read(self, name: str) -> Document | None:
        try:
            return read_yaml(self._folder / name, str(self._folder / name))
        except ModelError as error:
            self.findings.extend(error.findings)
            return None

    def _validate(self, document: Document, content: object, at: EntryPath, kind: type[D]) -> D | None:
        try:
            return kind.model_validate(content)
        except ValidationError as error:
            self.findings.extend(findings_of(error, document, at, kind))
            return None
