"""A station's folder, brought together.

station.yaml  resources/*.yaml  types/*.yaml  operations.yaml  specifications.yaml  work_masters.yaml  mimic.yaml
shifts.yaml
messages/<package>/msg/*.msg  messages/<package>/srv/*.srv  messages/<package>/action/*.action
drawings/*.svg  tests/*.yaml
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from sequence_planner.language.types import Place
from sequence_planner.model.documents import (
    OperationDocument,
    ResourceDocument,
    SpecificationDocument,
    StationDocument,
    WorkMasterDocument,
)
from sequence_planner.model.fields import DocumentPart, main_text
from sequence_planner.model.reading.folder import FolderDocuments, ReadBefore, operation_kind, unread_files
from sequence_planner.model.sequences import SequenceDocument
from sequence_planner.model.source import Finding, ModelError, SourceText
from sequence_planner.texts.message import message

if TYPE_CHECKING:
    from sequence_planner.model.mimic.documents import MimicDocument
    from sequence_planner.model.scenarios.documents import ScenarioDocument
    from sequence_planner.model.shifts.documents import ShiftDocument
    from sequence_planner.model.types.layers import Layer, UnusedType

__all__ = ["ReadBefore", "Station", "load_station"]


@dataclass(frozen=True)
class Station:
    """A station as written. `messages` is the folder of its message definitions; `empty` are the places of files of
    entries that are there and have none. `sequences` stand among the operations. `layers` are each instance and its
    types, `unused` the types that no instance has. `mimic` is its picture, with the texts of the `drawings` of its own,
    and `undrawn` what keeps it from being drawn: no station stands still because of that, nor because of
    `unreadable_scenarios` beside the `scenarios` by which it is tested.
    """

    folder: Path
    station: StationDocument
    resources: dict[str, ResourceDocument]
    operations: dict[SourceText, OperationDocument]
    specifications: dict[SourceText, SpecificationDocument]
    work_masters: dict[SourceText, WorkMasterDocument]
    empty: tuple[Place, ...] = ()
    sequences: dict[SourceText, SequenceDocument] = field(default_factory=dict)
    layers: Mapping[str, Sequence[Layer]] = field(default_factory=dict, compare=False, repr=False)
    unused: Mapping[str, UnusedType] = field(default_factory=dict, compare=False, repr=False)
    mimic: MimicDocument | None = None
    undrawn: tuple[Finding, ...] = ()
    drawings: Mapping[str, SourceText] = field(default_factory=dict)
    shifts: Mapping[SourceText, ShiftDocument] = field(default_factory=dict)
    scenarios: Mapping[SourceText, ScenarioDocument] = field(default_factory=dict)
    unreadable_scenarios: tuple[Finding, ...] = ()

    @property
    def messages(self) -> Path:
        """The folder of message definitions; it need not exist."""
        return self.folder / "messages"

    @property
    def message_folders(self) -> list[Path]:
        """The folders of message definitions that there are: the station's own, and those of its packages."""
        packages = (self.folder / "packages" / name / "messages" for name in self.station.packages)
        return [each for each in (self.messages, *packages) if each.is_dir()]

    @property
    def title(self) -> str:
        """The name that people call it by."""
        return main_text(self.station.title) or self.station.name


def load_station(folder: Path, before: ReadBefore | None = None) -> Station:
    """Read a station; what was read `before` is not read again.

    Raises `ModelError` with every finding of every file.
    """
    if not _is_file(folder / "station.yaml"):
        raise ModelError([Finding(Place(str(folder / "station.yaml"), 1, 1), message("wrong.no-station"))])
    reader = FolderDocuments(folder, before)
    reader.findings += unread_files(folder)
    station = reader.whole("station.yaml", StationDocument)
    station, types = reader.packaged(station)
    resources = reader.all_resources(station, types)
    entries = reader.entries("operations.yaml", DocumentPart, operation_kind)
    operations = {name: each for name, each in entries.items() if isinstance(each, OperationDocument)}
    sequences = {name: each for name, each in entries.items() if isinstance(each, SequenceDocument)}
    specifications = reader.entries("specifications.yaml", SpecificationDocument)
    work_masters = reader.entries("work_masters.yaml", WorkMasterDocument)
    mimic, undrawn, drawings = reader.mimic()
    shifts = reader.shifts()
    scenarios, unreadable = reader.scenarios()
    reader.end()
    if reader.findings or station is None:
        raise ModelError(reader.findings)
    empty = tuple(reader.empty)
    return Station(
        folder,
        station,
        resources,
        operations,
        specifications,
        work_masters,
        empty,
        sequences,
        reader.layers,
        reader.unused,
        mimic,
        undrawn,
        drawings,
        shifts,
        scenarios,
        unreadable,
    )


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # a folder that must not be entered, a name that is too long
        return False
