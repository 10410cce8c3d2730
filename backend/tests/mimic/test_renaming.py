"""Names in a picture: what is renamed in the model is renamed in its picture, byte by byte, and nothing else."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from sequence_planner.editor.symbols.index import ModelPart
from sequence_planner.editor.symbols.rename import renamed
from sequence_planner.model.files import read_files, write_files
from sequence_planner.station import prepare_station
from support.places import MODELS

TRUCK = MODELS / "truck_engine_station"


@pytest.mark.parametrize(
    ("part", "new"),
    [
        (ModelPart("resource", None, "robot"), "arm"),
        (ModelPart("variable", "robot", "target_pose"), "goal_pose"),
        (ModelPart("variable", None, "bolts"), "screws"),
        (ModelPart("variable", None, "ladder_frame"), "frame"),
        (ModelPart("value", "lift_state", "floats"), "hovers"),
        (ModelPart("value", "ladder_frame_state", "in_kit"), "within_kit"),
    ],
    ids=str,
)
def test_what_is_renamed_in_the_model_is_renamed_in_the_picture(tmp_path: Path, part: ModelPart, new: str) -> None:
    """The picture binds all that it did."""
    files = read_files(TRUCK)
    changed = renamed(files, part, new)
    write_files({**files, **{name: text for name, text in changed.items() if text is not None}}, tmp_path)
    for name in (name for name, text in changed.items() if text is None):
        (tmp_path / name).unlink()
    picture = (tmp_path / "mimic.yaml").read_text(encoding="utf-8")
    assert re.search(rf"\b{new}\b", picture)
    assert len(picture.splitlines()) == len(files["mimic.yaml"].splitlines())
    assert [str(each) for each in prepare_station(tmp_path).suspicions() if each.kind == "not-drawn"] == []
