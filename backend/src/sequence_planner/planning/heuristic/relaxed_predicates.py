"""What makes predicates true if nothing is ever undone, as nodes of an AND/OR graph over facts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import product
from math import prod

from sequence_planner.automaton.structure import Automaton
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import (
    TRUE,
    And,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    Variable,
    conjuncts,
    variables,
)
from sequence_planner.expressions.types import Value
from sequence_planner.planning.heuristic.graph import Graph

_MOST_COMBINATIONS = 256  # of an expression's variables; one with more is taken to have any value at any time


class RelaxedPredicates:
    """Reads predicates of an automaton into `graph`, each when it is asked for; others add what makes facts true."""

    def __init__(self, automaton: Automaton) -> None:
        self.graph = Graph()
        self._automaton = automaton
        self._read: dict[tuple[int, bool], tuple[int, Expression]] = {}  # with the expression, to keep its identity
        self._goals: dict[Expression, int] = {}

    def reaching(self, goal: Expression) -> int:
        """The node that is true when the predicate `goal` may hold; equal ones, from question to question, have one."""
        if goal not in self._goals:
            self._goals[goal] = self._may(goal)
        return self._goals[goal]

    def _may(self, predicate: Expression, truth: bool = True) -> int:
        """The node that is true when `predicate` may have the value `truth`."""
        key = (id(predicate), truth)
        if key not in self._read:
            self._read[key] = (self._node(predicate, truth), predicate)
        return self._read[key][0]

    def _needs(self, guard: Expression) -> list[int]:
        return [self._may(part) for part in conjuncts(guard) if part != TRUE]

    def _node(self, predicate: Expression, truth: bool) -> int:
        graph = self.graph
        match predicate:
            case Constant(value):
                return graph.TRUE if value is truth else graph.FALSE
            case Variable(name):
                return self._fact(name, truth)
            case Not(operand):
                return self._may(operand, not truth)
            case And(operands):
                combined = graph.all_of if truth else graph.any_of
                return combined([self._may(part, truth) for part in operands])
            case Or(operands):
                combined = graph.any_of if truth else graph.all_of
                return combined([self._may(part, truth) for part in operands])
            case Implies(left, right):
                combined = graph.any_of if truth else graph.all_of
                return combined((self._may(left, not truth), self._may(right, truth)))
            case Comparison("==" | "!=" as relation, Variable(name), Constant(value)):
                return self._among(name, {value}, truth is (relation == "=="))
            case Membership(Variable(name), options) if all(isinstance(option, Constant) for option in options):
                return self._among(name, {o.value for o in options if isinstance(o, Constant)}, truth)
        names = sorted(set(variables(predicate)))
        if not self._few(names):
            return graph.TRUE
        return graph.any_of(
            [
                graph.all_of([self._fact(name, value) for name, value in values.items()])
                for values in self._combinations(names)
                if evaluate(predicate, values) is truth
            ]
        )

    def _among(self, name: str, options: set[Value], truth: bool) -> int:
        domain = self._automaton.types[name].domain
        return self.graph.any_of([self._fact(name, value) for value in domain if (value in options) is truth])

    def _fact(self, name: str, value: Value) -> int:
        """The node of `name` having `value`; a flag follows its predicate once it has been asked for."""
        if name in self._automaton.flag_predicates and name not in self.graph.facts:
            predicate = self._automaton.flag_predicates[name]
            facts = {truth: self.graph.fact(name, truth) for truth in (True, False)}
            for truth, fact in facts.items():
                self.graph.rule((self._may(predicate, truth),), (fact,))
        return self.graph.fact(name, value)

    def _few(self, names: Iterable[str]) -> bool:
        return prod(len(self._automaton.types[name].domain) for name in names) <= _MOST_COMBINATIONS

    def _combinations(self, names: list[str]) -> Iterator[dict[str, Value]]:
        for values in product(*(self._automaton.types[name].domain for name in names)):
            yield dict(zip(names, values, strict=True))
