"""The relaxed planning task as an AND/OR graph, and the FF heuristic (Hoffmann and Nebel 2001)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from enum import Enum, auto
from heapq import heapify, heappop, heappush
from itertools import product
from math import prod

from sequence_planner.automaton.automaton import Automaton, reads, target
from sequence_planner.automaton.state_set import EVERYTHING, FIRST_NODE, NOTHING, StateSet, Supervisor
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import (
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
from sequence_planner.language.types import Value

# A monotone AND/OR graph: nodes that become true once all of the body of one of their rules is true.


class RuleKind(Enum):
    """The kind of thing that a rule with a cost stands for."""

    EFFECT = auto()
    FINISH = auto()
    START = auto()
    OPERATION = auto()
    ASSUMPTION = auto()  # that a fact comes about, whatever brings it


Operator = tuple[RuleKind, str]


class RelaxedGraph:
    """Nodes and rules by number. A fact is a node that says a variable or flag has a value, None being unknown.

    Rules of operators cost 1; the others derive, at no cost.
    """

    TRUE, FALSE = 0, 1

    def __init__(self) -> None:
        self.facts: dict[str, dict[Value | None, int]] = {}
        self.fact_of: dict[int, tuple[str, Value | None]] = {}
        self.readers: list[list[int]] = [[], []]  # of each node, the rules that have it in their body
        self.bodies: list[tuple[int, ...]] = []
        self.heads: list[tuple[int, ...]] = []
        self.operators: list[Operator | None] = []
        self._combined: dict[tuple[bool, frozenset[int]], int] = {}

    @property
    def nodes(self) -> int:
        """The number of nodes there are."""
        return len(self.readers)

    def node(self) -> int:
        """A new node without rules."""
        self.readers.append([])
        return len(self.readers) - 1

    def fact(self, name: str, value: Value | None) -> int:
        """The node of `name` having `value`."""
        values = self.facts.setdefault(name, {})
        if value not in values:
            values[value] = self.node()
            self.fact_of[values[value]] = (name, value)
        return values[value]

    def rule(self, body: Iterable[int], heads: tuple[int, ...], operator: Operator | None = None) -> None:
        """All of `body` makes `heads` true."""
        needed = set(body)
        if self.FALSE in needed or not heads:
            return
        needed = needed - {self.TRUE} or {self.TRUE}
        self.bodies.append(tuple(sorted(needed)))
        self.heads.append(heads)
        self.operators.append(operator)
        for node in needed:
            self.readers[node].append(len(self.bodies) - 1)

    def all_of(self, nodes: Iterable[int]) -> int:
        """The node that is true when all of `nodes` are."""
        return self._combination(frozenset(nodes), True)

    def any_of(self, nodes: Iterable[int]) -> int:
        """The node that is true when any of `nodes` is."""
        return self._combination(frozenset(nodes), False)

    def seeds(self, state: Mapping[str, Value | None]) -> list[int]:
        """The nodes that are true in `state` without any rule."""
        found = [self.TRUE]
        for name, values in self.facts.items():
            node = values.get(state[name])
            if node is not None:
                found.append(node)
        return found

    def _combination(self, nodes: frozenset[int], every: bool) -> int:
        neutral, decisive = (self.TRUE, self.FALSE) if every else (self.FALSE, self.TRUE)
        if decisive in nodes:
            return decisive
        nodes -= {neutral}
        if len(nodes) < 2:
            return next(iter(nodes), neutral)
        key = (every, nodes)
        if key not in self._combined:
            self._combined[key] = combined = self.node()
            for body in (nodes,) if every else ({node} for node in nodes):
                self.rule(body, (combined,))
        return self._combined[key]


# How far away goals are, by a plan of the relaxed task: the heuristic of FF (Hoffmann and Nebel 2001).
#
# Each fact's cost is the sum of those it takes (Bonet and Geffner 2001), and its cheapest rule belongs to the plan
# (Keyder and Geffner 2008).

_NEVER = 1 << 60
_PRICES: Mapping[RuleKind, int] = {}
_SHIFT = 24  # of a cost before its node in one number, so that a queue of numbers does
_NODE = (1 << _SHIFT) - 1


class RelaxedStep(Immutable):
    """An operator of a relaxed plan, with the facts it needs and those it is taken for and others it brings."""

    operator: Operator
    needs: tuple[tuple[str, Value | None], ...]
    brings: tuple[tuple[str, Value | None], ...]


class Estimate(Immutable):
    """A relaxed plan, cheaper steps first, and every operator that could be taken at once."""

    steps: tuple[RelaxedStep, ...]
    possible: frozenset[Operator]

    @property
    def cost(self) -> int:
        """The number of operators."""
        return len(self.steps)


class Estimator:
    """Estimates how far nodes of `graph`, as it is now, are from a state without the operators `idle`.

    Of each kind an operator costs what `prices` say, or else 1.
    """

    def __init__(
        self, graph: RelaxedGraph, idle: frozenset[Operator], prices: Mapping[RuleKind, int] = _PRICES
    ) -> None:
        self._graph = graph
        self._costs = [0 if operator is None else prices.get(operator[0], 1) for operator in graph.operators]
        self._left = [
            len(body) + (operator in idle) for body, operator in zip(graph.bodies, graph.operators, strict=True)
        ]

    def least(self, state: Mapping[str, Value | None], goals: Iterable[int]) -> int | None:
        """A lower bound on the number of operators; None if there is no relaxed plan, and then no plan at all."""
        missing = set(goals)
        graph, left = self._graph, self._left.copy()
        known = set(graph.seeds(state))
        now, cost = list(known), 0
        while True:
            following: list[int] = []
            for node in now:  # which grows meanwhile
                missing.discard(node)
                for rule in graph.readers[node]:
                    left[rule] -= 1
                    if not left[rule]:
                        new = [head for head in graph.heads[rule] if head not in known]
                        if self._costs[rule]:
                            following += new
                        else:
                            known.update(new)
                            now += new
            if not missing:
                return cost
            now = [node for node in dict.fromkeys(following) if node not in known]
            if not now:
                return None
            known.update(now)
            cost += 1

    def estimate(self, state: Mapping[str, Value | None], goals: Iterable[int]) -> Estimate | None:
        """A relaxed plan for the nodes `goals`; None if there is none, and then no plan at all."""
        wanted = set(goals)
        if RelaxedGraph.FALSE in wanted:
            return None
        supporter, totals, possible = self._explore(state, wanted)
        rules: set[int] = set()
        seen: set[int] = set()
        pending = list(wanted)
        while pending:
            node = pending.pop()
            if node in seen:
                continue
            seen.add(node)
            rule = supporter[node]
            if rule is None:
                return None
            if rule >= 0:
                rules.add(rule)
                pending.extend(self._graph.bodies[rule])
        ordered = sorted((rule for rule in rules if self._costs[rule]), key=lambda rule: (totals[rule], rule))
        return Estimate(self._steps(ordered), possible)

    def _explore(
        self, state: Mapping[str, Value | None], wanted: set[int]
    ) -> tuple[list[int | None], list[int], frozenset[Operator]]:
        """The cheapest rule of each node, -1 for what is true at once; the cost with each rule; what is possible."""
        graph, left, totals = self._graph, self._left.copy(), self._costs.copy()
        readers, heads = graph.readers, graph.heads
        supporter: list[int | None] = [None] * graph.nodes
        costs = [_NEVER] * graph.nodes
        missing = set(wanted)
        now = graph.seeds(state)
        for node in now:
            supporter[node], costs[node] = -1, 0
        fired: list[int] = []
        for node in now:  # which grows meanwhile
            missing.discard(node)
            for rule in readers[node]:
                left[rule] -= 1
                if not left[rule]:
                    if totals[rule]:
                        fired.append(rule)
                        continue
                    for head in heads[rule]:
                        if costs[head]:
                            supporter[head], costs[head] = rule, 0
                            now.append(head)
        queue: list[int] = []
        for rule in fired:
            cost = totals[rule]
            for head in heads[rule]:
                if costs[head] > cost:
                    supporter[head], costs[head] = rule, cost
                    queue.append(cost << _SHIFT | head)
        heapify(queue)
        while queue and missing:
            entry = heappop(queue)
            node, cost = entry & _NODE, entry >> _SHIFT
            if cost > costs[node]:
                continue
            missing.discard(node)
            for rule in readers[node]:
                left[rule] -= 1
                totals[rule] += cost
                if not left[rule]:
                    total = totals[rule]
                    for head in heads[rule]:
                        if total < costs[head]:
                            supporter[head], costs[head] = rule, total
                            heappush(queue, total << _SHIFT | head)
        operators = graph.operators
        return supporter, totals, frozenset(op for rule in fired if (op := operators[rule]) is not None)

    def _steps(self, rules: Iterable[int]) -> tuple[RelaxedStep, ...]:
        graph = self._graph
        needs: dict[Operator, dict[tuple[str, Value | None], None]] = {}
        brings: dict[Operator, dict[tuple[str, Value | None], None]] = {}
        for rule in rules:
            operator = graph.operators[rule]
            assert operator is not None  # it has a cost
            facts = (graph.fact_of[node] for node in graph.bodies[rule] if node in graph.fact_of)
            needs.setdefault(operator, {}).update(dict.fromkeys(facts))
            brings.setdefault(operator, {}).update(dict.fromkeys(graph.fact_of[head] for head in graph.heads[rule]))
        return tuple(RelaxedStep(operator, tuple(needs[operator]), tuple(brings[operator])) for operator in needs)


# What makes predicates true if nothing is ever undone, as nodes of an AND/OR graph over facts.

_MOST_COMBINATIONS = 256  # of an expression's variables; one with more is taken to have any value at any time


class RelaxedPredicates:
    """Reads predicates of an automaton into `graph`, each when it is asked for; others add what makes facts true."""

    def __init__(self, automaton: Automaton) -> None:
        self.graph = RelaxedGraph()
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


# The relaxed task of an automaton: what can become true if nothing is ever undone, as an AND/OR graph.
#
# This is the delete relaxation of planning (Bonet and Geffner 2001) over finite domains, as in `planning.relaxation`,
# made once per automaton so that it can be asked from thousands of states.

_MOST_NODES = 64  # of a supervisor's guard; one with more is left out


class RelaxedTask(RelaxedPredicates):
    """Reads an automaton into a graph; predicates come to it as they are asked for."""

    def __init__(
        self, automaton: Automaton, supervisor: Supervisor, pause: Callable[[], object] = lambda: None
    ) -> None:
        """`pause` is called for each ability, and may raise."""
        super().__init__(automaton)
        self._sets: dict[tuple[int, int], int] = {}
        for effect in automaton.effects:
            if not effect.fault:
                self._operator((RuleKind.EFFECT, effect.name), self._needs(effect.guard), effect.actions)
        for ability in automaton.abilities.values():
            pause()
            if ability.finish_guard is not None:
                needs = self._needs(ability.finish_guard)
                self._operator((RuleKind.FINISH, ability.name), needs, ability.finish_actions)
            needs = [*self._needs(ability.enabled), *self._needs(ability.start_guard)]
            guard = supervisor.guards.get(ability.name)
            if guard is not None and len(guard.nodes) <= _MOST_NODES:
                needs.append(self._member(guard, guard.root))
            self._operator((RuleKind.START, ability.name), needs, ability.start_actions)

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
        """Yield what an action can write, each with what it takes for that."""
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

    def _member(self, states: StateSet, reference: int) -> int:
        """The node that is true when a state may be among those that begin at `reference`."""
        if reference in (NOTHING, EVERYTHING):
            return RelaxedGraph.TRUE if reference == EVERYTHING else RelaxedGraph.FALSE
        key = (id(states), reference)
        if key not in self._sets:
            axis, children = states.nodes[reference - FIRST_NODE]
            name = states.names[axis]
            branches = [
                self.graph.all_of((self._fact(name, value), self._member(states, child)))
                for value, child in zip(states.domains[axis], children, strict=True)
            ]
            # What is unknown is left to the supervisor itself.
            self._sets[key] = self.graph.any_of((*branches, self.graph.fact(name, None)))
        return self._sets[key]
