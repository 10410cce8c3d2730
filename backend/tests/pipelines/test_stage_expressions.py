"""Expressions over records: their values, against Python's; their types; and what is refused, with its column."""

from __future__ import annotations

import math
from collections.abc import Mapping

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.choices import Choices, made_by
from pipelines.stage_texts import MESSAGE, MODE
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse, parse_calculation
from sequence_planner.language.printer import print_expression
from sequence_planner.language.records.expressions import read_calculation, read_condition
from sequence_planner.language.records.field_paths import REAL, TEXT
from sequence_planner.language.records.record import FieldType, RecordType
from sequence_planner.language.resolver import resolve_predicate
from sequence_planner.language.syntax import ExpressionError
from sequence_planner.language.types import BOOLEAN, BooleanType, EnumerationType, IntegerRange, Type
from support.examples import examples

RECORD: Mapping[str, object] = {
    "joints": [0.5, -1.0],
    "force": 2.5,
    "count": 3,
    "large": 2**62,
    "mode": "it's",
    "door": True,
    "names": ["a", "b"],
    "levels": [1, 2, 3],
    "pose": {"position": {"x": 1.0, "y": 2.0}},
    "points": [{"x": 7.0, "y": 8.0}],
    "state": "manual",
    "slot[left]": False,
}


def value(text: str, record: Mapping[str, object] = RECORD, fields: RecordType = MESSAGE) -> tuple[object, list[str]]:
    troubles: list[str] = []
    return read_calculation(text, fields).value(record, troubles), troubles


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("force * 2 + 1", 6.0),
        ("1 + force * 2", 6.0),
        ("(1 + force) * 2", 7.0),
        ("10 - 3 - 2", 5),
        ("12 / 4 / 3", 1.0),
        ("-force", -2.5),
        ("--3", 3),
        ("2 * -3", -6),
        ("1.5e2", 150.0),
        ("7 / 2", 3.5),
        ("count > 2.5", True),
        ("count == 3.0", True),
        ("force >= 2.5 and force < 3", True),
        ("mode == 'it''s'", True),
        ("mode in {'x', 'y'}", False),
        ("state == manual", True),
        ("manual != state", False),
        ("state == 'manual'", True),
        ("mode != state", True),
        ("joints[1] < 0", True),
        ("joints[0] + joints[1]", -0.5),
        ("levels[count - 2]", 2),
        ("points[0].y", 8.0),
        ("pose.position.x", 1.0),
        ("slot[left] or door", True),
        ("not door implies force > 99", True),
        ("door implies slot[left]", False),
        ("names[1] == 'b'", True),
        ("large * 4", 2**64),
        ("true", True),
        ("'text'", "text"),
        ("door == (count == 3)", True),
    ],
)
def test_values(text: str, expected: object) -> None:
    found = value(text)
    assert found == (expected, [])
    assert type(found[0]) is type(expected)


@pytest.mark.parametrize(
    ("text", "type_"),
    [
        ("count + 1", IntegerRange(1, 256)),
        ("count - count", IntegerRange(-255, 255)),
        ("count * -2", IntegerRange(-510, 0)),
        ("count / 2", REAL),
        ("count * 0.5", REAL),
        ("door", BOOLEAN),
        ("mode", TEXT),
        ("state", MODE),
        ("'x'", EnumerationType(("x",))),
        ("joints[0]", REAL),
        ("levels[count]", IntegerRange(0, 255)),
    ],
)
def test_types(text: str, type_: FieldType) -> None:
    assert read_calculation(text, MESSAGE).type == type_


