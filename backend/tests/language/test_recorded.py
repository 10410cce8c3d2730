"""Texts with what they mean, or why they are refused and where, recorded before there was one parser for all of them.

Left out are texts with several mistakes of which another one is told first now.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from math import inf
from pathlib import Path

import pytest

from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse, parse_assignment, parse_formula
from sequence_planner.language.printer import print_assignment, print_expression
from sequence_planner.language.records.expressions import read_calculation
from sequence_planner.language.records.field_paths import REAL, TEXT
from sequence_planner.language.records.record import ListType, NestedType, RecordType
from sequence_planner.language.resolver import resolve_assignment, resolve_formula, resolve_predicate
from sequence_planner.language.syntax import Expression, ExpressionError, children
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange

CASES = json.loads(Path(__file__).with_name("recorded.json").read_text(encoding="utf-8"))

SCOPE = NameScope(
    {
        "ready": BOOLEAN,
        "moving": BOOLEAN,
        "pose": EnumerationType(("unknown", "home", "above")),
        "target": EnumerationType(("home", "above")),
        "bolts[left]": EnumerationType(("empty", "placed")),
        "robot.move(home).executing": BOOLEAN,
        "count": IntegerRange(0, 3),
        "balance": IntegerRange(-2, 1),
        "N": BOOLEAN,
    }
)
POINT = NestedType("geometry_msgs/msg/Point", {"x": REAL, "y": REAL})
FIELDS: RecordType = {
    "joints": ListType(REAL, 2),
    "force": REAL,
    "count": IntegerRange(0, 255),
    "mode": TEXT,
    "door": BOOLEAN,
    "levels": ListType(IntegerRange(0, 255)),
    "pose": NestedType("geometry_msgs/msg/Pose", {"position": POINT}),
    "points": ListType(POINT),
    "state": EnumerationType(("manual", "automatic")),
    "slot[left]": BOOLEAN,
    "inspected[left, right]": IntegerRange(0, 3),
    "grid": ListType(ListType(IntegerRange(0, 9), 2), 2),
    "a.b": REAL,
    "manual": BOOLEAN,
}
RECORDS: tuple[Mapping[str, object], ...] = (
    {
        "joints": [0.5, -1.0],
        "force": 2.5,
        "count": 3,
        "mode": "it's",
        "door": True,
        "levels": [1, 2, 3],
        "pose": {"position": {"x": 1.0, "y": 2.0}},
        "points": [{"x": 7.0, "y": 8.0}],
        "state": "manual",
        "slot[left]": False,
        "inspected[left, right]": 2,
        "grid": [[1, 2], [3, 4]],
        "a.b": 1.5,
        "manual": True,
    },
    {
        "joints": [0.0, inf],
        "count": 0,
        "mode": "main",
        "door": False,
        "levels": [0],
        "state": "automatic",
        "slot[left]": True,
        "grid": [[0, 0], [1, 1]],
    },
    {},
)


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case[0]}: {case[1]}")
def test_a_text_means_what_it_meant(case: tuple[str, str, object]) -> None:
    kind, text, expected = case
    assert json.loads(json.dumps(found(kind, text))) == expected


def found(kind: str, text: str) -> object:
    """What a text means, or its complaint as `column: message`."""
    try:
        return over_records(text) if kind == "record" else over_variables(kind, text)
    except ExpressionError as error:
        return complaint(error)


def complaint(error: ExpressionError) -> str:
    return f"{error.span.start + 1}-{error.span.end}: {error.message}"


def over_records(text: str) -> object:
    calculation = read_calculation(text, FIELDS)
    troubles: list[list[str]] = [[] for _ in RECORDS]
    values = [calculation.value(*each) for each in zip(RECORDS, troubles, strict=True)]
    return str(calculation.type), list(calculation.reads), repr(calculation.constants), repr(values), troubles


def over_variables(kind: str, text: str) -> object:
    if kind == "action":
        action = parse_assignment(text)
        parts = [action.target, action.value, *([] if action.condition is None else [action.condition])]
        spans = [action.span, *(span for part in parts for span in spans_of(part))]
        return print_assignment(action), spans, said(lambda: print_assignment(resolve_assignment(action, SCOPE)))
    tree = parse_formula(text) if kind == "formula" else parse(text)
    resolve = resolve_formula if kind == "formula" else resolve_predicate
    return print_expression(tree), list(spans_of(tree)), said(lambda: print_expression(resolve(tree, SCOPE)))


def said(meaning: Callable[[], str]) -> str:
    try:
        return meaning()
    except ExpressionError as error:
        return complaint(error)


def spans_of(tree: Expression) -> Iterator[tuple[int, int]]:
    yield tree.span
    for child in children(tree):
        yield from spans_of(child)
