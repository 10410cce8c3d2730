"""Reachability with nothing ever undone: each variable gathers values, and never loses one.

Whatever the station can do, the relaxation can. A goal it cannot reach can never be reached, which is a proof that
there is no plan at all; this is the delete relaxation of planning (Bonet and Geffner 2001) over finite domains.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import product

from sequence_planner.automaton.structure import Automaton, State, target
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import And, Assignment, Expression, Not, Or, variables
from sequence_planner.expressions.types import Value

Possible = dict[str, set[Value | None]]

# An expression over more combinations than this is not evaluated: it may have any value, so the relaxation stays sound.
_MOST_COMBINATIONS = 4096


def unreachable_goals(automaton: Automaton, state: State, goals: Iterable[str]) -> frozenset[str]:
    """Those of the operations `goals` whose goal no run from `state` can ever reach."""
    possible: Possible = {name: {value} for name, value in state.items()}
    transitions: list[tuple[tuple[Expression, ...], tuple[Assignment, ...]]] = [
        ((effect.guard,), effect.actions) for effect in automaton.effects if not effect.fault
    ]
    for ability in automaton.abilities.values():
        if not ability.restart:
            transitions.append(((ability.enabled, ability.start_guard), ability.start_actions))
        if ability.finish_guard is not None:
            transitions.append(((ability.finish_guard,), ability.finish_actions))
    grown = True
    while grown:
        grown = False
        for guards, actions in transitions:
            if all(_may(guard, True, possible) for guard in guards):
                for action in actions:
                    grown |= _gather(automaton, action, possible)
        for flag in automaton.flags:
            for truth in (True, False):
                if truth not in possible[flag.name] and _may(flag.predicate, truth, possible):
                    possible[flag.name].add(truth)
                    grown = True
    return frozenset(goal for goal in goals if not _may(automaton.operations[goal].goal, True, possible))


def _gather(automaton: Automaton, action: Assignment, possible: Possible) -> bool:
    """Add what `action` can write; whether anything was new."""
    if action.condition is not None and not _may(action.condition, True, possible):
        return False
    name = target(action)
    if possible[name] == {None}:
        return False  # the planner keeps an unknown variable unknown
    values = _values(action.value, possible)
    if values is None:
        values = set(automaton.variables[name].type.domain)
    new = values - {None} - possible[name]
    possible[name] |= new
    return bool(new)


def _may(predicate: Expression, truth: bool, possible: Mapping[str, set[Value | None]]) -> bool:
    """Whether some choice of possible values may give `predicate` the value `truth`."""
    match predicate:
        case Not(operand):
            return _may(operand, not truth, possible)
        case And(operands):
            decide = all if truth else any
            return decide(_may(part, truth, possible) for part in operands)
        case Or(operands):
            decide = any if truth else all
            return decide(_may(part, truth, possible) for part in operands)
    values = _values(predicate, possible)
    return values is None or truth in values


def _values(expression: Expression, possible: Mapping[str, set[Value | None]]) -> set[Value | None] | None:
    """What `expression` may be; None when there are too many combinations to say."""
    names = sorted(set(variables(expression)))
    combinations = 1
    for name in names:
        combinations *= len(possible[name])
    if combinations > _MOST_COMBINATIONS:
        return None
    return {
        evaluate(expression, dict(zip(names, values, strict=True)))
        for values in product(*(possible[name] for name in names))
    }