@pytest.mark.parametrize(
    ("text", "change", "trouble"),
    [
        ("force / count", {"count": 0}, "force / count divides by zero"),
        ("1 + 2 / (count - 3)", {}, "2 / (count - 3) divides by zero"),
        ("force * 1e300", {"force": 1e300}, "force * 1e300 is too large a number"),
        ("large * large * large * large * large * large * large * large * large * large "
         "* large * large * large * large * large * large * large * 0.5", {}, "is too large a number"),
        ("force + 1", {"force": math.nan}, "force is nan"),
        ("force > 1", {"force": -math.inf}, "force is -inf"),
        ("joints[1] > 1", {"joints": [0.0, math.nan]}, "joints[1] is nan"),
        ("levels[count]", {"count": 3}, "levels has no item 3"),
        ("joints[count]", {"count": 0, "joints": [math.inf, 0.0]}, "joints is inf"),
        ("force > 1", {"force": "x"}, "nothing can be computed from {'force': 'x'}"),
        ("count + 1", {"count": [1]}, "nothing can be computed from {'count': [1]}"),
    ],
)  # fmt: skip
def test_what_cannot_be_computed_is_unknown_and_said(text: str, change: dict[str, object], trouble: str) -> None:
    found, (said,) = value(text, {**RECORD, **change})
    assert found is None
    assert said.endswith(trouble)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("force > 1", None),
        ("force > 1 and false", False),
        ("false and force > 1", False),
        ("force > 1 or true", True),
        ("not force > 1", None),
        ("force > 1 implies door", True),
        ("count in {3, 4} or force == 1", True),
        ("-force", None),
        ("joints[2 - 2]", None),
        ("missing.x > 1", None),
    ],
)
def test_what_is_unknown_stays_unknown(text: str, expected: object) -> None:
    fields = {**MESSAGE, "missing": MESSAGE["points"]}
    if text.startswith("missing"):
        text, fields = "points[0].x > 1", dict(MESSAGE)
    record = {name: known for name, known in RECORD.items() if name not in ("force", "joints", "points")}
    assert value(text, record, fields) == (expected, [])


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("forse > 1", "1: there is no field `forse` here; did you mean `force`?"),
        ("force > pose.position.z", "9: `pose.position` has no field `z`"),
        ("joints[2] > 1", "1: `joints` has only 2 items, the first of which is [0]"),
        ("count[0]", "1: `count` is 0..255, and no list"),
        ("joints[0.5]", "8: the place in a list is an integer, found a real number"),
        ("door[count]", "1: `door` is no list"),
        ("points[count].y", "14: `.y` cannot be read of an item at a computed place"),
        ("levels[count, 0]", "15: an item of a list has one place, found 2"),
        ("levels" + "[0]" * 31, "97: nested more than 30 deep: split it up"),
        ("force AND door", "7: `AND` has no meaning here; write and"),
        ("mode is 'x'", "6: `is` has no meaning here; write =="),
        ("mode === 'x'", "6: `===` has no meaning here; write =="),
        ("1.5.x", "4: expected an operator or the end, found `.`"),
        ("force and door", "1: expected a truth value, found a real number"),
        ("door + 1", "1: `+` needs numbers, found a truth value"),
        ("1 * mode", "5: `*` needs numbers, found a text"),
        ("-door", "2: `-` needs numbers, found a truth value"),
        ("mode < 'x'", "1: `<` compares numbers, not a text"),
        ("door == 1", "9: cannot compare a truth value with the integer 1"),
        ("count == 300", "10: cannot compare an integer in 0..255 with the integer 300"),
        ("state == 'broken'", "10: cannot compare one of {manual, automatic} with the value `broken`"),
        ("state == manul", "10: there is no field `manul` here"),
        ("force == 'x'", "10: cannot compare a real number with the value `x`"),
        (
            "1 < force < 2",
            "11: expected an operator or the end, found `<`; comparisons do not chain: join two with and",
        ),
        ("force = 1", "7: `=` has no meaning here; write =="),
        ("door && door", "6: `&&` has no meaning here; write and"),
        ('mode == "x"', '9: `"` has no meaning here; write texts in single quotes'),
        ("mode == 'x", "9: a text ends with a single quote"),
        ("force >", "8: expected a field, a value or `(`, found the end of the text"),
        ("", "1: expected a field, a value or `(`, found the end of the text"),
        ("(force", "7: expected an operator or `)`, found the end of the text"),
        ("mode in 'x'", "9: expected `{`, as in `pose in {home, above}`, found `'x'`"),
        ("force if door", "7: expected an operator or the end, found `if`; `if` stands once, at the end of an action"),
        ("points[0] == 1", "14: cannot compare a geometry_msgs/msg/Point with the integer 1"),
        ("123456789012345678901 > 1", "1: a number has at most 20 digits, found 21"),
        ("1e999", "1: the number is too large"),
        ("(" * 31 + "1" + ")" * 31, "31: nested more than 30 deep: split it up"),
        ("1" + " + 1" * 51, "203: more than 50 operations in one expression"),
    ],
)
def test_what_means_nothing_is_refused_at_its_column(text: str, complaint: str) -> None:
    with pytest.raises(ExpressionError) as refused:
        read_calculation(text, MESSAGE)
    assert f"{refused.value.span.start + 1}: {refused.value.message}" == complaint


