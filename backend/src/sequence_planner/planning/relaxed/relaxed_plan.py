"""Which transitions a plan could be made of, were nothing ever undone (Hoffmann and Nebel 2001).

Values are gathered layer by layer until the goals may hold; then, backwards, for each value that is needed the
transitions that first wrote it, and what these need. It is a guess, made quickly, of what matters.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from itertools import product

from sequence_planner.automaton.structure import Automaton, State, target
from sequence_planner.automaton.transitions import Transition
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import (
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
    variables,
)
from sequence_planner.expressions.types import Value

Fact = tuple[str, Value]
_Support = tuple[int, tuple[Fact, ...]]  # what it takes in transitions, and the values that are enough
_Way = tuple[int, Transition, tuple[Fact, ...]]  # a support with the transition that is taken on it

_DEARER = 2  # what a transition may take more than the best to be another way to the same value
_MOST_COMBINATIONS = 256  # of values, in one comparison; no more are tried


class RelaxedPlan:
    """From one state, by `moves`."""

    def __init__(self, automaton: Automaton, state: State, moves: Iterable[Transition]) -> None:
        self._automaton = automaton
        self._moves = tuple(moves)
        self._costs: dict[str, dict[Value, int]] = {
            name: {} if (value := state[name]) is None else {value: 0} for name in automaton.variables
        }
        self.layers = 0  # gathered so far
        self._achievers: dict[Fact, list[_Way]] = {}

    def towards(self, goals: Sequence[Expression]) -> tuple[Transition, ...] | None:
        """The transitions of a relaxed plan; None when even so not every one of `goals` may hold."""
        readers: dict[str, list[int]] = defaultdict(list)
        waiting: Iterable[int] = range(len(self._moves))
        blocked = False
        while not blocked:
            needed = [self._support(goal, True) for goal in goals]
            found = [each for each in needed if each is not None]
            if len(found) == len(needed):
                return self._extracted([fact for _, facts in found for fact in facts])
            gathered: dict[Fact, list[_Way]] = defaultdict(list)
            for number in waiting:
                for fact, way in self._taken(self._moves[number]):
                    gathered[fact].append(way)
            if not readers:
                readers = self._readers()
            for (name, value), ways in gathered.items():
                least = min(cost for cost, _, _ in ways)
                self._costs[name][value] = least
                self._achievers[name, value] = [way for way in ways if way[0] <= least + _DEARER]
            waiting = sorted({number for name, _ in gathered for number in readers[name]})
            self.layers += 1
            blocked = not gathered
        return None

    def _readers(self) -> dict[str, list[int]]:
        readers: dict[str, list[int]] = defaultdict(list)
        known: dict[str, frozenset[str]] = {}

        def behind(name: str) -> frozenset[str]:
            """The variables that decide a variable or flag."""
            if name not in known:
                predicate = self._automaton.flag_predicates.get(name)
                inner = () if predicate is None else tuple(map(behind, variables(predicate)))
                known[name] = frozenset({name} if predicate is None else ()).union(*inner)
            return known[name]

        for number, move in enumerate(self._moves):
            for name in frozenset[str]().union(*map(behind, move.reads)):
                readers[name].append(number)
        return readers

    def _taken(self, move: Transition) -> list[tuple[Fact, _Way]]:
        """The values that are new by `move`, if it may be taken."""
        new: list[tuple[Fact, _Way]] = []
        guard: _Support | None = None
        for action in move.actions:
            name, written = target(action), action.value
            costs = self._costs[name]
            if not costs or len(costs) == len(self._automaton.variables[name].type.domain):
                continue  # what is unknown stays so
            if isinstance(written, Constant) and written.value in costs:
                continue
            guard = guard or self._support(move.guard, True)
            if guard is None:
                return []
            for value, (cost, facts) in self._written(action):
                if value not in costs:
                    new.append(((name, value), (1 + guard[0] + cost, move, guard[1] + facts)))
        return new

    def _written(self, action: Assignment) -> list[tuple[Value, _Support]]:
        condition = (0, ()) if action.condition is None else self._support(action.condition, True)
        if condition is None:
            return []
        values = self._values(action.value)
        return [(value, (condition[0] + cost, condition[1] + facts)) for value, (cost, facts) in values]

    def _extracted(self, needed: list[Fact]) -> tuple[Transition, ...]:
        chosen: dict[str, Transition] = {}
        seen: set[Fact] = set()
        while needed:
            fact = needed.pop()
            if fact not in seen:
                for _, move, facts in self._achievers.get(fact, ()):
                    chosen[move.name] = move
                    needed.extend(facts)
            seen.add(fact)
        return tuple(chosen.values())

    def _support(self, predicate: Expression, truth: bool) -> _Support | None:
        """The cheapest values that give `predicate` the value `truth`; None when none of those gathered do."""
        # What is most frequent comes first, and without patterns, as in `expressions.evaluation.evaluate`.
        if isinstance(predicate, Comparison):
            return self._compared(predicate, truth)
        if isinstance(predicate, And):
            return self._every(predicate.operands, True) if truth else self._cheapest(predicate.operands, False)
        if isinstance(predicate, Or):
            return self._cheapest(predicate.operands, True) if truth else self._every(predicate.operands, False)
        if isinstance(predicate, Variable):
            name = predicate.name
            if name in self._automaton.flag_predicates:
                return self._support(self._automaton.flag_predicates[name], truth)
            cost = self._costs[name].get(truth)
            return None if cost is None else (cost, ((name, truth),))
        if isinstance(predicate, Not):
            return self._support(predicate.operand, not truth)
        match predicate:
            case Constant(value):
                return (0, ()) if value is truth else None
            case Implies(left, right):
                return self._support(Or((Not(left), right)), truth)
            case Membership():
                return self._among(predicate, truth)
            case _:
                return None

    def _compared(self, predicate: Comparison, truth: bool) -> _Support | None:
        left, right = predicate.left, predicate.right
        if not (isinstance(left, Variable) and isinstance(right, Constant) and predicate.operator in ("==", "!=")):
            return self._among(predicate, truth)
        costs = self._costs.get(left.name)
        if costs is None:
            return self._among(predicate, truth)
        equal = truth is (predicate.operator == "==")
        if equal:
            cost = costs.get(right.value)
            return None if cost is None else (cost, ((left.name, right.value),))
        options = [(cost, ((left.name, value),)) for value, cost in costs.items() if value != right.value]
        return min(options, default=None, key=_cost)

    def _among(self, predicate: Expression, truth: bool) -> _Support | None:
        values = self._values(predicate)
        return min((support for value, support in values if value is truth), default=None, key=_cost)

    def _every(self, parts: Iterable[Expression], truth: bool) -> _Support | None:
        cost, facts = 0, list[Fact]()
        for part in parts:
            support = self._support(part, truth)
            if support is None:
                return None
            cost += support[0]
            facts += support[1]
        return cost, tuple(facts)

    def _cheapest(self, parts: Iterable[Expression], truth: bool) -> _Support | None:
        options = (self._support(part, truth) for part in parts)
        return min((option for option in options if option is not None), default=None, key=_cost)

    def _values(self, expression: Expression) -> list[tuple[Value, _Support]]:
        """What `expression` may be, each with what it takes."""
        match expression:
            case Constant(value):
                return [(value, (0, ()))]
            case Variable(name) if name in self._costs:
                return [(value, (cost, ((name, value),))) for value, cost in self._costs[name].items()]
        names = tuple(dict.fromkeys(variables(expression)))
        supports = [self._named(name) for name in names]
        found: dict[Value, _Support] = {}
        for _, combination in zip(range(_MOST_COMBINATIONS), product(*supports), strict=False):
            result = evaluate(expression, dict(zip(names, (value for value, _ in combination), strict=True)))
            cost = sum(support[0] for _, support in combination)
            if result is not None and (result not in found or cost < found[result][0]):
                found[result] = (cost, tuple(fact for _, support in combination for fact in support[1]))
        return list(found.items())

    def _named(self, name: str) -> list[tuple[Value, _Support]]:
        if name in self._costs:
            return self._values(Variable(name, self._automaton.types[name]))
        both = ((truth, self._support(self._automaton.flag_predicates[name], truth)) for truth in (False, True))
        return [(truth, support) for truth, support in both if support is not None]


def _cost(support: _Support) -> int:
    return support[0]
