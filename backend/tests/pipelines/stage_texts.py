"""Stages as an engineer writes them, for a message with a field of every type."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from sequence_planner.language.records.field_paths import REAL, TEXT
from sequence_planner.language.records.record import FieldType, ListType, NestedType, Record, RecordType
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Place
from sequence_planner.model.stages.base import Context, Stage, StageInstance
from sequence_planner.model.stages.registry import StageDocument
from sequence_planner.model.yaml.reader import read_text

BYTE = IntegerRange(0, 255)
POINT = NestedType("geometry_msgs/msg/Point", {"x": REAL, "y": REAL})
POSE = EnumerationType(("home", "out", "unknown"))
MODE = EnumerationType(("manual", "automatic"))

MESSAGE: RecordType = {
    "joints": ListType(REAL, 2),
    "force": REAL,
    "count": BYTE,
    "large": IntegerRange(-(2**63), 2**63 - 1),
    "mode": TEXT,
    "door": BOOLEAN,
    "names": ListType(TEXT),
    "levels": ListType(BYTE),
    "pose": NestedType("geometry_msgs/msg/Pose", {"position": POINT}),
    "points": ListType(POINT),
    "state": MODE,
    "slot[left]": BOOLEAN,
}
VARIABLES: Mapping[str, FieldType] = {
    "at": POSE,
    "last": POSE,
    "control": MODE,
    "valve": BOOLEAN,
    "level": IntegerRange(0, 9),
}


@dataclass
class Written:
    """What became of a text: a stage, or findings as `column: message`."""

    stage: Stage | None
    findings: list[str] = field(default_factory=list)


def build(
    text: str,
    fields: RecordType = MESSAGE,
    wanted: Mapping[str, FieldType] = VARIABLES,
    is_incoming: bool = True,
    folder: Path = Path(),
) -> Written:
    """The stage that `text` is, as one entry of a pipeline."""
    written = Written(None)
    document = StageDocument.model_validate(read_text(text, "x.yaml").content)

    def found(place: Place, message: str) -> None:
        written.findings.append(f"{place.line}:{place.column}: {message}")

    context = Context(is_incoming, fields, wanted, folder, document.place, found)
    written.stage = document.check(context)
    assert (written.stage is None) == bool(written.findings)
    return written


def stage(text: str, fields: RecordType = MESSAGE, wanted: Mapping[str, FieldType] = VARIABLES) -> Stage:
    """A stage of an incoming topic, in which nothing is wrong."""
    written = build(text, fields, wanted)
    assert written.stage is not None, written.findings
    return written.stage


def outgoing(text: str) -> Stage:
    """A stage of an outgoing topic, whose message has the fields and whose record the variables."""
    written = build(text, VARIABLES, MESSAGE, is_incoming=False)
    assert written.stage is not None, written.findings
    return written.stage


def findings(text: str, is_incoming: bool = True, folder: Path = Path()) -> list[str]:
    """What is wrong with a stage."""
    fields, wanted = (MESSAGE, VARIABLES) if is_incoming else (VARIABLES, MESSAGE)
    return build(text, fields, wanted, is_incoming, folder).findings


def take(course: StageInstance, now: float = 0.0, /, **values: object) -> dict[str, object] | None:
    """What a record with these fields becomes; it must make sense."""
    record = course.take(Record(dict(values)), now)
    assert record is None or record.troubles == []
    return None if record is None else record.values


def given(stage: Stage, values: Mapping[str, object]) -> tuple[dict[str, object], list[str]]:
    """What a fresh course of `stage` gives for a record, with the troubles."""
    record = stage.begin().take(Record(dict(values)), 0.0)
    assert record is not None
    return {name: record.values[name] for name in stage.gives}, record.troubles


@contextmanager
def unchanged(values: object) -> Iterator[None]:
    """Nothing within may change `values`: other branches have the same lists and messages."""
    before = repr(values)
    yield
    assert repr(values) == before
