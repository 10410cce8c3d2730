"""Giving parts other names: how it is written, and why it may be refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from sequence_planner.editor.symbols.index import parse_part
from sequence_planner.editor.symbols.rename import renamed
from sequence_planner.model.files import read_files
from sequence_planner.model.paths import EditError
from sequence_planner.ros.types.messages import MessageRegistry
from support.places import BOLT_TIGHTENING

from .stations import CELL, changed, messages_of, write


@pytest.fixture(scope="module")
def messages(tmp_path_factory: pytest.TempPathFactory) -> MessageRegistry:
    folder = tmp_path_factory.mktemp("cell")
    write(CELL, folder)
    return messages_of(folder)


def test_variables_in_what_is_said_of_a_late_ability_are_renamed() -> None:
    """Where it is of the resource and where of another; a parameter of the same name is none of them."""
    arm = """\
measured:
  pose: {type: pose}
abilities:
  move:
    parameters: {where: pose}
    timeouts: {finish: 3}
    late: {not_finished: {en: "{pose}, not {where}; {lamp.pose}", sv: "{arm.pose}"}}
"""
    station = {"resources/arm.yaml": arm, "resources/lamp.yaml": "measured:\n  pose: {type: bool}\n"}
    new = renamed(station, parse_part("variable:arm.pose"), "place")["resources/arm.yaml"]
    assert new == arm.replace("  pose: {", "  place: {").replace('"{pose}', '"{place}').replace(
        "{arm.pose}", "{arm.place}"
    )


def test_only_the_names_change() -> None:
    text = """\
# of the whole
enumerations:
  side: [ 'left' , "right", middle ]   # both, and `left`
estimated:
  at: {type: side, initial: "left"}
  left_at: {type: bool}
rest: >-
  at ==
    left   and

  left_at
