"""The relaxed task of an automaton: what can become true if nothing is ever undone, as an AND/OR graph.

This is the delete relaxation of planning (Bonet and Geffner 2001) over finite domains, as in `planning.relaxation`,
made once per automaton so that it can be asked from thousands of states.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import product
from math import prod

from sequence_planner.automaton.state_set import EVERYTHING, NOTHING, StateSet, Supervisor
from sequence_planner.automaton.structure import Automaton, reads, target
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import (
    TRUE,
    And,
    Assignment,
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
from sequence_planner.planning.heuristic.graph import Graph, Kind, Operator

_MOST_COMBINATIONS = 256  # of an expression's variables; one with more is taken to have any value at any time
_MOST_NODES = 64  # of a supervisor's guard; one with more is left out


class RelaxedTask:
    """Reads an automaton into a graph; predicates come to it as they are asked for."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self.graph = Graph()
        self._automaton = automaton
        self._read: dict[tuple[int, bool], tuple[int, Expression]] = {}  # with the expression, to keep its identity
        self._goals: dict[Expression, int] = {}
        self._sets: dict[tuple[int, int], int] = {}
        for effect in automaton.effects:
            if not effect.fault:
                self._operator((Kind.EFFECT, effect.name), self._needs(effect.guard), effect.actions)
        for ability in automaton.abilities.values():
            if ability.finish_guard is not None:
                needs = self._needs(ability.finish_guard)
                self._operator((Kind.FINISH, ability.name), needs, ability.finish_actions)
            needs = [*self._needs(ability.enabled), *self._needs(ability.start_guard)]
            guard = supervisor.guards.get(ability.name)
            if guard is not None and len(guard.nodes) <= _MOST_NODES:
                needs.append(self._member(guard, guard.root))
            self._operator((Kind.START, ability.name), needs, ability.start_actions)

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

    def _operator(self, operator: Operator, needs: list[int], actions: Iterable[Assignment]) -> None:
        always: list[int] = []
        for action in actions:
            for condition, value in self._written(action):
                fact = self.graph.fact(target(action), value)
                if condition:
                    self.graph.rule([*needs, *condition], (fact,), operator)
                else:
                    always.append(fact)
        self.graph.rule(needs, tuple(always), operator)

    def _written(self, action: Assignment) -> Iterator[tuple[list[int], Value]]:
        """What an action can write, each with what it takes for that."""
        domain = self._automaton.variables[target(action)].type.domain
        condition = [] if action.condition is None else self._needs(action.condition)
        if isinstance(action.value, Constant):
            yield condition, action.value.value
            return
        names = sorted(reads(Assignment(action.target, action.value)))
        if not self._few(names):
            yield from ((condition, value) for value in domain)
            return
        for values in self._combinations(names):
            value = evaluate(action.value, values)
            if value is not None and value in domain:
                yield [*condition, *(self._fact(name, each) for name, each in values.items())], value

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

    def _member(self, states: StateSet, reference: int) -> int:
        """The node that is true when a state may be among those that begin at `reference`."""
        if reference in (NOTHING, EVERYTHING):
            return Graph.TRUE if reference == EVERYTHING else Graph.FALSE
        key = (id(states), reference)
        if key not in self._sets:
            axis, children = states.nodes[reference - 2]
            name = states.names[axis]
            branches = [
                self.graph.all_of((self._fact(name, value), self._member(states, child)))
                for value, child in zip(states.domains[axis], children, strict=True)
            ]
            # What is unknown is left to the supervisor itself.
            self._sets[key] = self.graph.any_of((*branches, self.graph.fact(name, None)))
        return self._sets[key]

    def _few(self, names: Iterable[str]) -> bool:
        return prod(len(self._automaton.types[name].domain) for name in names) <= _MOST_COMBINATIONS

    def _combinations(self, names: list[str]) -> Iterator[dict[str, Value]]:
        for values in product(*(self._automaton.types[name].domain for name in names)):
            yield dict(zip(names, values, strict=True))
