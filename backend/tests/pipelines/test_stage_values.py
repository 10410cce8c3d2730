"""Stages that turn values into others: names, points, ranges, maps, tables, texts, lists; forwards and backwards."""

from __future__ import annotations

import math
from collections.abc import Mapping

import pytest
from hypothesis import given as tried_with
from hypothesis import strategies as st

from core.choices import Choices, made_by
from pipelines.stage_texts import MESSAGE, POSE, given, outgoing, stage, take, unchanged
from sequence_planner.language.records.field_paths import TEXT
from sequence_planner.language.records.record import Record
from sequence_planner.language.types import BOOLEAN, IntegerRange
from sequence_planner.model.stages.base import NotInvertibleError, Stage
from support.examples import examples

POINTS = """
discretise: {field: joints, variable: at, values: {home: [0, 0], out: [1, 0.5]}, tolerance: 0.1, otherwise: unknown}
"""
RANGES = "discretise: {field: force, variable: at, ranges: {home: [null, 0.2], out: [0.8, null]}, otherwise: unknown}"
MAP = "map: {field: count, variable: control, values: {1: manual, 2: automatic}}"
TABLE = """
table:
  fields: [door, count]
  variables: [at, valve]
  rows:
    - {when: [true, any], gives: [home, false]}
    - {when: [false, 3], gives: [out, true]}
  otherwise: [unknown, false]
"""
NAMES = "match: {field: mode, variable: control, values: {manual: [T1, T2], automatic: [AUTO]}}"


def test_a_field_has_another_name_as_well() -> None:
    renaming = stage("rename: {door: valve, pose.position.x: x}")
    values = {"door": True, "pose": {"position": {"x": 0.5}}}
    assert given(renaming, values) == ({"valve": True, "x": 0.5}, [])
    assert take(renaming.begin(), **values) == values | {"valve": True, "x": 0.5}


def test_two_fields_can_change_their_names() -> None:
    assert given(stage("rename: {door: count, count: door}"), {"door": True, "count": 3})[0] == {
        "count": True,
        "door": 3,
    }


def test_an_outgoing_field_has_the_value_of_the_variable() -> None:
    assert given(outgoing("rename: {door: valve, pose.position.x: level}"), {"valve": True, "level": 3})[0] == {
        "door": True,
        "pose.position.x": 3,
    }


def test_constants_are_always_there() -> None:
    constant = outgoing(
        "constant: {force: 1, mode: fast, joints: [0, 0.5], pose.position.x: 2, pose: {position: {y: 1}}}"
    )
    assert given(constant, {}) == (
        {"force": 1, "mode": "fast", "joints": [0, 0.5], "pose.position.x": 2, "pose": {"position": {"y": 1}}},
        [],
    )


@pytest.mark.parametrize(
    ("joints", "name"),
    [
        ([0.0, 0.0], "home"),
        ([0.1, -0.1], "home"),  # the tolerance itself is within it
        ([0.100001, 0.0], "unknown"),
        ([0.0, 0.11], "unknown"),  # every coordinate counts
        ([1, 0.5], "out"),
    ],
)
def test_a_position_is_the_name_of_the_point_it_is_at(joints: list[float], name: str) -> None:
    assert given(stage(POINTS), {"joints": joints}) == ({"at": name}, [])


def test_of_two_points_within_the_tolerance_the_nearest_counts() -> None:
    text = (
        "discretise: {field: force, variable: at, values: {home: [0], out: [0.15]}, tolerance: 0.1, otherwise: unknown}"
    )
    assert [given(stage(text), {"force": x})[0]["at"] for x in (0.07, 0.08)] == ["home", "out"]
    course = stage(text).begin()  # without a hysteresis whatever was before
    assert [(take(course, force=x) or {})["at"] for x in (0.07, 0.08, 0.07)] == ["home", "out", "home"]


@pytest.mark.parametrize(("force", "name"), [(-9e9, "home"), (0.2, "home"), (0.5, "unknown"), (0.8, "out")])
def test_a_number_is_the_name_of_the_range_it_is_in(force: float, name: str) -> None:
    assert given(stage(RANGES), {"force": force}) == ({"at": name}, [])


