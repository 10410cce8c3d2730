"""Single stages: a field, a position, a memory, a constant."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.expressions.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value
from sequence_planner.pipelines.stages import (
    ConstantStage,
    Coordinates,
    DiscretiseStage,
    FieldStage,
    Reading,
    RememberStage,
    UndiscretiseStage,
)

POINTS = Coordinates({"home": (0.0, 0.0), "out": (1.0, 0.5), "near_out": (1.15, 0.5)})
TO_POSE = DiscretiseStage("joints", "pose", POINTS, tolerance=0.1, otherwise="unknown")
TO_JOINTS = UndiscretiseStage("pose", "joints", POINTS)


def pose(joints: object) -> tuple[Value | None, list[str]]:
    reading = Reading()
    TO_POSE.read({"joints": joints}, reading)
    return reading.values["pose"], reading.troubles


@pytest.mark.parametrize(
    ("joints", "name"),
    [
        ([0.0, 0.0], "home"),
        ([0.1, -0.1], "home"),  # the tolerance itself is within it
        ([0.100001, 0.0], "unknown"),
        ([0.0, 0.11], "unknown"),  # every coordinate counts
        ([0.5, 0.25], "unknown"),
        ([1.05, 0.5], "out"),  # within the tolerance of two: the nearest
        ([1.1, 0.5], "near_out"),
        ([0, 0], "home"),
    ],
)
def test_a_position_is_the_name_of_the_point_it_is_at(joints: list[float], name: str) -> None:
    assert pose(joints) == (name, [])


@pytest.mark.parametrize(
    "joints", [[math.nan, 0.0], [0.0, math.inf], [-math.inf, math.nan], [], [0.0], [0.0, 0.0, 0.0], 0.0, "home"]
)
def test_what_is_no_position_is_unknown_and_said(joints: object) -> None:
    assert pose(joints) == (None, [f"joints is no position: {joints!r}"])


@given(st.sampled_from(sorted(POINTS.points)), st.lists(st.floats(-0.05, 0.05), min_size=2, max_size=2))
def test_near_a_point_is_at_it(name: str, errors: list[float]) -> None:
    assert pose([a + b for a, b in zip(POINTS.points[name], errors, strict=True)]) == (name, [])


@given(st.lists(st.floats(allow_nan=True, allow_infinity=True), max_size=4))
def test_any_numbers_have_a_meaning_or_a_trouble(joints: list[float]) -> None:
    value, troubles = pose(joints)
    assert (value is None) == bool(troubles)
    assert value in (None, "unknown", *POINTS.points)


@given(st.sampled_from(sorted(POINTS.points)))
def test_a_point_becomes_its_coordinates_and_these_the_point(name: str) -> None:
    record: dict[str, object] = {}
    TO_JOINTS.write({"pose": name}, record)
    assert pose(record["joints"]) == (name, [])
    reading = Reading()
    TO_JOINTS.read(record, reading)
    assert (reading.values, reading.troubles) == ({"pose": name}, [])


def test_an_unknown_point_leaves_the_field_alone() -> None:
    record: dict[str, object] = {}
    TO_JOINTS.write({"pose": None}, record)
    assert record == {}


def test_a_command_that_is_no_position_is_unknown_to_the_device_and_said() -> None:
    reading = Reading()
    TO_JOINTS.read({"joints": [math.nan, 0.0]}, reading)
    assert (reading.values, reading.troubles) == ({"pose": None}, ["joints is no position: [nan, 0.0]"])


@pytest.mark.parametrize(
    ("type_", "good", "bad"),
    [
        (BOOLEAN, (False, True), (0, 1, "true", None, [])),
        (IntegerRange(-1, 2), (-1, 0, 2), (-2, 3, True, 1.0, "1", None)),
        (EnumerationType(("open", "shut")), ("open", "shut"), ("Open", "", "ajar", True, 0, None, ["open"])),
    ],
)
def test_a_field_gives_a_value_of_the_domain_or_none(
    type_: Type, good: tuple[object, ...], bad: tuple[object, ...]
) -> None:
    stage = FieldStage("valve", "tank.valve", type_)
    for value in good:
        reading = Reading()
        stage.read({"valve": value}, reading)
        assert (reading.values, reading.troubles) == ({"tank.valve": value}, [])
        assert type(reading.values["tank.valve"]) is type(value)
    for value in bad:
        reading = Reading()
        stage.read({"valve": value}, reading)
        assert reading.values == {"tank.valve": None}
        assert reading.troubles == [f"valve is {value!r}, and tank.valve ranges over {type_}"]


def test_a_memory_keeps_the_last_value_that_counts() -> None:
    stage = RememberStage("last", "pose", frozenset({"unknown"}))
    memory: dict[str, Value | None] = {}

    def remembered(value: Value | None) -> Value | None:
        reading = Reading({"pose": value})
        stage.read(memory, reading)
        return reading.values["last"]

    seen = ("unknown", "home", "unknown", None, "out", "unknown", "home")
    assert [remembered(value) for value in seen] == [None, "home", "home", "home", "out", "out", "home"]


def test_constants_are_always_there() -> None:
    record: dict[str, object] = {"goto": "home"}
    ConstantStage({"speed": 0.5}).write(record)
    assert record == {"goto": "home", "speed": 0.5}
