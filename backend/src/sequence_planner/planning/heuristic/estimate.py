"""How far away goals are, by a plan of the relaxed task: the heuristic of FF (Hoffmann and Nebel 2001).

Each fact's cost is the sum of those it takes (Bonet and Geffner 2001), and its cheapest rule belongs to the plan
(Keyder and Geffner 2008).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from heapq import heapify, heappop, heappush

from sequence_planner.expressions.types import Value
from sequence_planner.immutable import Immutable
from sequence_planner.planning.heuristic.graph import Graph, Kind, Operator

_NEVER = 1 << 60
_PRICES: Mapping[Kind, int] = {}
_SHIFT = 24  # of a cost before its node in one number, so that a queue of numbers does
_NODE = (1 << _SHIFT) - 1


class Step(Immutable):
    """An operator of a relaxed plan, with the facts it needs and those it is taken for and others it brings."""

    operator: Operator
    needs: tuple[tuple[str, Value | None], ...]
    brings: tuple[tuple[str, Value | None], ...]


class Estimate(Immutable):
    """A relaxed plan, cheaper steps first, and every operator that could be taken at once."""

    steps: tuple[Step, ...]
    possible: frozenset[Operator]

    @property
    def cost(self) -> int:
        """The number of operators."""
        return len(self.steps)


class Estimator:
    """Estimates how far nodes of `graph`, as it is now, are from a state without the operators `idle`.

    Of each kind an operator costs what `prices` say, or else 1.
    """

    def __init__(self, graph: Graph, idle: frozenset[Operator], prices: Mapping[Kind, int] = _PRICES) -> None:
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
        if Graph.FALSE in wanted:
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

    def _steps(self, rules: Iterable[int]) -> tuple[Step, ...]:
        graph = self._graph
        needs: dict[Operator, dict[tuple[str, Value | None], None]] = {}
        brings: dict[Operator, dict[tuple[str, Value | None], None]] = {}
        for rule in rules:
            operator = graph.operators[rule]
            assert operator is not None  # it has a cost
            facts = (graph.fact_of[node] for node in graph.bodies[rule] if node in graph.fact_of)
            needs.setdefault(operator, {}).update(dict.fromkeys(facts))
            brings.setdefault(operator, {}).update(dict.fromkeys(graph.fact_of[head] for head in graph.heads[rule]))
        return tuple(Step(operator, tuple(needs[operator]), tuple(brings[operator])) for operator in needs)