def test_a_word_that_is_both_a_value_and_a_field_is_refused() -> None:
    fields: RecordType = {"state": MODE, "manual": TEXT, "automatic": BOOLEAN}
    with pytest.raises(ExpressionError, match="both a value and a field here"):
        read_calculation("state == manual", fields)
    assert value("state == 'manual'", {"state": "manual"}, fields) == (True, [])
    assert value("state == automatic", {"state": "automatic"}, fields) == (True, [])  # the other cannot be meant


def test_a_condition_is_a_truth_value() -> None:
    with pytest.raises(ExpressionError, match="expected a truth value, found a real number"):
        read_condition("force", MESSAGE)


# Against Python, and against the language of guards

NAMES = ("a", "b", "c")


def _arithmetic(choose: Choices, depth: int = 4) -> str:
    if depth == 0 or choose.chance(4):
        return choose.pick([*NAMES, "1", "2", "0", "0.5", "-3"])
    left, right = _arithmetic(choose, depth - 1), _arithmetic(choose, depth - 1)
    text = f"{left} {choose.pick(['+', '-', '*', '/'])} {right}"
    return f"({text})" if choose.chance(2) else text


@given(made_by(_arithmetic), st.lists(st.integers(-9, 9), min_size=3, max_size=3))
@examples(300)
def test_arithmetic_is_pythons(text: str, numbers: list[int]) -> None:
    names = dict(zip(NAMES, numbers, strict=True))
    found, troubles = value(text, names, dict.fromkeys(NAMES, IntegerRange(-9, 9)))
    try:
        assert found == eval(text, {}, dict(names))
        assert troubles == []
    except ZeroDivisionError:
        assert found is None
        assert troubles[0].endswith("divides by zero")


def _predicate(choose: Choices, depth: int = 3) -> str:
    if depth == 0 or choose.chance(4):
        return choose.pick(["p", "q", "n > 1", "n == m + 1", "s == manual", "s in {automatic}", "m - n <= 2", "true"])
    left, right = _predicate(choose, depth - 1), _predicate(choose, depth - 1)
    return choose.pick([f"({left}) {word} ({right})" for word in ("and", "or", "implies", "==")] + [f"not ({left})"])


@given(made_by(lambda choose: choose.pick([_arithmetic, _predicate])(choose)))
@examples(300)
def test_printing_gives_the_same_tree_again(text: str) -> None:
    tree = parse_calculation(text)
    assert parse_calculation(print_expression(tree)) == tree


@pytest.mark.parametrize(
    "text", ["-a * (b - 0.5) / c", "a - b * c", "m == 'it''s'", "points[0].y > grid[1][n + 1]", "1e-07"]
)
def test_what_only_records_have_is_printed_and_is_no_guard(text: str) -> None:
    tree = parse_calculation(text)
    assert parse_calculation(print_expression(tree)) == tree
    with pytest.raises(ExpressionError, match="stand only in expressions over records"):
        resolve_predicate(tree, NameScope({name: IntegerRange(0, 3) for name in "abcmn"}))


SMALL: Mapping[str, Type] = {"p": BOOLEAN, "q": BOOLEAN, "n": IntegerRange(0, 3), "m": IntegerRange(0, 3), "s": MODE}


def _valuation(choose: Choices) -> dict[str, bool | int | str | None]:
    return {name: choose.pick([*type_.domain, None]) for name, type_ in SMALL.items()}


@given(made_by(_predicate), made_by(_valuation))
@examples(300)
def test_a_guard_means_the_same_here(text: str, valuation: dict[str, bool | int | str | None]) -> None:
    guard = resolve_predicate(parse(text), NameScope(SMALL))
    found = read_calculation(text, dict(SMALL))
    assert isinstance(found.type, BooleanType)
    assert found.value(valuation, []) == evaluate(guard, valuation)


@given(st.text(alphabet="ab01.+-*/()[]{}<>=!'\" ,&|n", max_size=25))
@examples(300)
def test_any_text_is_an_expression_or_refused_within_it(text: str) -> None:
    try:
        read_calculation(text, {"a": REAL, "b": BOOLEAN})
    except ExpressionError as error:
        assert 0 <= error.span.start <= error.span.end <= len(text)