"""
    new = renamed({"station.yaml": text}, parse_part("value:side.left"), "port")["station.yaml"]
    assert new is not None
    assert new == (
        text.replace("'left'", "'port'").replace('initial: "left"', 'initial: "port"').replace("    left ", "    port ")
    )


@pytest.mark.parametrize(
    "written",
    [
        "'at == left'",
        '"at == left"',
        '"at\\x20== \\x6ceft"',
        "|\n  at == left\n",
        ">\n  at ==\n  left\n",
        "&a at == left",
        '"at == \\\n  left"',
        "at ==\n  left",
    ],
)
def test_however_a_text_is_written(written: str) -> None:
    text = f"rest: {written}\nenumerations: {{side: [left, right]}}\nestimated: {{at: {{type: side}}}}\n"
    new = renamed({"station.yaml": text}, parse_part("value:side.left"), "port")["station.yaml"]
    assert new == text.replace("left", "port").replace("\\x6ceft", "port")


def test_line_ends_of_windows_stay() -> None:
    text = "enumerations:\n  side: [left, right] # both\nestimated: {at: {type: side}}\nrest: >-\n  at ==\n  left\n"
    text = text.replace("\n", "\r\n")
    assert renamed({"station.yaml": text}, parse_part("value:side.left"), "port") == {
        "station.yaml": text.replace("left", "port")
    }


def test_a_resource_takes_its_file_with_it() -> None:
    changes = renamed(CELL, parse_part("resource:other"), "another")
    assert set(changes) == {"resources/other.yaml", "resources/another.yaml", "specifications.yaml"}
    assert changes["resources/other.yaml"] is None
    assert changes["resources/another.yaml"] == CELL["resources/other.yaml"]
    after = changed(CELL, changes)
    assert changed(after, renamed(after, parse_part("resource:another"), "other")) == CELL


def test_the_same_name_changes_nothing() -> None:
    assert renamed(CELL, parse_part("ability:robot.move"), "move") == {}


@pytest.mark.parametrize(
    ("part", "name", "message"),
    [
        ("ability:robot.move", "move it", "`move it` is no name"),
        ("ability:robot.move", "1st", "`1st` is no name"),
        ("ability:robot.move", "and", "`and` is a word of the language"),
        ("ability:robot.move", "null", "no name that YAML would read as a text"),
        ("variable:robot.last", "executing", "a flag of every ability"),
        ("enumeration:pose", "bool", "a type already"),
        ("resource:robot", "operation", "stands for the operations"),
        ("value:pose.home", "any", "stands for every value"),
        ("topic:/robot/state", "state", "is not a topic name"),
        ("ability:robot.gone", "new", "the ability `robot.gone` is declared nowhere"),
        ("ability:robot.move", "load", "the ability `robot.load` is there already"),
        ("ability:robot.move", "pose", "the variable `robot.pose` is there already"),
        ("variable:robot.last", "move", "the ability `robot.move` is there already"),
        ("variable:robot.last", "busy", "the variable `robot.busy` is there already"),
        ("enumeration:pose", "goal", "the enumeration `goal` is there already"),
        ("value:pose.nowhere", "home", "the value `pose.home` is there already"),
        ("resource:robot", "other", "the resource `other` is there already"),
        ("topic:/robot/state", "/robot/command", "the topic `/robot/command` is there already"),
        ("variable:robot.pose", "is_out", "is named already, by topic /robot/state: pipeline[3].expression.is_out"),
        # It would be taken for another.
        ("variable:count", "slots", "the variable `slots` is there already"),
        ("variable:count", "last", "in resources/robot.yaml, `last` would name the variable `robot.last`"),
        ("variable:robot.last", "note", "would be the field `note` of the messages of /robot/command"),
        ("variable:robot.last", "to", "the parameter `robot.move.to` would hide the variable `robot.to`"),
        ("parameter:robot.move.to", "pose", "the parameter `robot.move.pose` would hide the variable `robot.pose`"),
        ("parameter:robot.move.to", "count", "the parameter `robot.move.count` would hide the variable `count`"),
        ("parameter:robot.move.to", "left", "the parameter `robot.move.left` would hide the value `side.left`"),
        ("parameter:operation:bring.where", "count", "would hide the variable `count`"),
        ("value:side.left", "to", "the parameter `robot.move.to` would hide the value `side.to`"),
        ("value:pose.home", "target", "the variable `robot.target` would hide the value `pose.target`"),
        ("variable:robot.target", "home", "the variable `robot.home` would hide the value `pose.home`"),
        ("value:pose.nowhere", "here", None),
        ("value:goal_state.idle", "still", "is declared nowhere"),
    ],
)
def test_what_is_refused(part: str, name: str, message: str | None, messages: MessageRegistry) -> None:
    if message is None:
        assert renamed(CELL, parse_part(part), name, messages)
        return
    with pytest.raises(EditError) as refused:
        renamed(CELL, parse_part(part), name, messages)
    assert message in str(refused.value)


def test_values_that_would_become_one() -> None:
    files = {
        "station.yaml": "enumerations: {a: [x, y], b: [x, z]}\nestimated: {p: {type: a}, q: {type: b}}\nrest: p == q\n"
    }
    with pytest.raises(EditError, match="are compared, and would become one"):
        renamed(files, parse_part("value:a.y"), "z")
    assert renamed(files, parse_part("value:a.x"), "w") == {
        "station.yaml": "enumerations: {a: [w, y], b: [w, z]}\nestimated: {p: {type: a}, q: {type: b}}\nrest: p == q\n"
    }


def test_what_a_python_function_is_called_with(messages: MessageRegistry) -> None:
    robot = CELL["resources/robot.yaml"].replace(
        "      - rename: {is_seen: is_seen_again}",
        "      - python: {file: s.py, function: f, reads: {is_seen: bool}, gives: {is_seen_again: bool}}",
    )
    assert "python" in robot
    for part in ("variable:robot.is_seen", "variable:robot.is_seen_again"):
        with pytest.raises(EditError, match="function of a `python` stage"):
            renamed({**CELL, "resources/robot.yaml": robot}, parse_part(part), "new", messages)


def test_items_of_a_list_at_a_computed_place(messages: MessageRegistry) -> None:
    text = (
        "topics:\n  /s:\n    type: cell_msgs/msg/RobotState\n    direction: in\n    pipeline:\n"
        "      - expression: {axis: place - 1}\n      - expression: {pose: 'switches[axis]'}\n"
        "measured: {axis: {type: 0..1}, pose: {type: pose}}\n"
    )
    files = {"resources/robot.yaml": text, "station.yaml": "enumerations: {pose: [home, out]}\n"}
    assert renamed(files, parse_part("variable:robot.axis"), "joint", messages) == {
        "resources/robot.yaml": text.replace("axis", "joint")
    }
    with pytest.raises(EditError, match="the topic /s says the values of `pose` by their names"):
        renamed(files, parse_part("value:pose.home"), "rest", messages)


STAGES = """\
topics:
  /arm:
    type: arm_msgs/msg/Arm
    direction: in
    pipeline:
      - one_of: {variable: grip, fields: {open: is_open, closed: is_closed}}
      - PIPELINE
  /told:
    type: arm_msgs/msg/Told
    direction: out
    pipeline:
      - one_of: {variable: wanted, fields: {open: release, closed: close}}
      - table: {fields: [wanted, grip], variables: [do], rows: [{when: [any, open], gives: [{field: wanted}]}]}
