"""The part of a predicate about the state after a transition that speaks of the state before it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import product
from math import prod

from sequence_planner.automaton.automaton import target
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.fitting import fits_condition
from sequence_planner.language.simplifier import simplify
from sequence_planner.language.substitution import rebuilt
from sequence_planner.language.syntax import (
    TRUE,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Membership,
    Or,
    Variable,
    conjunction,
    conjuncts,
    occurrences,
    variables,
)

# How many combinations of values are tried to find that a comparison is decided.
_MOST_COMBINATIONS = 1000


def enabling_guard(written: Expression, actions: Iterable[Assignment], invariant: Expression) -> Expression:
    """Return where a transition can be taken: its guard holds, each update fits its variable, and the invariant holds
    after.

    What the guard says already is not repeated. Parts of the invariant that read nothing written hold as before.
    """
    updates = {target(action): action.value for action in actions}
    parts = dict.fromkeys(conjuncts(written))
    for action in actions:
        parts |= dict.fromkeys(conjuncts(simplify(fits_condition(action))))
    for part in conjuncts(invariant):
        if not updates.keys().isdisjoint(variables(part)):
            parts |= dict.fromkeys(conjuncts(simplify(_before(part, updates))))
    parts.pop(TRUE, None)
    return simplify(conjunction(*parts))


def _before(expression: Expression, updates: Mapping[str, Expression]) -> Expression:
    """`expression` with each written variable replaced by what is written to it."""

    def part(inner: Expression) -> Expression:
        return _before(inner, updates)

    match expression:
        case Variable(name):
            return updates.get(name, expression)
        case Comparison(operator, left, right):
            return decided(Comparison(operator, part(left), part(right)))
        case Membership(left, options):
            equal = [decided(Comparison("==", part(left), part(option))) for option in options]
            return Or(tuple(equal)) if len(equal) > 1 else equal[0]
        case _:
            return rebuilt(expression, part)


def decided(comparison: Comparison) -> Expression:
    """The constant that a comparison always is; after a replacement it may be one that nobody could write down."""
    domains = {variable.name: variable.type.domain for variable in occurrences(comparison)}
    if prod(map(len, domains.values())) > _MOST_COMBINATIONS:
        return comparison
    truths = {evaluate(comparison, dict(zip(domains, values, strict=True))) for values in product(*domains.values())}
    return Constant(truths.pop() is True) if len(truths) == 1 else comparison
