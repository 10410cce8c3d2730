"""Transitions whose actions are conditional, in cases without conditions; and finishes that dispute a variable."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

from sequence_planner.automaton.automaton import target
from sequence_planner.automaton.plain.updates import decided
from sequence_planner.automaton.transitions import Transition
from sequence_planner.language.simplifier import simplify, simplify_assignment
from sequence_planner.language.substitution import Replacements, replaced, replaced_in_action
from sequence_planner.language.syntax import (
    FALSE,
    TRUE,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Not,
    Or,
    Variable,
    conjunction,
)


def condition_of(action: Assignment, seen: Replacements) -> Expression:
    """Return where an action applies."""
    return TRUE if action.condition is None else replaced(action.condition, seen)


def cases(transition: Transition, seen: Replacements) -> Iterator[tuple[Expression, tuple[Assignment, ...]]]:
    """The transition without conditional actions: a guard, and what is written, for all that can apply."""
    guard = replaced(transition.guard, seen)
    actions = [simplify_assignment(replaced_in_action(action, seen)) for action in transition.actions]
    conditions = list(dict.fromkeys(action.condition for action in actions if action.condition is not None))
    for truths in product((True, False), repeat=len(conditions)):
        holding = [c for c, truth in zip(conditions, truths, strict=True) if truth]
        others = [Not(c) for c, truth in zip(conditions, truths, strict=True) if not truth]
        case = simplify(conjunction(guard, *holding, *others))
        if case != FALSE:
            taken = (a for a in actions if a.condition is None or a.condition in holding)
            yield case, tuple(Assignment(a.target, a.value) for a in taken)


def leaves(action: Assignment) -> Expression:
    """That an action leaves its target as it is."""
    assert isinstance(action.target, Variable)
    return _equal(action.target, action.value)


def _equal(one: Expression, other: Expression) -> Expression:
    if isinstance(other, Constant) and isinstance(other.value, bool):
        return one if other.value else Not(one)
    return decided(Comparison("==", one, other))


def no_dispute(finish: Transition, other: Transition, seen: Replacements) -> Expression:
    """That `other` does not finish with it, or does not write differently."""
    differently: list[Expression] = []
    values = {target(action): action for action in other.actions}
    for action in finish.actions:
        if (against := values.get(target(action))) is not None:
            first, second = replaced(action.value, seen), replaced(against.value, seen)
            both = conjunction(condition_of(action, seen), condition_of(against, seen))
            differently.append(conjunction(both, Not(_same(first, second))))
    return Not(conjunction(replaced(other.guard, seen), Or((FALSE, *differently))))


def _same(one: Expression, other: Expression) -> Expression:
    if isinstance(one, Constant) and isinstance(other, Constant):
        return Constant(one.value == other.value)
    return _equal(other, one) if isinstance(one, Constant) else _equal(one, other)
