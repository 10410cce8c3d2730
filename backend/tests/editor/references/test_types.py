"""Parts that instances have of their type are renamed and found in the type, for all of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from sequence_planner.editor.symbols.index import parse_part
from sequence_planner.editor.symbols.rename import renamed, usages
from sequence_planner.model.files import read_files
from sequence_planner.model.loader import load_station
from sequence_planner.model.paths import EditError
from sequence_planner.pipelines.builder import load_messages
from support.places import MODELS

from .stations import changed, write

ROBOTS = MODELS / "robots_with_buffer"
FILES = read_files(ROBOTS)
MESSAGES = load_messages(load_station(ROBOTS))
TYPE = "types/robot.yaml"
SCENARIOS = "tests/work.yaml"


def test_an_ability_of_a_type_is_renamed_there_and_wherever_an_instance_has_it() -> None:
    changes = renamed(FILES, parse_part("ability:robot_1.open_gripper"), "let_go", MESSAGES)
    assert changes == {
        TYPE: FILES[TYPE].replace("open_gripper:", "let_go:"),
        SCENARIOS: FILES[SCENARIOS].replace("robot_1.open_gripper", "robot_1.let_go"),
    }


def test_what_instances_say_of_it_themselves_follows() -> None:
    changes = renamed(FILES, parse_part("ability:robot_2.move_to"), "go_to", MESSAGES)
    own = (TYPE, "resources/robot_1.yaml", "resources/robot_2.yaml")
    assert changes == {
        **{file: FILES[file].replace("move_to:", "go_to:") for file in own},
        SCENARIOS: FILES[SCENARIOS].replace(".move_to(", ".go_to("),
    }


def test_a_topic_that_is_called_by_an_argument_keeps_its_name() -> None:
    with pytest.raises(EditError, match="its name is made of an argument of its type"):
        renamed(FILES, parse_part("topic:/robot_1/state"), "/arm/state", MESSAGES)


def test_usages_are_where_they_are_written() -> None:
    found = usages(FILES, parse_part("variable:robot_1.target"), MESSAGES).found
    places = {(each.file, each.line) for each in found}
    assert {file for file, _ in places} >= {TYPE, "resources/robot_1.yaml", "specifications.yaml", "station.yaml"}
    for each in found:
        line = FILES[each.file].split("\n")[each.line - 1]
        assert line[each.column - 1 :].startswith("target"), each


def test_a_field_of_a_topic_of_the_type_is_one_variable_of_all_instances() -> None:
    part = parse_part("variable:robot_1.part_on_conveyor")
    assert {each.part.id for each in usages(FILES, part, MESSAGES).found} == {
        "variable:robot_1.part_on_conveyor",
        "variable:robot_2.part_on_conveyor",
    }
    changes = renamed(FILES, part, "has_part", MESSAGES)
    assert "pipeline: [{rename: {part_on_conveyor: has_part}}]" in (changes[TYPE] or "")
    now = changed(FILES, changes)
    back = renamed(now, parse_part("variable:robot_2.has_part"), "part_on_conveyor", MESSAGES)
    assert changed(now, back) == FILES


@pytest.mark.parametrize(("name", "new"), [("stops", "goals"), ("conveyor", "belt"), ("namespace", "prefix")])
def test_a_parameter_is_renamed_in_the_type_and_in_the_arguments(name: str, new: str, tmp_path: Path) -> None:
    changes = renamed(FILES, parse_part(f"parameter:type:robot.{name}"), new, MESSAGES)
    assert changes.keys() == {TYPE, "resources/robot_1.yaml", "resources/robot_2.yaml"}
    now = {**FILES, **{file: text for file, text in changes.items() if text is not None}}
    write(now, tmp_path)
    assert load_station(tmp_path).resources == load_station(ROBOTS).resources
    back = renamed(now, parse_part(f"parameter:type:robot.{new}"), name, MESSAGES)
    assert back == {file: FILES[file] for file in changes}


# Nothing in the types uses what they are given, and `small_press` passes on what it is given itself.
_UNUSED = {
    "station.yaml": "name: line\nenumerations:\n  load: [none, blank]\n  side: [left, right]\n",
    "types/press.yaml": """\
