"""Whether two transitions can happen at once: would they write different values, does one say all that both do.

Both are decided by trying all values of the variables concerned; beyond a number of them the answer is the careful one.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from math import prod

from sequence_planner.automaton.structure import target
from sequence_planner.automaton.tick import Writes, writes
from sequence_planner.automaton.transitions import Transition
from sequence_planner.expressions.evaluation import holds
from sequence_planner.expressions.syntax import Constant, Expression, occurrences

_MOST_VALUATIONS = 5000


def can_dispute(one: Transition, other: Transition) -> bool:
    """Whether both may be enabled and write different values to one variable."""
    shared = one.writes & other.writes
    if not shared or all(_constant(one, name) == _constant(other, name) is not None for name in shared):
        return False
    pairs = _pairs(one, other)
    return pairs is None or any(not _agree(first, second) for first, second in pairs)


def one_suffices(one: Transition, other: Transition) -> bool:
    """Whether what both do together, where they can, one of them does alone."""
    if one.writes == other.writes and len(one.writes) == 1:
        return True
    pairs = _pairs(one, other)
    if pairs is None:
        return False
    return all(
        not _agree(first, second) or first.items() <= second.items() or second.items() <= first.items()
        for first, second in pairs
    )


def _agree(first: Writes, second: Writes) -> bool:
    return all(first[name] == second[name] for name in first.keys() & second.keys())


def _constant(transition: Transition, name: str) -> Constant | None:
    """The constant that it always writes to the variable, if there is one."""
    values = [a.value if a.condition is None else None for a in transition.actions if target(a) == name]
    return values[0] if len(values) == 1 and isinstance(values[0], Constant) else None


def _pairs(one: Transition, other: Transition) -> Iterator[tuple[Writes, Writes]] | None:
    """What each writes, wherever both are enabled; None if there are too many valuations. Flags can be anything."""
    domains = {
        variable.name: variable.type.domain
        for transition in (one, other)
        for expression in _expressions(transition)
        for variable in occurrences(expression)
    }
    if prod(map(len, domains.values())) > _MOST_VALUATIONS:
        return None
    return _enabled_pairs(one, other, domains)


def _enabled_pairs(
    one: Transition, other: Transition, domains: dict[str, tuple[bool | int | str, ...]]
) -> Iterator[tuple[Writes, Writes]]:
    for values in product(*domains.values()):
        valuation = dict(zip(domains, values, strict=True))
        if holds(one.guard, valuation) and holds(other.guard, valuation):
            first, second = writes(one.actions, valuation), writes(other.actions, valuation)
            assert first is not None
            assert second is not None
            yield first, second


def _expressions(transition: Transition) -> Iterator[Expression]:
    yield transition.guard
    for action in transition.actions:
        yield action.value
        if action.condition is not None:
            yield action.condition
