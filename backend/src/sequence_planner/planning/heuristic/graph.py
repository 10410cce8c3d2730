"""A monotone AND/OR graph: nodes that become true once all of the body of one of their rules is true."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from enum import Enum, auto

from sequence_planner.expressions.types import Value


class Kind(Enum):
    """What a rule with a cost stands for."""

    EFFECT = auto()
    FINISH = auto()
    START = auto()
    OPERATION = auto()
    ASSUMPTION = auto()  # that a fact comes about, whatever brings it


Operator = tuple[Kind, str]


class Graph:
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
        """How many nodes there are."""
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
