"""One reference tick, with an account of each of its six steps."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Ability, Automaton, Effect, State
from sequence_planner.automaton.tick import (
    apply_effects,
    finish,
    record_activity,
    reverts,
    sense,
    start,
    start_guard_holds,
    synchronise,
    update_operations,
)
from sequence_planner.cli.moments import Moment
from sequence_planner.expressions.evaluation import evaluate, holds
from sequence_planner.expressions.printing import print_expression
from sequence_planner.expressions.syntax import Expression, conjuncts
from sequence_planner.expressions.types import Value

Changes = Mapping[str, Value | None]


@dataclass(frozen=True)
class Request:
    """What happens in a tick: measured values, effects, and the starts that are wanted, in their order."""

    measured: Mapping[str, Value | None] = field(default_factory=dict)
    effects: Sequence[Effect] = ()
    starts: Sequence[Ability] = ()
    restart_mode: bool = False


@dataclass(frozen=True)
class StartTried:
    """A start that was wanted; `waits_for` is empty if it was taken, and `changes` is what it did."""

    ability: str
    waits_for: tuple[str, ...]
    changes: Changes


@dataclass(frozen=True)
class TickTaken:
    """What each step of a tick did. Changes are the new values."""

    sensed: Changes
    finished: tuple[str, ...]
    conflicts: tuple[tuple[str, str, str], ...]
    finish_changes: Changes
    flags: Changes
    activated: tuple[str, ...]
    completed: tuple[str, ...]
    starts: tuple[StartTried, ...]
    published: Changes
    after: Moment


class EffectRefused(Exception):
    """An effect that cannot happen now; the text says why."""


def take_tick(automaton: Automaton, supervisor: Supervisor | None, before: Moment, request: Request) -> TickTaken:
    """Take one tick from `before`, all of whose outputs have been published. Raises `EffectRefused`.

    Without a `supervisor` starts are kept from nothing but their own guards.
    """
    sensed = _sensed(before.state, request)
    finishing = finish(automaton, sensed)
    state = synchronise(automaton, finishing.state)
    flags = changes(finishing.state, state)
    active = update_operations(automaton, state, before.active)
    state = record_activity(automaton, state, active)
    starts: list[StartTried] = []
    for ability in request.starts:
        waits_for = tuple(_waits_for(automaton, supervisor, before.state, state, ability, request.restart_mode))
        after = state if waits_for else start(automaton, state, ability)
        assert after is not None
        starts.append(StartTried(ability.name, waits_for, changes(state, after)))
        state = after
    return TickTaken(
        sensed=changes(before.state, sensed),
        finished=finishing.finished,
        conflicts=finishing.conflicts,
        finish_changes=changes(sensed, finishing.state),
        flags=flags,
        activated=tuple(sorted(active - before.active)),
        completed=tuple(sorted(before.active - active)),
        starts=tuple(starts),
        published={n: v for n, v in changes(before.state, state).items() if n in automaton.outputs},
        after=Moment(state, active),
    )


def changes(before: State, after: State) -> Changes:
    """The new values of what differs."""
    return {name: value for name, value in after.items() if before[name] != value}


def _sensed(state: State, request: Request) -> State:
    for effect in request.effects:
        if not holds(effect.guard, state):
            raise EffectRefused(f"the effect `{effect.name}` is not enabled: {', '.join(lacking(effect.guard, state))}")
    sensed = apply_effects(state, request.effects)
    if sensed is None:
        raise EffectRefused("these effects cannot happen in one tick: they would write different values to a variable")
    return sense(sensed, request.measured)


def lacking(condition: Expression, state: State) -> Iterable[str]:
    """What of a condition does not hold, in words."""
    for part in conjuncts(condition):
        truth = evaluate(part, state)
        if truth is not True:
            yield f"`{print_expression(part)}` is {'unknown' if truth is None else 'false'}"


def _waits_for(
    automaton: Automaton,
    supervisor: Supervisor | None,
    published: State,
    state: State,
    ability: Ability,
    restart_mode: bool,
) -> Iterable[str]:
    if ability.restart and not restart_mode:
        yield "it is for restart mode only (--restart-mode)"
        return
    if not start_guard_holds(ability, state):
        yield from dict.fromkeys((*lacking(ability.enabled, state), *lacking(ability.start_guard, state)))
        return
    after = start(automaton, state, ability)
    if after is None:
        yield "what it would write depends on values that are unknown"
    elif taken := reverts(automaton, published, state, after):
        yield f"{', '.join(sorted(taken))} must be published first"
    elif supervisor is not None and not supervisor.allows(state, after):
        broken = [s.name for s in automaton.specifications.values() if holds(s.forbidden, after)]
        why = "after it a specification could be broken, or rest not be reached any more"
        if broken:
            why = f"specification {', '.join(broken)} forbids the state after it"
        if unknown := [name for name in supervisor.safe.names if state[name] is None]:
            why = f"{', '.join(unknown)} is unknown, and with some value of it a specification could be broken"
        elif not supervisor.safe.includes(state):
            why = "the state is not a safe one"
        yield why
