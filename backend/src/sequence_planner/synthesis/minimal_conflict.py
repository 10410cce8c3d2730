"""The fewest things a model says that already leave no supervisor: specifications, and what nobody decides.

Of a set that is in conflict, one part after the other is taken out and stays out if the rest still is in conflict
(deletion: Chinneck & Dravnieks 1991). A specification is taken out by leaving it away, an effect or a finish by letting
the station decide at any time whether it can happen.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from sequence_planner.automaton.automaton import Ability, Automaton, Effect, Kind, VariableDeclaration
from sequence_planner.automaton.transitions import Phase, transitions
from sequence_planner.language.syntax import FALSE, TRUE, Assignment, Expression, Not, Variable, conjunction
from sequence_planner.language.types import BOOLEAN
from sequence_planner.synthesis.supervisor import Supervision, relevant
from sequence_planner.synthesis.traces import Trace
from sequence_planner.synthesis.transition_relation import Plant

MOST_SYNTHESES = 60

_FINISH = ".finish"


@dataclass(frozen=True)
class Conflict:
    """Specifications, and effects and finishes (`ability.finish`), that cannot be met together with reaching rest.

    With `minimal` they could without any one of them; else not all of that was tried.
    """

    specifications: tuple[str, ...]
    uncontrollable: tuple[str, ...]
    minimal: bool


def minimal_conflict(automaton: Automaton, trace: Trace | None = None) -> Conflict:
    """Return what is in conflict in an `automaton` without supervisor. `trace` shows it, and so says where to begin."""
    return _Deletion(automaton).of(trace)


class _Deletion:
    def __init__(self, automaton: Automaton) -> None:
        self._automaton = automaton
        self._left = MOST_SYNTHESES
        names = set(relevant(automaton))
        self._uncontrollable = frozenset(
            each.name for each in transitions(automaton) if each.phase is not Phase.START and each.writes & names
        )

    def of(self, trace: Trace | None) -> Conflict:
        specifications, uncontrollable = frozenset(self._automaton.specifications), self._uncontrollable
        for some_specifications, some_uncontrollable in self._suspected(trace):
            if self._conflicting(some_specifications, some_uncontrollable):
                specifications, uncontrollable = some_specifications, some_uncontrollable
                break
        for name in self._automaton.specifications:
            if name in specifications and self._conflicting(specifications - {name}, uncontrollable):
                specifications -= {name}
        for name in sorted(uncontrollable):
            if self._conflicting(specifications, uncontrollable - {name}):
                uncontrollable -= {name}
        kept = tuple(name for name in self._automaton.specifications if name in specifications)
        return Conflict(kept, tuple(sorted(uncontrollable)), self._left >= 0)

    def _suspected(self, trace: Trace | None) -> Iterable[tuple[frozenset[str], frozenset[str]]]:
        """Parts that are likely to be in conflict already: what a trace takes and breaks; and no transition at all."""
        everything = frozenset(self._automaton.specifications)
        if trace is not None:
            taken = {name for step in trace.steps for name in (*step.names, *(f + _FINISH for f in step.finished))}
            broken = {name for step in trace.steps for name in step.forbidden_by}
            yield frozenset(broken) or everything, self._uncontrollable & taken
        yield everything, frozenset()

    def _conflicting(self, specifications: frozenset[str], uncontrollable: frozenset[str]) -> bool:
        """Return whether there is no supervisor with these alone; no longer found out after too many syntheses."""
        self._left -= 1
        if self._left < 0:
            return False
        kept = {name: each for name, each in self._automaton.specifications.items() if name in specifications}
        decided = self._uncontrollable - uncontrollable
        tried = _deciding(replace(self._automaton, specifications=kept), decided)
        return not Supervision(Plant(tried, relevant(tried))).possible


def _deciding(automaton: Automaton, decided: frozenset[str]) -> Automaton:
    """`automaton` in which the station decides about some effects and finishes."""
    if automaton.one_at_a_time:
        abilities = {e.name: _ability(e.name, e.guard, e.actions) for e in automaton.effects if e.name in decided}
        left = tuple(effect for effect in automaton.effects if effect.name not in decided)
        return replace(automaton, abilities={**automaton.abilities, **abilities}, effects=left)
    permits = {name: Variable(f"permit {name}", BOOLEAN) for name in sorted(decided)}
    declared = {
        permit.name: VariableDeclaration(permit.name, BOOLEAN, Kind.OUTPUT, False, None) for permit in permits.values()
    }
    changing = {
        permit.name: _ability(permit.name, TRUE, (Assignment(permit, Not(permit)),)) for permit in permits.values()
    }
    effects = tuple(_permitted_effect(effect, permits.get(effect.name)) for effect in automaton.effects)
    abilities = {
        name: _permitted_finish(ability, permits.get(name + _FINISH)) for name, ability in automaton.abilities.items()
    }
    return replace(
        automaton,
        variables={**automaton.variables, **declared},
        abilities={**abilities, **changing},
        effects=effects,
    )


def _ability(name: str, guard: Expression, actions: tuple[Assignment, ...]) -> Ability:
    """Done at its start."""
    return Ability(name, "", name, TRUE, guard, actions, FALSE, FALSE, None, ())


def _permitted_effect(effect: Effect, permit: Variable | None) -> Effect:
    return effect if permit is None else replace(effect, guard=conjunction(effect.guard, permit))


def _permitted_finish(ability: Ability, permit: Variable | None) -> Ability:
    if permit is None or ability.finish_guard is None:
        return ability
    return replace(ability, finish_guard=conjunction(ability.finish_guard, permit))
