"""A set of states as a decision diagram over the variables it depends on, and the supervisor made of such sets.

This is how a supervisor is handed on: the controller looks states up in it, the planner turns it into clauses. It is
plain data, so that it goes from process to process and into files.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from functools import cached_property

from sequence_planner.automaton.automaton import State
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.types import Value

# References to nodes: the two sets that test no variable, and then the nodes in their order.
NOTHING, EVERYTHING = 0, 1
FIRST_NODE = 2

Node = tuple[int, tuple[int, ...]]  # the position of the variable in `names`; a reference for each value of its domain


class StateSet(Immutable):
    """`nodes` is a reduced, ordered decision diagram with a branch for each value of a variable (Kam et al. 1998).

    Every way from `root` tests variables in the order of `names`, and a node comes after those it refers to. Two equal
    sets over the same names, in the same order, have equal diagrams.
    """

    names: tuple[str, ...]
    domains: tuple[tuple[Value, ...], ...]
    nodes: tuple[Node, ...] = ()
    root: int = EVERYTHING

    def includes(self, state: State) -> bool:
        """Return whether the set holds `state` for every value that its unknown variables could have."""
        pending = [self.root]
        seen: set[int] = set()
        while pending:
            reference = pending.pop()
            if reference == NOTHING:
                return False
            if reference == EVERYTHING or reference in seen:
                continue
            seen.add(reference)
            axis, children = self.nodes[reference - FIRST_NODE]
            value = state[self.names[axis]]
            if value is None:
                pending.extend(children)
            else:
                pending.append(children[self._positions[axis][value]])
        return True

    def for_all(self, unknown: frozenset[str]) -> StateSet:
        """The set over the other variables of what is included for every value of `unknown`."""
        if unknown.isdisjoint(self.names):
            return self
        kept = [axis for axis, name in enumerate(self.names) if name not in unknown]
        number = {axis: position for position, axis in enumerate(kept)}
        builder = Builder()
        memo: dict[frozenset[int], int] = {}

        def all_of(references: frozenset[int]) -> int:
            """The intersection of several sets, without the unknown variables."""
            references -= {EVERYTHING}
            if not references:
                return EVERYTHING
            if NOTHING in references:
                return NOTHING
            if references not in memo:
                axis = min(self.nodes[reference - FIRST_NODE][0] for reference in references)
                branches = [
                    frozenset(self._branch(reference, axis, position) for reference in references)
                    for position in range(len(self.domains[axis]))
                ]
                if axis in number:
                    memo[references] = builder.node(number[axis], tuple(map(all_of, branches)))
                else:
                    memo[references] = all_of(frozenset().union(*branches))
            return memo[references]

        root = all_of(frozenset({self.root}))
        names = tuple(self.names[axis] for axis in kept)
        return builder.built(names, tuple(self.domains[axis] for axis in kept), root)

    def nearest(self, state: State, certain: Collection[str] = ()) -> dict[str, Value] | None:
        """The values of a member that differ from `state`, in as few variables as possible; None if there is no member.

        An unknown variable differs from no value. Of those that are `certain` one differs only where no member is
        without that.
        """
        if self.root == NOTHING:
            return None
        costs: list[float] = [float("inf"), 0]
        best: list[int] = [0, 0]
        for axis, children in self.nodes:
            value = state[self.names[axis]]
            price = len(self.names) + 1 if self.names[axis] in certain else 1
            priced = [
                costs[child] + price * (value is not None and value != other)
                for child, other in zip(children, self.domains[axis], strict=True)
            ]
            costs.append(min(priced))
            best.append(priced.index(costs[-1]))
        changes: dict[str, Value] = {}
        reference = self.root
        while reference >= FIRST_NODE:
            axis, children = self.nodes[reference - FIRST_NODE]
            other = self.domains[axis][best[reference]]
            if state[self.names[axis]] not in (None, other):
                changes[self.names[axis]] = other
            reference = children[best[reference]]
        return changes

    def members(self) -> Iterator[Mapping[str, Value]]:
        """Every state of the set, over its own variables."""

        def completed(axis: int, reference: int) -> Iterator[tuple[Value, ...]]:
            if reference == NOTHING:
                return
            if axis == len(self.names):
                yield ()
                return
            for position, value in enumerate(self.domains[axis]):
                for rest in completed(axis + 1, self._branch(reference, axis, position)):
                    yield (value, *rest)

        return (dict(zip(self.names, values, strict=True)) for values in completed(0, self.root))

    @property
    def count(self) -> int:
        """The number of states it has, over its own variables."""
        size = [1]  # of the domains from each variable on
        for domain in reversed(self.domains):
            size.append(size[-1] * len(domain))
        size.reverse()
        axes = [len(self.names), len(self.names), *(axis for axis, _ in self.nodes)]
        counts = [0, 1]
        for axis, children in self.nodes:
            counts.append(sum(counts[child] * size[axis + 1] // size[axes[child]] for child in children))
        return counts[self.root] * size[0] // size[axes[self.root]]

    @property
    def everything(self) -> bool:
        """True if it is the set of all states."""
        return self.root == EVERYTHING

    def _branch(self, reference: int, axis: int, position: int) -> int:
        """The set of `reference` where the variable at `axis`, none later than the next tested, has that value."""
        if reference < FIRST_NODE or self.nodes[reference - FIRST_NODE][0] != axis:
            return reference
        return self.nodes[reference - FIRST_NODE][1][position]

    @cached_property
    def _positions(self) -> tuple[dict[Value, int], ...]:
        return tuple({value: position for position, value in enumerate(domain)} for domain in self.domains)


class Builder:
    """Makes the nodes of a set, from the last variable to the first; equal ones are one."""

    def __init__(self) -> None:
        self._references: dict[Node, int] = {}

    def node(self, axis: int, children: tuple[int, ...]) -> int:
        """The reference to what tests the variable at `axis`, and goes on in `children`."""
        if len(set(children)) == 1:
            return children[0]
        return self._references.setdefault((axis, children), len(self._references) + FIRST_NODE)

    def built(self, names: tuple[str, ...], domains: tuple[tuple[Value, ...], ...], root: int) -> StateSet:
        """The set that begins at `root`, with the nodes that it needs and no others."""
        nodes = list(self._references)
        number = {NOTHING: NOTHING, EVERYTHING: EVERYTHING}
        kept: list[Node] = []
        pending = [root]
        while pending:
            reference = pending[-1]
            if reference in number:
                pending.pop()
                continue
            axis, children = nodes[reference - FIRST_NODE]
            if missing := [child for child in dict.fromkeys(children) if child not in number]:
                pending.extend(reversed(missing))
                continue
            number[reference] = len(kept) + FIRST_NODE
            kept.append((axis, tuple(number[child] for child in children)))
            pending.pop()
        return StateSet(names, domains, tuple(kept), number[root])

    def whole(self, names: tuple[str, ...], domains: tuple[tuple[Value, ...], ...], root: int) -> StateSet:
        """The same where all nodes were made for it, each right after its children in their order."""
        return StateSet(names, domains, tuple(self._references), root)


class Supervisor(Immutable):
    """The starts that are safe: a start must lead from a safe state into one.

    `guards` says the same per ability, over few variables and for safe states only; an ability without an entry may
    always start. The safe set itself is what is enforced.
    """

    safe: StateSet
    guards: Mapping[str, StateSet]

    def allows(self, before: State, after: State) -> bool:
        """Return whether the start that leads from `before` to `after` is allowed."""
        return self.safe.includes(before) and self.safe.includes(after)
