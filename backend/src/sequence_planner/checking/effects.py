"""Effects under the same condition that leave a device in different states: a plan takes whichever suits it."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from sequence_planner.automaton.grounding.findings import without_arguments
from sequence_planner.automaton.structure import Automaton, Effect, target
from sequence_planner.checking.satisfiability import UndecidedError, can_be_asked, differ, satisfying
from sequence_planner.checking.warning import ModelWarning, listed, place
from sequence_planner.expressions.syntax import conjuncts, variables


def check_effects(automaton: Automaton) -> Iterator[ModelWarning]:
    """Pairs of effects with one condition, neither a fault, that write different values to a variable."""
    said: set[tuple[str, str]] = set()
    alike: dict[frozenset[str], list[Effect]] = {}
    for effect in automaton.effects:
        if not effect.fault:
            alike.setdefault(frozenset(variables(effect.guard)), []).append(effect)
    for effects in alike.values():
        for one, other in combinations(effects, 2):
            names = without_arguments(one.name), without_arguments(other.name)
            if names in said or not (written := _contradictory(one, other)) or not _same(automaton, one, other):
                continue
            said.add(names)
            message = (
                f"`{one.name}` and `{other.name}` happen under the same condition and write different values to "
                f"{listed(written)}: a plan counts on whichever suits it. Let their conditions exclude each other, "
                "or mark the one that nobody is to count on with `fault: true`"
            )
            yield ModelWarning(place(automaton, other.name), "contradictory-effects", message)


def _same(automaton: Automaton, one: Effect, other: Effect) -> bool:
    """Whether the one happens exactly where the other does, however that is written."""
    if set(conjuncts(one.guard)) == set(conjuncts(other.guard)):
        return True
    if not can_be_asked(automaton, one.guard, other.guard):
        return False
    try:
        return not differ(automaton, one.guard, other.guard) and satisfying(automaton, one.guard) is not None
    except UndecidedError:
        return False


def _contradictory(one: Effect, other: Effect) -> list[str]:
    """The variables to which both write, without a condition, and not the same."""
    written = {target(action): action for action in one.actions if action.condition is None}
    return [
        name
        for action in other.actions
        if action.condition is None and (name := target(action)) in written and written[name].value != action.value
    ]
