"""What is wrong with a pipeline is said where it was written, before a station runs, with what to do."""

from __future__ import annotations

from pathlib import Path

import pytest

from sequence_planner.model.source import ModelError
from support.commands import command

from .stage_texts import findings
from .station_writing import station_with, write_station

MESSAGES = {
    "State": "uint8 MANUAL=0\nuint8 AUTOMATIC=1\nuint8 mode\nfloat64 force\nstring program\n",
    "Command": "string<=5 word\nfloat32 speed\nint32[] levels\nfloat64 force\n",
}
ENUMERATIONS = "drive: [manual, automatic]"


def refused(folder: Path, resource: str) -> list[str]:
    """The findings about a resource, without their places."""
    with pytest.raises(ModelError) as error:
        station_with(folder, resource, MESSAGES, ENUMERATIONS)
    return [finding.message for finding in error.value.findings]


def state(pipeline: str, measured: str, more: str = "") -> str:
    """A resource with an incoming topic."""
    topic = f"/state: {{type: tank_msgs/msg/State, direction: in, ignore: [mode], pipeline: [{pipeline}]}}"
    return f"topics:\n  {topic}\nmeasured: {{{measured}}}\n{more}"


def command_topic(pipeline: str, more: str = "") -> str:
    """A resource with an outgoing topic."""
    topic = f"/command: {{type: tank_msgs/msg/Command, direction: out, pipeline: [{pipeline}]{more}}}"
    return f"topics:\n  {topic}\noutput: {{wanted: {{type: drive}}}}\n"


def test_a_fold_of_all_fields_is_no_use_of_any(tmp_path: Path) -> None:
    stages = "{fold: []}, {expression: {strong: force > 1}}"
    station = station_with(tmp_path / "right", state(stages, "strong: {type: bool}"), MESSAGES, ENUMERATIONS)
    assert station.pipelines.incoming["/state"].variables == ("tank.strong",)
    spare = "{expression: {spare: force > 2}}, "
    assert refused(tmp_path / "wrong", state(spare + stages, "strong: {type: bool}")) == [
        "`/state` → stage 1 `expression`: `tank` has no measured variable `spare`, and no later stage reads it"
    ]


def test_a_number_is_not_remembered_under_the_names_of_its_constants(tmp_path: Path) -> None:
    resource = state(
        "remember: {variable: last, of: mode, except: [manual]}", "last: {type: drive}, mode: {type: drive}"
    )
    assert refused(tmp_path, resource.replace("ignore: [mode], ", "")) == [
        "`/state` → stage 1 `remember`: `mode` is 0..255 here, and `last` is {manual, automatic}: make one of the "
        "other by a stage before this"
    ]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("remember: {variable: valve, of: ‹force}", "`force` is real here, and `valve` is bool: make one of the other "
         "by a stage before this"),
        ("remember: {variable: last, of: ‹count}", "`count` is 0..255 here, and `last` is {home, out, unknown}: make "
         "one of the other by a stage before this"),
        ("map: {field: force, variable: valve, values: {1: true, ‹1.0: false}}", "`1.0` is the same as `1`, for which "
         "there is a value already"),
        ("table: {fields: [count], variables: [valve, ‹valve], rows: [{when: [1], gives: [true, false]}]}",
         "`valve` is given twice here"),
        ("expression: {valve: mode == ‹main}", "there is no field `main` here; a text is written 'main'"),
        ("expression: {valve: count == ‹busy}", "there is no field `busy` here; `count` is a number here, whose values "
         "get names by a `map` before this"),
    ],
)  # fmt: skip
def test_incoming_stages(text: str, said: str) -> None:
    assert findings(text.replace("‹", "")) == [f"1:{text.index('‹') + 1}: {said}"]


