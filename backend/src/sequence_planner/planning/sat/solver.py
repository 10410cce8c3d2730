"""SAT solver of the planner (Glucose 4.1), and Boolean circuits as clauses."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from itertools import repeat
from typing import Protocol

import pysolvers

from sequence_planner.process.budget import Budget

# Boolean circuits on a SAT solver: each gate is a literal, equal gates are one literal, constants are folded.
#
# Literals are non-zero integers, negated by sign. Gates are encoded in both directions (Tseitin 1968), so that a
# literal can be assumed either way, or later only in those that are needed.


class ClauseSink(Protocol):
    """The place where clauses go."""

    def add_clause(self, clause: list[int], /) -> object:
        """Add one clause."""


class Circuit:
    """Gates over the variables of one solver."""

    TRUE = 1
    FALSE = -1

    def __init__(self, sink: ClauseSink, later: bool = False) -> None:
        """With `later`, gates mean nothing to `sink` before somebody defines them."""
        self._add = sink.add_clause
        self._later = later
        self._top = 1
        self._gates: dict[tuple[int, ...], int] = {}
        self._add([self.TRUE])

    @property
    def gates(self) -> dict[tuple[int, ...], int]:
        """All gates by the literals of which each is the conjunction, parts before wholes."""
        return self._gates

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
            if not self._later:
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

    def exceeding(self, literals: Sequence[int], number: int) -> int:
        """A literal that is true wherever more than `number` of `literals` are, and may be elsewhere (Sinz 2005)."""
        if number >= len(literals):
            return self.FALSE
        more = self.fresh()
        before: list[int] = []  # that at least 1, 2 and so on of those so far are true, up to `number`
        for literal in literals:
            if number == 0:
                self.require(-literal, more)
                continue
            if len(before) == number:
                self.require(-before[-1], -literal, more)
            after = [self.fresh() for _ in range(min(len(before) + 1, number))]
            for one, same in zip(before, after, strict=False):
                self.require(-one, same)
            for fewer, one in zip((self.TRUE, *before), after, strict=False):
                self.require(-fewer, -literal, one)
            before = after
        return more


# The planner's SAT solver: Glucose 4.1 (Audemard and Simon 2009), as python-sat builds it.
#
# `pysat.solvers` wraps the same functions, but takes longer to import than many a question takes to answer.

# Conflicts within which most questions are answered; only longer ones are worth an alarm clock, which is a thread.
_AT_ONCE = 200
_SOON = 500  # within which it is worth while to wait for an answer without which there is another way


class Solver:
    """Clauses are added and questions asked in any order; what is learnt is kept."""

    def __init__(self) -> None:
        self._handle: object | None = pysolvers.glucose41_new()

    def __del__(self) -> None:
        self.close()

    def close(self) -> None:
        """Give the memory back; nothing else may follow."""
        if self._handle is not None:
            pysolvers.glucose41_del(self._handle)
            self._handle = None

    def add_clause(self, clause: Sequence[int]) -> None:
        """Demand that one of the literals is true."""
        pysolvers.glucose41_add_cl(self._handle, clause)

    def add_clauses(self, clauses: Iterable[Sequence[int]]) -> None:
        """Demand all of them."""
        # There are many, and this is the fastest way to exhaust an iterator.
        deque(map(pysolvers.glucose41_add_cl, repeat(self._handle), clauses), maxlen=0)

    def prefer(self, literals: Sequence[int]) -> None:
        """Try these literals true first, where nothing decides them."""
        pysolvers.glucose41_setphases(self._handle, literals)

    def solve(self, assumptions: Sequence[int], budget: Budget, soon: bool = False) -> bool | None:
        """Return whether the clauses can be satisfied under `assumptions`; None when the budget is spent before.

        Or, with `soon`, when it takes much longer than most questions do.
        """
        if budget.spent:
            return None
        pysolvers.glucose41_cbudget(self._handle, _SOON if soon else _AT_ONCE)
        answer = pysolvers.glucose41_solve_lim(self._handle, assumptions, 0, 0)
        if answer is not None or soon or budget.spent:
            return answer
        pysolvers.glucose41_cbudget(self._handle, -1)
        with budget.interrupting(self._interrupt):
            answer = pysolvers.glucose41_solve_lim(self._handle, assumptions, 0, 1)
        pysolvers.glucose41_clearint(self._handle)
        return answer

    def model(self) -> list[int]:
        """The literals that are true in the answer to the last question, which was yes."""
        return pysolvers.glucose41_model(self._handle) or []

    def core(self) -> list[int]:
        """The assumptions that made the answer to the last question no; others may be needless too."""
        return pysolvers.glucose41_core(self._handle) or []

    def _interrupt(self) -> None:
        pysolvers.glucose41_interrupt(self._handle)
