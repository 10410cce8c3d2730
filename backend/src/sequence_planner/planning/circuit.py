"""Boolean circuits on a SAT solver: each gate is a literal, equal gates are one literal, constants are folded.

Literals are non-zero integers, negated by sign. Gates are encoded in both directions (Tseitin 1968), so that a literal
can be assumed either way.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Protocol


class ClauseSink(Protocol):
    """Where clauses go."""

    def add_clause(self, clause: Sequence[int]) -> object:
        """Add one clause."""


class Circuit:
    """Gates over the variables of one solver."""

    TRUE = 1
    FALSE = -1

    def __init__(self, sink: ClauseSink) -> None:
        self._sink = sink
        self._top = 1
        self._gates: dict[tuple[int, ...], int] = {}
        sink.add_clause([self.TRUE])

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
        if self.TRUE not in literals:
            self._sink.add_clause([literal for literal in literals if literal != self.FALSE])

    def conjunction(self, literals: Iterable[int]) -> int:
        """The literal that is true exactly when all of `literals` are."""
        parts = sorted(set(literals) - {self.TRUE})
        if self.FALSE in parts or any(-part in parts for part in parts if part > 0):
            return self.FALSE
        if len(parts) < 2:
            return parts[0] if parts else self.TRUE
        key = tuple(parts)
        if key not in self._gates:
            gate = self._gates[key] = self.fresh()
            for part in parts:
                self._sink.add_clause([-gate, part])
            self._sink.add_clause([gate, *(-part for part in parts)])
        return self._gates[key]

    def disjunction(self, literals: Iterable[int]) -> int:
        """The literal that is true exactly when one of `literals` is."""
        return -self.conjunction(-literal for literal in literals)

    def choice(self, condition: int, then: int, otherwise: int) -> int:
        """`then` where `condition` is true, else `otherwise`."""
        if then == otherwise or condition == self.TRUE:
            return then
        if condition == self.FALSE:
            return otherwise
        return self.disjunction((self.conjunction((condition, then)), self.conjunction((-condition, otherwise))))