measured:
  grip: {type: grips}
  holds: {type: things}
output:
  wanted: {type: orders}
"""


@pytest.mark.parametrize("pipeline", ["member: {field: names, variable: holds}", "map: {field: name, variable: holds}"])
def test_stages_that_turn_several_into_one(pipeline: str, tmp_path: Path) -> None:
    files = {
        "station.yaml": "name: a\nenumerations: {grips: [open, closed], orders: [open, closed], things: [cup, pot]}",
        "resources/arm.yaml": STAGES.replace("PIPELINE", pipeline),
        "messages/arm_msgs/msg/Arm.msg": "bool is_open\nbool is_closed\nstring[] names\nstring name\n",
        "messages/arm_msgs/msg/Told.msg": "bool release\nbool close\nstring do\n",
    }
    write(files, tmp_path)
    registry = messages_of(tmp_path)
    grips = renamed(files, parse_part("value:grips.closed"), "shut", registry)["resources/arm.yaml"]
    assert grips is not None
    assert "one_of: {variable: grip, fields: {open: is_open, shut: is_closed}}" in grips
    assert "one_of: {variable: wanted, fields: {open: release, closed: close}}" in grips
    variable = renamed(files, parse_part("variable:arm.wanted"), "asked", registry)["resources/arm.yaml"]
    assert variable is not None
    assert "one_of: {variable: asked, fields:" in variable
    assert "table: {fields: [asked, grip], variables: [do]" in variable and "gives: [{field: asked}]" in variable
    for part, said in (("value:orders.closed", "wanted"), ("value:things.cup", "holds")):
        with pytest.raises(EditError, match=f"says the values of `{said}` by their names"):
            renamed(files, parse_part(part), "other", registry)


def test_messages_whose_definitions_are_not_known() -> None:
    files = {
        "resources/robot.yaml": "topics: {/r: {type: r_msgs/msg/R, direction: in}}\nmeasured: {pose: {type: bool}}\n"
    }
    with pytest.raises(EditError, match="may be a field of the messages of /r, whose definition is not known"):
        renamed(files, parse_part("variable:robot.pose"), "new")


def test_what_cannot_be_read_and_may_hold_the_name() -> None:
    broken = {**CELL, "operations.yaml": CELL["operations.yaml"] + "\nworse: {goal: robot.pose ==}\n"}
    with pytest.raises(EditError, match=r"operations\.yaml:8:15: this cannot be read, and may name the variable"):
        renamed(broken, parse_part("variable:robot.pose"), "new")
    assert renamed(broken, parse_part("ability:robot.move"), "new")
    broken = {**CELL, "resources/robot.yaml": CELL["resources/robot.yaml"].replace("not busy", "not busy and")}
    with pytest.raises(EditError, match="this cannot be read, and may name the variable"):
        renamed(broken, parse_part("variable:robot.pose"), "new")
    broken = {**CELL, "specifications.yaml": "one: {exclusive: [robot.move\n"}
    with pytest.raises(EditError, match="this file cannot be read, and may name the ability"):
        renamed(broken, parse_part("ability:robot.move"), "new")
    assert renamed(broken, parse_part("ability:other.go_there"), "new")


STATE = """\
topics:
  /robot/state:
    type: cell_msgs/msg/RobotState
    direction: in
    # What the device says.
    pipeline:
      # First of all.
      - expression: {is_still: not busy}
