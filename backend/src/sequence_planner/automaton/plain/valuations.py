"""Valuations that satisfy a predicate, without looking at every combination of values.

Conjuncts on one variable narrow its domain. The variables left open are given values one after another, and a choice is
given up as soon as a conjunct is false whatever comes after it (three-valued evaluation).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from sequence_planner.language.evaluator import Valuation, evaluate
from sequence_planner.language.fitting import narrowed
from sequence_planner.language.syntax import Expression, conjuncts, variables
from sequence_planner.language.types import Type, Value

MOST_CHOICES = 20_000


class TooEntangledError(Exception):
    """The search was given up: the predicate relates too many variables."""


def valuations_of(predicate: Expression, types: Mapping[str, Type]) -> Iterator[dict[str, Value]]:
    """The valuations of all variables of `types` that satisfy `predicate`, each once, earlier values first.

    Raises `TooEntangledError` after `MOST_CHOICES` choices since the last valuation.
    """
    read = {part: frozenset(variables(part)) for part in conjuncts(predicate)}
    domains = {name: narrowed(name, type_, read) for name, type_ in types.items()}
    if not all(domains.values()):
        return
    open_ = [name for name, domain in domains.items() if len(domain) > 1]
    decided = {name: domain[0] for name, domain in domains.items() if len(domain) == 1}
    undecided: dict[str, Value | None] = dict.fromkeys(open_)
    pending: list[tuple[Value, ...]] = [()]
    choices = 0
    while pending:
        chosen = pending.pop()
        choices += 1
        if choices > MOST_CHOICES:
            raise TooEntangledError
        given: dict[str, Value] = decided | dict(zip(open_, chosen, strict=False))
        valuation: Valuation = undecided | given
        last = open_[len(chosen) - 1] if chosen else None
        if any(evaluate(part, valuation) is False for part, names in read.items() if last is None or last in names):
            continue
        if len(chosen) < len(open_):
            pending.extend((*chosen, value) for value in reversed(domains[open_[len(chosen)]]))
            continue
        choices = 0
        yield {name: given[name] for name in types}