def test_without_another_value_a_number_between_ranges_is_unknown_and_said() -> None:
    text = "discretise: {field: force, variable: at, ranges: {home: [0, 1], out: [1, 2]}}"
    assert given(stage(text), {"force": 1}) == ({"at": "home"}, [])  # of two that touch the first
    assert given(stage(text), {"force": 3.0}) == ({"at": None}, ["force is 3.0, which is in none of the ranges"])


@pytest.mark.parametrize(
    "joints", [[math.nan, 0.0], [0.0, math.inf], [], [0.0], [0.0] * 3, 0.0, "home", [True, 0.0], ["0", "0"]]
)
def test_what_is_no_position_is_unknown_and_said(joints: object) -> None:
    assert given(stage(POINTS), {"joints": joints}) == ({"at": None}, [f"joints is no position: {joints!r}"])


def test_what_is_said_is_short() -> None:
    (trouble,) = given(stage(POINTS), {"joints": [math.nan] * 10_000})[1]
    assert len(trouble) < 100
    (trouble,) = given(stage(NAMES), {"mode": "x" * 10_000})[1]
    assert len(trouble) < 130


@tried_with(st.lists(st.floats(-2, 2), max_size=30), st.floats(0.0, 0.3))
@examples(200)
def test_a_point_is_left_only_beyond_tolerance_and_hysteresis(places: list[float], hysteresis: float) -> None:
    text = (
        "discretise: {field: force, variable: at, values: {home: [0], out: [1]}, tolerance: 0.25, otherwise: unknown}"
    )
    course = stage(text.replace("tolerance", f"hysteresis: {hysteresis}, tolerance")).begin()
    points, last = {"home": 0.0, "out": 1.0}, "unknown"
    for place in places:
        if last == "unknown" or abs(place - points[last]) > 0.25 + hysteresis:
            last = next((name for name, point in points.items() if abs(place - point) <= 0.25), "unknown")
        assert take(course, force=place) == {"force": place, "at": last}


@tried_with(st.lists(st.floats(0.2, 0.3), min_size=1, max_size=30))
@examples(100)
def test_within_the_band_nothing_flaps(places: list[float]) -> None:
    text = "discretise: {field: force, variable: at, ranges: {home: [null, 0.25], out: [0.25, null]}, hysteresis: 0.06}"
    course = stage(text).begin()
    assert len({(take(course, force=place) or {})["at"] for place in places}) == 1


def test_after_nonsense_no_point_has_been_reached() -> None:
    course = stage(RANGES.replace("otherwise", "hysteresis: 0.5, otherwise")).begin()
    assert [(take(course, force=x) or {})["at"] for x in (0.1, 0.5, None, 0.5)] == ["home", "home", None, "unknown"]


def test_a_name_becomes_its_coordinates() -> None:
    undiscretise = outgoing(
        "undiscretise: {variable: at, field: joints, values: {home: [0, 0], out: [1, 0.5], unknown: [9, 9]}}"
    )
    assert given(undiscretise, {"at": "out"}) == ({"joints": [1.0, 0.5]}, [])
    assert given(undiscretise, {"at": None}) == ({"joints": None}, [])
    values: dict[str, object] = {"joints": [1.0000001, 0.5]}
    undiscretise.backwards(values)
    assert values["at"] == "out"
    with pytest.raises(NotInvertibleError, match="joints is no position"):
        undiscretise.backwards({"joints": [math.nan, 0]})


def test_values_are_mapped_and_others_are_unknown_and_said() -> None:
    assert given(stage(MAP), {"count": 2}) == ({"control": "automatic"}, [])
    trouble = "count is 7, to which no value of control is given"
    assert given(stage(MAP), {"count": 7}) == ({"control": None}, [trouble])
    assert given(stage(MAP[:-1] + ", otherwise: manual}"), {"count": 7}) == ({"control": "manual"}, [])
    assert given(stage(MAP), {"count": None}) == ({"control": None}, [])


def test_a_map_of_an_outgoing_topic_goes_from_the_variable_to_the_field() -> None:
    mapping = outgoing("map: {field: count, variable: control, values: {manual: 1, automatic: 2}}")
    assert given(mapping, {"control": "automatic"}) == ({"count": 2}, [])


