"""What resolution makes of one name of a text."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.expressions.parser import parse, parse_assignment, parse_formula
from sequence_planner.expressions.resolution import Scope, resolve_assignment, resolve_formula, resolve_predicate
from sequence_planner.expressions.syntax import Constant, Expression, ExpressionError, Span, children
from sequence_planner.workshop.language.field import FieldKind


def is_value_at(span: Span, text: str, kind: FieldKind, scope: Scope) -> bool:
    """Whether the name there is read as a value; not where the text makes no sense."""
    try:
        parts = _resolved(text, kind, scope)
    except ExpressionError:
        return False
    return any(isinstance(leaf, Constant) and leaf.span == span for part in parts for leaf in _leaves(part))


def _resolved(text: str, kind: FieldKind, scope: Scope) -> tuple[Expression, ...]:
    if kind is FieldKind.FORMULA:
        return (resolve_formula(parse_formula(text), scope),)
    if kind is FieldKind.CONDITION:
        return (resolve_predicate(parse(text), scope),)
    action = resolve_assignment(parse_assignment(text), scope)
    return (action.value,) if action.condition is None else (action.value, action.condition)


def _leaves(expression: Expression) -> Iterator[Expression]:
    parts = children(expression)
    if not parts:
        yield expression
    for part in parts:
        yield from _leaves(part)
