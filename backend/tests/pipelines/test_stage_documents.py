"""What is wrong with a stage as written: each finding at its place, with what would be right."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from core.choices import Choices, made_by
from pipelines.stage_texts import BYTE, MESSAGE, MODE, POSE, VARIABLES, build, findings, stage
from sequence_planner.language.records.field_paths import REAL, TEXT, find_field
from sequence_planner.language.records.record import Record, RecordType
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange
from sequence_planner.model.source import ModelError
from support.examples import examples

POINTS = "{home: [0, 0], out: [1, 1]}"
REST = "tolerance: 0.1, otherwise: unknown"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("rename: {‹dor: valve}", "there is no field `dor` here; did you mean `door`?"),
        ("rename: {‹pose.positon.x: valve}", "`pose` has no field `positon`; did you mean `position`?"),
        ("rename: {door: valve, mode: ‹valve}", "`valve` is given twice here"),
        ("constant: {‹door: true}", "`constant` is for outgoing topics: an incoming message has its own values"),
        ("expression: {valve: force > ‹forse}", "there is no field `forse` here; did you mean `force`?"),
        ("expression: {valve: 'door and ‹force'}", "expected a truth value, found a real number"),
        ("filter: ‹force", "expected a truth value, found a real number"),
        (
            f"discretise: {{field: ‹jonts, variable: at, values: {POINTS}, {REST}}}",
            "there is no field `jonts` here; did you mean `joints`?",
        ),
        (
            f"discretise: {{field: ‹door, variable: at, values: {POINTS}, {REST}}}",
            "`door` must be an array of numbers, or a number, and is bool",
        ),
        (
            f"discretise: {{field: ‹force, variable: at, values: {POINTS}, {REST}}}",
            "all points need as many coordinates as `force` has: real",
        ),
        (
            f"discretise: {{field: ‹joints, variable: valve, values: {POINTS}, {REST}}}",
            "points have names, so the variable must be an enumeration and not bool",
        ),
        (
            f"discretise: {{field: joints, variable: at, values: {{home: [0, 0], ‹ot: [1, 1]}}, {REST}}}",
            "`ot` is none of {home, out, unknown}; did you mean `out`?",
        ),
        (
            f"discretise: {{field: joints, variable: at, values: {POINTS}, tolerance: 1, otherwise: ‹nowhere}}",
            "`nowhere` is none of {home, out, unknown}",
        ),
        (
            f"discretise: {{field: joints, variable: at, values: {{home: [0, 0], ‹out: [0, 0]}}, {REST}}}",
            "`out` is at the same coordinates as `home`",
        ),
        (
            f"discretise: {{field: joints, variable: at, values: {{home: [0, 0], ‹out: [0.05, 0.02]}}, {REST}}}",
            "`out` is only 0.05 from `home`: the tolerance of 0.1 does not tell them apart",
        ),
        (
            "discretise: {field: ‹joints, variable: at, ranges: {home: [0, 1]}}",
            "`joints` is real[2], and ranges are of a single number",
        ),
        (
            "discretise: {field: force, variable: at, ranges: {home: [0, 1], ‹out: [0.9, null]}}",
            "the range of `out` overlaps that of `home`",
        ),
        (
            "discretise: {field: force, variable: at, ranges: {home: [null, null], ‹out: [0.9, 1]}}",
            "the range of `out` overlaps that of `home`",
        ),
        (
            "discretise: {field: force, variable: at, ranges: {‹home: [1, 0]}}",
            "the range of `home` ends before it begins: write the smaller number first",
        ),
        (
            f"undiscretise: {{variable: at, field: ‹joints, values: {POINTS}}}",
            "`undiscretise` is for outgoing topics; use `discretise` here",
        ),
        (
            "map: {field: ‹cont, variable: control, values: {1: manual}}",
            "there is no field `cont` here; did you mean `count`?",
        ),
        ("map: {field: count, variable: control, values: {‹x: manual}}", "`x` is no value of type 0..255"),
        ("map: {field: count, variable: control, values: {‹256: manual}}", "`256` is no value of type 0..255"),
        (
            "map: {field: count, variable: control, values: {1: ‹manul}}",
            "`manul` is none of {manual, automatic}; did you mean `manual`?",
        ),
        (
            "map: {field: count, variable: control, values: {1: manual}, otherwise: ‹off}",
            "`off` is none of {manual, automatic}",
        ),
        (
            "map: {field: count, variable: ‹new, values: {1: a, 2: 3}}",
            "the values of `new` are of different kinds: 'a', 3",
        ),
        ("map: {field: count, variable: ‹valve, values: {1: 1}}", "`1` is none of bool"),
        (
            "table: {fields: [count, ‹dor], variables: [valve], rows: [{when: [1, true], gives: [true]}]}",
            "there is no field `dor` here; did you mean `door`?",
        ),
        (
            "table: {fields: [mode, door], variables: [valve], rows: [{when: [‹a], gives: [true]}]}",
            "`when` needs 2 values: for mode, door",
        ),
        (
            "table: {fields: [mode], variables: [valve], rows: [{when: [‹a], gives: [true, false]}]}",
            "`gives` needs 1 value: for valve",
        ),
        (
            "table: {fields: [state], variables: [valve], rows: [{when: [‹of], gives: [true]}]}",
            "`of` is none of {manual, automatic}",
        ),
        (
            "table: {fields: [mode], variables: [control], rows: [{when: [a], gives: [manual]}], otherwise: [‹off]}",
            "`off` is none of {manual, automatic}",
        ),
        (
            "table: {fields: [mode], variables: [x], rows: [{when: [a], gives: [b]}], otherwise: [‹b, 2]}",
            "`otherwise` needs 1 value: for x",
        ),
        ("match: {field: ‹count, variable: valve, contains: a}", "`count` is 0..255, and only texts are matched"),
        (
            "match: {field: mode, variable: control, values: {manual: [a], automatic: [b, ‹a]}}",
            "`a` means `manual` already",
        ),
        (
            "match: {field: mode, variable: control, values: {‹manul: [a]}}",
            "`manul` is none of {manual, automatic}; did you mean `manual`?",
        ),
        ("member: {field: ‹mode, item: a, variable: valve}", "`mode` is text, and no list"),
        ("member: {field: levels, item: ‹a, variable: valve}", "`a` is no value of type 0..255"),
        (
            "member: {field: names, variable: ‹valve}",
            "without `item` the variable is an enumeration: the list has its names",
        ),
        (
            "member: {field: ‹levels, variable: control}",
            "`levels` is 0..255[], and without `item` a list of texts is needed",
        ),
        ("member: {field: names, variable: control, if_none: ‹off}", "`off` is none of {manual, automatic}"),
        (
            "one_of: {variable: control, fields: {manual: ‹dor, automatic: door}}",
            "there is no field `dor` here; did you mean `door`?",
        ),
        (
            "one_of: {variable: control, fields: {manual: ‹count, automatic: door}}",
            "`count` must be true or false, and is 0..255",
        ),
        (
            "one_of: {variable: control, fields: {‹manul: door, automatic: 'slot[left]'}}",
            "`manul` is none of {manual, automatic}; did you mean `manual`?",
        ),
        (
            "one_of: {variable: control, fields: {manual: door, automatic: ‹door}}",
            "`door` stands for two values: give each a field of its own",
        ),
        (
            "one_of: {variable: control, fields: {manual: door, automatic: 'slot[left]'}, otherwise: ‹off}",
            "`off` is none of {manual, automatic}",
        ),
        (
            "table: {fields: [state], variables: [control], rows: [{when: [any], gives: [{field: ‹stat}]}]}",
            "`stat` is none of the `fields` of the table; did you mean `state`?",
        ),
        (
            "table: {fields: [mode], variables: [control], rows: [{when: [any], gives: [{field: ‹mode}]}]}",
            "`mode` is text, and only what is one of a few values can be given by its name",
        ),
        (
            "table: {fields: [door], variables: [control], rows: [{when: [true], gives: [{field: ‹door}]}]}",
            "`door` can be `true` here, and that is none of {manual, automatic}",
        ),
        ("remember: {variable: last, of: ‹sate, except: []}", "there is no field `sate` here; did you mean `state`?"),
        ("remember: {variable: ‹last, of: state}", "`last` cannot be automatic, manual: put it into `except`"),
        (
            "remember: {variable: control, of: state, except: [‹manul]}",
            "`manul` is no value of `state`; did you mean `manual`?",
        ),
        ("debounce: {fields: [door, ‹dor], seconds: 1}", "there is no field `dor` here; did you mean `door`?"),
        ("timeout: {fields: [‹dor], seconds: 1}", "there is no field `dor` here; did you mean `door`?"),
        ("fold: [‹dor]", "there is no field `dor` here; did you mean `door`?"),
        (
            "override: {name: x, fields: {‹dor: {in: [true]}}, expires: 1}",
            "there is no field `dor` here; did you mean `door`?",
        ),
        (
            "override: {name: x, fields: {‹door: {between: [0, 1]}}, expires: 1}",
            "`door` is bool, which is not between two numbers: write `in: [values]`",
        ),
        (
            "override: {name: x, fields: {‹count: {between: [0, 300]}}, expires: 1}",
            "the field ranges over 0..255, and cannot be 300",
        ),
        (
            "override: {name: x, fields: {state: {in: [manual, ‹off]}}, expires: 1}",
            "`off` is none of {manual, automatic}",
        ),
    ],
)
def test_incoming(text: str, message: str) -> None:
    assert findings(text.replace("‹", "")) == [f"1:{text.index('‹') + 1}: {message}"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("rename: {door: ‹vale}", "there is no field `vale` here; did you mean `valve`?"),
        ("constant: {‹force: fast}", "`force` is real, and 'fast' is no value of that type"),
        ("constant: {‹joints: [1]}", "`joints` is real[2], and [1] is no value of that type"),
        (
            "constant: {‹pose: {position: 1}}",
            "`pose` is geometry_msgs/msg/Pose, and {'position': 1} is no value of that type",
        ),
        ("constant: {‹jonts: [1]}", "the message has no field `jonts`; did you mean `joints`?"),
        (
            f"discretise: {{field: ‹joints, variable: at, values: {POINTS}, {REST}}}",
            "`discretise` is for incoming topics; use `undiscretise` here",
        ),
        (
            f"undiscretise: {{variable: ‹att, field: joints, values: {POINTS}}}",
            "there is no field `att` here; did you mean `at`?",
        ),
        (f"undiscretise: {{variable: ‹at, field: joints, values: {POINTS}}}", "no coordinates for unknown"),
        (
            f"undiscretise: {{variable: at, field: ‹door, values: {POINTS}}}",
            "`door` must be an array of numbers, or a number, and is bool",
        ),
        ("map: {field: count, variable: ‹control, values: {manual: 1}}", "nothing is given for automatic"),
        (
            "map: {field: count, variable: control, values: {manual: 1, ‹off: 2}}",
            "`off` is none of {manual, automatic}",
        ),
        (
            "map: {field: ‹count, variable: control, values: {manual: 1, automatic: 300}}",
            "`300` is no value of type 0..255",
        ),
        (
            "one_of: {variable: ‹att, fields: {home: door, out: 'slot[left]'}}",
            "there is no field `att` here; did you mean `at`?",
        ),
        (
            "one_of: {variable: at, fields: {‹hom: door, out: 'slot[left]'}}",
            "`hom` is none of {home, out, unknown}; did you mean `home`?",
        ),
        ("one_of: {variable: at, fields: {home: ‹force, out: door}}", "`force` must be true or false, and is real"),
        (
            "one_of: {variable: at, fields: {home: door, out: 'slot[left]'}, otherwise: ‹out}",
            "`otherwise` is for incoming topics: for a value that is not listed no field is true",
        ),
        ("match: {field: ‹at, variable: mode, contains: a}", "`match` is for incoming topics"),
        ("member: {field: ‹at, item: a, variable: door}", "`member` is for incoming topics"),
        ("remember: {variable: ‹last, of: at}", "`remember` is for incoming topics"),
        ("debounce: {fields: [‹at], seconds: 1}", "`debounce` is for incoming topics"),
        ("timeout: {fields: [‹at], seconds: 1}", "`timeout` is for incoming topics"),
        ("override: {name: x, fields: {‹forse: {in: [1]}}, expires: 1}", "there is no field `forse` here"),
    ],
)
def test_outgoing(text: str, message: str) -> None:
    assert findings(text.replace("‹", ""), is_incoming=False) == [f"1:{text.index('‹') + 1}: {message}"]


def test_all_that_is_wrong_is_said_at_once() -> None:
    text = "discretise: {field: joint, variable: at, values: {home: [0, 0], x: [1, 1]}, tolerance: 1, otherwise: y}"
    assert [message.split(": ", 1)[1] for message in findings(text)] == [
        "there is no field `joint` here; did you mean `joints`?",
        "`x` is none of {home, out, unknown}",
        "`y` is none of {home, out, unknown}",
    ]


@pytest.mark.parametrize(
    ("text", "gives"),
    [
        ("rename: {door: valve, count: number}", {"valve": BOOLEAN, "number": BYTE}),
        (
            "expression: {valve: force > 1, x: count + 1, y: 5, z: true}",
            {"valve": BOOLEAN, "x": IntegerRange(1, 256), "y": IntegerRange(5, 5), "z": BOOLEAN},
        ),
        ("map: {field: door, variable: x, values: {true: on, false: off}}", {"x": EnumerationType(("on", "off"))}),
        ("map: {field: count, variable: x, values: {1: 0.5, 2: 3}}", {"x": REAL}),
        ("match: {field: mode, variable: x, values: {a: [b]}, otherwise: b}", {"x": EnumerationType(("a", "b"))}),
        (
            "table: {fields: [mode], variables: [x, level], rows: [{when: [any], gives: [3, 4]}]}",
            {"x": IntegerRange(3, 3), "level": IntegerRange(0, 9)},
        ),
        ("remember: {variable: x, of: mode}", {"x": TEXT}),
        ("debounce: {fields: [joints], seconds: 1}", {"joints": MESSAGE["joints"]}),
        ("filter: door", {}),
        ("limit: {every: 1}", {}),
    ],
)
def test_types_of_what_is_given(text: str, gives: RecordType) -> None:
    assert stage(text).gives == gives


def test_a_stage_knows_what_it_reads_and_where_it_stands() -> None:
    made = stage("\n\ntable: {fields: [mode, pose.position.x], variables: [x], rows: [{when: [a, any], gives: [3]}]}")
    assert made.reads == {"mode", "pose.position.x"}
    assert (made.place.line, made.place.column) == (3, 1)
    assert made.kind == "table"
    assert stage("expression: {x: 'levels[count] > 1 and force > joints[0]'}").reads == {
        "levels",
        "count",
        "force",
        "joints[0]",
    }
    assert stage("fold: []").reads == set(MESSAGE)


def test_a_field_of_the_message_can_be_overridden_though_no_stage_has_given_it() -> None:
    written = build("override: {name: x, fields: {force: {between: [0, 1]}}, expires: 1}", VARIABLES, MESSAGE, False)
    assert written.stage is not None
    assert written.stage.gives == {"force": REAL}


WORDS = re.compile(r"(?<=[ \[{])[a-z_]+(?=[,}\]:])|\d+")
STAGES = [
    "rename: {door: valve, mode: control}",
    "constant: {force: 1, mode: fast, joints: [0, 1]}",
    "expression: {valve: door, x: force}",
    f"discretise: {{field: joints, variable: at, values: {POINTS}, {REST}, hysteresis: 1}}",
    "discretise: {field: force, variable: at, ranges: {home: [0, 1], out: [2, 3]}, otherwise: unknown}",
    f"undiscretise: {{variable: at, field: joints, values: {POINTS}}}",
    "map: {field: count, variable: control, values: {1: manual, 2: automatic}, otherwise: manual}",
    "table: {fields: [count, door], variables: [valve], rows: [{when: [1, any], gives: [true]}], otherwise: [false]}",
    "match: {field: mode, variable: valve, contains: a}",
    "match: {field: mode, variable: control, values: {manual: [a], automatic: [b]}, otherwise: manual}",
    "member: {field: names, item: a, variable: valve}",
    "member: {field: names, variable: control, if_none: manual}",
    "one_of: {variable: control, fields: {manual: door, automatic: valve}, otherwise: manual}",
    "table: {fields: [state, door], variables: [control], rows: [{when: [any, true], gives: [{field: state}]}]}",
    "remember: {variable: last, of: state, except: [manual]}",
    "debounce: {fields: [door], seconds: 1}",
    "override: {name: x, fields: {force: {between: [0, 1]}, state: {in: [manual]}}, expires: 1}",
    "fold: [door]",
    "timeout: {fields: [door], seconds: 1}",
    "python: {file: x, function: f, reads: {force: real}, gives: {valve: bool}}",
]


def _changed(choose: Choices) -> str:
    """A stage in which some words and numbers are others."""
    text = choose.pick(STAGES)
    others = [*MESSAGE, *VARIABLES, *POSE.values, *MODE.values, "any", "true", "0", "1", "300", "x", "real"]
    for _ in range(choose.number(1, 4)):
        found = choose.pick([*WORDS.finditer(text)])
        text = text[: found.start()] + choose.pick(others) + text[found.end() :]
    return text


@given(made_by(_changed), st.booleans())
@examples(600)
def test_whatever_is_written_is_a_stage_or_refused(text: str, is_incoming: bool) -> None:
    fields, wanted = (MESSAGE, VARIABLES) if is_incoming else (VARIABLES, MESSAGE)
    try:
        written = build(text, fields, wanted, is_incoming)
    except (ValidationError, ModelError):
        return  # not of the form of a stage
    if written.stage is not None:
        # An override may also set a field of the message that no stage has given yet.
        readable = {**({} if is_incoming else wanted), **fields}
        assert all(find_field(readable, name) for name in written.stage.reads)
        assert text.startswith(written.stage.kind)
        record = written.stage.begin().take(Record({}), 0.0)
        assert record is None or set(written.stage.gives) <= set(record.values)
