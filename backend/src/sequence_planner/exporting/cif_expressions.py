"""Expressions in the language CIF, in as few forms as its data-based synthesis has always read.

Enumerations of CIF have values of their own, and its integers are not negative here: a range that is has been moved to
begin at 0. A comparison of sums is written with sums of positive terms on both sides.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from sequence_planner.expressions.evaluation import RELATIONS
from sequence_planner.expressions.syntax import (
    And,
    Arithmetic,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    Variable,
)
from sequence_planner.expressions.types import BooleanType, EnumerationType, IntegerRange, Type, Value

_RELATIONS = {"==": "=", "!=": "!=", "<": "<", "<=": "<=", ">": ">", ">=": ">="}


# Strength of binding, as far as brackets are left out; `not` before a relation always has them.
_COMPOUND, _RELATION, _ATOM = range(3)


@dataclass(frozen=True)
class Text:
    """A predicate as text, and how strongly its parts are bound."""

    text: str
    strength: int = _COMPOUND

    def part(self, place: int) -> str:
        """The text as a part of another: in brackets where its parts would be bound less than `place` needs."""
        return self.text if self.strength >= place else f"({self.text})"


_TRUE, _FALSE = Text("true", _ATOM), Text("false", _ATOM)


def offset(type_: Type) -> int:
    """What is added to the values of an integer range so that none is negative."""
    return max(0, -type_.minimum) if isinstance(type_, IntegerRange) else 0


@dataclass(frozen=True)
class Writer:
    """Writes resolved expressions. `variables` names each variable, `literals` the values of each enumeration."""

    variables: Mapping[str, str]
    literals: Mapping[EnumerationType, Mapping[str, str]]

    def predicate(self, expression: Expression) -> Text:
        """A truth value."""
        match expression:
            case Constant(value):
                return _TRUE if value else _FALSE
            case Variable(name):
                return Text(self.variables[name], _ATOM)
            case Not(operand):
                return self._not(self.predicate(operand))
            case And(operands):
                return _joined("and", map(self.predicate, operands), _TRUE)
            case Or(operands):
                return _joined("or", map(self.predicate, operands), _FALSE)
            case Implies(left, right):
                return Text(f"{self.predicate(left).part(_ATOM)} => {self.predicate(right).part(_ATOM)}")
            case Comparison(relation, left, right):
                return self._compared(relation, left, right)
            case Membership(left, options):
                return _joined("or", (self._compared("==", left, option) for option in options), _FALSE)
            case _:
                raise TypeError(f"{expression} is no predicate of a state")

    def literal(self, type_: Type, value: Value) -> str:
        """A value of that type."""
        if isinstance(value, bool):
            return "true" if value else "false"
        return str(value + offset(type_)) if isinstance(value, int) else self.literals[_enumeration(type_)][value]

    def value(self, expression: Expression, type_: Type) -> str:
        """What is written to a variable of that type: a variable of another enumeration cannot be."""
        if isinstance(type_, BooleanType):
            return self.predicate(expression).text
        if isinstance(expression, Constant):
            return self.literal(type_, expression.value)
        if isinstance(type_, EnumerationType):
            assert isinstance(expression, Variable)
            assert expression.type == type_
            return self.variables[expression.name]
        terms, constant = _sum(expression)
        constant += offset(type_)
        added = [*self._terms(terms), *([str(constant)] if constant > 0 else [])] or ["0"]
        taken = [*self._terms(-terms), *([str(-constant)] if constant < 0 else [])]
        return " - ".join([" + ".join(added), *taken])

    def _terms(self, terms: Counter[str]) -> list[str]:
        """Those that are added, each as often as it is."""
        return [self.variables[name] for name in terms.elements()]

    def _not(self, operand: Text) -> Text:
        return Text(f"not {operand.part(_ATOM)}", _RELATION)

    def _compared(self, relation: str, left: Expression, right: Expression) -> Text:
        if _is_named(left) or _is_named(right):
            return self._alike(relation, left, right)
        if _is_integer(left) or _is_integer(right):
            return self._sums(relation, left, right)
        equal = Text(f"{self.predicate(left).part(_ATOM)} <=> {self.predicate(right).part(_ATOM)}")
        return equal if relation == "==" else self._not(equal)

    def _alike(self, relation: str, left: Expression, right: Expression) -> Text:
        """Whether two variables of enumerations, or one and a value, have the same value."""
        if isinstance(left, Constant):
            left, right = right, left
        if isinstance(left, Constant) and isinstance(right, Constant):
            return _TRUE if RELATIONS[relation](left.value, right.value) else _FALSE
        assert isinstance(left, Variable)
        name = self.variables[left.name]
        of_left = self.literals[_enumeration(left.type)]
        if isinstance(right, Constant):
            known = of_left.get(str(right.value))
            if known is None:
                return _FALSE if relation == "==" else _TRUE
            return Text(f"{name} {_RELATIONS[relation]} {known}", _RELATION)
        assert isinstance(right, Variable)
        other = self.variables[right.name]
        if left.type == right.type:
            return Text(f"{name} {_RELATIONS[relation]} {other}", _RELATION)
        of_right = self.literals[_enumeration(right.type)]
        shared = (
            Text(f"{name} = {literal} and {other} = {of_right[value]}")
            for value, literal in of_left.items()
            if value in of_right
        )
        equal = _joined("or", shared, _FALSE)
        return equal if relation == "==" else self._not(equal)

    def _sums(self, relation: str, left: Expression, right: Expression) -> Text:
        (terms, constant), (subtracted, other) = _sum(left), _sum(right)
        difference = Counter(terms)
        difference.subtract(subtracted)
        constant -= other
        if not any(difference.values()):
            return _TRUE if RELATIONS[relation](constant, 0) else _FALSE
        first = [*self._terms(difference), *([str(constant)] if constant > 0 else [])] or ["0"]
        second = [*self._terms(-difference), *([str(-constant)] if constant < 0 else [])] or ["0"]
        return Text(f"{' + '.join(first)} {_RELATIONS[relation]} {' + '.join(second)}", _RELATION)


def cases_of_copies(
    actions: Iterable[tuple[Variable, Expression]],
) -> Iterator[tuple[tuple[tuple[Variable, Value], ...], dict[str, Value]]]:
    """For actions that copy variables of other enumerations: each case in which these have values that fit.

    A case is what the copied variables have, and what is written to which variable.
    """
    cases: list[tuple[tuple[tuple[Variable, Value], ...], dict[str, Value]]] = [((), {})]
    for to, value in actions:
        if isinstance(to.type, EnumerationType) and isinstance(value, Variable) and value.type != to.type:
            shared = [each for each in value.type.domain if each in to.type.domain]
            cases = [((*has, (value, v)), {**written, to.name: v}) for has, written in cases for v in shared]
    yield from (case for case in cases if len(dict(case[0])) == len(set(case[0])))


def _joined(operator: str, parts: Iterable[Text], empty: Text) -> Text:
    texts = list(parts)
    if len(texts) < 2:
        return texts[0] if texts else empty
    return Text(f" {operator} ".join(part.part(_RELATION) for part in texts))


def _is_named(expression: Expression) -> bool:
    """Whether it is of an enumeration."""
    match expression:
        case Constant(value):
            return isinstance(value, str)
        case Variable(_, type_):
            return isinstance(type_, EnumerationType)
        case _:
            return False


def _is_integer(expression: Expression) -> bool:
    match expression:
        case Constant(value):
            return isinstance(value, int) and not isinstance(value, bool)
        case Variable(_, type_):
            return isinstance(type_, IntegerRange)
        case _:
            return isinstance(expression, Arithmetic)


def _sum(expression: Expression) -> tuple[Counter[str], int]:
    """How often each variable, as it is written in CIF, is added, and the constant that is."""
    match expression:
        case Constant(value):
            return Counter(), int(value)
        case Variable(name, type_):
            return Counter((name,)), -offset(type_)
        case Arithmetic(sign, left, right):
            (terms, constant), (others, other) = _sum(left), _sum(right)
            total = Counter(terms)
            (total.update if sign == "+" else total.subtract)(others)
            return total, constant + other if sign == "+" else constant - other
        case _:
            raise TypeError(f"{expression} is no sum")


def _enumeration(type_: Type) -> EnumerationType:
    assert isinstance(type_, EnumerationType)
    return type_
