"""What an editor shows in a type of resources, and at the names of what is declared."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from sequence_planner.cli.main import app
from support.editor import Editor
from support.waiting import until

from .test_names import named


def labels(editor: Editor, uri: str, mark: str) -> list[str]:
    found = editor.ask("textDocument/completion", **editor.at(uri, mark, len(mark)))
    return [each["label"] for each in found["items"]]


def told(editor: Editor, uri: str, mark: str, offset: int) -> str:
    found = editor.ask("textDocument/hover", **editor.at(uri, mark, offset))
    return "" if found is None else str(found["contents"]["value"])


def test_what_can_be_written_in_a_type_is_offered(editor: Editor, robots: Path) -> None:
    uri = editor.open(robots / "types" / "robot.yaml")
    before = editor.text(uri)
    editor.type(uri, "executing: target == stop and at != stop", "executing: target == conv")
    assert labels(editor, uri, "executing: target == conv")[0] == "conveyor"
    editor.type(uri, "executing: target == conv", "executing: target == conveyor and a")
    assert "at" in labels(editor, uri, "target == conveyor and a")
    editor.type(uri, "executing: target == conveyor and a", "executing: true\n    enab")
    assert "enabled" in labels(editor, uri, "\n    enab")
    assert before != editor.text(uri)
    editor.close(uri)
    instance = editor.open(robots / "resources" / "robot_1.yaml")
    editor.type(instance, "namespace: robot_1, stops: infeed_side, conveyor: infeed", "conv")
    assert labels(editor, instance, "arguments: {conv") == ["conveyor"]
    editor.type(instance, "arguments: {conv", "arguments: {namespace: robot_1, stops: infeed_side, conveyor: b")
    assert labels(editor, instance, "conveyor: b") == ["buffer"]
    editor.close(instance)


@pytest.mark.parametrize(
    ("file", "mark", "offset", "said"),
    [
        ("types/robot.yaml", "initial: conveyor", 12, "stands for `infeed in robot_1, outfeed in robot_2`"),
        ("types/robot.yaml", "at != stop", 1, "**measured** `robot_1.at`"),
        ("types/robot.yaml", "  stops: enumeration", 4, "stands for `infeed_side in robot_1"),
        ("types/robot.yaml", "  move_to:", 4, "**ability** `robot_1.move_to`"),
        ("types/robot.yaml", "  at: {type", 3, "initially `infeed`"),
        ("resources/robot_2.yaml", "type: robot", 8, "**type** `robot`"),
        ("resources/robot_2.yaml", "  move_to:", 4, "declared in types/robot.yaml:19"),
        ("station.yaml", "  parts_on_buffer:", 4, "**estimated** `parts_on_buffer`: `0..2`"),
        ("station.yaml", "  place:", 4, "{between, infeed, buffer, outfeed}"),
    ],
)
def test_what_a_name_is_where_it_is_declared(
    editor: Editor, robots: Path, file: str, mark: str, offset: int, said: str
) -> None:
    uri = editor.open(robots / file)
    assert said in told(editor, uri, mark, offset)
    editor.close(uri)


_DRIVE = {
    "station.yaml": """\
name: drives
enumerations: {mode: [manual, automatic], side: [left, right], piece: [none, part]}
maps:
  code_of: {from: mode, to: 0..9, values: {manual: 1, automatic: 4}}
estimated:
  pieces: {for: {where: side}, type: piece, initial: none}
predicates:
  has:
    parameters: {where: side, what: piece}
    when: pieces[where] == what
""",
    "resources/drive.yaml": """\
topics:
  /drive/command:
    type: drive_msgs/msg/Drive
    direction: out
    pipeline:
      - map: {field: code, variable: wanted, values: code_of}
output:
  wanted: {type: mode, initial: manual}
""",
    "types/lamp.yaml": """\
parameters: {namespace: text}
topics:
  /{namespace}/command:
    type: drive_msgs/msg/Drive
    direction: out
    pipeline:
      - map: {field: code, variable: shown, values: code_of}
