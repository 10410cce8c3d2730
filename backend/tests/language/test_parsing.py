"""Text to tree and back: binding, spans, and what is said of a text that is no expression."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import given

from sequence_planner.language.lexer import MOST_DIGITS, tokens
from sequence_planner.language.parser import MOST_NESTED, MOST_OPERATIONS, can_go_on, parse, parse_assignment
from sequence_planner.language.printer import print_assignment, print_expression
from sequence_planner.language.syntax import (
    Arithmetic,
    Assignment,
    Comparison,
    Constant,
    Expression,
    ExpressionError,
    Implies,
    Name,
    Variable,
    children,
)

from .marking import assert_refused
from .trees import written, written_assignments


@given(written)
def test_printing_parses_to_the_same_tree(tree: Expression) -> None:
    assert parse(print_expression(tree)) == tree


@given(written_assignments)
def test_a_printed_action_parses_to_the_same_tree(action: Assignment) -> None:
    assert parse_assignment(print_assignment(action)) == action


@given(written)
def test_brackets_around_every_part_change_nothing(tree: Expression) -> None:
    assert parse(bracketed(tree)) == tree


@given(written)
def test_the_span_of_each_part_is_its_text(tree: Expression) -> None:
    text = print_expression(tree)
    for part in parts(parse(text)):
        assert parse(text[part.span.start : part.span.end]) == part


@pytest.mark.parametrize(
    ("text", "means"),
    [
        ("a or b and c", "a or (b and c)"),
        ("not a and b", "(not a) and b"),
        ("not a == b", "not (a == b)"),
        ("a and b implies c or d", "(a and b) implies (c or d)"),
        ("a implies b implies c", "a implies (b implies c)"),
        ("a - b - c == d", "((a - b) - c) == d"),
        ("a + -1 < b", "(a + (-1)) < b"),
        ("a == b and c in {d, e} or f", "((a == b) and (c in {d, e})) or f"),
    ],
)
def test_binding(text: str, means: str) -> None:
    assert parse(text) == parse(means)
    assert print_expression(parse(means)) == text


def test_brackets_that_matter_are_kept() -> None:
    for text in ("(a or b) and c", "not (a and b)", "(a implies b) implies c", "a - (b - c)", "(a and b) and c"):
        assert print_expression(parse(text)) == text


def test_line_breaks_and_tabs_are_white_space() -> None:
    assert parse("a\tand\n  b") == parse("a and b")


@pytest.mark.parametrize(
    ("example", "message"),
    [
        ("‹›", "expected a name, a value or `(`, found the end of the text"),
        ("a and‹› ", "expected a name, a value or `(`, found the end of the text"),
        ("a ‹b›", "expected an operator or the end, found `b`"),
        ("a == b ‹==› c", "expected an operator or the end, found `==`; comparisons do not chain: join two with and"),
        ("(a or b‹›", "expected an operator or `)`, found the end of the text"),
        ("a‹)›", "expected an operator or the end, found `)`"),
        ("a in {‹}›", "expected a name, a value or `(`, found `}`"),
        ("a in {b‹›", "expected `,` or `}`, found the end of the text"),
        ("a in {b ‹c›}", "expected `,` or `}`, found `c`"),
        ("a.‹.›b", "expected a name, found `.`"),
        ("a.‹and›", "expected a name, found `and`; `and` is a word of the language"),
        ("move(‹)›", "expected a value or parameter, found `)`"),
        ("move(a‹›", "expected `,` or `)`, found the end of the text"),
        ("bolts[a‹)›", "expected `,` or `]`, found `)`"),
        ("bolts[‹1›]", "expected a value or parameter, found `1`"),
        ("1‹a›", "expected an operator or the end, found `a`"),
        ("- ‹a›", "expected a number, found `a`"),
        ("a == ‹1234567›", f"a number has at most {MOST_DIGITS} digits, found 7"),
        ("‹ä›rm", "`ä` has no meaning here"),
        ("a ‹=› b", "`=` has no meaning here; write == (or := in an action)"),
        ("a ‹&› b", "`&` has no meaning here; write and"),
        ("a ‹|› b", "`|` has no meaning here; write or"),
        ("‹!›a", "`!` has no meaning here; write not"),
        ("a ‹#› b", "`#` has no meaning here"),
        ("a ‹:=› b", "expected an operator or the end, found `:=`; a condition compares with =="),
        ("a ‹if› b", "expected an operator or the end, found `if`; `if` stands once, at the end of an action"),
    ],
)
def test_what_is_no_expression(example: str, message: str) -> None:
    assert_refused(parse, example, message)


@pytest.mark.parametrize(
    ("example", "message"),
    [
        ("a‹›", "expected `:=`, found the end of the text"),
        ("a ‹==› b", "expected `:=`, found `==`"),
        ("a := b ‹if›", "expected a name, a value or `(`, found the end of the text"),
        ("‹true› := b", "expected a name, found `true`; `true` is a word of the language"),
        (
            "a := b if c ‹if› d",
            "expected an operator or the end, found `if`; `if` stands once, at the end of an action",
        ),
        ("a := b ‹,› c := d", "expected an operator or the end, found `,`"),
    ],
)
def test_what_is_no_action(example: str, message: str) -> None:
    if example.endswith("‹if›"):  # the end of the text is what is missing
        example = example.replace("‹if›", "if‹›")
    assert_refused(parse_assignment, example, message)


def test_a_condition_belongs_to_the_action() -> None:
    action = parse_assignment("bolts[pair] := tightened if pose == pair and not busy")
    assert print_expression(action.target) == "bolts[pair]"
    assert print_expression(action.value) == "tightened"
    assert action.condition == parse("pose == pair and not busy")


@pytest.mark.parametrize("opening", ["(", "not ", "a implies ", "(not (a and b) implies "])
def test_deep_nesting_is_refused_and_not_a_crash(opening: str) -> None:
    deepest = opening * (5 * MOST_NESTED)
    with pytest.raises(ExpressionError, match=f"nested more than {MOST_NESTED} deep: split it up"):
        parse(deepest)


def test_long_expressions_are_no_deep_ones() -> None:
    assert len(children(parse(" and ".join(f"v{number}" for number in range(5000))))) == 5000
    message = f"more than {MOST_OPERATIONS} operations in one expression"
    assert_refused(parse, "n" + " + 1" * MOST_OPERATIONS + " ‹+› 1 == 2", message)


def test_unusual_characters_anywhere_are_refused_with_their_place() -> None:
    for character in "~`@$%^&*|\\'\";:?/#=!§€\u200b\x00😀":
        assert_refused_at(f"a and {character}", 6)


def assert_refused_at(text: str, place: int) -> None:
    with pytest.raises(ExpressionError) as caught:
        parse(text)
    assert caught.value.span.start == place


def parts(tree: Expression) -> Iterator[Expression]:
    yield tree
    for child in children(tree):
        yield from parts(child)


def bracketed(tree: Expression) -> str:
    match tree:
        case Constant() | Name() | Variable():
            return f"({print_expression(tree)})"
        case Implies(left, right):
            return f"({bracketed(left)} implies {bracketed(right)})"
        case Comparison(operator, left, right) | Arithmetic(operator, left, right):
            return f"({bracketed(left)} {operator} {bracketed(right)})"
    inside = [bracketed(child) for child in children(tree)]
    match type(tree).__name__:
        case "Not":
            return f"(not {inside[0]})"
        case "Membership":
            return f"({inside[0]} in {{{', '.join(inside[1:])}}})"
    return f"({f' {type(tree).__name__.lower()} '.join(inside)})"


@given(written)
def test_every_beginning_of_a_text_can_go_on(tree: Expression) -> None:
    text = print_expression(tree)
    for word in tokens(text):
        assert can_go_on(text[: word.start])
        assert not can_go_on(f"{text[: word.start]} , ,")


@pytest.mark.parametrize(
    ("text", "action", "temporal", "goes_on"),
    [
        ("a :=", True, False, True),
        ("a :=", False, False, False),
        ("1", True, False, False),
        ("F a", False, False, False),
        ("F a", False, True, True),
        ("a U", False, True, True),
        ("a  ", False, False, True),
        ("a && ", False, False, False),
    ],
)
def test_only_what_fits_can_go_on(text: str, action: bool, temporal: bool, goes_on: bool) -> None:
    assert can_go_on(text, action, temporal) is goes_on