def test_truth_values_and_numbers_are_told_apart() -> None:
    mapping = stage("map: {field: door, variable: step, values: {true: 1, false: 0}}")
    assert given(mapping, {"door": True}) == ({"step": 1}, [])
    assert given(mapping, {"door": 1})[0] == {"step": None}


def test_the_first_row_that_applies_says_what_is() -> None:
    table = stage(TABLE)
    assert given(table, {"door": True, "count": 3}) == ({"at": "home", "valve": False}, [])
    assert given(table, {"door": False, "count": 3}) == ({"at": "out", "valve": True}, [])
    assert given(table, {"door": False, "count": 4}) == ({"at": "unknown", "valve": False}, [])


def test_a_table_knows_what_the_known_decides() -> None:
    table = stage(TABLE)
    assert given(table, {"door": True, "count": None}) == ({"at": "home", "valve": False}, [])
    assert given(table, {"door": False, "count": None}) == ({"at": None, "valve": None}, [])
    assert given(table, {"door": None, "count": 3}) == ({"at": None, "valve": None}, [])


def test_no_row_is_unknown_and_said() -> None:
    table = stage("table: {fields: [count, mode], variables: [valve], rows: [{when: [1, any], gives: [true]}]}")
    assert given(table, {"count": 2, "mode": "x"}) == (
        {"valve": None},
        ["no row of the table fits [2, 'x'] for count, mode"],
    )


@pytest.mark.parametrize(
    ("way", "text", "truth"),
    [
        ("contains: op", "open", True),
        ("contains: op", "shut", False),
        ("begins: op", "open", True),
        ("begins: op", "stop", False),
        ("ends: op", "stop", True),
        ("equals: op", "op", True),
        ("equals: op", "Op", False),
        ("contains: op", None, None),
    ],
)
def test_texts_are_recognised(way: str, text: str | None, truth: bool | None) -> None:
    match = stage(f"match: {{field: mode, variable: valve, {way}}}")
    assert given(match, {"mode": text}) == ({"valve": truth}, [])
    assert match.gives == {"valve": BOOLEAN}


def test_texts_mean_the_name_under_which_they_are_listed() -> None:
    assert given(stage(NAMES), {"mode": "T2"}) == ({"control": "manual"}, [])
    assert given(stage(NAMES), {"mode": "t2"}) == ({"control": None}, ["mode is 't2', which is no value of control"])
    assert given(stage(NAMES[:-1] + ", otherwise: manual}"), {"mode": ""}) == ({"control": "manual"}, [])


def test_a_list_contains_an_item_or_not() -> None:
    assert given(stage("member: {field: names, item: clamp, variable: valve}"), {"names": ["a", "clamp"]})[0] == {
        "valve": True
    }
    member = stage("member: {field: levels, item: 1, variable: valve}")
    assert [given(member, {"levels": levels})[0]["valve"] for levels in ([1], [], [2], None)] == [
        True,
        False,
        False,
        None,
    ]


def test_the_name_of_which_a_list_has_one() -> None:
    member = stage("member: {field: names, variable: control}")
    assert given(member, {"names": ["x", "manual", "manual"]}) == ({"control": "manual"}, [])
    assert given(member, {"names": None}) == ({"control": None}, [])
    assert given(member, {"names": ["x"]}) == (
        {"control": None},
        ["names is ['x'], with none of manual, automatic, which is no value of control"],
    )
    assert given(member, {"names": ["manual", "automatic"]}) == (
        {"control": None},
        ["names is ['manual', 'automatic'], with manual and automatic at once, which is no value of control"],
    )
    or_manual = stage("member: {field: names, variable: control, if_none: manual}")
    texts: list[list[str]] = [[], ["manual"], ["automatic"], ["automatic", "manual"]]
    found = [given(or_manual, {"names": names})[0]["control"] for names in texts]
    assert found == ["manual", "manual", "automatic", "automatic"]


ONE_OF = "one_of: {variable: control, fields: {manual: door, automatic: 'slot[left]'}}"


