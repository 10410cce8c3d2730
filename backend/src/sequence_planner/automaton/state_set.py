"""A set of states as a table over the few variables it depends on.

This is how a supervisor is handed on: the controller looks states up in it, the planner turns it into clauses.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sequence_planner.automaton.structure import State
from sequence_planner.expressions.types import Value

Table = NDArray[np.bool_]


@dataclass(frozen=True)
class StateSet:
    """`table` has one axis for each of `names`, in that order; an axis is indexed by the position in the domain."""

    names: tuple[str, ...]
    domains: tuple[tuple[Value, ...], ...]
    table: Table

    def includes(self, state: State) -> bool:
        """Whether the set holds `state` for every value that its unknown variables could have."""
        index: list[Any] = []
        for name, domain in zip(self.names, self.domains, strict=True):
            value = state[name]
            index.append(slice(None) if value is None else domain.index(value))
        return bool(np.all(self.table[tuple(index)]))

    def for_all(self, unknown: frozenset[str]) -> StateSet:
        """The set over the other variables of what is included for every value of `unknown`."""
        axes = tuple(axis for axis, name in enumerate(self.names) if name in unknown)
        kept = [axis for axis in range(len(self.names)) if axis not in axes]
        return StateSet(
            tuple(self.names[axis] for axis in kept),
            tuple(self.domains[axis] for axis in kept),
            np.asarray(self.table.all(axis=axes)),
        )

    def reduced(self, care: Table) -> StateSet:
        """A set over fewer variables that agrees with this one wherever `care` is true.

        Variables are dropped greedily, the last declared first, as long as no two states that matter come to differ.
        """
        yes, no = self.table & care, ~self.table & care
        names, domains = list(self.names), list(self.domains)
        for axis in reversed(range(len(names))):
            some_yes, some_no = yes.any(axis=axis), no.any(axis=axis)
            if not (some_yes & some_no).any():
                yes, no = np.asarray(some_yes), np.asarray(some_no)
                del names[axis], domains[axis]
        return StateSet(tuple(names), tuple(domains), np.asarray(~no))

    def members(self) -> list[Mapping[str, Value]]:
        """Every state of the set, over its own variables."""
        return [
            {name: domain[i] for name, domain, i in zip(self.names, self.domains, index, strict=True)}
            for index in np.argwhere(self.table).tolist()
        ]


@dataclass(frozen=True)
class Supervisor:
    """Which starts are safe: a start must lead from a safe state into one.

    `guards` says the same per ability, over few variables and for safe states only; an ability without an entry may
    always start. The safe set itself is what is enforced.
    """

    safe: StateSet
    guards: Mapping[str, StateSet]

    def allows(self, before: State, after: State) -> bool:
        """Whether the start that leads from `before` to `after` is allowed."""
        return self.safe.includes(before) and self.safe.includes(after)
