"""The order in which the entries of a document are written: that in which its parts declare them."""

from __future__ import annotations

from typing import get_args, get_origin

from sequence_planner.model.documents import (
    OperationDocument,
    SpecificationDocument,
    StationDocument,
    WorkMasterDocument,
)
from sequence_planner.model.fields import DocumentPart
from sequence_planner.model.mimic.documents import MimicDocument
from sequence_planner.model.paths import has_scenarios, type_of
from sequence_planner.model.scenarios.documents import ScenarioDocument
from sequence_planner.model.sequences import SequenceDocument
from sequence_planner.model.shifts.documents import ShiftDocument
from sequence_planner.model.types.composed import InstanceDocument, TypeDocument
from sequence_planner.model.yaml.reader import EntryPath

_FILES: dict[str, object] = {
    "station.yaml": StationDocument,
    "operations.yaml": dict[str, OperationDocument | SequenceDocument],
    "specifications.yaml": dict[str, SpecificationDocument],
    "work_masters.yaml": dict[str, WorkMasterDocument],
    "mimic.yaml": MimicDocument,
    "shifts.yaml": dict[str, ShiftDocument],
}


def declared_order(file: str, path: EntryPath) -> tuple[str, ...]:
    """The keys that the mapping at `path` of a file of a model may have, in their order; none where it is no part of a
    document, or one whose names are free.
    """
    kind = _FILES.get(file)
    if file.startswith("resources/"):
        kind = InstanceDocument
    elif type_of(file):
        kind = TypeDocument
    elif has_scenarios(file):
        kind = dict[str, ScenarioDocument]
    return () if kind is None else _order(kind, path)


def _order(kind: object, path: EntryPath) -> tuple[str, ...]:
    if isinstance(kind, type) and issubclass(kind, DocumentPart):
        fields = {field.alias or name: field.annotation for name, field in kind.model_fields.items()}
        if not path:
            return tuple(fields)
        return _order(fields.get(str(path[0])), path[1:])
    if get_origin(kind) in (dict, list):
        return _order(get_args(kind)[-1], path[1:]) if path else ()
    return tuple(dict.fromkeys(name for each in get_args(kind) for name in _order(each, path)))