@pytest.mark.parametrize(
    ("door", "slot", "is_so", "or_else"),
    [
        (True, False, "manual", "manual"),
        (False, True, "automatic", "automatic"),
        (False, False, None, "manual"),
        (True, True, None, "manual"),
        (None, True, None, None),
        (True, None, None, None),
    ],
)
def test_which_of_several_is_true(door: bool | None, slot: bool | None, is_so: str | None, or_else: str | None) -> None:
    said = {"door": door, "slot[left]": slot}
    found, troubles = given(stage(ONE_OF), said)
    assert found == {"control": is_so}
    assert len(troubles) == (is_so is None and None not in said.values())
    assert given(stage(ONE_OF[:-1] + ", otherwise: manual}"), said) == ({"control": or_else}, [])


def test_one_of_several_is_sent() -> None:
    sent = outgoing("one_of: {variable: at, fields: {home: door, out: 'slot[left]'}}")
    assert given(sent, {"at": "home"})[0] == {"door": True, "slot[left]": False}
    assert given(sent, {"at": "out"})[0] == {"door": False, "slot[left]": True}
    assert given(sent, {"at": "unknown"})[0] == {"door": False, "slot[left]": False}
    assert given(sent, {"at": None})[0] == {"door": None, "slot[left]": None}


def test_a_row_gives_what_a_field_is() -> None:
    table = stage(
        "table: {fields: [state, door], variables: [control], "
        "rows: [{when: [any, true], gives: [{field: state}]}], otherwise: [automatic]}"
    )
    for state in ("manual", "automatic", None):
        assert given(table, {"state": state, "door": True})[0] == {"control": state}
    assert given(table, {"state": "manual", "door": False})[0] == {"control": "automatic"}
    assert given(table, {"state": "manual", "door": None})[0] == {"control": None}


def _values(choose: Choices) -> dict[str, object]:
    """Values that a device may say: those of the variables."""
    truth = [True, False]
    return {
        "at": choose.pick(POSE.values),
        "valve": choose.pick(truth),
        "control": choose.pick(["manual", "automatic"]),
        "n": choose.number(-3, 5),
    }


INVERTIBLE = [
    POINTS,
    POINTS.replace("tolerance", "hysteresis: 3, tolerance"),
    RANGES,
    RANGES.replace("otherwise", "hysteresis: 0.25, otherwise"),
    MAP,
    "map: {field: count, variable: control, values: {1: manual}, otherwise: automatic}",
    "map: {field: mode, variable: control, values: {'': manual}, otherwise: automatic}",
    "map: {field: force, variable: control, values: {0.5: manual}, otherwise: automatic}",
    "rename: {door: valve, mode: at}",
    TABLE.replace("[unknown, false]\n", "[unknown, true]\n"),
    NAMES,
    NAMES.replace("automatic: [AUTO]}", "manual: [T1]}, otherwise: automatic").replace("manual: [T1, T2], ", ""),
    *(f"match: {{field: mode, variable: valve, {way}: op}}" for way in ("contains", "begins", "ends", "equals")),
    "member: {field: names, item: clamp, variable: valve}",
    "member: {field: levels, item: 1, variable: valve}",
    "member: {field: joints, item: 1, variable: valve}",
    "member: {field: names, variable: control}",
    "member: {field: names, variable: control, if_none: automatic}",
    ONE_OF,
    ONE_OF[:-1] + ", otherwise: automatic}",
    "table: {fields: [state], variables: [control], rows: [{when: [any], gives: [{field: state}]}]}",
    "expression: {valve: 'force > 0.5'}",
    "expression: {valve: 'force * 2 >= 3 and not door'}",
    "expression: {valve: 'mode == ''T1'' or count in {3, 4}'}",
    "expression: {n: 'count - 3', valve: 'count >= 0 and door'}",
    "expression: {valve: 'joints[1] > 0.2 and pose.position.x < 0'}",
    "expression: {valve: 'points[1].x > 3'}",
]

ONE_NAME = [  # for what a stage reads and for what it gives
    "map: {field: control, variable: control, values: {M: manual, A: automatic}}",
    "match: {field: control, variable: control, values: {manual: [M], automatic: [A]}}",
    "table: {fields: [control], variables: [control], rows: [{when: [M], gives: [manual]}], otherwise: [automatic]}",
    "expression: {n: n - 4}",
    "rename: {n: at, at: n}",
]


