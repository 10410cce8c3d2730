"""Values that depend on the state, case by case: what is written out where an index or argument is a variable."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import product

from sequence_planner.core.immutable import Immutable
from sequence_planner.language.syntax import (
    FALSE,
    TRUE,
    And,
    Comparison,
    Constant,
    Expression,
    ExpressionError,
    Membership,
    Not,
    Or,
    Span,
    Variable,
    conjunction,
)
from sequence_planner.language.types import Value
from sequence_planner.texts.late import message

# What is written out is read by people and solvers: more than this was not meant.
MOST_CASES = 4096


class Cases(Immutable):
    """A value that is what the expression of a case says while the condition of that case holds.

    No two conditions hold at once. While none does there is no value, and what is asked of it is false.
    """

    alternatives: tuple[tuple[Expression, Expression], ...]


class Count(Immutable):
    """The number of `conditions` that hold."""

    conditions: tuple[Expression, ...]
    span: Span

    @property
    def alternatives(self) -> tuple[tuple[Expression, Expression], ...]:
        """Its cases: each number with the condition that there are so many."""
        numbers = range(len(self.conditions) + 1)
        return tuple((counted("==", n, self.conditions, self.span), Constant(n, self.span)) for n in numbers)


Dependent = Expression | Cases | Count
BY_CASES = (Cases, Count)  # made once: it is asked for of each comparison


def alternatives_of(value: Dependent) -> tuple[tuple[Expression, Expression], ...]:
    """The cases of a value; one without a condition where it does not depend on the state."""
    return value.alternatives if isinstance(value, BY_CASES) else ((TRUE, value),)


def distributed(parts: Sequence[Dependent], span: Span, build: Callable[..., Dependent]) -> Dependent:
    """What `build` makes of the `parts`, for each combination of their cases."""
    if not any(isinstance(part, BY_CASES) for part in parts):
        return build(*parts)
    found: list[tuple[Expression, Expression]] = []
    for combination in product(*map(alternatives_of, parts)):
        condition = conjunction(*(condition for condition, _ in combination))
        inner = alternatives_of(build(*(value for _, value in combination)))
        found += [(conjunction(condition, further), value) for further, value in inner]
        require_few(len(found), span)
    return Cases(tuple(found))


def truth_of(value: Dependent, span: Span) -> Expression:
    """The condition that a truth value is, with its cases put together."""
    if not isinstance(value, BY_CASES):
        return value
    by_outcome: dict[Expression, list[Expression]] = {}
    for condition, outcome in value.alternatives:
        if outcome != FALSE:
            by_outcome.setdefault(outcome, []).append(condition)
    parts = tuple(conjunction(_any_of(conditions, span), outcome) for outcome, conditions in by_outcome.items())
    return disjunction(parts, span)


def _any_of(conditions: list[Expression], span: Span) -> Expression:
    """One of `conditions`, as a membership where they are values of one variable."""
    together: dict[Expression, list[Expression]] = {}
    others: list[Expression] = []
    for condition in conditions:
        match condition:
            case Comparison("==", left, Constant() as value):
                together.setdefault(left, []).append(value)
            case _:
                others.append(condition)
    parts = [
        Comparison("==", left, values[0], span) if len(values) == 1 else Membership(left, tuple(values), span)
        for left, values in together.items()
    ]
    return disjunction((*parts, *others), span)


def by_value(value: Dependent, span: Span) -> Dependent:
    """`value` with a case for each value of a variable, so that all that is told apart is constant."""

    def build(single: Expression) -> Dependent:
        if not isinstance(single, Variable):
            return single
        return Cases(
            tuple(
                (Comparison("==", single, Constant(each, span), span), Constant(each, span))
                for each in single.type.domain
            )
        )

    return distributed((value,), span, build)


def mapped(argument: Dependent, table: Mapping[str, Value], span: Span) -> Dependent:
    """What `table` has for a value whose cases are constant; nothing for what it does not have."""

    def build(value: Expression) -> Dependent:
        if not isinstance(value, Constant) or value.value not in table:
            return Cases(())
        return Constant(table[str(value.value)], span)

    return distributed((argument,), span, build)


def related(first: Dependent, second: Dependent, pairs: frozenset[tuple[str, str]], span: Span) -> Expression:
    """That two values whose cases are constant are one of `pairs`; those with the same partners stand together."""

    def partners(one: Expression) -> Dependent:
        return truth_of(distributed((second,), span, lambda other: holds(one, other)), span)

    def holds(one: Expression, other: Expression) -> Dependent:
        pair = one.value if isinstance(one, Constant) else "", other.value if isinstance(other, Constant) else ""
        return Constant(pair in pairs, span)

    return truth_of(distributed((first,), span, partners), span)


def disjunction(parts: Sequence[Expression], span: Span) -> Expression:
    """One of `parts`; false when there is none."""
    if not parts:
        return FALSE
    return parts[0] if len(parts) == 1 else Or(tuple(parts), span)


def at_least(number: int, conditions: Sequence[Expression], span: Span) -> Expression:
    """That so many of `conditions` hold, written out as few times as possible."""
    if number <= 0:
        return TRUE
    if number > len(conditions):
        return FALSE
    if number == 1:
        return disjunction(conditions, span)
    if number == len(conditions):
        return And(tuple(conditions), span)
    first, *others = conditions
    with_first = And((first, at_least(number - 1, others, span)), span)
    return Or((with_first, at_least(number, others, span)), span)


def require_few_choices(number: int, of: int, span: Span) -> None:
    """Raise `ExpressionError` where `at_least` so many would be too long: it writes out the choices of so many."""
    choices = 1
    for step in range(min(number, of - number)):
        choices = choices * (of - step) // (step + 1)
        require_few(choices, span)


def require_few(count: int, span: Span) -> None:
    """Raise `ExpressionError` for more cases than can be written out."""
    if count > MOST_CASES:
        raise ExpressionError(message("wrong.cases", most=MOST_CASES), span)


def counted(operator: str, number: int, conditions: Sequence[Expression], span: Span) -> Expression:
    """A comparison of how many of `conditions` hold with `number`."""
    match operator:
        case ">=":
            return _at_least(number, conditions, span)
        case ">":
            return _at_least(number + 1, conditions, span)
        case "<":
            return _negated(_at_least(number, conditions, span), span)
        case "<=":
            return _negated(_at_least(number + 1, conditions, span), span)
    exactly = conjunction(_at_least(number, conditions, span), _negated(_at_least(number + 1, conditions, span), span))
    return exactly if operator == "==" else _negated(exactly, span)


def _at_least(number: int, conditions: Sequence[Expression], span: Span) -> Expression:
    if 0 < number <= len(conditions):
        require_few_choices(number, len(conditions), span)
    return at_least(number, conditions, span)


def _negated(expression: Expression, span: Span) -> Expression:
    if isinstance(expression, Constant):
        return Constant(not expression.value, span)
    return Not(expression, span)
