"""What a start asks of the state before it and leaves in the one after it, as far as its text alone says so."""

from __future__ import annotations

from collections.abc import Set
from functools import cached_property

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.structure import Ability, Automaton, State, target
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import Comparison, Constant, Expression, Variable, conjunction, conjuncts
from sequence_planner.expressions.types import Value
from sequence_planner.planning.known import Known, equalities


class Demands:
    """Of one ability: values that variables have, or have not, wherever it starts, and values that it then writes."""

    def __init__(self, automaton: Automaton, ability: Ability) -> None:
        guard = conjunction(ability.enabled, ability.start_guard)
        self._guard = guard
        self._automaton = automaton
        self._asked: dict[str, Value] = {n: v for n, v in equalities(guard) if n in automaton.variables}
        refused: list[tuple[str, Value]] = []
        self._equal: list[tuple[str, str]] = []
        for part in conjuncts(guard):
            match part:
                case Comparison("!=", Variable(name), Constant(value)):
                    refused.append((name, value))
                case Comparison("==", Variable(name), Variable(other)):
                    self._equal += [(name, other), (other, name)]
        self._written = frozenset(map(target, ability.start_actions))
        self._constants = {
            target(each): each.value.value
            for each in ability.start_actions
            if each.condition is None and isinstance(each.value, Constant)
        }
        kept = {name: value for name, value in self._asked.items() if name not in self._written}
        self._missing = frozenset((name, value) for name, value in refused if name not in self._written)
        self._writes_constants = self._written <= self._constants.keys()
        self._left = Known({**kept, **self._constants})

    def excludes(self, other: Demands) -> bool:
        """Whether `other` cannot start in the same tick after this start and no others."""
        left, missing = self._left, self._missing
        for name, value in other._asked.items():
            if (name, value) in missing or left[name] not in (None, value):
                return True
        if any((same, left[name]) in missing for name, same in other._equal):
            return True
        return evaluate(other._guard, left) is False

    def undone_by(self, other: Demands) -> bool:
        """Whether `other`, right after this start, leaves every variable as it was before this start."""
        if not (self._writes_constants and other._writes_constants):
            return False
        end = self._constants | other._constants
        return all(name in self._asked and self._asked[name] == value for name, value in end.items())

    def commutes_with(self, other: Demands) -> bool:
        """Whether `other`, where it can start after this, can start before this just as well, to the same effect."""
        if not (self._writes_constants and other._writes_constants):
            return False
        if any(self._constants[name] != other._constants[name] for name in self._written & other._written):
            return False
        known = Known({n: v for n, v in other._asked.items() if n not in self._written})
        known.update(self._asked)
        if not other._holds(self._written, known):
            return False
        known.update(other._constants)
        return self._holds(other._written, known)

    @cached_property
    def _parts(self) -> list[tuple[Expression, frozenset[str]]]:
        """The parts of the guard, with the variables that they read."""
        return [(part, read_variables(self._automaton, (part,))) for part in conjuncts(self._guard)]

    def _holds(self, changing: Set[str], state: State) -> bool:
        """Whether the parts of the guard hold in `state` that read what is `changing`."""
        return all(evaluate(part, state) is True for part, names in self._parts if not names.isdisjoint(changing))
