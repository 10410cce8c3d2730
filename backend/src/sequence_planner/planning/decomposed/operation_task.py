"""The relaxed task of operations: which of them, in which order, seem to lead to goals.

An operation is taken to bring every value that its goal allows, once its precondition holds, and nothing to undo any.
Where its goal allows several values of a variable, it does not bring one that is all that another one's goal allows: a
bolt that is no longer missing is not tight yet, if there is an operation for that. What no operation brings is assumed
to come about, at a price, if it can at all: the plan of each operation sees to it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping

from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.expressions.evaluation import evaluate, holds
from sequence_planner.expressions.syntax import And, Expression, Implies, Not, Or, Variable, variables
from sequence_planner.expressions.types import Value
from sequence_planner.planning.heuristic.estimate import Estimator
from sequence_planner.planning.heuristic.graph import Graph, Kind, Operator
from sequence_planner.planning.heuristic.relaxed_predicates import RelaxedPredicates
from sequence_planner.planning.relaxed.relaxation import Possible

_Fact = tuple[str, Value]

_PRICES = {Kind.ASSUMPTION: 4}  # of operations: what one of them brings is seldom cheaper to be had otherwise


class OperationTask(RelaxedPredicates):
    """Reads the operations of an automaton into a graph once, to be asked about from many states."""

    def __init__(self, automaton: Automaton) -> None:
        super().__init__(automaton)
        brought = _attributed(
            {name: dict.fromkeys(self._allowed(each.goal)) for name, each in automaton.operations.items()}
        )
        self._brought = frozenset(fact for facts in brought.values() for fact in facts)
        self._assumed: dict[Operator, tuple[str, Value | None]] = {}
        for name, operation in automaton.operations.items():
            heads = tuple(self.graph.fact(*fact) for fact in brought[name])
            self.graph.rule(self._needs(operation.precondition), heads, (Kind.OPERATION, name))

    def towards(
        self, state: State, goals: Iterable[Expression], possible: Possible | None = None
    ) -> tuple[str, ...] | None:
        """Operations that seem to lead from `state` to `goals`, where variables may have the values `possible`, or any.

        Those that can be pursued sooner come first. None if nothing seems to lead there.
        """
        nodes = [self.reaching(goal) for goal in goals]
        done = ((Kind.OPERATION, name) for name, each in self._automaton.operations.items() if holds(each.goal, state))
        never = (
            operator
            for operator, (name, value) in self._assumed.items()
            if possible is not None and value not in possible[name]
        )
        found = Estimator(self.graph, frozenset((*done, *never)), _PRICES).estimate(state, nodes)
        if found is None:
            return None
        return tuple(step.operator[1] for step in found.steps if step.operator[0] is Kind.OPERATION)

    def _fact(self, name: str, value: Value) -> int:
        new = value not in self.graph.facts.get(name, {})
        node = super()._fact(name, value)
        if new and name not in self._automaton.flag_predicates and (name, value) not in self._brought:
            operator = (Kind.ASSUMPTION, f"{name} == {value}")
            self._assumed[operator] = (name, value)
            self.graph.rule((Graph.TRUE,), (node,), operator)
        return node

    def _allowed(self, predicate: Expression, truth: bool = True) -> Iterator[_Fact]:
        """The values of variables that a part of `predicate` has if it is `truth`."""
        match predicate:
            case Not(operand):
                yield from self._allowed(operand, not truth)
            case And(operands) | Or(operands):
                for part in operands:
                    yield from self._allowed(part, truth)
            case Implies(left, right):
                yield from self._allowed(left, not truth)
                yield from self._allowed(right, truth)
            case Variable(name) if name in self._automaton.flag_predicates:
                yield from self._allowed(self._automaton.flag_predicates[name], truth)
            case _:
                names = sorted(set(variables(predicate)))
                if any(name in self._automaton.flag_predicates for name in names) or not self._few(names):
                    return
                for values in self._combinations(names):
                    if evaluate(predicate, values) is truth:
                        yield from values.items()


def _attributed(allowed: Mapping[str, Iterable[_Fact]]) -> dict[str, list[_Fact]]:
    """What each operation brings of what its goal allows."""
    only: set[_Fact] = set()
    for facts in allowed.values():
        values = Counter(name for name, _ in facts)
        only.update(fact for fact in facts if values[fact[0]] == 1)
    brought: dict[str, list[_Fact]] = {}
    for operation, facts in allowed.items():
        values = Counter(name for name, _ in facts)
        own = [fact for fact in facts if values[fact[0]] == 1 or fact not in only]
        brought[operation] = own or list(facts)
    return brought
