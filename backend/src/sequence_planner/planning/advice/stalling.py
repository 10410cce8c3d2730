"""Effects that should have happened by now, and the same station without counting on them.

A device that does not do what it was told will not do it for being waited for. It may when it is told something else,
or when a person has helped: an effect is counted on again as soon as anything has changed that it reads or writes.
"""

from __future__ import annotations

from collections.abc import Iterable

from sequence_planner.automaton.structure import Automaton, Effect, State, reads, target
from sequence_planner.automaton.tick import effect_writes
from sequence_planner.expressions.syntax import Not, conjunction, variables
from sequence_planner.expressions.types import Value
from sequence_planner.immutable import Immutable, replace
from sequence_planner.planning.advice.conjoining import all_equal


class Stall(Immutable):
    """An effect that does not happen as long as these variables have these values."""

    effect: str
    values: tuple[tuple[str, Value], ...]


def stalled_effects(automaton: Automaton, state: State, resources: Iterable[str]) -> frozenset[str]:
    """The effects of these resources, whose abilities are overdue, that should have changed something by now."""
    late = frozenset(resources)
    return frozenset(
        effect.name
        for effect in automaton.effects
        if effect.resource in late and not effect.fault and changes_something(effect, state)
    )


def changes_something(effect: Effect, state: State) -> bool:
    """Whether the effect can happen, and then something is different."""
    written = effect_writes(effect, state) or {}
    return any(state[name] != value for name, value in written.items())


def stalls(automaton: Automaton, state: State, names: frozenset[str]) -> frozenset[Stall]:
    """What it is that does not happen now."""
    return frozenset(_stall(automaton, state, effect) for effect in automaton.effects if effect.name in names)


def stalling(automaton: Automaton, stalled: frozenset[Stall]) -> Automaton:
    """The station in which these do not happen."""
    conditions = {stall.effect: all_equal(automaton, stall.values) for stall in stalled}
    effects = (
        replace(effect, guard=conjunction(effect.guard, Not(conditions[effect.name])))
        if effect.name in conditions
        else effect
        for effect in automaton.effects
    )
    return replace(automaton, effects=tuple(effects))


def only_written(automaton: Automaton, names: frozenset[str]) -> frozenset[str]:
    """The variables that these effects write, and none of them reads: no device is helped by their values."""
    effects = [effect for effect in automaton.effects if effect.name in names]
    written = {target(action) for effect in effects for action in effect.actions}
    read = {name for effect in effects for name in variables(effect.guard)}
    return frozenset(written - read)


def written_by(automaton: Automaton, names: frozenset[str]) -> frozenset[str]:
    """The variables that these effects should have changed: whoever changes one has helped their device, if it is one
    that is to blame.
    """
    return frozenset(target(action) for each in automaton.effects if each.name in names for action in each.actions)


def _stall(automaton: Automaton, state: State, effect: Effect) -> Stall:
    acted = (name for action in effect.actions for name in (target(action), *reads(action)))
    local = {*variables(effect.guard), *acted} & automaton.variables.keys()
    return Stall(effect.name, tuple((name, value) for name in sorted(local) if (value := state[name]) is not None))
