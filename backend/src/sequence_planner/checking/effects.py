"""Effects of one device under the same condition that leave it in different states: a plan takes whichever suits it."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from sequence_planner.automaton.grounding.findings import without_arguments
from sequence_planner.automaton.structure import Automaton, Effect, target
from sequence_planner.checking.warning import ModelWarning, listed, place
from sequence_planner.expressions.syntax import conjuncts


def check_effects(automaton: Automaton) -> Iterator[ModelWarning]:
    """Pairs of effects with one condition, neither a fault, that write different values to a variable."""
    said: set[tuple[str, str]] = set()
    alike: dict[tuple[str, frozenset[object]], list[Effect]] = {}
    for effect in automaton.effects:
        if not effect.fault:
            alike.setdefault((effect.resource, frozenset(conjuncts(effect.guard))), []).append(effect)
    for effects in alike.values():
        for one, other in combinations(effects, 2):
            names = without_arguments(one.name), without_arguments(other.name)
            if names in said or not (variables := _contradictory(one, other)):
                continue
            said.add(names)
            message = (
                f"`{one.name}` and `{other.name}` happen under the same condition and write different values to "
                f"{listed(variables)}: a plan counts on whichever suits it. Let their conditions exclude each other, "
                "or mark the one that nobody is to count on with `fault: true`"
            )
            yield ModelWarning(place(automaton, other.name), "contradictory-effects", message)


def _contradictory(one: Effect, other: Effect) -> list[str]:
    """The variables to which both write, without a condition, and not the same."""
    written = {target(action): action for action in one.actions if action.condition is None}
    return [
        name
        for action in other.actions
        if action.condition is None and (name := target(action)) in written and written[name].value != action.value
    ]
