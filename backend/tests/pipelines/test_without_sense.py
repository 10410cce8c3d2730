"""Values without sense: numbers that are not finite, ones too large, messages that cannot be read."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given as for_all
from hypothesis import strategies as st

from sequence_planner.controller.io.inputs import Inputs
from sequence_planner.language.records.field_paths import REAL, fits
from sequence_planner.language.records.record import Record
from sequence_planner.ros.transport import Sample
from support.examples import examples

from .stage_texts import given, stage
from .station_writing import Heard, station_with

NOT_FINITE = st.sampled_from([math.nan, math.inf, -math.inf])

ARM = {"Arm": "float64 force\nfloat64 speed\n"}


@pytest.mark.parametrize(
    "text",
    [
        "map: {field: force, variable: valve, values: {0: true}, otherwise: false}",
        "table: {fields: [force, count], variables: [valve], rows: [{when: [1, any], gives: [true]}]}",
        "expression: {valve: force > 1}",
        "remember: {variable: kept, of: force}",
        "fold: [force]",
        "debounce: {fields: [force], seconds: 1}",
        "timeout: {fields: [force], seconds: 1}",
    ],
)
@examples(5)
@for_all(NOT_FINITE)
def test_numbers_that_are_not_finite_are_unknown_and_said(text: str, number: float) -> None:
    values, troubles = given(stage(text), {"force": number, "count": 1})
    assert set(values.values()) == {None}
    assert troubles == [f"force is {number}"]


def test_what_is_not_finite_neither_counts_nor_is_remembered() -> None:
    for text in ("fold: [force]", "remember: {variable: force, of: force}"):
        course = stage(text).begin()
        course.take(Record({"force": 5.0}), 0.0)
        after = course.take(Record({"force": math.nan}), 0.1)
        assert after is not None
        assert after.values["force"] == 5.0
    debounced = stage("debounce: {fields: [force], seconds: 1}").begin()
    debounced.take(Record({"force": 5.0}), 0.0)
    after = debounced.take(Record({"force": math.nan}), 0.1)
    assert after is not None
    assert after.values["force"] is None, "what becomes unknown is so at once"


@pytest.mark.parametrize(
    ("joints", "contains", "is_said"),
    [([1.0, math.nan], True, False), ([0.0, math.nan], None, True), ([0.0, 2.0], False, False)],
)
def test_an_item_that_is_no_number_may_be_the_one(joints: list[float], contains: bool | None, is_said: bool) -> None:
    values, troubles = given(stage("member: {field: joints, item: 1, variable: valve}"), {"joints": joints})
    assert values == {"valve": contains}
    assert bool(troubles) is is_said


@pytest.mark.parametrize("number", [10**400, -(10**400), 2**1024])
def test_integers_beyond_all_real_numbers_are_none(number: int) -> None:
    assert not fits(REAL, number)
    assert given(stage("discretise: {field: force, variable: at, ranges: {home: [0, null]}}"), {"force": number})[
        0
    ] == {"at": None}


def test_integers_of_64_bits_are_exact() -> None:
    equal = stage("expression: {valve: large == -9223372036854775807}")
    assert given(equal, {"large": -(2**63) + 1})[0] == {"valve": True}
    assert given(equal, {"large": -(2**63)})[0] == {"valve": False}


@pytest.mark.parametrize(
    "pipeline",
    [
        "[tick: {every: 0.5}, expression: {strong: force > 1}]",
        "[limit: {every: 0.5}, expression: {strong: force > 1}]",
        "[expression: {strong: force > 1}, debounce: {fields: [strong], seconds: 0.5}]",
        "[override: {name: x, fields: {force: {between: [0, 9]}}, expires: 0.5}, expression: {strong: force > 1}]",
    ],
)
def test_what_came_before_an_unreadable_message_does_not_come_back_with_time(tmp_path: Path, pipeline: str) -> None:
    text = f"""
topics:
  /arm: {{type: tank_msgs/msg/Arm, direction: in, pipeline: {pipeline}}}
flows:
  later: {{from: /arm, pipeline: [tick: {{every: 0.3}}, expression: {{weak: not strong}}]}}
measured: {{strong: {{type: bool}}, weak: {{type: bool}}}}
"""
    heard = Heard(station_with(tmp_path, text, ARM))
    unknown: dict[str, object] = {"tank.strong": None, "tank.weak": None}
    heard.take("/arm", 0.0, force=2.0)
    if "override" in pipeline:
        heard.running.set_override("/arm", "x", {"force": 0.0}, 0.1, "eva")
    assert heard.take("/arm", 0.1, force=0.0)["tank.strong"] is not None
    heard.running.spoil("/arm", "truncated")
    for moment in (0.3, 0.6, 0.9, 1.2):
        assert heard.wake(moment).items() >= unknown.items(), moment
    assert heard.running.trouble("/arm") == "truncated"
    known = heard.take("/arm", 2.0, force=3.0)
    assert known["tank.strong"] is not None
    assert known["tank.weak"] is (not known["tank.strong"])
    assert heard.running.trouble("/arm") is None


def test_what_made_no_sense_and_was_held_back_is_reported_when_its_time_has_come(tmp_path: Path) -> None:
    text = """
topics:
  /arm: {type: tank_msgs/msg/Arm, direction: in, pipeline: [limit: {every: 0.5}, expression: {strong: force > 1}]}
measured: {strong: {type: bool}}
"""
    station = station_with(tmp_path, text, ARM)
    feeds = Inputs(station.pipelines, station.registry)
    for moment, force in ((0.0, 2.0), (0.1, math.nan)):
        data = station.registry.encode("tank_msgs/msg/Arm", {"force": force})
        feeds.take([Sample("/arm", data, moment)])
    assert list(feeds.reports.current(0.1)) == []
    feeds.wake(0.5)
    feeds.wake(0.7)
    assert [(place, report.text, report.count) for place, _, report in feeds.reports.current(0.7)] == [
        ("/arm", "force is nan", 1)
    ]


def test_each_cause_is_said_once_whoever_reads_the_topic(tmp_path: Path) -> None:
    text = """
topics:
  /arm: {type: tank_msgs/msg/Arm, direction: in, pipeline: [expression: {strong: force > 1}]}
flows:
  one: {from: /arm, pipeline: [expression: {fast: speed > 1}]}
  two: {from: one, pipeline: [expression: {slow: speed < 1}]}
measured: {strong: {type: bool}, fast: {type: bool}, slow: {type: bool}}
"""
    heard = Heard(station_with(tmp_path, text, ARM))
    heard.take("/arm", 0.0, force=math.nan, speed=math.inf)
    assert heard.running.trouble("/arm") == "force is nan; speed is inf"