output:
  shown: {type: mode, initial: manual}
""",
    "resources/lamp.yaml": "type: lamp\narguments: {namespace: lamp}\n",
    "operations.yaml": """\
fill: {parameters: {where: side}, precondition: "not has(where, part)", goal: "has(where, part)"}
two_pieces: {title: Both sides, sequence: [fill(left), fill(right)]}
""",
    "messages/drive_msgs/msg/Drive.msg": "uint8 code\n",
}


@pytest.mark.parametrize(
    ("file", "mark", "offset", "said"),
    [
        ("station.yaml", "  has:", 3, "**predicate** `has(where, what)`"),
        ("station.yaml", "  has:", 3, "is `pieces[where] == what`"),
        ("resources/drive.yaml", "values: code_of", 10, "**map** `code_of`"),
        ("resources/drive.yaml", "values: code_of", 10, "manual → 1, automatic → 4"),
        ("types/lamp.yaml", "values: code_of", 10, "**map** `code_of`"),
        ("types/lamp.yaml", "variable: shown", 12, "**output** `lamp.shown`"),
        ("operations.yaml", "two_pieces:", 3, "**sequence** `two_pieces`"),
        ("operations.yaml", "fill:", 2, "**operation** `fill`"),
    ],
)
def test_what_is_declared_is_told_in_its_own_words(
    editor: Editor, tmp_path: Path, file: str, mark: str, offset: int, said: str
) -> None:
    for name, text in _DRIVE.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    uri = editor.open(tmp_path / file)
    assert said in told(editor, uri, mark, offset)
    editor.close(uri)


@pytest.mark.parametrize(
    ("file", "mark", "offset", "found"),
    [
        ("types/robot.yaml", "at != stop", 1, ("robot.yaml", "at")),
        ("types/robot.yaml", "initial: conveyor", 12, ("robot.yaml", "conveyor")),
        ("types/robot.yaml", "  stops: enumeration", 4, ("robot.yaml", "stops")),
        ("resources/robot_1.yaml", "stops: infeed_side", 2, ("robot.yaml", "stops")),
        ("resources/robot_1.yaml", "  move_to:", 4, ("robot.yaml", "move_to")),
        ("station.yaml", "  parts_on_buffer:", 4, ("station.yaml", "parts_on_buffer")),
        ("station.yaml", "robot_1.at", 9, ("robot.yaml", "at")),
    ],
)
def test_where_it_leads(
    editor: Editor, robots: Path, file: str, mark: str, offset: int, found: tuple[str, str]
) -> None:
    uri = editor.open(robots / file)
    places = editor.ask("textDocument/definition", **editor.at(uri, mark, offset))
    assert [named(editor, each) for each in places] == [found]
    editor.close(uri)


def test_the_type_is_the_file_that_it_is_in(editor: Editor, robots: Path) -> None:
    uri = editor.open(robots / "resources" / "robot_1.yaml")
    (place,) = editor.ask("textDocument/definition", **editor.at(uri, "type: robot", 8))
    assert place["uri"].endswith("types/robot.yaml")
    editor.close(uri)


@pytest.mark.parametrize(
    ("file", "mark", "offset", "name", "files"),
    [
        ("types/robot.yaml", "initial: conveyor", 12, "belt", {"robot.yaml", "robot_1.yaml", "robot_2.yaml"}),
        ("types/robot.yaml", "  move_to:", 4, "go_to", {"robot.yaml", "robot_1.yaml", "robot_2.yaml", "work.yaml"}),
        ("resources/robot_1.yaml", "type: robot", 8, "arm", {"arm.yaml", "robot_1.yaml", "robot_2.yaml"}),
    ],
)
def test_another_name_follows_in_types_and_instances(
    editor: Editor, robots: Path, file: str, mark: str, offset: int, name: str, files: set[str]
) -> None:
    before = {path: path.read_text(encoding="utf-8") for path in robots.rglob("*.yaml")}
    uri = editor.open(robots / file)
    editor.apply(editor.ask("textDocument/rename", **editor.at(uri, mark, offset), newName=name))
    Path(uri.removeprefix("file://")).write_text(editor.text(uri), encoding="utf-8")
    checked = CliRunner().invoke(app, ["check", str(robots)])
    assert checked.exit_code == 0, checked.output
    after = {path: path.read_text(encoding="utf-8") for path in robots.rglob("*.yaml")}
    assert {path.name for path, text in after.items() if before.get(path) != text} == files
    editor.close(uri)


def test_what_an_unused_parameter_is_given_is_a_name_of_the_model(editor: Editor, robots: Path) -> None:
    for file, old, new in (
        ("types/robot.yaml", "namespace: text", "namespace: text\n  other: resource"),
        ("resources/robot_1.yaml", "arguments: {", "arguments: {other: robot_2, "),
        ("resources/robot_2.yaml", "arguments: {", "arguments: {other: robot_1, "),
    ):
        path = robots / file
        path.write_text(path.read_text(encoding="utf-8").replace(old, new, 1), encoding="utf-8")
    uri = editor.open(robots / "resources" / "robot_2.yaml")
    (place,) = editor.ask("textDocument/definition", **editor.at(uri, "other: robot_1", 9))
    assert place["uri"].endswith("resources/robot_1.yaml")
    assert editor.ask("textDocument/prepareRename", **editor.at(uri, "other: robot_1", 9))["placeholder"] == "robot_1"
    editor.apply(editor.ask("textDocument/rename", **editor.at(uri, "other: robot_1", 9), newName="loader"))
    assert "arguments: {other: loader, " in editor.text(uri)
    editor.close(uri)


@pytest.mark.parametrize(
    ("specifications", "said", "about"),
    [
        (None, "supervisor: 2 guards, as `robot_1.move_to(buffer)`: parts_on_buffer <= 1 and ", ("robot_1", "robot_2")),
        (
            "one_way: {forbidden: robot_1.target == buffer and robot_2.close_gripper}\n",
            "supervisor, in robot_1: parts_on_buffer <= 1 and not robot_2.close_gripper",
            ("robot_1",),
        ),
    ],
)
def test_what_the_supervisor_adds_stands_in_the_type_with_the_instances_that_it_restricts(
    editor: Editor, robots: Path, specifications: str | None, said: str, about: tuple[str, ...]
) -> None:
    if specifications is not None:
        (robots / "specifications.yaml").write_text(specifications, encoding="utf-8")
    uri = editor.open(robots / "types" / "robot.yaml")
    whole = {"start": {"line": 0, "character": 0}, "end": {"line": 999, "character": 0}}

    def hints() -> list[dict[str, Any]]:
        return editor.ask("textDocument/inlayHint", textDocument={"uri": uri}, range=whole) or []

    until(hints, "hints of guards")
    (hint,) = hints()
    assert hint["label"].startswith(said)
    lines = editor.text(uri).split("\n")
    above = lines[: hint["position"]["line"] + 1]
    assert above[-1].strip() == "start:"
    assert [each for each in above if each.startswith("  ") and each[2] != " "][-1] == "  move_to:"
    told_of = [
        name for name in ("robot_1", "robot_2") if f"lets `{name}.move_to(buffer)` start" in str(hint["tooltip"])
    ]
    assert told_of == list(about)
    editor.close(uri)


def test_a_type_without_an_instance_is_checked_as_far_as_it_can_be(editor: Editor, robots: Path) -> None:
    text = "parameters: {stop: text}\nmeasured: {up: {type: bool}}\nabilities:\n  go:\n    enabled: up and\n"
    uri = editor.open(robots / "types" / "spare.yaml", text)
    shown = editor.until_shown(uri, "expected a name, a value or `(`, found the end of the text")
    assert shown["range"]["start"]["line"] == 4
    editor.type(uri, "up and\n", "up\n    exec")
    assert "executing" in labels(editor, uri, "\n    exec")
    editor.type(uri, "    exec", "    executing: up")
    editor.until_clean(uri)
