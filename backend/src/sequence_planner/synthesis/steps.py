"""The steps of an automaton over sets of states: where a step leads from some states, and from where it leads to them.

All writes are functions of the state, so a guarded update is split into cases that write constants: the states after it
are a quantification and a conjunction, those before it a cofactor, and no bits for values afterwards are needed. Only
an update of several values that depend on the state has such bits, and the `reaction` of a tick.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

from oxidd.util import BooleanOperator

from sequence_planner.automaton.structure import target
from sequence_planner.expressions.syntax import Assignment, Constant, Expression
from sequence_planner.expressions.types import Value
from sequence_planner.synthesis.diagrams import Diagrams, Function, Substitution, Values
from sequence_planner.synthesis.reading import Reader

_AND = BooleanOperator.AND


class Step(Protocol):
    """What can happen in one step. It touches no bit above the level `top`."""

    @property
    def top(self) -> int:
        """The first level that it reads or writes."""

    def after(self, states: Function) -> Function:
        """Where it can lead from `states`."""

    def before(self, states: Function) -> Function:
        """From where it can lead to `states`."""


@dataclass(frozen=True)
class Update:
    """Where `guard` holds, the bits `written` take the values of `values`."""

    guard: Function
    values: Function
    written: Function
    top: int

    def after(self, states: Function) -> Function:
        """Where it leads from `states`."""
        return states.apply_exists(_AND, self.guard, self.written) & self.values

    def before(self, states: Function) -> Function:
        """From where it leads to `states`."""
        return states.apply_exists(_AND, self.values, self.written) & self.guard


@dataclass(frozen=True)
class Stutter:
    """Where `guard` holds, nothing changes."""

    guard: Function
    top: int

    def after(self, states: Function) -> Function:
        """The same states."""
        return states & self.guard

    before = after


@dataclass(frozen=True)
class Change:
    """A relation between values now and values afterwards of some variables; the others stay what they are."""

    relation: Function
    now: Function
    afterwards: Function
    to_now: Substitution
    to_afterwards: Substitution
    top: int

    def after(self, states: Function) -> Function:
        """Where it leads from `states`."""
        return states.apply_exists(_AND, self.relation, self.now).substitute(self.to_now)

    def before(self, states: Function) -> Function:
        """From where it leads to `states`."""
        return states.substitute(self.to_afterwards).apply_exists(_AND, self.relation, self.afterwards)


def depends(actions: Iterable[Assignment]) -> list[str]:
    """The variables to which something is written that depends on the state."""
    return [target(a) for a in actions if a.condition is not None or not isinstance(a.value, Constant)]


def updates(
    diagrams: Diagrams, reader: Reader, guards: Iterable[Expression], actions: Iterable[Assignment]
) -> list[Step]:
    """A guarded update of those variables of `actions` that there are bits for.

    It is split into cases that write constants. Where several values depend on the state there would be a case for each
    combination of them, so then it is a relation, if there are bits for the values afterwards.
    """
    guard = diagrams.conjunction(map(reader.predicate, guards))
    written = [action for action in actions if target(action) in diagrams.bits]
    if len(depends(written)) > 1 and all(target(action) in diagrams.bits_after for action in written):
        return [_change(diagrams, reader, guard, written)]
    steps: list[Step] = []
    for where, values in _cases(diagrams, reader, written, guard):
        if not values:
            steps.append(Stutter(where, diagrams.top([where])))
            continue
        where &= diagrams.valid_of(values)
        bits = [bit for name in values for bit in diagrams.bits[name]]
        constants = diagrams.conjunction(diagrams.values(name)[value] for name, value in values.items())
        steps.append(Update(where, constants, diagrams.cube(bits), diagrams.top([where], bits)))
    return steps


def _change(diagrams: Diagrams, reader: Reader, guard: Function, actions: Sequence[Assignment]) -> Change:
    names = [target(action) for action in actions]
    relation = guard & diagrams.valid_of(names)
    for action in actions:
        name = target(action)
        becomes = same(diagrams, reader.values(action.value), diagrams.values_after(name))
        if action.condition is not None:
            stays = same(diagrams, diagrams.values(name), diagrams.values_after(name))
            becomes = reader.predicate(action.condition).ite(becomes, stays)
        relation &= becomes
    now = [bit for name in names for bit in diagrams.bits[name]]
    afterwards = [bit for name in names for bit in diagrams.bits_after[name]]
    return Change(
        relation,
        diagrams.cube(now),
        diagrams.cube(afterwards),
        diagrams.substitution(zip(afterwards, map(diagrams.bit, now), strict=True)),
        diagrams.substitution(zip(now, map(diagrams.bit, afterwards), strict=True)),
        diagrams.top([relation], now),
    )


def _cases(
    diagrams: Diagrams, reader: Reader, actions: Sequence[Assignment], guard: Function
) -> Iterator[tuple[Function, dict[str, Value]]]:
    """Where which constants are written."""
    if not guard.satisfiable():
        return
    if not actions:
        yield guard, {}
        return
    action, rest = actions[0], actions[1:]
    if action.condition is not None:
        applies = reader.predicate(action.condition)
        yield from _cases(diagrams, reader, rest, guard & ~applies)
        guard &= applies
    domain = diagrams.domains[target(action)]
    for value, where in reader.values(action.value).items():
        if value in domain:
            for inner, values in _cases(diagrams, reader, rest, guard & where):
                yield inner, {**values, target(action): value}


@dataclass(frozen=True)
class Flip:
    """A truth value changes: an operation becomes active, or is so no longer."""

    other: Substitution
    top: int

    def after(self, states: Function) -> Function:
        """The states that differ by the truth value."""
        return states.substitute(self.other)

    before = after


def same(diagrams: Diagrams, one: Values, other: Values) -> Function:
    """Where two have the same value."""
    return diagrams.disjunction(where & other[value] for value, where in one.items() if value in other)