@pytest.mark.parametrize(
    ("pipeline", "said"),
    [
        (
            "map: {variable: wanted, field: word, values: {manual: hand, automatic: machine}}",
            "stage 1 `map`: the message cannot be written: tank_msgs/msg/Command word: expected at most 5 bytes of "
            "UTF-8, found 'machine' (str)",
        ),
        (
            "map: {variable: wanted, field: speed, values: {manual: 1, automatic: 1e300}}",
            "stage 1 `map`: the message cannot be written: tank_msgs/msg/Command speed: expected float32 (at most "
            "3.402823e+38 in size), found 1e+300 (float)",
        ),
        (
            "undiscretise: {variable: wanted, field: levels, values: {manual: [1], automatic: [1.5]}}",
            "stage 1 `undiscretise`: `automatic` has the coordinate 1.5, and the field has integers in "
            "-2147483648..2147483647",
        ),
        (
            "expression: {'levels[0]': 1}",
            "stage 1 `expression`: `levels[0]` is an item of a list, and lists are sent as a whole: give `levels`",
        ),
        (f"constant: {{force: 1{'0' * 400}}}", "stage 1 `constant`: `force` is real, and 1000"),
    ],
)
def test_what_no_message_can_hold(tmp_path: Path, pipeline: str, said: str) -> None:
    found = refused(tmp_path, command_topic(pipeline))
    assert [each.startswith(f"`/command` → {said}") for each in found] == [True], found


def test_coordinates_are_sent_as_integers_where_the_field_has_these(tmp_path: Path) -> None:
    stage = "undiscretise: {variable: wanted, field: levels, values: {manual: [1, 2], automatic: [3, -4]}}"
    example = ", examples: [{name: it, given: {wanted: automatic}, gives: {levels: [3, -4]}}]"
    folder = write_station(tmp_path, command_topic(stage, example), MESSAGES, ENUMERATIONS)
    assert command("check", folder)[2] == ""


def test_a_range_has_two_ends(tmp_path: Path) -> None:
    stage = "discretise: {field: force, variable: kept, ranges: {manual: [1, 2, 3]}}"
    assert refused(tmp_path, state(stage, "kept: {type: drive}")) == ["expected at most 2 entries, found a list"]


@pytest.mark.parametrize(
    ("flows", "said"),
    [
        ("/one: {from: /state}", "`/one` is no name for a flow: use letters, digits and _"),
        ("or: {from: /state}", "`or` is no name for a flow: it is a word of the language"),
        ("one: {from: {in: /state}}", "`in` is no name for a source: it is a word of the language"),
    ],
)
def test_names_of_flows_and_sources(tmp_path: Path, flows: str, said: str) -> None:
    resource = state("expression: {strong: force > 1}", "strong: {type: bool}", f"flows:\n  {flows}\n")
    assert refused(tmp_path, resource) == [said]


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("{force: lots}", "`force` is real, and 'lots' is no value of that type"),
        ("{strong: 1}", "`strong` is bool, and 1 is no value of that type"),
    ],
)
def test_an_example_of_a_flow_is_given_values_of_the_types(tmp_path: Path, given: str, said: str) -> None:
    code, _, errors = command("check", write_station(tmp_path, _with_example(given), MESSAGES, ENUMERATIONS))
    assert code == 2
    assert said in errors


def test_an_example_of_a_flow_may_be_of_numbers_without_sense(tmp_path: Path) -> None:
    folder = write_station(tmp_path, _with_example("{force: .nan}"), MESSAGES, ENUMERATIONS)
    assert command("check", folder)[2] == ""


def _with_example(given: str) -> str:
    examples = f"[{{name: it, given: {{a: {given}}}, gives: {{weak: null}}}}]"
    stages = "[expression: {weak: a.force < 1}]"
    flows = f"flows:\n  one: {{from: {{a: /state}}, pipeline: {stages}, examples: {examples}}}\n"
    return state("expression: {strong: force > 1}", "strong: {type: bool}, weak: {type: bool}", flows)


def test_what_an_outgoing_message_depends_on_is_read(tmp_path: Path) -> None:
    resource = """
topics:
  /state:
    type: tank_msgs/msg/State
    direction: in
    ignore: [mode]
    pipeline: [expression: {strong: force > 1, weak: force < 1}]
  /command:
    type: tank_msgs/msg/Command
    direction: out
    pipeline: [map: {variable: strong, field: word, values: {true: go, false: stop}}]
measured: {strong: {type: bool}, weak: {type: bool}}
"""
    _, printed, _ = command("check", write_station(tmp_path, resource, MESSAGES, ENUMERATIONS))
    unread = [line for line in printed.splitlines() if "[never-read]" in line and "tank." in line]
    assert len(unread) == 1
    assert "nothing reads `tank.weak`" in unread[0]
