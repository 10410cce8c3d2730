"""The check whether what an action writes is a value of its target.

`count := count + 1` leaves the range 0..3 of `count` unless a guard or a condition says `count < 3`. Where an action
must fit for certain, `misfit` finds a state in which it does not; where an update out of range disables its transition,
as in a plain automaton, `fits_condition` is what to ask before.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import product
from math import prod
from typing import TYPE_CHECKING

from sequence_planner.core.immutable import Immutable
from sequence_planner.language.evaluator import evaluate, holds
from sequence_planner.language.printer import print_assignment, print_value
from sequence_planner.language.syntax import (
    FALSE,
    TRUE,
    Arithmetic,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Membership,
    Variable,
    conjunction,
    conjuncts,
    occurrences,
    variables,
)
from sequence_planner.language.types import EnumerationType, IntegerRange, Type, Value, contains
from sequence_planner.texts.late import message

if TYPE_CHECKING:
    from sequence_planner.texts.message import Message

# How many combinations of values are tried; beyond them, conditions are left out.
MOST_COMBINATIONS = 20_000

_Domains = Mapping[str, tuple[Value, ...]]


class Misfit(Immutable):
    """A state in which an action is taken and writes `value`, which is outside the target's domain.

    `valuation` gives the variables on which that depends; it is empty where there were too many of them to find such a
    state, and `value` is then a bound.
    """

    action: Assignment
    valuation: Mapping[str, Value]
    value: Value

    def __str__(self) -> str:
        return str(self.in_words())

    def in_words(self) -> Message:
        """It, as people are told."""
        target = self.action.target
        state = " and ".join(f"{name} == {print_value(value)}" for name, value in self.valuation.items())
        domain = str(target.type) if isinstance(target, Variable) else "its domain"
        said = {"action": print_assignment(self.action), "value": print_value(self.value), "domain": domain}
        return message("wrong.may-write-where", **said, state=state) if state else message("wrong.may-write", **said)


def misfit(action: Assignment, guard: Expression) -> Misfit | None:
    """A state in which `guard` holds and the resolved `action` is taken and writes no value of its target's domain.

    None means that there is no such state. The answer is exact but for conditions left out because they read too many
    variables beside those of the value: then a misfit may be reported that they rule out, and never one overlooked.
    """
    type_ = _target(action).type
    if _always_fits(action.value, type_):
        return None
    conditions = [*conjuncts(guard), *(() if action.condition is None else conjuncts(action.condition))]
    read = {part: frozenset(variables(part)) for part in conditions}
    types = {v.name: v.type for part in (action.value, *conditions) for v in occurrences(part)}
    domains = {name: narrowed(name, type_, read) for name, type_ in types.items()}
    chosen = dict.fromkeys(variables(action.value))
    if isinstance(action.value, Arithmetic) and _combinations(chosen, domains) > MOST_COMBINATIONS:
        bounds = _bounds(action.value, domains)
        return next((Misfit(action, {}, bound) for bound in bounds if not contains(type_, bound)), None)
    together = _connected(chosen, read, domains)
    for valuation in _valuations(together, domains):
        value = evaluate(action.value, valuation)
        if value is None or contains(type_, value):
            continue
        if all(holds(part, valuation) for part, names in read.items() if names <= together.keys()):
            return Misfit(action, valuation, value)
    return None


def fits_condition(action: Assignment) -> Expression:
    """The predicate that is true where the value of the resolved `action` is in its target's domain."""
    value, type_ = action.value, _target(action).type
    if _always_fits(value, type_):
        return TRUE
    if isinstance(value, Constant):
        return FALSE
    if isinstance(type_, EnumerationType):
        possible = value.type.domain if isinstance(value, Variable) else ()
        common = tuple(Constant(name) for name in possible if name in type_.values)
        return Membership(value, common) if common else FALSE
    assert isinstance(type_, IntegerRange)
    least, most = _bounds(value, _extremes(value))
    if most < type_.minimum or least > type_.maximum:
        return FALSE
    return conjunction(
        Comparison(">=", value, Constant(type_.minimum)) if least < type_.minimum else TRUE,
        Comparison("<=", value, Constant(type_.maximum)) if most > type_.maximum else TRUE,
    )


def _target(action: Assignment) -> Variable:
    if not isinstance(action.target, Variable):
        raise TypeError(f"unresolved name {action.target}")
    return action.target


def _always_fits(value: Expression, type_: Type) -> bool:
    match value:
        case Constant(constant):
            return contains(type_, constant)
        case Variable(_, IntegerRange(least, most)) if isinstance(type_, IntegerRange):
            return type_.minimum <= least and most <= type_.maximum
        case Variable(_, EnumerationType(values)) if isinstance(type_, EnumerationType):
            return values == type_.values or set(values) <= set(type_.values)
        case Arithmetic():
            return all(contains(type_, bound) for bound in _bounds(value, _extremes(value)))
        case _:
            return True  # a truth value


def _extremes(value: Expression) -> _Domains:
    """The least and the most of each integer that `value` reads."""
    ranges = ((variable.name, variable.type) for variable in occurrences(value))
    return {name: (type_.minimum, type_.maximum) for name, type_ in ranges if isinstance(type_, IntegerRange)}


def _bounds(value: Expression, domains: _Domains) -> tuple[int, int]:
    """The least and the most that an integer can be: interval arithmetic."""
    match value:
        case Arithmetic(sign, left, right):
            (a, b), (c, d) = _bounds(left, domains), _bounds(right, domains)
            return (a + c, b + d) if sign == "+" else (a - d, b - c)
        case Variable(name):
            numbers = [int(number) for number in domains[name]]
            return min(numbers), max(numbers)
        case Constant(constant):
            return int(constant), int(constant)
        case _:
            raise TypeError(f"{value} is no integer")


def narrowed(name: str, type_: Type, read: Mapping[Expression, frozenset[str]]) -> tuple[Value, ...]:
    """The values of a variable that the conditions on it alone admit."""
    alone = [part for part, names in read.items() if names == {name}]
    return tuple(value for value in type_.domain if all(holds(part, {name: value}) for part in alone))


def _connected(
    chosen: Mapping[str, None], read: Mapping[Expression, frozenset[str]], domains: _Domains
) -> dict[str, None]:
    """`chosen` and what is connected with it by conditions, as far as the combinations remain few."""
    together = dict(chosen)
    grown = True
    while grown:
        grown = False
        for names in sorted(read.values(), key=lambda names: _combinations(names, domains)):
            more = [name for name in domains if name in names and name not in together]
            if len(more) == len(names) or not more:
                continue
            if _combinations([*together, *more], domains) <= MOST_COMBINATIONS:
                together |= dict.fromkeys(more)
                grown = True
    return together


def _combinations(names: Iterable[str], domains: _Domains) -> int:
    return prod(len(domains[name]) for name in names)


def _valuations(names: Iterable[str], domains: _Domains) -> Iterator[dict[str, Value]]:
    ordered = list(names)
    for values in product(*(domains[name] for name in ordered)):
        yield dict(zip(ordered, values, strict=True))
