"""Values of measured variables that the stage which gives the variable never does."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pipelines.station_writing import write_station
from sequence_planner.analysis.checks.ungiven_values import may_give
from sequence_planner.language.records.field_paths import FieldPath
from sequence_planner.language.records.record import Record
from sequence_planner.language.types import EnumerationType, IntegerRange, Place
from sequence_planner.model.stages.map import MapStage, Row, TableStage
from sequence_planner.station import prepare_station

FIELDS = {"Scene": "string text\nuint8 code\nfloat64 height\n"}
NAMES = "grips: [open, closed, lost]"


def found(folder: Path, stage: str, names: str = NAMES) -> list[str]:
    resource = f"""
topics:
  /scene:
    type: tank_msgs/msg/Scene
    direction: in
    pipeline:
      - {stage}
measured: {{grip: {{type: grips}}}}
"""
    station = prepare_station(write_station(folder, resource, FIELDS, names))
    return [f"{each.place.line}:{each.place.column}: {each.message}" for each in station.suspicions()]


NEVER_LOST = "no message ever makes `tank.grip` `lost`, since this `{}` never gives it"


@pytest.mark.parametrize(
    ("kind", "stage"),
    [
        ("discretise", "discretise: {field: height, variable: grip, ranges: {open: [0, 1], closed: [1, 2]}}"),
        (
            "discretise",
            "discretise: {field: height, variable: grip, ranges: {open: [0, 1]}, otherwise: closed}",
        ),
        ("map", "map: {field: code, variable: grip, values: {0: open, 1: closed}}"),
        ("map", "map: {field: code, variable: grip, values: {0: open}, otherwise: closed}"),
        ("match", "match: {field: text, variable: grip, values: {open: [O], closed: [C]}}"),
    ],
)
def test_a_name_that_a_stage_never_gives(tmp_path: Path, kind: str, stage: str) -> None:
    (said,) = found(tmp_path, stage)
    assert said.startswith(f"7:9: {NEVER_LOST.format(kind)}")
    assert found(tmp_path / "other", stage, "grips: [open, closed]") == []


def test_a_name_whose_numbers_are_all_those_of_others(tmp_path: Path) -> None:
    stage = "discretise: {field: height, variable: grip, ranges: {open: [null, 0], closed: [0, null]}, otherwise: lost}"
    (said,) = found(tmp_path, stage)
    assert NEVER_LOST.format("discretise") in said


VALUES = EnumerationType(("open", "closed", "lost"))
PLACE = Place("tank.yaml", 7, 9)
MEANINGS = st.sampled_from(VALUES.values)


@given(st.dictionaries(st.integers(0, 15), MEANINGS, min_size=1), st.none() | MEANINGS)
def test_what_a_map_may_give_is_what_it_gives_for_some_value(meant: dict[int, str], otherwise: str | None) -> None:
    code = FieldPath("code", "code", ())
    stage = MapStage(PLACE, code, IntegerRange(0, 15), "grip", VALUES, tuple(meant.items()), otherwise)
    records = [Record({"code": each}) for each in range(16)]
    for record in records:
        stage.apply(record)
    gives = {record.values["grip"] for record in records}
    assert {each for each in VALUES.values if may_give(stage, "grip", each)} == gives - {None}


@given(st.lists(st.tuples(st.tuples(st.none() | st.integers(0, 2), st.none() | st.booleans()), MEANINGS), min_size=1))
def test_what_a_table_gives_it_may_give(written: list[tuple[tuple[int | None, bool | None], str]]) -> None:
    sources = FieldPath("code", "code", ()), FieldPath("on", "on", ())
    rows = tuple(Row(when, (meant,)) for when, meant in written)
    stage = TableStage(PLACE, sources, (IntegerRange(0, 2), IntegerRange(0, 1)), {"grip": VALUES}, rows, None)
    for code in range(3):
        for on in (False, True):
            record = Record({"code": code, "on": on})
            stage.apply(record)
            given_ = record.values["grip"]
            assert given_ is None or may_give(stage, "grip", str(given_))
