"""One order of starts for a tick in which most that can start together find their places.

Who sets what another waits for comes before it, and who sets what keeps another from starting comes after it. Circles
are broken somewhere, at the price that some starts wait for the next tick.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping

from sequence_planner.automaton.structure import Ability, Automaton, target
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import Constant, Expression, conjunction, variables
from sequence_planner.expressions.types import Value
from sequence_planner.planning.known import Known, equalities


def likely_order(part: Automaton) -> tuple[Ability, ...]:
    """Each ability of `part` once."""
    before = _before(part.abilities)
    ordered: dict[str, Ability] = {}
    visited: set[str] = set()
    pending = [(name, False) for name in reversed(tuple(part.abilities))]
    while pending:
        name, done = pending.pop()
        if done:
            ordered[name] = part.abilities[name]
        elif name not in visited:
            visited.add(name)
            pending.append((name, True))
            pending += [(earlier, False) for earlier in before[name]]
    return tuple(ordered.values())


def _before(abilities: Mapping[str, Ability]) -> dict[str, dict[str, None]]:
    """For each ability those that should have their place before it."""
    guards = {name: conjunction(ability.enabled, ability.start_guard) for name, ability in abilities.items()}
    readers: dict[str, list[str]] = defaultdict(list)
    for name, guard in guards.items():
        for variable in dict.fromkeys(variables(guard)):
            readers[variable].append(name)
    before: dict[str, dict[str, None]] = {name: {} for name in abilities}
    for name, ability in abilities.items():
        written = set(map(target, ability.start_actions))
        for action in ability.start_actions:
            variable = target(action)
            for reader in readers[variable]:
                if reader == name:
                    continue
                if isinstance(action.value, Constant) and _excludes(guards[reader], variable, action.value.value):
                    before[name][reader] = None
                elif not any(n not in written and _excludes(guards[name], n, v) for n, v in equalities(guards[reader])):
                    before[reader][name] = None
    return before


def _excludes(guard: Expression, variable: str, value: Value) -> bool:
    """Whether `guard` cannot hold while the variable has that value."""
    return evaluate(guard, Known({variable: value})) is False
