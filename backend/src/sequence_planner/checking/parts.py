"""The conditions of a model, each with what it is and what it depends on."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from sequence_planner.automaton.grounding.findings import without_arguments
from sequence_planner.automaton.structure import Ability, Automaton
from sequence_planner.expressions.syntax import TRUE, Expression, conjunction


@dataclass(frozen=True)
class Part:
    """A condition of the model. Its place is under `key`; without the parts `needs` it means nothing.

    With `old_flags` it is read over new measured values and the flags of the tick before.
    """

    key: str
    what: str
    expression: Expression
    consequence: str = ""  # of its never holding
    needs: tuple[str, ...] = ()
    old_flags: bool = False

    @property
    def name(self) -> str:
        """What tells it from all other parts."""
        return f"{self.key}: {self.what}"

    @property
    def family(self) -> str:
        """The name of what was written, for all its ground instances."""
        return without_arguments(self.name)

    @property
    def repeats_an_argument(self) -> bool:
        """Whether it is of an instance such as `carry(left, left)`, which is often meant to be impossible."""
        found = re.search(r"\(([^)]*)\)", self.key)
        arguments = found[1].split(", ") if found else []
        return len(set(arguments)) < len(arguments)


def parts(automaton: Automaton) -> Iterator[Part]:
    """All conditions, those first on which others depend."""
    for ability in automaton.abilities.values():
        yield from _of_ability(ability)
    for effect in automaton.effects:
        ability_name = effect.name.rpartition(".")[0]
        needs = _start_parts(ability_name)
        yield Part(effect.name, "effect's condition", effect.guard, "so the effect never happens", needs)
    for operation in automaton.operations.values():
        key = f"operation.{operation.name}"
        precondition = Part(key, "precondition", operation.precondition, "so the operation never becomes active")
        yield precondition
        yield Part(key, "goal", operation.goal, "so the operation is never completed", (precondition.name,))


def _of_ability(ability: Ability) -> Iterator[Part]:
    name = ability.name
    needs: tuple[str, ...] = _start_parts(name)
    yield Part(f"{name}.enabled", "condition", ability.enabled, "so the ability never starts")
    if ability.start_guard != TRUE:
        both = conjunction(ability.enabled, ability.start_guard)
        yield Part(f"{name}.start", "start guard with `enabled`", both, "so the ability never starts", needs[:1])
    executing = Part(f"{name}.executing", "condition", ability.executing, "", needs)
    yield executing
    yield Part(f"{name}.finished", "condition", ability.finished, "", needs)
    if ability.finish_guard is not None:
        needs = (*needs, executing.name)
        yield Part(f"{name}.finish", "finish guard", ability.finish_guard, "so the ability never finishes", needs, True)


def _start_parts(ability: str) -> tuple[str, str]:
    return f"{ability}.enabled: condition", f"{ability}.start: start guard with `enabled`"
