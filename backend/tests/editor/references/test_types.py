"""Parts that instances have of their type are renamed and found in the type, for all of them."""

from __future__ import annotations

import pytest

from sequence_planner.editor.symbols.index import parse_part
from sequence_planner.editor.symbols.rename import renamed, usages
from sequence_planner.model.files import read_files
from sequence_planner.model.loader import load_station
from sequence_planner.model.paths import EditError
from sequence_planner.pipelines.builder import load_messages
from support.places import MODELS

ROBOTS = MODELS / "robots_with_buffer"
FILES = read_files(ROBOTS)
MESSAGES = load_messages(load_station(ROBOTS))
TYPE = "types/robot.yaml"


def test_an_ability_of_a_type_is_renamed_there_and_wherever_an_instance_has_it() -> None:
    changed = renamed(FILES, parse_part("ability:robot_1.open_gripper"), "let_go", MESSAGES)
    assert changed.keys() == {TYPE}
    assert changed[TYPE] == FILES[TYPE].replace("open_gripper:", "let_go:")


def test_what_instances_say_of_it_themselves_follows() -> None:
    changed = renamed(FILES, parse_part("ability:robot_2.move_to"), "go_to", MESSAGES)
    assert changed == {
        file: FILES[file].replace("move_to:", "go_to:")
        for file in (TYPE, "resources/robot_1.yaml", "resources/robot_2.yaml")
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
