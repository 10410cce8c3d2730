"""Boolean circuits on a SAT solver: each gate is a literal, equal gates are one literal, constants are folded.

Literals are non-zero integers, negated by sign. Gates are encoded in both directions (Tseitin 1968), so that a literal
can be assumed either way.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Protocol


class ClauseSink(Protocol):
    """Where clauses go."""

    def add_clause(self, clause: list[int], /) -> object:
        """Add one clause."""


class Circuit:
    """Gates over the variables of one solver."""

    TRUE = 1
    FALSE = -1

    def __init__(self, sink: ClauseSink) -> None:
        self._add = sink.add_clause
        self._top = 1
        self._gates: dict[tuple[int, ...], int] = {}
        self._add([self.TRUE])

    @property
    def top(self) -> int:
        """The highest variable in use."""
        return self._top

    def reserve(self, top: int) -> None:
        """Leave the variables up to `top` to others."""
        self._top = max(self._top, top)

    def fresh(self) -> int:
        """A new free variable."""
        self._top += 1
        return self._top

    def require(self, *literals: int) -> None:
        """Demand that at least one of `literals` is true."""
        if 1 not in literals:
            self._add([literal for literal in literals if literal != -1])

    def conjunction(self, literals: Iterable[int]) -> int:
        """The literal that is true exactly when all of `literals` are."""
        parts = set(literals)
        parts.discard(1)
        if -1 in parts:
            return -1
        if len(parts) < 2:
            return parts.pop() if parts else 1
        if not parts.isdisjoint([-part for part in parts]):
            return -1
        return self._gate(tuple(sorted(parts)))

    def both(self, one: int, other: int) -> int:
        """The conjunction of two."""
        if other in (one, 1):
            return one
        if one == 1:
            return other
        if -1 in (one, other) or one == -other:
            return -1
        return self._gate((one, other) if one < other else (other, one))

    def disjunction(self, literals: Iterable[int]) -> int:
        """The literal that is true exactly when one of `literals` is."""
        return -self.conjunction([-literal for literal in literals])

    def choice(self, condition: int, then: int, otherwise: int) -> int:
        """`then` where `condition` is true, else `otherwise`."""
        if then == otherwise or condition == 1:
            return then
        if condition == -1:
            return otherwise
        return -self.both(-self.both(condition, then), -self.both(-condition, otherwise))

    def _gate(self, parts: tuple[int, ...]) -> int:
        """The conjunction of at least two literals, in ascending order and none of them constant."""
        gate = self._gates.get(parts)
        if gate is None:
            self._top = gate = self._top + 1
            self._gates[parts] = gate
            for part in parts:
                self._add([-gate, part])
            self._add([gate, *[-part for part in parts]])
        return gate

    def at_most_one(self, literals: Sequence[int]) -> None:
        """Demand that no two of `literals` are true: each tells the next that one was (Sinz 2005)."""
        before = self.FALSE
        for literal in literals:
            self.require(-before, -literal)
            before = -self.both(-before, -literal)

    def counted(self, literals: Sequence[int], most: int) -> list[int]:
        """For each number from 1 to `most`, the literal that says that at least so many of `literals` are true.

        A tree of sums (Bailleux and Boufkhad 2003).
        """
        if len(literals) <= 1:
            return list(literals[:most])
        if most == 1:
            return [self.disjunction(literals)]
        middle = len(literals) // 2
        one, other = self.counted(literals[:middle], most), self.counted(literals[middle:], most)
        return [
            self.disjunction(
                self.both((one[i - 1] if i else self.TRUE), (other[total - i - 1] if total > i else self.TRUE))
                for i in range(max(total - len(other), 0), min(total, len(one)) + 1)
            )
            for total in range(1, min(len(one) + len(other), most) + 1)
        ]
