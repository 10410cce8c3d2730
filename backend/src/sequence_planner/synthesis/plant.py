"""All states of the relevant variables, and the steps between them: what the environment can do, and what we may start.

A state is its index in the product of the domains, in row-major order of `names`. Flags are functions of it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import prod

import numpy as np
from numpy.typing import NDArray

from sequence_planner.automaton.structure import Ability, Automaton, Effect, Kind, State, target
from sequence_planner.expressions.syntax import Assignment, Expression
from sequence_planner.expressions.types import BOOLEAN, Value
from sequence_planner.synthesis.vectorised import Column, Columns, Mask, Numbering, Writes

Indices = NDArray[np.int64]


@dataclass(frozen=True)
class Steps:
    """Steps from state `source[i]` to state `target[i]`."""

    source: Indices
    target: Indices


class Plant:
    """The states over `names` and the steps between them."""

    def __init__(self, automaton: Automaton, names: Sequence[str]) -> None:
        self.automaton = automaton
        self.names = tuple(names)
        self.domains: tuple[tuple[Value, ...], ...] = tuple(automaton.variables[n].type.domain for n in names)
        self.shape = tuple(map(len, self.domains))
        self.size = prod(self.shape)
        self._numbering = Numbering()
        self._strides = dict(
            zip(self.names, (prod(self.shape[axis + 1 :]) for axis in range(len(self.shape))), strict=True)
        )
        self._numbers = {
            name: np.array([self._numbering.number(value) for value in domain], dtype=np.int32)
            for name, domain in zip(self.names, self.domains, strict=True)
        }
        self._columns = self._all_columns()
        self._with_flags = self._synchronised(self._columns, self.size)

    def index(self, values: dict[str, Value]) -> int:
        """The index of the state with these values."""
        position = [domain.index(values[name]) for name, domain in zip(self.names, self.domains, strict=True)]
        return int(np.ravel_multi_index(position, self.shape)) if position else 0

    def state(self, index: int) -> dict[str, Value]:
        """The values of the state with this index."""
        position = np.unravel_index(index, self.shape) if self.shape else ()
        return {n: d[int(i)] for n, d, i in zip(self.names, self.domains, position, strict=True)}

    def where(self, predicate: Expression) -> Mask:
        """The states in which `predicate` holds."""
        return self._numbering.mask((predicate,), self._with_flags, self.size)

    def uncontrollable(self, faults: bool) -> Steps:
        """What happens without us. With `faults`, effects marked as faults may be among it.

        Steps 1 to 3 of the tick, with every set of compatible effects that is enabled, the empty one included; and step
        4, of which any outcome is possible: the activity of any operation changes by itself. In a plain automaton, each
        effect alone.
        """
        effects = [e for e in self.automaton.effects if (faults or not e.fault) and self._concerned(e)]
        everywhere = np.arange(self.size, dtype=np.int64)
        if self.automaton.one_at_a_time:
            return _joined(self._taken((effect.guard,), effect.actions) for effect in effects)
        senses = (Steps(s, self._finished(s, sensed)) for s, sensed in self._effect_sets(effects, everywhere, {}))
        return _joined((*senses, *self._activity_changes(everywhere)))

    def conflicting_finishes(self, one: Ability, other: Ability, variable: str, within: Mask) -> State | None:
        """What two abilities see when both finish, after a step from `within`, and would write `variable` differently.

        Variables are as just measured, flags as before.
        """
        effects = [e for e in self.automaton.effects if self._concerned(e)]
        for source, sensed in self._effect_sets(effects, np.flatnonzero(within).astype(np.int64), {}):
            before = self._at(source)
            columns = {**before, **_applied(before, sensed)}
            found = {a.name: (taken, writes) for a, taken, writes in self._finishing(columns, len(source))}
            (first, first_writes), (second, second_writes) = found[one.name], found[other.name]
            (writes, value), (other_writes, other_value) = first_writes[variable], second_writes[variable]
            where = np.flatnonzero(first & second & writes & other_writes & (value != other_value))
            if len(where):
                return self._seen(columns, int(where[0]))
        return None

    def starts(self, ability: Ability) -> Steps:
        """The start of `ability`, followed by synchronisation."""
        return self._taken((ability.enabled, ability.start_guard), ability.start_actions)

    def _all_columns(self) -> dict[str, Column]:
        if not self.names:
            return {}
        grid = np.unravel_index(np.arange(self.size), self.shape)
        return {name: self._numbers[name][axis] for name, axis in zip(self.names, grid, strict=True)}

    def _synchronised(self, columns: Columns, length: int) -> dict[str, Column]:
        """`columns` and those flags that depend on the relevant variables only."""
        after = dict(columns)
        for flag in self.automaton.flags:
            try:
                after[flag.name] = self._numbering.evaluate(flag.predicate, after, length)
            except KeyError:
                continue  # it reads a variable outside, so nothing here reads it
        return after

    def _taken(self, guards: Iterable[Expression], actions: Iterable[Assignment]) -> Steps:
        source = np.flatnonzero(self._numbering.mask(guards, self._with_flags, self.size)).astype(np.int64)
        columns = self._at(source)
        writes = self._numbering.writes(actions, columns, len(source), self.names)
        return Steps(source, self._moved(source, columns, _applied(columns, writes)))

    def _activity_changes(self, source: Indices) -> Iterator[Steps]:
        """An operation becomes active, or is so no longer; one at a time, as several are several such steps."""
        for name in self.automaton.names(Kind.ACTIVITY):
            if name in self._strides:
                stride = self._strides[name]
                yield Steps(source, np.where(source // stride % len(BOOLEAN.domain), source - stride, source + stride))

    def _concerned(self, effect: Effect) -> bool:
        return any(target(action) in self._strides for action in effect.actions)

    def _at(self, source: Indices) -> dict[str, Column]:
        return {name: column[source] for name, column in self._with_flags.items()}

    def _seen(self, columns: Columns, position: int) -> State:
        """The values at one position of `columns`."""
        seen: dict[str, Value | None] = {name: bool(column[position]) for name, column in columns.items()}
        for name, domain in zip(self.names, self.domains, strict=True):
            (at,) = np.flatnonzero(self._numbers[name] == columns[name][position])
            seen[name] = domain[int(at)]
        return seen

    def _effect_sets(
        self, effects: Sequence[Effect], source: Indices, chosen: Writes
    ) -> Iterator[tuple[Indices, Writes]]:
        """`chosen` alone, and with each compatible choice among `effects` beside it, each with its states."""
        if not len(source):
            return
        if not effects:
            yield source, chosen
            return
        first, rest = effects[0], effects[1:]
        yield from self._effect_sets(rest, source, chosen)
        columns = self._at(source)
        writes = self._numbering.writes(first.actions, columns, len(source), self.names)
        taken = self._numbering.mask((first.guard,), columns, len(source)) & ~_conflict(chosen, writes, len(source))
        together = _together(chosen, writes)
        yield from self._effect_sets(rest, source[taken], {n: (w[taken], v[taken]) for n, (w, v) in together.items()})

    def _finished(self, source: Indices, sensed: Writes) -> Indices:
        """Step 2 after the measured values of `sensed`: guards see the flags of the state before."""
        before = self._at(source)
        columns = {**before, **_applied(before, sensed)}
        length = len(source)
        finishing = [(taken, writes) for _, taken, writes in self._finishing(columns, length)]
        refused = [np.zeros(length, dtype=np.bool_) for _ in finishing]
        for i, (one, first) in enumerate(finishing):
            for j, (other, second) in enumerate(finishing[:i]):
                conflict = one & other & _conflict(first, second, length)
                refused[i] |= conflict
                refused[j] |= conflict
        together = sensed
        for (taken, writes), no in zip(finishing, refused, strict=True):
            together = _together(together, {n: (w & taken & ~no, v) for n, (w, v) in writes.items()})
        return self._moved(source, before, _applied(before, together))

    def _finishing(self, columns: Columns, length: int) -> list[tuple[Ability, Mask, Writes]]:
        """Where each ability finishes, and what it writes then."""
        return [
            (
                ability,
                self._numbering.mask((ability.finish_guard,), columns, length),
                self._numbering.writes(ability.finish_actions, columns, length, self.names),
            )
            for ability in self.automaton.abilities.values()
            if ability.finish_guard is not None
            and any(target(action) in self._strides for action in ability.finish_actions)
        ]

    def _moved(self, source: Indices, before: Columns, after: Columns) -> Indices:
        """The states that differ from those of `source` by the values of `after`."""
        moved = source.copy()
        for name, column in after.items():
            numbers = self._numbers[name]
            order = np.argsort(numbers)
            axis, axis_before = (order[np.searchsorted(numbers, c, sorter=order)] for c in (column, before[name]))
            moved += self._strides[name] * (axis - axis_before)
        return moved


def _joined(parts: Iterable[Steps]) -> Steps:
    """All of them, and none of none."""
    nothing = np.zeros(0, dtype=np.int64)
    steps = list(parts)
    return Steps(
        np.concatenate([nothing, *(each.source for each in steps)]),
        np.concatenate([nothing, *(each.target for each in steps)]),
    )


def _conflict(first: Writes, second: Writes, length: int) -> Mask:
    """Where the two would write different values to one variable."""
    conflict: Mask = np.zeros(length, dtype=np.bool_)
    for name in first.keys() & second.keys():
        (where, value), (other_where, other_value) = first[name], second[name]
        conflict |= where & other_where & (value != other_value)
    return conflict


def _together(first: Writes, second: Writes) -> Writes:
    """Both, where they do not conflict."""
    merged = dict(first)
    for name, (where, value) in second.items():
        if name in first:
            other_where, other_value = first[name]
            merged[name] = (where | other_where, np.where(where, value, other_value))
        else:
            merged[name] = (where, value)
    return merged


def _applied(before: Columns, writes: Writes) -> dict[str, Column]:
    """The values of the written variables afterwards."""
    return {name: np.where(where, value, before[name]) for name, (where, value) in writes.items()}
