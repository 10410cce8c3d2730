"""What documents of the right form may say: names, types, who may write what, and pipelines that fit."""

from __future__ import annotations

from pathlib import Path

import pytest

from .breaking import assert_found, copy_of_cell, findings, replace, write

ARM, STATION, OPERATIONS, SPECIFICATIONS = (
    "resources/arm.yaml",
    "station.yaml",
    "operations.yaml",
    "specifications.yaml",
)
STATE, COMMAND = "messages/cell_msgs/msg/ArmState.msg", "messages/cell_msgs/msg/ArmCommand.msg"
POZE = "unknown variable or value `poze`; did you mean `pose`?"
STATE_STAGE_1, STATE_STAGE_2 = "`/arm/state` → stage 1 `discretise`", "`/arm/state` → stage 2"
NO_TOPIC = (
    "is not a topic name: write it absolute, as in /robot/state, "
    "of letters, digits and single underscores, no part beginning with a digit"
)
NO_QUOTES = "`'` has no meaning here; write values without quotes"
NO_NAME = "is no name: use letters, digits and `_`, and no digit first"

WORD = "`implies` is a word of the language: take another name"


@pytest.mark.parametrize(
    ("file", "old", "new", "message"),
    [
        # names in guards and actions, in every style of text
        (ARM, "enabled: goto == pose", "enabled: goto == ‹poze", POZE),
        (ARM, "enabled: goto == pose and pose != position", "enabled: 'goto == ‹poze'", POZE),
        (
            ARM,
            "enabled: goto == pose and pose != position",
            "enabled: >-\n      goto == pose and\n\n      ‹poze != position",
            POZE,
        ),
        (
            ARM,
            "enabled: goto == pose and pose != position",
            "enabled: |\n      goto == pose\n        and ‹poze != position",
            POZE,
        ),
        (ARM, "enabled: goto == pose and pose != position", "enabled: goto == pose\n      and ‹poze != position", POZE),
        (
            ARM,
            "enabled: goto == pose and pose != position",
            'enabled: "goto == pose and\n      \\\n      ‹poze != position"',
            POZE,
        ),
        (ARM, "enabled: goto == pose and pose != position", 'enabled: "goto\\t== pose and ‹poze != position"', POZE),
        (ARM, "enabled: goto == pose and pose != position", "enabled: 'goto == ‹''home'''", NO_QUOTES),
        (ARM, "enabled: goto == pose and pose != position", "enabled: &guard goto == pose and ‹poze != position", POZE),
        (
            ARM,
            "enabled: goto == pose and pose != position",
            "enabled: goto == pose and‹  # and what?",
            "expected a name, a value or `(`, found the end of the text",
        ),
        (
            ARM,
            "enabled: goto == pose and pose != position",
            "enabled: 'goto == pose and‹'",
            "expected a name, a value or `(`, found the end of the text",
        ),
        (
            ARM,
            "enabled: goto == pose and pose != position",
            "enabled: >\n      goto ==\n      pose and‹\n\n",
            "expected a name, a value or `(`, found the end of the text",
        ),
        (
            ARM,
            "enabled: goto == pose and pose != position",
            "enabled: ‹''",
            "expected a name, a value or `(`, found the end of the text",
        ),
        (ARM, "last := goto,", "‹lst := goto,", "unknown variable `lst`; did you mean `last`?"),
        (ARM, '["pose := goto"', '["pose := ‹goo"', "unknown variable or value `goo`; did you mean `goto`?"),
        (
            OPERATIONS,
            "    arm.pose == out and\n    parts[which]",
            "    arm.pose == out and\n    ‹parts[wich]",
            "unknown variable `parts[wich]`; did you mean `parts[…]`, as in `parts[left]`?",
        ),
        (
            SPECIFICATIONS,
            "parts[left] == full",
            "parts[left] == ‹fulll",
            "unknown variable or value `fulll`; did you mean `full`?",
        ),
        (
            STATION,
            "rest: arm.pose == home",
            "rest: ‹arm.poses == home",
            "unknown variable `arm.poses`; did you mean `arm.pose`?",
        ),
        # types
        (ARM, "goto == pose and pose", "‹goto and pose", "expected a truth value, found one of {home, out}"),
        (ARM, "do: [goto := position]", "do: [goto := ‹moving]", "expected one of {home, out}, found a truth value"),
        (
            ARM,
            "goto == pose and pose",
            "goto == ‹moving and pose",
            "cannot compare one of {home, out} with a truth value",
        ),
        (
            ARM,
            "{type: bool, initial: false}",
            "{type: ‹boool}",
            "unknown type `boool`: write bool, a range such as 0..3, or an enumeration; did you mean `bool`?",
        ),
        (
            ARM,
            "moving: {type: bool, initial: false}",
            "moving: {type: ‹3..0}",
            "the range 3..0 is empty: write the smaller number first",
        ),
        (
            ARM,
            "moving: {type: bool, initial: false}",
            "moving: {type: ‹0..1000}",
            "the range 0..1000 has more than 1000 values: use a coarser measure",
        ),
        (
            ARM,
            "moving: {type: bool, initial: false}",
            "moving: {type: ‹0..99999999}",
            "the range 0..99999999 has more than 1000 values: use a coarser measure",
        ),
        (
            ARM,
            "moving: {type: bool, initial: false}",
            "moving: {type: ‹1000000..1000001}",
            "integers have at most 6 digits",
        ),
        (
            ARM,
            "goto: {type: target, initial: home}",
            "goto: {type: target, initial: ‹hom}",
            "`hom` is no initial value of `arm.goto`, which ranges over {home, out}; did you mean `home`?",
        ),
        (
            ARM,
            "moving: {type: bool, initial: false}",
            "‹moving: {type: bool, initial: 0}",
            "`0` is no initial value of `arm.moving`, which ranges over bool",
        ),
        (STATION, "which: part}", "which: ‹parts}", "unknown enumeration `parts`; did you mean `part`?"),
        (
            ARM,
            "parameters: {position: target}",
            "parameters: {position: ‹targets}",
            "unknown enumeration `targets`; did you mean `target`?",
        ),
        (
            OPERATIONS,
            "parameters: {which: part}",
            "parameters: {which: ‹prt}",
            "unknown enumeration `prt`; did you mean `part`?",
        ),
        # names
        (ARM, "  moving: {type", "  ‹my-arm: {type: bool}\n  moving: {type", f"`my-arm` {NO_NAME}"),
        (
            ARM,
            "  moving: {type",
            "  ‹in: {type: bool}\n  moving: {type",
            "`in` is a word of the language: take another name",
        ),
        (
            ARM,
            "  moving: {type",
            "  ‹executing: {type: bool}\n  moving: {type",
            "`executing` is a flag of every ability: take another name",
        ),
        # one rule for all names
        (STATION, "  fill: [empty, full]", "  fill: [empty, full, ‹implies]", WORD),
        (STATION, "enumerations:\n", "sets: {‹implies: {of: fill, values: [full]}}\nenumerations:\n", WORD),
        (STATION, "enumerations:\n", "predicates: {‹implies: true}\nenumerations:\n", WORD),
        (
            STATION,
            "enumerations:\n",
            "predicates: {p: {parameters: {‹implies: fill}, when: true}}\nenumerations:\n",
            WORD,
        ),
        (ARM, "  moving: {type", "  ‹implies: {type: bool}\n  moving: {type", WORD),
        (ARM, "abilities:\n", "abilities:\n  ‹implies: {enabled: moving}\n", WORD),
        (OPERATIONS, "fetch:\n", "‹implies:\n", WORD),
        (STATION, "  fill: [empty, full]", "  fill: [empty, full, ‹half full]", f"`half full` {NO_NAME}"),
        (STATION, "  fill: [empty, full]", "  fill: [empty, full, ‹empty]", "duplicate value `empty` in `fill`"),
        (STATION, "  fill: [", "  ‹bool: [x]\n  fill: [", "`bool` is a type already: take another name"),
        (OPERATIONS, "fetch:\n", "‹fetch part:\n", f"`fetch part` {NO_NAME}"),
        # who writes what
        (
            ARM,
            "do: [goto := position]",
            "do: [goto := position, ‹moving := true]",
            "a start writes output or estimated variables, and `moving` is a measured variable",
        ),
        (
            ARM,
            "      when: executing and pose == position\n",
            "      when: executing and pose == position\n      do: [‹pose := home]\n",
            "a finish writes output or estimated variables, and `pose` is a measured variable",
        ),
        (
            ARM,
            "do: [goto := position]",
            "do: [goto := position, ‹executing := true]",
            "a start writes output or estimated variables, and `executing` is a flag of an ability",
        ),
        (
            ARM,
            "do: [pose := unknown, moving := true]",
            "do: [pose := unknown, ‹goto := home]",
            "an effect writes measured variables, and `goto` is an output variable",
        ),
        (
            ARM,
            "do: [goto := position]",
            "do: [goto := position, ‹goto := home]",
            "`arm.goto` is written twice by one transition: keep one of the two",
        ),
        (
            ARM,
            "do: [pose := unknown, moving := true]",
            "do: [moving := true if goto == home, ‹moving := false if goto != home]",
            "`arm.moving` is written twice by one transition: put the cases into one value, such as "
            "`(A and B) or (C and D)`",
        ),
        (
            ARM,
            "when: goto != pose and pose != unknown",
            "when: goto != pose and ‹parts[left] == full",
            "an effect depends on measured and output variables only, and `parts[left]` is neither",
        ),
        (
            ARM,
            "when: goto != pose and pose != unknown",
            "when: goto != pose and ‹move(home).executing",
            "an effect depends on measured and output variables only, and `move(home).executing` is neither",
        ),
        (
            ARM,
            "moving := true]",
            "'moving := ‹parts[left] == full']",
            "an effect depends on measured and output variables only, and `parts[left]` is neither",
        ),
        (
            ARM,
            "moving := true]",
            "'moving := true if ‹parts[left] == full']",
            "an effect depends on measured and output variables only, and `parts[left]` is neither",
        ),
        # circles
        (
            ARM,
            "  move:\n    parameters: {position: target}\n    enabled: goto",
            "  ‹move:\n    parameters: {position: target}\n    enabled: enabled and goto",
            "flags depend on each other in a circle: arm.move(home).enabled → arm.move(home).enabled",
        ),
        # people
        (
            ARM,
            "    parameters: {position: target}\n",
            "    parameters: {position: target}\n    human: {task: Push, acknowledgement: ‹movin}\n",
            "`movin` must be a measured bool of `arm`; did you mean `moving`?",
        ),
        (
            ARM,
            "    parameters: {position: target}\n",
            "    parameters: {position: target}\n    human: {task: Push, acknowledgement: ‹pose}\n",
            "`pose` must be a measured bool of `arm`",
        ),
        # topics
        (
            ARM,
            "type: cell_msgs/msg/ArmState",
            "type: ‹cell_msgs/msg/ArmStates",
            "no message type `cell_msgs/msg/ArmStates` is known; did you mean `cell_msgs/msg/ArmState`?",
        ),
        (
            ARM,
            "type: cell_msgs/msg/ArmState",
            "type: ‹ArmState",
            "no message type `ArmState` is known; did you mean `cell_msgs/msg/ArmState`?",
        ),
        (
            ARM,
            "  /arm/state:",
            "  ‹arm/state:",
            f"`arm/state` {NO_TOPIC}",
        ),
        (
            ARM,
            "          field: joints\n",
            "          field: ‹joint\n",
            f"{STATE_STAGE_1}: there is no field `joint` here; did you mean `joints`?",
        ),
        (
            ARM,
            "          otherwise: unknown\n",
            "          otherwise: ‹unknwon\n",
            f"{STATE_STAGE_1}: `unknwon` is none of {{unknown, home, out}}; did you mean `unknown`?",
        ),
        (
            ARM,
            "          field: joints\n",
            "          field: ‹moving\n",
            f"{STATE_STAGE_1}: `moving` must be an array of numbers, or a number, and is bool",
        ),
        (
            ARM,
            "{variable: last, of: pose, except: [unknown]}",
            "{variable: ‹lst, of: pose, except: [unknown]}",
            f"{STATE_STAGE_2} `remember`: `arm` has no measured variable `lst`, and no later stage reads it; "
            "did you mean `last`?",
        ),
        (
            ARM,
            "{variable: last, of: pose, except: [unknown]}",
            "{variable: last, of: ‹pos, except: [unknown]}",
            f"{STATE_STAGE_2} `remember`: there is no field `pos` here; did you mean `pose`?",
        ),
        (
            ARM,
            "{variable: last, of: pose, except: [unknown]}",
            "{variable: ‹last, of: pose}",
            f"{STATE_STAGE_2} `remember`: `last` cannot be unknown: put it into `except`",
        ),
        (
            ARM,
            "{variable: last, of: pose, except: [unknown]}",
            "{variable: last, of: pose, except: [unknown, ‹hoome]}",
            f"{STATE_STAGE_2} `remember`: `hoome` is no value of `pose`; did you mean `home`?",
        ),
        (
            ARM,
            "{speed: 0.5}",
            "{‹sped: 0.5}",
            "`/arm/command` → stage 2 `constant`: the message has no field `sped`, and no later stage reads it; "
            "did you mean `speed`?",
        ),
        (
            ARM,
            "{speed: 0.5}",
            "{‹speed: fast}",
            "`/arm/command` → stage 2 `constant`: `speed` is real, and 'fast' is no value of that type",
        ),
        (
            ARM,
            "{speed: 0.5}\n",
            "{speed: 0.5}\n      - rename: {speed: ‹gotoo}\n",
            "`/arm/command` → stage 3 `rename`: there is no field `gotoo` here; did you mean `goto`?",
        ),
        (
            ARM,
            "      - remember",
            "      - constant: {‹moving: true}\n      - remember",
            f"{STATE_STAGE_2} `constant`: `constant` is for outgoing topics: an incoming message has its own values",
        ),
        (
            ARM,
            "{variable: goto, field: joints, values: *poses}",
            "{variable: goto, field: ‹joint, values: *poses}",
            "`/arm/command` → stage 1 `undiscretise`: the message has no field `joint`, and no later stage reads it; "
            "did you mean `joints`?",
        ),
        (
            ARM,
            "variable: goto, field: joints, values: *poses}",
            "variable: ‹goto, field: joints, values: {home: [0, 0]}}",
            "`/arm/command` → stage 1 `undiscretise`: no coordinates for out",
        ),
        (
            ARM,
            "      - undiscretise: {variable: goto, field: joints, values: *poses}",
            "      - discretise: {field: ‹joints, variable: pose, values: *poses, tolerance: 1, otherwise: unknown}",
            "`/arm/command` → stage 1 `discretise`: `discretise` is for incoming topics; use `undiscretise` here",
        ),
        # messages
        (STATE, "bool moving", "bool moving\n‹bool moving", "moving is already declared in line 2"),
        (COMMAND, "float64 speed", "‹float speed", "ROS 2 has no type float: write float32 or float64"),
    ],
)
def test_meaning(tmp_path: Path, file: str, old: str, new: str, message: str) -> None:
    assert_found(tmp_path, file, old, new, message)


