"""The reference tick of `docs/semantics.md`, step by step: plain, slow and obviously right.

A running station takes the compiled tick (`compiled_tick`), which tests hold against this one with measured values;
planning, synthesis and tests call these functions with effects in place of measurements. No function changes a state:
each returns a new one.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from sequence_planner.automaton.automaton import Ability, Automaton, Effect, State, target
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.evaluator import evaluate, holds
from sequence_planner.language.syntax import Assignment, conjunction
from sequence_planner.language.types import Value

Writes = dict[str, Value]
Conflicts = tuple[tuple[str, str, str], ...]  # two abilities and the variable


class Finishing(Immutable):
    """The outcome of step 2: who finished, and which abilities would have written different values to one variable."""

    state: State
    finished: tuple[str, ...]
    conflicts: Conflicts


def initial_state(automaton: Automaton) -> State:
    """The declared initial values, with flags synchronised."""
    return synchronise(automaton, automaton.initial_valuation)


def writes(actions: Iterable[Assignment], state: State) -> Writes | None:
    """Return what `actions` write when taken at once in `state`; None when an unknown value leaves it undetermined."""
    written: Writes = {}
    for action in actions:
        if action.condition is not None:
            applies = evaluate(action.condition, state)
            if applies is None:
                return None
            if not applies:
                continue
        value = evaluate(action.value, state)
        if value is None:
            return None
        written[target(action)] = value
    return written


def sense(state: State, measured: Mapping[str, Value | None]) -> State:
    """Step 1 on a live station: take the measured values; None makes a variable unknown."""
    return {**state, **measured}


def effect_writes(effect: Effect, state: State) -> Writes | None:
    """Return what `effect` writes if it is enabled in `state`, else None. An unknown variable stays unknown."""
    if not holds(effect.guard, state):
        return None
    written = writes(effect.actions, state)
    if written is None:
        return None
    return {name: value for name, value in written.items() if state[name] is not None}


def apply_effects(state: State, effects: Iterable[Effect]) -> State | None:
    """Step 1 without a station: all of `effects` at once, or None if one is not enabled or two are incompatible."""
    together: Writes = {}
    for effect in effects:
        written = effect_writes(effect, state)
        if written is None or any(together.get(name, value) != value for name, value in written.items()):
            return None
        together |= written
    return {**state, **together}


def finish(automaton: Automaton, state: State) -> Finishing:
    """Step 2: every ability whose finish guard holds takes its finish actions, all on the state before them.

    Flags are still those of the last tick. Of two abilities that would write different values neither is applied.
    """
    candidates: dict[str, Writes] = {}
    for ability in automaton.abilities.values():
        if ability.finish_guard is not None and holds(ability.finish_guard, state):
            written = writes(ability.finish_actions, state)
            if written is not None:
                candidates[ability.name] = written
    conflicts = conflicts_of(candidates)
    refused = {ability for one, other, _ in conflicts for ability in (one, other)}
    finished = tuple(name for name in candidates if name not in refused)
    after = dict(state)
    for name in finished:
        after |= candidates[name]
    return Finishing(after, finished, conflicts)


def conflicts_of(candidates: Mapping[str, Writes]) -> Conflicts:
    """Each two that would write different values to a variable, with the variable."""
    return tuple(
        (one, other, name)
        for one, first in candidates.items()
        for other, second in candidates.items()
        if one < other
        for name in sorted(first.keys() & second.keys())
        if first[name] != second[name]
    )


def synchronise(automaton: Automaton, state: State) -> State:
    """Step 3: each flag takes the value of its predicate; one that is undetermined keeps its value."""
    after = dict(state)
    for flag in automaton.flags:
        truth = evaluate(flag.predicate, after)
        if truth is not None:
            after[flag.name] = truth
    return after


def update_operations(automaton: Automaton, state: State, active: frozenset[str]) -> frozenset[str]:
    """Step 4: the operations active after it, given those active before."""
    after = set(active)
    for operation in automaton.operations.values():
        goal = evaluate(operation.goal, state)
        if goal is True:
            after.discard(operation.name)
        elif goal is False and holds(operation.precondition, state):
            after.add(operation.name)
    return frozenset(after)


def record_activity(automaton: Automaton, state: State, active: frozenset[str]) -> State:
    """The state after step 4: the operations that expressions read are active or not, and flags that read them follow.

    Were these left as they are until the next tick, a finish guard could see an activity and a flag that contradicts
    it, which no state that the supervisor knows of does.
    """
    known = {o.activity: o.name in active for o in automaton.operations.values() if o.activity in automaton.variables}
    return synchronise(automaton, {**state, **known}) if known else state


def start_guard_holds(ability: Ability, state: State) -> bool:
    """Return whether `enabled` and the written start guard hold. The supervisor has its say elsewhere."""
    return state[ability.flag("enabled")] is True and holds(conjunction(ability.enabled, ability.start_guard), state)


def start(automaton: Automaton, state: State, ability: Ability) -> State | None:
    """Step 5, one start: its actions, then synchronise. None when the actions are undetermined."""
    written = writes(ability.start_actions, state)
    return None if written is None else synchronise(automaton, {**state, **written})


def reverts(automaton: Automaton, published: State, before: State, after: State) -> frozenset[str]:
    """Outputs that the step from `before` to `after` would set back before anybody saw them.

    `published` has the outputs as they were last published: a device must see every command.
    """
    return frozenset(
        name for name in automaton.outputs if before[name] != published[name] and after[name] == published[name]
    )


def supervised_start(
    automaton: Automaton, supervisor: Supervisor, published: State, state: State, ability: Ability
) -> State | None:
    """The state after the start of `ability`, or None while something keeps it: its guards, what it would revert, or
    the supervisor. Whether the rest of a start order still reaches its goals is for the planner to say.
    """
    if not start_guard_holds(ability, state):
        return None
    after = start(automaton, state, ability)
    if after is None or reverts(automaton, published, state, after) or not supervisor.allows(state, after):
        return None
    return after
