"""`migrate` shows what could be said shorter, and writes what is chosen of it."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from sequence_planner.cli.editing import migrate as command_module
from sequence_planner.editor.folds.finder import Fold, FoldFinder
from sequence_planner.model.files import Files
from sequence_planner.model.paths import EditError
from sequence_planner.model.yaml.saving import add_file
from support.commands import as_json, command
from support.places import MODELS, TESTS

STATION = """\
name: cell
enumerations:
  part: [p1, p2, p3] # of one engine
  state: [empty, placed]
estimated:
  bolts: {for: {which: part}, type: state}
"""
OPERATIONS = """\
place: # all of them
  precondition: bolts[p1] == empty and bolts[p2] == empty and bolts[p3] == empty # none yet
  goal: bolts[p1] == placed and bolts[p2] == placed and bolts[p3] == placed
"""


@pytest.fixture
def cell(tmp_path: Path) -> Path:
    folder = tmp_path / "cell"
    folder.mkdir()
    (folder / "station.yaml").write_text(STATION, encoding="utf-8")
    (folder / "operations.yaml").write_bytes(OPERATIONS.replace("\n", "\r\n").encode())
    return folder


def _marks(cell: Path) -> list[str]:
    code, document = as_json("migrate", cell)
    assert code == 0
    return [fold["id"] for fold in document["folds"]]


def test_what_could_be_shorter_is_shown_and_nothing_is_written(cell: Path) -> None:
    before = {file: file.read_bytes() for file in cell.iterdir()}
    code, out, err = command("migrate", cell)
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert "  Write `all which in part: bolts[which] == empty`: as many lines" in lines[0] + lines[2]
    assert (
        f"  {cell}/operations.yaml:2:17: bolts[p1] == empty and bolts[p2] == empty and bolts[p3] == …"
        " → all which in part: bolts[which] == empty"
    ) in lines
    assert lines[-1].startswith(f"write one with: sequence-planner migrate {cell} --write ")
    assert {file: file.read_bytes() for file in cell.iterdir()} == before


def test_what_is_chosen_is_written(cell: Path) -> None:
    one, other = _marks(cell)
    code, out, err = command("migrate", cell, "--write", one, "--write", other)
    assert (code, err) == (0, "")
    assert "+  goal: 'all which in part: bolts[which] == placed'\n" in out
    assert (cell / "operations.yaml").read_bytes().decode() == (
        "place: # all of them\r\n"
        "  precondition: 'all which in part: bolts[which] == empty' # none yet\r\n"
        "  goal: 'all which in part: bolts[which] == placed'\r\n"
    )
    assert (cell / "station.yaml").read_text(encoding="utf-8") == STATION
    code, out, _ = command("migrate", cell)
    assert (code, out) == (0, f"{cell}: there is nothing that is known to be said shorter\n")


def test_a_set_is_called_as_it_is_told(cell: Path) -> None:
    station = STATION.replace("[p1, p2, p3]", "[p1, p2, p3, p4]") + "  at: {type: part}\n"
    (cell / "station.yaml").write_text(station, encoding="utf-8")
    (cell / "operations.yaml").write_text(
        "one: {precondition: 'at in {p1, p2, p3}', goal: at == p4}\n"
        "two: {precondition: at == p4, goal: 'at in {p3, p1, p2}'}\n",
        encoding="utf-8",
    )
    (mark,) = _marks(cell)
    code, _, err = command("migrate", cell, "--write", mark, "--name", f"{mark}=bolts")
    assert (code, err) == (2, "`bolts` is the name of something else: take another one; nothing was written\n")
    code, out, _ = command("migrate", cell, "--write", mark, "--name", f"{mark}=front")
    assert code == 0
    assert "+sets:\n+  front:\n+    of: part\n+    values: [p1, p2, p3]\n" in out
    assert command("check", cell)[0] in (0, 1)


def test_what_cannot_be_written_leaves_everything_as_it_is(cell: Path) -> None:
    first, _ = _marks(cell)
    near = first[:-1] + ("0" if first[-1] != "0" else "1")
    before = (cell / "operations.yaml").read_bytes()
    for chosen, message in (
        ((near,), f"there is no fold `{near}`: look at those that there are now; did you mean `{first}`?; nothing"),
        ((first, first), f"there is no fold `{first}`: look at those that there are now (after `{first}`)"),
    ):
        code, out, err = command("migrate", cell, *(part for each in chosen for part in ("--write", each)))
        assert (code, out) == (2, "")
        assert err.startswith(message)
        assert err.endswith("; nothing was written\n")
    code, _, err = command("migrate", cell, "--write", first, "--name", "docked")
    assert (code, err) == (2, "`docked` is not FOLD=NAME, as in `1c81a640=docked`\n")
    code, _, err = command("migrate", cell, "--name", f"{first}=docked")
    assert (code, err) == (2, f"`{first}` is named and not written: add --write {first}\n")
    assert (cell / "operations.yaml").read_bytes() == before


def test_a_file_that_is_changed_meanwhile_is_left_alone(cell: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Meanwhile(FoldFinder):
        def fold(self, files: Files, wanted: str, name: str | None = None) -> Fold:
            found = super().fold(files, wanted, name)
            (cell / "operations.yaml").write_text(OPERATIONS + "\n# somebody\n", encoding="utf-8")
            return found

    mark = _marks(cell)[0]
    monkeypatch.setattr(command_module, "FoldFinder", Meanwhile)
    code, out, err = command("migrate", cell, "--write", mark)
    assert (code, out) == (2, "")
    assert err.startswith(f"{cell}/operations.yaml was changed by somebody else in the meantime.")
    assert (cell / "operations.yaml").read_text(encoding="utf-8") == OPERATIONS + "\n# somebody\n"


def test_a_station_that_cannot_be_used_is_refused_with_the_place(cell: Path, tmp_path: Path) -> None:
    (cell / "operations.yaml").write_text(OPERATIONS.replace("bolts[p2] == empty", "bolt[p2] == empty"), "utf-8")
    code, out, err = command("migrate", cell)
    assert (code, out) == (2, "")
    assert err.startswith(f"{cell}/operations.yaml:2:40: unknown variable `bolt[p2]`; did you mean `bolts[p2]`?")
    code, _, err = command("migrate", tmp_path / "nowhere")
    assert (code, err) == (2, f"{tmp_path}/nowhere: there is no such folder of a station\n")


def test_a_type_is_written_into_a_file_of_its_own(tmp_path: Path) -> None:
    robots = Path(shutil.copytree(MODELS / "robots_with_buffer", tmp_path / "robots"))
    shutil.rmtree(robots / "types")
    for written in (TESTS / "model" / "written_out").glob("*.yaml"):
        shutil.copy(written, robots / "resources")
    code, document = as_json("migrate", robots)
    (mark,) = (fold["id"] for fold in document["folds"] if fold["kind"] == "type")
    before = as_json("show", robots, "--expanded")
    code, out, err = command("migrate", robots, "--write", mark, "--name", f"{mark}=arm")
    assert (code, err) == (0, "")
    assert f"+++ {robots}/types/arm.yaml\n" in out
    assert "+type: arm\n+arguments: {sides: outfeed_side, own_side: outfeed, namespace: robot_2}\n" in out
    assert (robots / "types" / "arm.yaml").read_text(encoding="utf-8").count("move_to:") == 1
    assert as_json("show", robots, "--expanded")[1]["abilities"] == before[1]["abilities"]
    assert command("check", robots)[0] == 0


def test_a_file_that_somebody_has_made_meanwhile_is_left_alone(tmp_path: Path) -> None:
    path = tmp_path / "types" / "robot.yaml"
    assert "+++ " in add_file(path, "title: A robot\n")
    with pytest.raises(EditError, match=r"robot\.yaml is there already: take another name, or look at it first"):
        add_file(path, "title: Another robot\n")
    assert path.read_text(encoding="utf-8") == "title: A robot\n"
