"""Alarms of a model in an editor: what they read is found and renamed, completed and explained; they are parts too."""

from __future__ import annotations

from pathlib import Path

import pytest

from editor.language.drafts import draft
from sequence_planner.editor.language.completion import complete
from sequence_planner.editor.language.hover import hover
from sequence_planner.editor.symbols.index import parse_part
from sequence_planner.editor.symbols.rename import renamed, usages
from sequence_planner.model.yaml.reader import EntryPath

from .stations import messages_of, of_folder

MODELS = Path(__file__).parents[4] / "models"
AGV, WHEN = "resources/agv.yaml", ("alarms", "battery_low", "when")


def test_a_variable_is_used_by_the_alarm_that_reads_it() -> None:
    found = usages(of_folder(MODELS / "docking_agv"), parse_part("variable:agv.battery")).found
    assert [each.path for each in found if each.used_by == "alarm agv.battery_low: when"] == [WHEN]


@pytest.mark.parametrize(
    ("part", "new", "line"),
    [
        ("variable:agv.battery", "charge", "    when: charge < 2\n"),
        ("alarm:agv.battery_low", "nearly_empty", "  nearly_empty:\n"),
    ],
)
def test_renaming_renames_it_there(part: str, new: str, line: str) -> None:
    text = renamed(of_folder(MODELS / "docking_agv"), parse_part(part), new, messages_of(MODELS / "docking_agv"))[AGV]
    assert text is not None
    assert line in text


@pytest.mark.parametrize(
    ("station", "file", "path", "typed", "offered"),
    [
        ("docking_agv", AGV, WHEN, "bat", "battery"),
        ("docking_agv", AGV, ("alarms", "new", "when"), "at == be", "bench"),
        ("robots_with_buffer", "station.yaml", ("alarms", "buffer_full", "when"), "parts", "parts_on_buffer"),
    ],
)
def test_its_condition_is_completed(station: str, file: str, path: EntryPath, typed: str, offered: str) -> None:
    lexicon = draft(station).lexicon
    field = lexicon.field(file, path)
    assert field is not None
    assert offered in [option.insert for option in complete(lexicon, field, typed, len(typed)).options]


def test_its_condition_is_explained() -> None:
    lexicon = draft("docking_agv").lexicon
    field = lexicon.field(AGV, WHEN)
    assert field is not None
    found = hover(lexicon, field, "battery < 2", 3)
    assert found is not None
    assert found.pattern == "agv.battery"
