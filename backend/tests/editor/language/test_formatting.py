"""A text as the printer writes it: the same meaning, in the same names."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from language.trees import written, written_assignments, written_formulas
from sequence_planner.editor.language.field import FieldKind, TextField
from sequence_planner.editor.language.service import formatted
from sequence_planner.language.parser import parse, parse_assignment, parse_formula
from sequence_planner.language.printer import print_assignment, print_expression
from sequence_planner.language.syntax import ExpressionError
from support.examples import examples

from .drafts import STATIONS, draft

PARSERS: dict[FieldKind, Callable[[str], object]] = {
    FieldKind.CONDITION: parse,
    FieldKind.FORMULA: parse_formula,
    FieldKind.ACTION: parse_assignment,
}
KINDS = st.sampled_from(sorted(PARSERS))


def field(kind: FieldKind) -> TextField:
    return TextField(kind, lambda meaning, text, scope: None)


@pytest.mark.parametrize(
    ("kind", "text", "pretty"),
    [
        (FieldKind.CONDITION, "(a   and\n b)or c", "a and b or c"),
        (FieldKind.CONDITION, "a and (b and c)", "a and (b and c)"),
        (FieldKind.CONDITION, "pose in{home,above}", "pose in {home, above}"),
        (FieldKind.CONDITION, "f( a,b ).done", "f(a, b).done"),
        (FieldKind.CONDITION, "a and", "a and"),
        (FieldKind.CONDITION, "a  &&  b", "a  &&  b"),
        (FieldKind.FORMULA, "G(a)and X  b U(c)", "G a and X b U c"),
        (FieldKind.ACTION, "n:=n+1 if(n<3)", "n := n + 1 if n < 3"),
        (FieldKind.TYPE, "0 .. 3", "0 .. 3"),
        (FieldKind.ABILITY, "robot . move( home )", "robot.move(home)"),
        (FieldKind.OPERATION, "a( b )", "a( b )"),
    ],
)
def test_spaces_and_brackets_are_as_the_printer_has_them(kind: FieldKind, text: str, pretty: str) -> None:
    assert formatted(field(kind), text) == pretty


@pytest.mark.parametrize("station", STATIONS)
def test_the_texts_of_a_station_keep_their_meaning(station: str) -> None:
    for each in draft(station).texts:
        if each.field.kind in PARSERS:
            keeps_meaning(each.field.kind, each.text)


TEXTS = st.one_of(
    written.map(print_expression), written_formulas.map(print_expression), written_assignments.map(print_assignment)
)


@examples(300)
@given(KINDS, TEXTS, st.data())
def test_any_text_keeps_its_meaning(kind: FieldKind, text: str, data: st.DataObject) -> None:
    spaces = data.draw(st.lists(st.sampled_from(["", " ", "  ", "\n "]), min_size=1, max_size=5))
    spread = "".join(letter if letter != " " else " " + spaces[at % len(spaces)] for at, letter in enumerate(text))
    keeps_meaning(kind, spread)


@examples(200)
@given(KINDS, st.text("ab FGXU()[]{},.:=!<>+-01 notandif", max_size=30))
def test_what_does_not_parse_stays(kind: FieldKind, text: str) -> None:
    keeps_meaning(kind, text)


def keeps_meaning(kind: FieldKind, text: str) -> None:
    pretty = formatted(field(kind), text)
    assert formatted(field(kind), pretty) == pretty
    try:
        tree = PARSERS[kind](text)
    except ExpressionError:
        assert pretty == text
    else:
        assert PARSERS[kind](pretty) == tree
