"""Where names of a station lead in an editor, and other names for them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from sequence_planner.cli.main import app
from support.editor import CAPABILITIES, Editor, RefusedError, position


def named(editor: Editor, location: dict[str, Any]) -> tuple[str, str]:
    """The file of a place, and what is written there."""
    path = Path(location["uri"].removeprefix("file://"))
    line = path.read_text(encoding="utf-8").split("\n")[location["range"]["start"]["line"]]
    return path.name, line[location["range"]["start"]["character"] : location["range"]["end"]["character"]]


@pytest.mark.parametrize(
    ("file", "mark", "offset", "found"),
    [
        ("resources/nutrunner.yaml", "robot.pose == bolt_pair_1", 8, ("robot.yaml", "pose")),
        ("resources/nutrunner.yaml", "bolts[bolt_pair_1] == placed", 2, ("station.yaml", "bolts")),
        ("resources/nutrunner.yaml", "bolts[bolt_pair_1] == placed", 25, ("station.yaml", "placed")),
        ("resources/operator.yaml", "parameters: {pair: bolt_pair}", 22, ("station.yaml", "bolt_pair")),
        ("resources/operator.yaml", "enabled: bolts[pair]", 17, ("operator.yaml", "pair")),
        ("resources/operator.yaml", "acknowledgement: acknowledged", 20, ("operator.yaml", "acknowledged")),
        ("resources/nutrunner.yaml", "truck_engine_msgs/msg/NutrunnerState", 5, ("NutrunnerState.msg", "")),
        ("specifications.yaml", "nutrunner.run_nut.executing", 12, ("nutrunner.yaml", "tool_is_running_forward")),
        ("work_masters.yaml", "after: [place_bolt_pair(", 10, ("operations.yaml", "place_bolt_pair")),
        ("work_masters.yaml", "    new_engine:", 6, ("operations.yaml", "new_engine")),
    ],
)
def test_where_it_is_declared(
    editor: Editor, station: Path, file: str, mark: str, offset: int, found: tuple[str, str]
) -> None:
    uri = editor.open(station / file)
    places = editor.ask("textDocument/definition", **editor.at(uri, mark, offset))
    if found[1]:
        assert [named(editor, each) for each in places] == [found]
    else:
        assert [Path(each["uri"]).name for each in places] == [found[0]]
    editor.close(uri)


def test_an_operation_in_a_sequence_leads_to_it(editor: Editor, station: Path) -> None:
    file = station / "operations.yaml"
    whole = "whole:\n  for: {one: bolt_pair}\n  sequence: [place_bolt_pair(one), tighten_bolt_pair(one)]\n"
    file.write_text(f"{whole}again: {{sequence: whole}}\n{file.read_text(encoding='utf-8')}", encoding="utf-8")
    uri = editor.open(file)
    for mark, offset, found in (
        ("[place_bolt_pair(one)", 3, "place_bolt_pair"),
        ("sequence: whole", 12, "whole"),
    ):
        (place,) = editor.ask("textDocument/definition", **editor.at(uri, mark, offset))
        assert named(editor, place) == ("operations.yaml", found)
    editor.close(uri)


def test_where_it_is_used(editor: Editor, station: Path) -> None:
    uri = editor.open(station / "resources" / "robot.yaml")
    asked = editor.at(uri, "  pose:\n", 4)
    every = editor.ask("textDocument/references", **asked, context={"includeDeclaration": True})
    others = editor.ask("textDocument/references", **asked, context={"includeDeclaration": False})
    assert len(every) == len(others) + 1
    files = ("robot.yaml", "nutrunner.yaml", "station.yaml", "specifications.yaml", "mimic.yaml", "work.yaml")
    assert {named(editor, each) for each in every} == {(file, "pose") for file in files}
    shown = editor.ask("textDocument/documentHighlight", **asked)
    own = [each["range"] for each in every if each["uri"] == uri]
    assert sorted((each["range"] for each in shown), key=str) == sorted(own, key=str)
    editor.close(uri)


def test_another_name_in_all_files(editor: Editor, station: Path) -> None:
    """Also in one that has been typed in and is not saved; comments stay, and it means what it meant."""
    robot = editor.open(station / "resources" / "robot.yaml")
    other = editor.open(station / "specifications.yaml")
    editor.type(other, "robot.pose == pair", "robot.pose == pair  # seen")
    asked = editor.at(robot, "  pose:\n", 4)
    prepared = editor.ask("textDocument/prepareRename", **asked)
    assert prepared["placeholder"] == "pose"
    edit = editor.ask("textDocument/rename", **asked, newName="place")
    editor.apply(edit)
    assert "robot.place == pair  # seen" in editor.text(other)
    assert "robot.place == bolt_pair_1" in (station / "resources" / "nutrunner.yaml").read_text(encoding="utf-8")
    assert "of: robot.place\n" in (station / "mimic.yaml").read_text(encoding="utf-8")
    for uri in (robot, other):
        Path(uri.removeprefix("file://")).write_text(editor.text(uri), encoding="utf-8")
    told = CliRunner().invoke(app, ["check", str(station)])
    assert told.exit_code == 0, told.output
    editor.close(robot)
    editor.close(other)


def test_a_resource_has_its_file_renamed(editor: Editor, station: Path) -> None:
    uri = editor.open(station / "specifications.yaml")
    edit = editor.ask("textDocument/rename", **editor.at(uri, "nutrunner.run_nut", 3), newName="tool")
    kinds = [each.get("kind") for each in edit["documentChanges"]]
    assert kinds.count("rename") == 1
    assert kinds[-1] == "rename"
    editor.apply(edit)
    assert (station / "resources" / "tool.yaml").is_file()
    assert not (station / "resources" / "nutrunner.yaml").exists()
    assert "not tool.run_nut.executing" in editor.text(uri)
    Path(uri.removeprefix("file://")).write_text(editor.text(uri), encoding="utf-8")
    assert CliRunner().invoke(app, ["check", str(station)]).exit_code == 0
    editor.close(uri)


def test_an_editor_that_renames_no_files_is_told_so(station: Path) -> None:
    with Editor({**CAPABILITIES, "workspace": {}}) as editor:
        uri = editor.open(station / "specifications.yaml")
        with pytest.raises(RefusedError, match="does not rename files"):
            editor.ask("textDocument/rename", **editor.at(uri, "nutrunner.run_nut", 3), newName="tool")


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("set tool", "is no name"),
        ("tool_is_idle", "is there already: choose another name"),
        ("and", "`and` is a word of the language: take another name"),
    ],
)
def test_names_that_are_refused(editor: Editor, station: Path, name: str, why: str) -> None:
    uri = editor.open(station / "resources" / "nutrunner.yaml")
    with pytest.raises(RefusedError, match=why) as refused:
        editor.ask("textDocument/rename", **editor.at(uri, "  set_tool_idle:", 4), newName=name)
    assert refused.value.code == -32803
    editor.close(uri)


def test_a_name_that_would_hide_another_is_refused(editor: Editor, station: Path) -> None:
    uri = editor.open(station / "resources" / "robot.yaml")
    with pytest.raises(RefusedError, match=r"`robot\.move_to_position\.position` would hide the variable"):
        editor.ask("textDocument/rename", **editor.at(uri, "  pose:\n", 4), newName="position")
    editor.close(uri)


def test_there_is_nothing_to_rename_in_a_comment(editor: Editor, station: Path) -> None:
    uri = editor.open(station / "resources" / "nutrunner.yaml")
    with pytest.raises(RefusedError, match="no name of the model"):
        editor.ask("textDocument/prepareRename", **editor.at(uri, "# The command and", 5))
    with pytest.raises(RefusedError, match="known to all nodes"):
        editor.ask("textDocument/prepareRename", **editor.at(uri, "truck_engine_msgs/msg", 5))
    editor.close(uri)


def test_what_documents_declare(editor: Editor, station: Path) -> None:
    uri = editor.open(station / "resources" / "nutrunner.yaml")
    symbols = editor.ask("textDocument/documentSymbol", textDocument={"uri": uri})
    run = next(each for each in symbols if each["name"] == "run_nut")
    assert [each["name"] for each in run["children"]] == ["tool_starts", "torque_is_reached", "tool_settles"]
    text = editor.text(uri)
    assert run["range"]["start"] == position(text, text.index("run_nut:"))
    assert run["range"]["end"]["line"] == len(text.rstrip().split("\n")) - 1
    found = editor.ask("workspace/symbol", query="rnut")
    assert "nutrunner.run_nut" in [each["name"] for each in found]
    editor.close(uri)
