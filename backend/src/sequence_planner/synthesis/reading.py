"""Expressions over sets of states."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

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
from sequence_planner.expressions.types import Value
from sequence_planner.synthesis.diagrams import Diagrams, Function, Lookup, Values


class Reader:
    """Reads resolved expressions; `lookup` says where each variable or flag has which value."""

    def __init__(self, diagrams: Diagrams, lookup: Lookup) -> None:
        self._diagrams = diagrams
        self.lookup = lookup

    def predicate(self, expression: Expression) -> Function:
        """Where a predicate holds."""
        diagrams = self._diagrams
        match expression:
            case Constant(value):
                return diagrams.true if value else diagrams.false
            case Variable(name):
                return self.lookup(name).get(True, diagrams.false)
            case Not(operand):
                return ~self.predicate(operand)
            case And(operands):
                return diagrams.conjunction(map(self.predicate, operands))
            case Or(operands):
                return diagrams.disjunction(map(self.predicate, operands))
            case Implies(left, right):
                return self.predicate(left).imp(self.predicate(right))
            case Comparison(relation, left, right):
                return self._compared(RELATIONS[relation], self.values(left), self.values(right))
            case Membership(left, options):
                subject = self.values(left)
                return diagrams.disjunction(
                    self._compared(RELATIONS["=="], subject, self.values(option)) for option in options
                )
            case _:
                raise TypeError(f"{expression} is no predicate of a state")

    def values(self, expression: Expression) -> Values:
        """Where an expression has each of the values that it can have."""
        match expression:
            case Constant(value):
                return {value: self._diagrams.true}
            case Variable(name):
                return self.lookup(name)
            case Arithmetic(sign, left, right):
                totals: dict[Value, Function] = {}
                for (a, where), (b, and_where) in product(self.values(left).items(), self.values(right).items()):
                    total = int(a) + int(b) if sign == "+" else int(a) - int(b)
                    totals[total] = totals.get(total, self._diagrams.false) | (where & and_where)
                return totals
            case _:
                holds = self.predicate(expression)
                return {True: holds, False: ~holds}

    def _compared(self, holds: Callable[[Value, Value], bool], left: Values, right: Values) -> Function:
        return self._diagrams.disjunction(
            where & and_where
            for (one, where), (other, and_where) in product(left.items(), right.items())
            if holds(one, other)
        )
