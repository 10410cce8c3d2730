"""What synthesis uses of `oxidd`, on CUDD by `dd.cudd`: the same algorithm on another engine.

As `dd` quantifies over names, the names of a set of bits are looked up once and kept. There is no reordering: the order
is the one that synthesis has chosen.
"""

from __future__ import annotations

from collections.abc import Iterable

from dd import cudd
from oxidd.util import BooleanOperator


class Function:
    """A function of the bits of a manager."""

    __slots__ = ("_manager", "node")

    def __init__(self, manager: Manager, node: cudd.Function) -> None:
        self._manager = manager
        self.node = node

    def __and__(self, other: Function) -> Function:
        return Function(self._manager, self.node & other.node)

    def __or__(self, other: Function) -> Function:
        return Function(self._manager, self.node | other.node)

    def __invert__(self) -> Function:
        return Function(self._manager, ~self.node)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Function) and self.node == other.node

    def __hash__(self) -> int:
        return hash(self.node)

    def imp(self, other: Function) -> Function:
        """Where this implies `other`."""
        return Function(self._manager, self.node.implies(other.node))

    def ite(self, then: Function, otherwise: Function) -> Function:
        """`then` where this holds, `otherwise` where not."""
        return Function(self._manager, self._manager.bdd.ite(self.node, then.node, otherwise.node))

    def exists(self, bits: Function) -> Function:
        """Where it holds for some values of `bits`."""
        return Function(self._manager, self._manager.bdd.exist(self._manager.names(bits), self.node))

    def apply_exists(self, operator: BooleanOperator, other: Function, bits: Function) -> Function:
        """Where this and `other` hold for some values of `bits`."""
        assert operator is BooleanOperator.AND
        return Function(self._manager, cudd.and_exists(self.node, other.node, self._manager.names(bits)))

    def substitute(self, substitution: Substitution) -> Function:
        """This, with functions in place of some bits."""
        return Function(self._manager, self._manager.bdd.let(substitution.nodes, self.node))

    def satisfiable(self) -> bool:
        """Whether it holds anywhere."""
        return bool(self.node != self._manager.bdd.false)

    def node_level(self) -> int | None:
        """The level of its first bit."""
        return None if self.node.var is None else int(self.node.level)

    node_var = node_level

    def cofactors(self) -> tuple[Function, Function] | None:
        """What is left of it where its first bit is set, and where it is not."""
        node = self.node
        if node.var is None:
            return None
        high, low = (~node.high, ~node.low) if node.negated else (node.high, node.low)
        return Function(self._manager, high), Function(self._manager, low)

    def node_count(self) -> int:
        """How many nodes it has."""
        return len(self.node)

    def sat_count(self, bits: int) -> int:
        """How many valuations of `bits` satisfy it, as near as a floating-point number is."""
        return int(self._manager.bdd.count(self.node, bits))


class Manager:
    """Makes functions; room and cache are CUDD's own affair."""

    def __init__(self, _nodes: int, _cache: int, _threads: int) -> None:
        self.bdd = cudd.BDD()
        self.bdd.configure(reordering=False)
        self._names: dict[Function, frozenset[str]] = {}

    def add_vars(self, count: int) -> None:
        """Bits from 0 on, each on the level of its number."""
        self.bdd.declare(*(f"b{number}" for number in range(count)))

    def var(self, number: int) -> Function:
        """Where a bit is set."""
        return Function(self, self.bdd.var(f"b{number}"))

    def not_var(self, number: int) -> Function:
        """Where it is not."""
        return ~self.var(number)

    def true(self) -> Function:
        """Everywhere."""
        return Function(self, self.bdd.true)

    def false(self) -> Function:
        """Nowhere."""
        return Function(self, self.bdd.false)

    def names(self, bits: Function) -> frozenset[str]:
        """The names of a set of bits."""
        if bits not in self._names:
            self._names[bits] = frozenset(self.bdd.support(bits.node))
        return self._names[bits]


class Substitution:
    """Functions in place of bits."""

    def __init__(self, pairs: Iterable[tuple[int, Function]]) -> None:
        self.nodes = {f"b{number}": function.node for number, function in pairs}
