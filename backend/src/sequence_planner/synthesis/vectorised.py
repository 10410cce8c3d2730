"""Expressions and actions over many states at once: a column of numbers for each variable.

Values become numbers: truth values 0 and 1, integers themselves, and a name the same number in every enumeration, so
that comparison across enumerations is comparison of names.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from sequence_planner.automaton.structure import target
from sequence_planner.expressions.syntax import (
    And,
    Arithmetic,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    Variable,
)
from sequence_planner.expressions.types import Value

Column = NDArray[np.int32]
Mask = NDArray[np.bool_]
Columns = Mapping[str, Column]
Writes = dict[str, tuple[Mask, Column]]  # for each variable: where it is written, and which numbers

_RELATIONS: dict[str, Callable[[Column, Column], Mask]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}


class Numbering:
    """The number of each value; a name gets its number when it is first asked for."""

    def __init__(self) -> None:
        self._names: dict[str, int] = {}

    def number(self, value: Value) -> int:
        """The number that stands for `value`."""
        if isinstance(value, str):
            return self._names.setdefault(value, len(self._names))
        return int(value)

    def evaluate(self, expression: Expression, columns: Columns, length: int) -> Column:
        """The value of a resolved expression in each of `length` states, none of whose values is unknown."""
        match expression:
            case Constant(value):
                return np.full(length, self.number(value), dtype=np.int32)
            case Variable(name):
                return columns[name]
            case Comparison(relation, left, right):
                sides = (self.evaluate(side, columns, length) for side in (left, right))
                return _RELATIONS[relation](*sides).astype(np.int32)
            case Membership(left, options):
                subject = self.evaluate(left, columns, length)
                equal = [subject == self.evaluate(option, columns, length) for option in options]
                return np.asarray(np.logical_or.reduce(equal), dtype=np.int32)
            case Not(operand):
                return 1 - self.evaluate(operand, columns, length)
            case And(operands):
                return np.asarray(np.minimum.reduce([self.evaluate(part, columns, length) for part in operands]))
            case Or(operands):
                return np.asarray(np.maximum.reduce([self.evaluate(part, columns, length) for part in operands]))
            case Implies(left, right):
                return np.maximum(1 - self.evaluate(left, columns, length), self.evaluate(right, columns, length))
            case Arithmetic(sign, left, right):
                a, b = self.evaluate(left, columns, length), self.evaluate(right, columns, length)
                return a + b if sign == "+" else a - b
            case _:
                raise TypeError(f"{expression} has no value in a single state")

    def mask(self, expressions: Iterable[Expression], columns: Columns, length: int) -> Mask:
        """Where all of `expressions` hold."""
        holds: Mask = np.ones(length, dtype=np.bool_)
        for expression in expressions:
            holds &= self.evaluate(expression, columns, length).astype(np.bool_)
        return holds

    def writes(self, actions: Iterable[Assignment], columns: Columns, length: int, within: Iterable[str]) -> Writes:
        """What `actions` write to the variables of `within`."""
        allowed = frozenset(within)
        return {
            target(action): (
                self.mask(() if action.condition is None else (action.condition,), columns, length),
                self.evaluate(action.value, columns, length),
            )
            for action in actions
            if target(action) in allowed
        }