parameters:
  other: resource
  loads: enumeration
  nothing: {kind: value, of: loads}
  where: {kind: value, of: side, default: left}
estimated:
  busy: {type: bool, initial: false}
""",
    "types/small_press.yaml": """\
parameters: {beside: resource}
type: press
arguments: {other: beside, loads: load, nothing: none}
""",
    "resources/press_l.yaml": "type: press\narguments: {other: press_r, loads: load, nothing: none, where: right}\n",
    "resources/press_r.yaml": "type: small_press\narguments: {beside: press_l}\n",
}


@pytest.mark.parametrize(
    ("part", "new", "files"),
    [
        ("resource:press_l", "press_one", {f"resources/press_{each}.yaml" for each in ("l", "r", "one")}),
        ("resource:press_r", "press_two", {f"resources/press_{each}.yaml" for each in ("l", "r", "two")}),
        ("enumeration:load", "cargo", {"station.yaml", "resources/press_l.yaml", "types/small_press.yaml"}),
        ("value:load.none", "empty", {"station.yaml", "resources/press_l.yaml", "types/small_press.yaml"}),
        ("value:side.right", "east", {"station.yaml", "resources/press_l.yaml"}),
        ("value:side.left", "west", {"station.yaml", "types/press.yaml"}),
        ("enumeration:side", "edge", {"station.yaml", "types/press.yaml"}),
    ],
)
def test_what_an_unused_parameter_is_given_follows(part: str, new: str, files: set[str], tmp_path: Path) -> None:
    changes = renamed(_UNUSED, parse_part(part), new)
    assert changes.keys() == files
    now = changed(_UNUSED, changes)
    write(now, tmp_path)
    load_station(tmp_path)
    old = parse_part(part)
    back = renamed(now, old._replace(name=new), old.name)
    assert changed(now, back) == _UNUSED


def test_an_argument_is_a_usage_of_what_it_names_whether_used_or_not() -> None:
    found = usages(_UNUSED, parse_part("resource:press_l")).found
    assert [(each.file, each.line, each.column, each.declares) for each in found] == [
        ("resources/press_l.yaml", 1, 1, True),
        ("resources/press_r.yaml", 2, 21, False),
    ]


def test_a_type_takes_its_file_along(tmp_path: Path) -> None:
    changes = renamed(FILES, parse_part("type:robot"), "arm", MESSAGES)
    assert changes[TYPE] is None
    assert changes["types/arm.yaml"] == FILES[TYPE]
    write({file: text for file, text in {**FILES, **changes}.items() if text is not None}, tmp_path)
    assert load_station(tmp_path).resources == load_station(ROBOTS).resources


@pytest.mark.parametrize(
    ("part", "name", "why"),
    [
        ("parameter:type:robot.stops", "conveyor", "is there already"),
        ("parameter:type:robot.conveyor", "at", "would hide the variable"),
        ("parameter:type:robot.conveyor", "buffer", "would hide the value"),
        ("parameter:type:robot.conveyor", "parts_on_buffer", "would hide the variable"),
        ("variable:robot_1.at", "conveyor", "would hide the variable"),
        ("parameter:type:robot.conveyor", "executing", "is a flag"),
    ],
)
def test_a_name_that_would_be_taken_for_something_else_is_refused(part: str, name: str, why: str) -> None:
    with pytest.raises(EditError, match=why):
        renamed(FILES, parse_part(part), name, MESSAGES)


def test_a_type_of_a_package_keeps_its_name() -> None:
    packaged = {
        **{file: text for file, text in FILES.items() if file != TYPE},
        "packages/arms/types/robot.yaml": FILES[TYPE],
    }
    for file in ("resources/robot_1.yaml", "resources/robot_2.yaml"):
        packaged[file] = packaged[file].replace("type: robot", "type: arms.robot")
    found = usages(packaged, parse_part("type:arms.robot"), MESSAGES)
    assert [(each.file, each.written) for each in found.found][:2] == [
        ("packages/arms/types/robot.yaml", "robot"),
        ("resources/robot_1.yaml", "robot"),
    ]
    for part in ("type:arms.robot", "parameter:type:arms.robot.stops"):
        with pytest.raises(EditError, match="belongs to the package `arms`"):
            renamed(packaged, parse_part(part), "other", MESSAGES)
