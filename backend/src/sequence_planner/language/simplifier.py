"""Smaller expressions of the same meaning: constants folded where parameters have made a predicate partly constant."""

from __future__ import annotations

from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import (
    FALSE,
    TRUE,
    And,
    Arithmetic,
    Assignment,
    BinaryTemporal,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Name,
    NamedMembership,
    Not,
    Or,
    Quantified,
    RecordConstant,
    Selection,
    Span,
    UnaryTemporal,
    Variable,
)


def simplify(expression: Expression) -> Expression:
    """An expression equal to the resolved `expression` in every state, and for a formula at every position of every
    finite trace, also over unknown values.
    """
    match expression:
        case Comparison(_, Variable(), Constant() | Variable()):  # as most are
            return expression
        case Variable() | Constant() | Name():
            return expression
        case And(operands) | Or(operands):
            return _several(expression, tuple(map(simplify, operands)))
        case Not(operand, span=span):
            simple = simplify(operand)
            return expression if simple is operand and not isinstance(simple, Constant) else _folded(Not(simple, span))
        case Implies(left, right, span=span):
            premise, conclusion = simplify(left), simplify(right)
            if premise == FALSE or conclusion == TRUE:
                return TRUE
            return conclusion if premise == TRUE else Implies(premise, conclusion, span)
        case Comparison(operator, left, right, span=span):
            a, b = simplify(left), simplify(right)
            return _folded(expression if a is left and b is right else Comparison(operator, a, b, span))
        case Membership(left, options, span=span):
            return _folded(Membership(simplify(left), tuple(map(simplify, options)), span))
        case Arithmetic(operator, left, right, span=span):
            return _folded(Arithmetic(operator, simplify(left), simplify(right), span))
        case UnaryTemporal(operator, operand, span=span):
            return _unary(operator, simplify(operand), span)
        case BinaryTemporal(operator, left, right, span=span):
            return _binary(operator, simplify(left), simplify(right), span)
        case NamedMembership() | Quantified() | RecordConstant() | Selection():
            return expression


def simplify_assignment(action: Assignment) -> Assignment:
    """An action with its parts simplified; a condition that always holds is dropped."""
    condition = None if action.condition is None else simplify(action.condition)
    return Assignment(action.target, simplify(action.value), None if condition == TRUE else condition, action.span)


def _several(expression: And | Or, operands: tuple[Expression, ...]) -> Expression:
    """A conjunction or disjunction without the constants among its simplified `operands`."""
    neutral = isinstance(expression, And)
    parts = tuple(part for part in operands if not isinstance(part, Constant) or part.value is not neutral)
    if any(isinstance(part, Constant) for part in parts):
        return FALSE if neutral else TRUE
    if len(parts) < 2:
        return parts[0] if parts else Constant(neutral)
    unchanged = len(parts) == len(expression.operands) and all(map(_same, parts, expression.operands))
    return expression if unchanged else type(expression)(parts, expression.span)


def _same(one: Expression, other: Expression) -> bool:
    return one is other


def _unary(operator: str, operand: Expression, span: Span) -> Expression:
    """A prefix formula. `X true` and `N false` stay: they say whether there is a next position."""
    if isinstance(operand, Constant) and (operator in "FG" or operand.value is (operator == "N")):
        return operand
    if operator in "FG" and isinstance(operand, UnaryTemporal) and operand.operator == operator:
        return operand
    return UnaryTemporal(operator, operand, span)


def _binary(operator: str, left: Expression, right: Expression, span: Span) -> Expression:
    if isinstance(right, Constant):
        return _unary("G", left, span) if operator == "W" and right.value is False else right
    match operator, left:
        case ("U", Constant(True)):
            return _unary("F", right, span)
        case ("R", Constant(False)):
            return _unary("G", right, span)
        case ("W", Constant(True)):
            return TRUE
        case (_, Constant()):  # nothing to wait for: the right side decides here and now
            return right
    return BinaryTemporal(operator, left, right, span)


def _folded(expression: Not | Comparison | Membership | Arithmetic) -> Expression:
    """The constant that `expression` is when all its parts are constants, else itself."""
    match expression:
        case Not(operand):
            constant = isinstance(operand, Constant)
        case Membership(left, options):
            constant = isinstance(left, Constant) and all(isinstance(option, Constant) for option in options)
        case Comparison(_, left, right) | Arithmetic(_, left, right):
            constant = isinstance(left, Constant) and isinstance(right, Constant)
    value = evaluate(expression, {}) if constant else None
    return expression if value is None else Constant(value, expression.span)
