"""The ground transitions of an automaton, by the phase of the tick that takes them, with what they read and write."""

from __future__ import annotations

from enum import StrEnum
from functools import cached_property

from sequence_planner.automaton.automaton import Ability, Automaton, Effect, reads, target
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.syntax import Assignment, Expression, conjunction, variables


class Phase(StrEnum):
    """The step of the tick that takes a transition."""

    SENSE = "sense"  # an effect; without a station, or as what a station is expected to do
    FINISH = "finish"
    START = "start"


class Transition(Immutable):
    """A guarded update. Only a start is controllable."""

    name: str
    phase: Phase
    guard: Expression
    actions: tuple[Assignment, ...]
    fault: bool = False  # an effect that nobody counts on
    restart: bool = False  # a start for restart mode only

    @property
    def controllable(self) -> bool:
        """True if we decide when it is taken."""
        return self.phase is Phase.START

    @cached_property
    def reads(self) -> frozenset[str]:
        """The variables and flags that its guard and its actions read."""
        return frozenset(variables(self.guard)).union(*map(reads, self.actions))

    @cached_property
    def writes(self) -> frozenset[str]:
        """The variables that it may write."""
        return frozenset(map(target, self.actions))


def transitions(automaton: Automaton) -> tuple[Transition, ...]:
    """All of them: effects, finishes and starts, each in order of declaration.

    An effect bears its own name, the others those of their abilities with `.finish` and `.start`.
    """
    abilities = automaton.abilities.values()
    return (
        *map(sensing, automaton.effects),
        *(finishing(ability) for ability in abilities if ability.finish_guard is not None),
        *map(starting, abilities),
    )


def sensing(effect: Effect) -> Transition:
    """The transition of an effect."""
    return Transition(effect.name, Phase.SENSE, effect.guard, effect.actions, fault=effect.fault)


def finishing(ability: Ability) -> Transition:
    """The finish of an ability that has one."""
    assert ability.finish_guard is not None
    return Transition(f"{ability.name}.finish", Phase.FINISH, ability.finish_guard, ability.finish_actions)


def starting(ability: Ability) -> Transition:
    """The start of an ability."""
    guard = conjunction(ability.enabled, ability.start_guard)
    return Transition(f"{ability.name}.start", Phase.START, guard, ability.start_actions, restart=ability.restart)
