"""What formulas mean over finite traces: the laws of LTLf, also over unknown values, and progression along a trace."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import pytest
from hypothesis import given

from sequence_planner.language.ltl import progress, satisfies
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse_formula
from sequence_planner.language.resolver import resolve_formula
from sequence_planner.language.simplifier import simplify
from sequence_planner.language.syntax import (
    FALSE,
    TRUE,
    And,
    BinaryTemporal,
    Expression,
    Implies,
    Not,
    Or,
    UnaryTemporal,
    children,
    variables,
)
from sequence_planner.language.types import BOOLEAN, Value
from support.examples import examples

from .trees import VARIABLES, formulas, formulas_with_parameters, traces

Trace = list[dict[str, Value | None]]
SCOPE = NameScope(dict.fromkeys("abc", BOOLEAN))


def X(operand: Expression) -> Expression:  # noqa: N802 - the operators have these names
    return UnaryTemporal("X", operand)


def N(operand: Expression) -> Expression:  # noqa: N802
    return UnaryTemporal("N", operand)


def F(operand: Expression) -> Expression:  # noqa: N802
    return UnaryTemporal("F", operand)


def G(operand: Expression) -> Expression:  # noqa: N802
    return UnaryTemporal("G", operand)


def U(left: Expression, right: Expression) -> Expression:  # noqa: N802
    return BinaryTemporal("U", left, right)


def R(left: Expression, right: Expression) -> Expression:  # noqa: N802
    return BinaryTemporal("R", left, right)


def W(left: Expression, right: Expression) -> Expression:  # noqa: N802
    return BinaryTemporal("W", left, right)


# Pairs of formulas that mean the same at every position of every trace.
LAWS: dict[str, Callable[[Expression, Expression], tuple[Expression, Expression]]] = {
    "not X a": lambda a, b: (Not(X(a)), N(Not(a))),
    "not F a": lambda a, b: (Not(F(a)), G(Not(a))),
    "not (a U b)": lambda a, b: (Not(U(a, b)), R(Not(a), Not(b))),
    "not (a W b)": lambda a, b: (Not(W(a, b)), U(Not(b), And((Not(a), Not(b))))),
    "a W b": lambda a, b: (W(a, b), Or((U(a, b), G(a)))),
    "a W b by release": lambda a, b: (W(a, b), R(b, Or((a, b)))),
    "F a": lambda a, b: (F(a), U(TRUE, a)),
    "G a": lambda a, b: (G(a), R(FALSE, a)),
    "F a expanded": lambda a, b: (F(a), Or((a, X(F(a))))),
    "G a expanded": lambda a, b: (G(a), And((a, N(G(a))))),
    "a U b expanded": lambda a, b: (U(a, b), Or((b, And((a, X(U(a, b))))))),
    "a R b expanded": lambda a, b: (R(a, b), And((b, Or((a, N(R(a, b))))))),
    "a W b expanded": lambda a, b: (W(a, b), Or((b, And((a, N(W(a, b))))))),
    "X (a and b)": lambda a, b: (X(And((a, b))), And((X(a), X(b)))),
    "G F a is F G a": lambda a, b: (G(F(a)), F(G(a))),  # both speak of the last position
    "a implies b": lambda a, b: (Implies(a, b), Or((Not(a), b))),
}


@pytest.mark.parametrize("law", LAWS)
def test_laws(law: str) -> None:
    @examples(40)
    @given(formulas, formulas, traces)
    def check(a: Expression, b: Expression, trace: Trace) -> None:
        one, other = LAWS[law](a, b)
        for position in range(len(trace)):
            assert satisfies(one, trace, position) is satisfies(other, trace, position)

    check()


# What each formula says of words: the letter at each position is the variable that is true there, and none at a dot.
MEANINGS: dict[str, Callable[[str], bool]] = {
    "a": lambda word: word[0] == "a",
    "X a": lambda word: word[1:2] == "a",
    "N a": lambda word: word[1:2] in ("a", ""),
    "F b": lambda word: "b" in word,
    "G a": lambda word: set(word) == {"a"},
    "a U b": lambda word: word.lstrip("a")[:1] == "b",
    "a R not b": lambda word: "b" not in word[: (word + "a").index("a")],
    "a W b": lambda word: word.lstrip("a")[:1] in ("b", ""),
    "not b U a": lambda word: "a" in word and "b" not in word[: word.index("a")],
    "X true": lambda word: len(word) > 1,
    "N false": lambda word: len(word) == 1,
    "G (a implies F b)": lambda word: "a" not in word[word.rfind("b") + 1 :],
    "F (a and X b)": lambda word: "ab" in word,
}


@pytest.mark.parametrize("text", MEANINGS)
def test_each_operator_on_all_short_words(text: str) -> None:
    formula = resolve_formula(parse_formula(text), SCOPE)
    answers = set()
    for length in range(1, 6):
        for word in map("".join, product("ab.", repeat=length)):
            satisfied = satisfies(formula, [{name: letter == name for name in "abc"} for letter in word])
            assert satisfied is MEANINGS[text](word), word
            answers.add(satisfied)
    assert answers == {False, True}


@given(formulas, traces)
def test_a_determined_formula_is_that_of_every_completion(formula: Expression, trace: Trace) -> None:
    satisfied = satisfies(formula, trace)
    if satisfied is None:
        return
    for choice in (0, -1):
        complete: Trace = [
            {name: VARIABLES[name].domain[choice] if value is None else value for name, value in state.items()}
            for state in trace
        ]
        assert satisfies(formula, complete) is satisfied


@given(formulas_with_parameters, traces)
def test_simplification_keeps_the_meaning_at_every_position(formula: Expression, trace: Trace) -> None:
    simple = simplify(formula)
    assert simplify(simple) == simple
    assert size(simple) <= size(formula)
    assert set(variables(simple)) <= set(variables(formula))
    for position in range(len(trace)):
        assert satisfies(simple, trace, position) is satisfies(formula, trace, position)


@given(formulas, traces)
def test_progression_leaves_what_the_rest_must_satisfy(formula: Expression, trace: Trace) -> None:
    for doubt in (False, True):
        whole = satisfies(formula, trace)
        decided = doubt if whole is None else whole
        rest = formula
        for position, state in enumerate(trace):
            last = position == len(trace) - 1
            rest = progress(rest, state, last, doubt)
            if not last:
                remaining = satisfies(rest, trace, position + 1)
                assert (doubt if remaining is None else remaining) is decided
        assert rest == (TRUE if decided else FALSE)


def test_progression_decides_as_soon_as_it_can() -> None:
    def after(text: str, *positions: str) -> Expression:
        rest = resolve_formula(parse_formula(text), SCOPE)
        for true in positions:
            rest = progress(rest, {name: name in true for name in "abc"}, last=False)
        return rest

    def formula(text: str) -> Expression:
        return resolve_formula(parse_formula(text), SCOPE)

    assert after("not a U b", "c", "b") == TRUE
    assert after("not a U b", "c", "a") == FALSE
    assert after("not a U b", "c", "c") == formula("not a U b")
    assert after("G not a", "", "a") == FALSE
    assert after("F a", "a") == TRUE
    assert after("G (a implies X b)", "a") == formula("b and G (a implies X b)")
    assert after("N (a or b)", "") == formula("a or b")


def test_what_remains_does_not_grow_with_the_trace() -> None:
    for text in ("G (a implies F b)", "G F (a and X b)", "F G (a U b)", "G (a implies (not c U b)) and F c"):
        rest = resolve_formula(parse_formula(text), SCOPE)
        sizes = []
        for step in range(200):
            rest = progress(rest, {"a": step % 2 == 0, "b": step % 3 == 0, "c": False}, last=False)
            sizes.append(size(rest))
        assert max(sizes) <= 40
        assert max(sizes[150:]) <= max(sizes[:50])


def test_a_position_the_trace_does_not_have_is_refused() -> None:
    for length, position in ((0, 0), (1, 1), (1, -1)):
        with pytest.raises(ValueError, match="positions"):
            satisfies(TRUE, [{}] * length, position)


def size(tree: Expression) -> int:
    return 1 + sum(map(size, children(tree)))
