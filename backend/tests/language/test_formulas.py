"""Formulas of LTL over finite traces as text: which letters are operators, binding, printing and names."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import given

from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import MOST_NESTED, parse, parse_assignment, parse_formula
from sequence_planner.language.printer import print_expression
from sequence_planner.language.resolver import resolve_formula, resolve_predicate
from sequence_planner.language.syntax import (
    Expression,
    ExpressionError,
    children,
    first_temporal,
    occurrences,
)
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange

from .marking import assert_refused
from .trees import VARIABLES, formulas, written, written_formulas

SCOPE = NameScope(
    {
        "bad": BOOLEAN,
        "good": BOOLEAN,
        "X": BOOLEAN,
        "N": IntegerRange(0, 3),
        "philosopher": EnumerationType(("L", "R", "F")),
        "fork[X]": BOOLEAN,
        "robot.F(home).executing": BOOLEAN,
    },
    ("robot.",),
)

INSIDE = "is a temporal operator here: a temporal formula is no part of a comparison, a sum or `in {...}`"
TEMPORAL = (
    "is a temporal operator here: temporal operators stand only in `local` formulas of operations and in goals of "
    "plain automata"
)


@given(written_formulas)
def test_printing_parses_to_the_same_formula(tree: Expression) -> None:
    assert parse_formula(print_expression(tree)) == tree


@given(written)
def test_a_predicate_is_also_a_formula(tree: Expression) -> None:
    assert parse_formula(print_expression(tree)) == parse(print_expression(tree)) == tree


@given(written_formulas)
def test_the_span_of_each_part_is_its_text(tree: Expression) -> None:
    text = print_expression(tree)
    for part in parts(parse_formula(text)):
        assert parse_formula(text[part.span.start : part.span.end]) == part


@given(formulas)
def test_a_resolved_formula_prints_as_what_resolves_to_it(tree: Expression) -> None:
    assert resolve_formula(parse_formula(print_expression(tree)), NameScope(VARIABLES)) == tree


@pytest.mark.parametrize(
    ("text", "means"),
    [
        ("not bad U good", "(not (bad)) U (good)"),
        ("a U b and c", "((a) U b) and c"),
        ("a U b U c", "a U (b U c)"),
        ("a U b R c W d", "a U (b R (c W d))"),
        ("a or b U c implies d W e", "(a or (b U c)) implies (d W e)"),
        ("F (a == b)", "(F (a == b))"),
        ("G not a", "G (not (a))"),
        ("not X F a", "not (X (F (a)))"),
        ("N G a implies b", "(N (G a)) implies b"),
        ("F a and b", "(F a) and b"),
        ("a U F b", "a U (F b)"),
        ("F G a U b", "(F G a) U b"),
    ],
)
def test_binding(text: str, means: str) -> None:
    assert parse_formula(text) == parse_formula(means)
    assert print_expression(parse_formula(means)) == text


def test_relations_bind_tighter_than_letters_also_without_brackets() -> None:
    assert parse_formula("F a == b") == parse_formula("F (a == b)")
    assert parse_formula("a == b U c == d") == parse_formula("(a == b) U (c == d)")
    assert print_expression(parse_formula("F a in {b} and X n + 1 < 2")) == "F (a in {b}) and X (n + 1 < 2)"
    assert print_expression(parse_formula("F (-1)")) == "F (-1)"


@pytest.mark.parametrize(
    "text",
    [
        "philosopher == R",
        "philosopher in {F, R, U}",
        "N == 3",
        "N - 1 == G + X",
        "N -1 == 0",
        "X and y",
        "not X",
        "X",
        "U",
        "X implies F or G",
        "U == R and W != U",
        "fork[X]",
        "F[x] == N",
        "a.F",
        "X.done",
        "F(x).done",
        "F(x, y).done",
        "move(F).executing",
        "(X)",
    ],
)
def test_letters_that_are_names(text: str) -> None:
    assert first_temporal(parse_formula(text)) is None
    assert parse_formula(text) == parse(text)


@pytest.mark.parametrize(
    ("text", "printed"),
    [
        ("X X", "X X"),
        ("X (a)", "X a"),
        ("F(done)", "F done"),
        ("F 1 == n", "F (1 == n)"),
        ("F (F(x).done)", "F F(x).done"),
        ("F F(x).done", "F F(x).done"),
        ("U U U", "U U U"),
        ("(X) U b", "(X) U b"),
        ("(not X) U b", "(not X) U b"),
        ("a == X U b", "a == X U b"),
        ("a U X", "a U X"),
        ("a U (X) R b", "a U (X) R b"),
        ("X true", "X true"),
        ("N false or X not X", "N false or X not X"),
        ("X U", "X U"),
        ("a U N == 3", "a U N == 3"),
    ],
)
def test_letters_that_are_operators(text: str, printed: str) -> None:
    formula = parse_formula(text)
    assert first_temporal(formula) is not None
    assert print_expression(formula) == printed
    assert parse_formula(printed) == formula


@pytest.mark.parametrize(
    ("example", "message"),
    [
        ("X U ‹b›", "expected an operator or the end, found `b`; if `X` is a name, write (X) U b"),
        ("a U‹›", "expected a name, a value or `(`, found the end of the text"),
        ("X F not‹›", "expected a name, a value or `(`, found the end of the text"),
        ("a == F ‹b›", "expected an operator or the end, found `b`"),
        ("a in {b, G ‹c›}", "expected `,` or `}`, found `c`"),
        ("a ‹V› b", "expected an operator or the end, found `V`"),
        ("F (a‹›", "expected an operator or `)`, found the end of the text"),
    ],
)
def test_what_is_no_formula(example: str, message: str) -> None:
    assert_refused(parse_formula, example, message)


@pytest.mark.parametrize("opening", ["F ", "X (", "a U ", "a W (b or ", "not G "])
def test_deep_nesting_is_refused_and_not_a_crash(opening: str) -> None:
    with pytest.raises(ExpressionError, match=f"nested more than {MOST_NESTED} deep: split it up"):
        parse_formula(opening * (5 * MOST_NESTED) + "a")


def test_names_are_resolved_within_formulas() -> None:
    for text, means in (
        ("not bad U good", "not bad U good"),
        ("G (philosopher == R implies F philosopher == F)", "G (philosopher == R implies F (philosopher == F))"),
        ("N == 3 and fork[X] W X", "N == 3 and fork[X] W X"),
        ("F F(home).executing", "F robot.F(home).executing"),
        ("X N == 3", "X (N == 3)"),
    ):
        assert print_expression(resolve_formula(parse_formula(text), SCOPE)) == means


@pytest.mark.parametrize(
    ("example", "message"),
    [
        ("G (‹gud› or bad)", "unknown variable `gud`; did you mean `good`?"),
        ("bad U ‹N›", "expected a truth value, found an integer in 0..3"),
        ("F ‹philosopher›", "expected a truth value, found one of {L, R, F}"),
        (
            "bad == (‹F good›)",
            f"`F` {INSIDE}",
        ),
        (
            "X ((‹bad U good›) in {true})",
            f"`U` {INSIDE}",
        ),
        (
            "1 + (‹X bad›) == 2",
            f"`X` {INSIDE}",
        ),
        (
            "bad == (good or ‹G bad›)",
            f"`G` {INSIDE}",
        ),
    ],
)
def test_formulas_that_mean_nothing(example: str, message: str) -> None:
    assert_refused(lambda text: resolve_formula(parse_formula(text), SCOPE), example, message)


@pytest.mark.parametrize(
    ("example", "letter"),
    [
        ("good and ‹F good›", "F"),
        ("‹F(good)›", "F"),
        ("bad or ‹X (good and bad)›", "X"),
        ("‹not bad U good›", "U"),
        ("good := ‹bad W good›", "W"),
        ("good := true if ‹G bad›", "G"),
    ],
)
def test_a_predicate_or_an_action_with_temporal_operators_is_refused(example: str, letter: str) -> None:
    def read(text: str) -> object:
        return parse_assignment(text) if ":=" in text else resolve_predicate(parse(text), SCOPE)

    assert_refused(read, example, f"`{letter}` {TEMPORAL}")


def test_a_formula_given_where_a_predicate_belongs_is_refused() -> None:
    assert_refused(lambda text: resolve_predicate(parse_formula(text), SCOPE), "bad or ‹G good›", f"`G` {TEMPORAL}")


def test_a_formula_has_no_value_in_a_single_state() -> None:
    for text in ("F good", "bad U good"):
        formula = resolve_formula(parse_formula(text), SCOPE)
        assert {variable.name for variable in occurrences(formula)} <= {"bad", "good"}
        with pytest.raises(TypeError, match="has no value in a single state"):
            evaluate(formula, {"bad": True, "good": True})


def parts(tree: Expression) -> Iterator[Expression]:
    yield tree
    for child in children(tree):
        yield from parts(child)


def test_the_deepest_formula_prints_as_one_that_can_be_read() -> None:
    formula = parse_formula("F " * 30 + "a == b")
    assert parse_formula(print_expression(formula)) == formula
