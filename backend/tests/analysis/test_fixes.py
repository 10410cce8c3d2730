"""What findings offer to write: each mends what it is about."""

from __future__ import annotations

from pathlib import Path

import pytest

from editor.models import bolts
from sequence_planner.analysis.report import FindingDocument, error_document, fixes_of
from sequence_planner.editor.usable import station_in
from sequence_planner.model.source import ModelError


def found(files: dict[str, str], folder: Path) -> list[FindingDocument]:
    try:
        station_in(files, None, folder)
    except ModelError as error:
        return [error_document(each) for each in error.findings]
    return []


@pytest.mark.parametrize(
    ("right", "slip"),
    [
        ("when: run_tool_forward and programmed_torque_reached", "when: run_tol_forward and programmed_torque_reached"),
        ("robot.pose == bolt_pair_2 and", "robot.pose == bolt_pear_2 and"),
        ("robot.pose == bolt_pair_2 and", "robott.pose == bolt_pair_2 and"),
    ],
)
def test_what_was_meant_is_offered_and_mends_the_model(tmp_path: Path, right: str, slip: str) -> None:
    files = bolts(nutrunner=(right, slip))
    first = found(files, tmp_path / "slip")[0]
    fix = next(each for each in first.fixes if each.is_sure)
    lines = files[first.file].split("\n")
    line = lines[first.line - 1]
    assert fix.was in line[first.column - 1 :]
    lines[first.line - 1] = line[: first.column - 1] + line[first.column - 1 :].replace(fix.was, fix.now, 1)
    mended = files | {first.file: "\n".join(lines)}
    assert found(mended, tmp_path / "mended") == []
    assert mended == bolts()


def test_where_several_things_can_stand_none_is_sure() -> None:
    fixes = list(fixes_of("`in_out` is no direction; write in or out"))
    assert [(each.was, each.now, each.is_sure) for each in fixes] == [("in_out", "in", False), ("in_out", "out", False)]


def test_what_names_nothing_offers_nothing() -> None:
    assert list(fixes_of("there is no title; write one of a, b")) == []