measured: {is_still: {type: bool}}
"""


def test_a_variable_that_is_a_field_by_its_name_gets_a_stage(messages: MessageRegistry) -> None:
    files = {
        "resources/robot.yaml": STATE,
        "station.yaml": "rest: not robot.busy\n",
    }
    there = renamed(files, parse_part("variable:robot.busy"), "is_busy", messages)
    assert there == {
        "resources/robot.yaml": STATE.replace(
            "      # First", "      - rename:\n          busy: is_busy\n      # First"
        ).replace("not busy", "not is_busy"),
        "station.yaml": "rest: not robot.is_busy\n",
    }
    after = changed(files, there)
    assert changed(after, renamed(after, parse_part("variable:robot.is_busy"), "busy", messages)) == files
    again = changed(after, renamed(after, parse_part("variable:robot.is_busy"), "works", messages))
    assert "          busy: works\n" in again["resources/robot.yaml"]


def test_an_outgoing_field_too(messages: MessageRegistry) -> None:
    text = "topics: {/c: {type: cell_msgs/msg/RobotCommand, direction: out}}\noutput: {place: {type: 0..3}}\n"
    files = {"resources/robot.yaml": text}
    there = renamed(files, parse_part("variable:robot.place"), "to", messages)
    assert there["resources/robot.yaml"] == text.replace(
        "direction: out", "direction: out, pipeline: [{rename: {place: to}}]"
    ).replace("{place: {type", "{to: {type")
    after = changed(files, there)
    assert changed(after, renamed(after, parse_part("variable:robot.to"), "place", messages)) == files


def test_nothing_is_written(tmp_path: Path) -> None:
    files = dict(CELL)
    renamed(files, parse_part("ability:robot.move"), "new")
    assert files == CELL


SCENARIO = """\
fine:
  given: {"bolts[bolt_pair_1]": placed, robot.pose: home}
  never: [robot.pose == bolt_pair_2 and not nutrunner.run_nut.executing, robot.pose == home]
  steps:
    - fault: robot.pose wrong home for 3 s
    - fault: clear robot
    - set: {robot.pose: home}
    - starts: [robot.move_to_position(home), robot.move_to_previous]
    - completes: tighten_bolt_pair(bolt_pair_1)
    - done: operator.place_bolt_pair
"""


@pytest.mark.parametrize(
    ("part", "name", "before", "after"),
    [
        ("resource:robot", "arm", "robot", "arm"),
        ("variable:robot.pose", "place", "robot.pose", "robot.place"),
        ("value:pose.home", "rest_pose", "home", "rest_pose"),
        ("ability:robot.move_to_position", "go_to", "move_to_position", "go_to"),
        ("operation:tighten_bolt_pair", "tighten", "tighten_bolt_pair", "tighten"),
        ("ability:nutrunner.run_nut", "turn", "run_nut", "turn"),
    ],
)
def test_scenarios_follow(part: str, name: str, before: str, after: str) -> None:
    files = {**read_files(BOLT_TIGHTENING), "tests/work.yaml": SCENARIO}
    new = renamed(files, parse_part(part), name)["tests/work.yaml"]
    assert new == SCENARIO.replace(before, after)
