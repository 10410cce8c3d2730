"""One order of starts for a tick in which most that can start together find their places.

Who sets what another waits for comes before it, and who sets what keeps another from starting comes after it. Circles
are broken somewhere, at the price that some starts wait for the next tick.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping

from sequence_planner.automaton.structure import Ability, Automaton, target
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import Constant, Expression, conjunction, conjuncts, variables
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
    guards = {name: _Guard(conjunction(ability.enabled, ability.start_guard)) for name, ability in abilities.items()}
    readers: dict[str, list[str]] = defaultdict(list)
    for name, guard in guards.items():
        for variable in guard.reading:
            readers[variable].append(name)
    before: dict[str, dict[str, None]] = {name: {} for name in abilities}
    for name, ability in abilities.items():
        written = set(map(target, ability.start_actions))
        for action in ability.start_actions:
            variable = target(action)
            for reader in readers[variable]:
                if reader == name:
                    continue
                if isinstance(action.value, Constant) and guards[reader].excludes(variable, action.value.value):
                    before[name][reader] = None
                elif not any(n not in written and guards[name].excludes(n, v) for n, v in guards[reader].equalities):
                    before[reader][name] = None
    return before


class _Guard:
    """What a guard asks of variables, one by one."""

    def __init__(self, guard: Expression) -> None:
        self.reading: dict[str, list[Expression]] = defaultdict(list)  # parts by the variables that they read
        for part in conjuncts(guard):
            for name in dict.fromkeys(variables(part)):
                self.reading[name].append(part)
        self.equalities = tuple(equalities(guard))

    def excludes(self, name: str, value: Value) -> bool:
        """Whether it cannot hold while the variable `name` has that value."""
        return any(evaluate(part, Known({name: value})) is False for part in self.reading.get(name, ()))