def test_a_variable_in_two_sections_and_an_ability_of_its_name(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    [first] = replace(station, ARM, "  moving: {type", "  ‹moving: {type")
    places = [
        *replace(station, ARM, "output:\n", "output:\n  ‹moving: {type: bool}\n"),
        *replace(station, ARM, "abilities:\n", "estimated:\n  ‹moving: {type: bool}\nabilities:\n  ‹moving: {}\n"),
    ]
    assert findings(station) == [
        f"{place}: duplicate name `arm.moving`, first declared at {first}: rename one of them" for place in places
    ]


def test_a_field_that_does_not_correspond(tmp_path: Path) -> None:
    for fields, found in (("int8 moving", "-128..127"), ("bool[2] moving", "bool[2]"), ("string moving", "text")):
        station = copy_of_cell(tmp_path / found)
        replace(station, STATE, "bool moving", fields)
        [place] = replace(station, ARM, "  /arm/state:", "  ‹/arm/state:")
        message = f"field `moving` is {found}, and `arm.moving` is bool: they do not correspond"
        assert findings(station) == [f"{place}: {message}"]


def test_a_range_must_fit_into_the_field(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    replace(station, STATE, "bool moving", "bool moving\nuint8 count")
    replace(station, ARM, "  moving: {type", "  count: {type: -1..3}\n  moving: {type")
    [line] = findings(station)
    assert line.endswith(": field `count` is 0..255, and `arm.count` is -1..3: they do not correspond")


def test_coordinates_that_do_not_fit_are_said_of_every_stage_that_uses_them(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    replace(station, ARM, "out: [1.0, 0.5]", "out: [1.0]")
    here = replace(station, ARM, "          field: joints", "          field: ‹joints")
    there = replace(station, ARM, "goto, field: joints", "goto, field: ‹joints")
    assert findings(station) == [
        f"{place}: {stage}: all points need as many coordinates as `joints` has: real[2]"
        for place, stage in zip(
            (*here, *there), (STATE_STAGE_1, "`/arm/command` → stage 1 `undiscretise`"), strict=True
        )
    ]


def test_a_topic_that_feeds_nothing_and_one_that_feeds_what_is_fed_already(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    second, empty = replace(
        station,
        ARM,
        "  /arm/command:",
        "  ‹/arm/again: {type: cell_msgs/msg/ArmState, direction: in}\n"
        "  ‹/arm/nothing: {type: std_msgs/msg/String, direction: in}\n"
        "  /arm/command:",
    )
    assert findings(station) == [
        f"{second}: `arm.moving` is fed by `/arm/state` already",
        f"{empty}: `/arm/nothing` feeds no variable: no field bears the name of a measured variable",
    ]


def test_points_at_the_same_place_are_said_of_every_stage_that_uses_them(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    [place] = replace(station, ARM, "            out: [1.0, 0.5]\n", "            ‹out: [0.0, 0.0]\n")
    stages = ("`/arm/command` → stage 1 `undiscretise`", STATE_STAGE_1)
    assert findings(station) == [f"{place}: {stage}: `out` is at the same coordinates as `home`" for stage in stages]


def test_a_name_misspelt_where_it_is_given_is_found_where_it_is_read(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    replace(station, ARM, "          variable: pose\n", "          variable: poses\n")
    [place] = replace(station, ARM, "{variable: last, of: pose", "{variable: last, of: ‹pose")
    message = f"{STATE_STAGE_2} `remember`: there is no field `pose` here; did you mean `poses`?"
    assert findings(station) == [f"{place}: {message}"]


def test_only_what_the_topic_has_said_can_be_remembered(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    replace(station, ARM, "measured:\n", "measured:\n  elsewhere: {type: target}\n")
    [place] = replace(station, ARM, "of: pose, except: [unknown]", "of: ‹elsewhere")
    message = f"{STATE_STAGE_2} `remember`: there is no field `elsewhere` here"
    assert findings(station) == [f"{place}: {message}"]


def test_circular_flags_of_two_abilities(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    places = replace(
        station,
        ARM,
        "abilities:\n",
        "abilities:\n  ‹one: {executing: two.finished}\n  two: {finished: one.executing and moving}\n",
    )
    [line] = findings(station)
    place, message = line.split(": flags depend on each other in a circle: ")
    assert place in (*places, places[0].replace(":32:", ":33:"))
    assert set(message.split(" → ")) == {"arm.one.executing", "arm.two.finished"}


def test_what_is_of_no_usable_type_is_reported_once_and_not_where_it_is_used(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    places = [
        *replace(station, STATION, "type: fill", "type: ‹fil"),
        *replace(station, ARM, "parameters: {position: target}", "parameters: {position: ‹targt}"),
        *replace(
            station,
            SPECIFICATIONS,
            "never:\n",
            "later:\n  forbidden: arm.move(home).executing\nlast:\n  forbidden: ‹arm.mov\nnever:\n",
        ),
    ]
    assert [line.split(": ")[0] for line in findings(station)] == sorted(places)


def test_errors_of_meaning_in_several_files_are_all_reported(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    places = [
        *replace(station, STATION, "rest: arm.pose", "rest: ‹arm.poze"),
        *replace(station, ARM, "enabled: goto == pose and pose", "enabled: ‹moved and mved and pose"),
        *replace(station, ARM, "do: [goto := position]", "do: [goto := ‹positon, ‹moving := true]"),
        *replace(station, OPERATIONS, "precondition: parts[which]", "precondition: ‹part[which]"),
        *replace(station, SPECIFICATIONS, "arm.pose == out", "arm.pose == ‹outt"),
    ]
    assert {line.split(": ")[0] for line in findings(station)} == set(places)


def test_message_definitions_come_before_what_follows_from_them(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    replace(station, STATION, "rest: arm.pose", "rest: arm.poze")
    places = replace(station, STATE, "bool moving", "‹boool moving")
    assert [line.split(": ")[0] for line in findings(station)] == places


def test_a_resource_must_have_a_name_too(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    write(station, "resources/left-arm.yaml", "title: Left arm\n")
    assert findings(station) == [f"{station}/resources/left-arm.yaml:1:1: `left-arm` {NO_NAME}"]


def test_no_station(tmp_path: Path) -> None:
    message = "a station is a folder with a station.yaml: there is none here"
    (tmp_path / "file").write_text("name: cell\n", encoding="utf-8")
    for folder in (tmp_path, tmp_path / "missing", tmp_path / "file", tmp_path / ("x" * 300)):
        assert findings(folder) == [f"{folder / 'station.yaml'}:1:1: {message}"]