@pytest.mark.parametrize("text", [*INVERTIBLE, *ONE_NAME])
@tried_with(wanted=made_by(_values))
@examples(30)
def test_backwards_then_forwards_is_the_same(text: str, wanted: Mapping[str, object]) -> None:
    made = stage(text, {**MESSAGE, "control": TEXT, "n": IntegerRange(0, 9), "at": TEXT})
    values = {name: value for name, value in wanted.items() if name in made.gives}
    if text == TABLE.replace("[unknown, false]\n", "[unknown, true]\n"):
        values["valve"] = {"home": False, "out": True, "unknown": True}[str(values["at"])]
    assert _reread(made, values) == values


def _reread(made: Stage, values: Mapping[str, object]) -> dict[str, object]:
    """What a message says that a device has made of `values`."""
    said = dict(values)
    made.backwards(said)
    record: dict[str, object] = {}
    for name in made.reads:
        value = said[name]
        match name:
            case "joints[1]":
                record["joints"] = [0.0, value]
            case "pose.position.x":
                record["pose"] = {"position": {"x": value}}
            case "points[1].x":
                record["points"] = [{"x": 0.0}, {"x": value}]
            case _:
                record[name] = value
    found, troubles = given(made, record)
    assert troubles == []
    return found


@pytest.mark.parametrize(
    ("text", "values", "why"),
    [
        (
            "discretise: {field: force, variable: at, ranges: {home: [null, 0], out: [0, null]}, otherwise: unknown}",
            {"at": "unknown"},
            "no number means 'unknown' for `at`",
        ),
        (MAP, {"control": "broken"}, "no value of `count` becomes 'broken'"),
        (MAP, {"control": "manual", "count": 2}, "no value of `count` becomes 'manual'"),
        (TABLE, {"at": "home", "valve": True}, "no row gives"),
        (NAMES, {"control": "x"}, "no text of `mode` means 'x'"),
        (
            "match: {field: mode, variable: valve, contains: ''}",
            {"valve": False},
            "no text of `mode` makes `valve` False",
        ),
        ("expression: {valve: 'force > 1 and force < 0'}", {"valve": True}, "no values tried for `force` give valve"),
        ("filter: 'door and not door'", {}, "no values tried for `door` pass the filter"),
    ],
)
def test_what_no_device_can_say_is_refused(text: str, values: dict[str, object], why: str) -> None:
    with pytest.raises(NotInvertibleError) as refused:
        stage(text).backwards(values)
    assert str(refused.value).startswith(why)


def test_a_device_goes_on_from_where_it_is() -> None:
    values: dict[str, object] = {"at": "unknown", "joints": [0.5, 0.2]}
    stage(POINTS).backwards(values)
    assert values["joints"] == [0.5, 0.2]
    values["joints"] = [0.95, 0.5]
    stage(POINTS).backwards(values)
    assert values["joints"] == [0.95 + 0.2, 0.5]
    values["at"] = "out"
    stage(POINTS).backwards(values)
    assert values["joints"] == [1.0, 0.5]


def test_what_is_unknown_says_nothing_backwards() -> None:
    for text in INVERTIBLE:
        values: dict[str, object] = {}
        stage(text).backwards(values)
        assert values == {}


ANYTHING = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from("xy"), inner, max_size=2),
    max_leaves=5,
)
FIELDS = ("joints", "force", "count", "mode", "door", "names", "levels", "pose", "points")


@pytest.mark.parametrize("text", INVERTIBLE[:-5])
@tried_with(values=st.fixed_dictionaries({}, optional=dict.fromkeys(FIELDS, ANYTHING)))
@examples(60)
def test_anything_has_a_meaning_or_is_unknown_and_nothing_else_changes(text: str, values: dict[str, object]) -> None:
    made = stage(text)
    with unchanged(values):
        record = made.begin().take(Record(dict(values)), 0.0)
    assert record is not None
    assert {name: value for name, value in record.values.items() if name not in made.gives}.keys() == {
        name for name in values if name not in made.gives
    }
    for name in made.gives:
        if name == "at" and "rename" not in text:
            assert record.values[name] in (None, *POSE.values)
