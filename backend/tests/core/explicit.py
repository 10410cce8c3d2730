"""The supervisor straight from its definition: plain sets of states and the reference tick, over all variables.

Slow on purpose. It knows nothing of a cone of influence, of tables or of columns, so that agreement means something.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, product

from sequence_planner.automaton.automaton import Ability, Automaton, Effect, Kind, State
from sequence_planner.automaton.tick import (
    apply_effects,
    effect_writes,
    finish,
    initial_state,
    start,
    start_guard_holds,
    synchronise,
)
from sequence_planner.language.evaluator import holds
from sequence_planner.language.syntax import TRUE
from sequence_planner.language.types import Value

Key = tuple[Value, ...]


def outcomes(automaton: Automaton, state: State, effects: Sequence[Effect]) -> list[State]:
    """The different states after steps 1 to 3, with every set of `effects` that can happen together."""
    enabled = [effect for effect in effects if effect_writes(effect, state) is not None]
    sensed: dict[tuple[Value | None, ...], State] = {}
    for size in range(len(enabled) + 1):
        for chosen in combinations(enabled, size):
            if (together := apply_effects(state, chosen)) is not None:
                sensed[tuple(together.values())] = together
    return [synchronise(automaton, finish(automaton, each).state) for each in sensed.values()]


@dataclass(frozen=True)
class Explicit:
    """All states of `automaton` with what can happen in each."""

    automaton: Automaton

    @cached_property
    def states(self) -> Mapping[Key, State]:
        """Every combination of values, with synchronised flags."""
        names = list(self.automaton.variables)
        undetermined = self.automaton.initial_valuation
        found = {}
        for values in product(*(variable.type.domain for variable in self.automaton.variables.values())):
            found[values] = synchronise(self.automaton, {**undetermined, **dict(zip(names, values, strict=True))})
        return found

    def key(self, state: State) -> Key:
        """The values of the variables of a state, none of which is unknown."""
        return tuple(value for name in self.automaton.variables if (value := state[name]) is not None)

    @cached_property
    def initial(self) -> Key:
        """The initial state."""
        return self.key(initial_state(self.automaton))

    def _uncontrollable(self, effects: Sequence[Effect]) -> dict[Key, frozenset[Key]]:
        return {
            key: frozenset(
                (*(self.key(after) for after in outcomes(self.automaton, state, effects)), *self._flips(key))
            )
            for key, state in self.states.items()
        }

    def _flips(self, key: Key) -> Iterator[Key]:
        """In step 4, any operation may become active, or be so no longer."""
        for position, variable in enumerate(self.automaton.variables.values()):
            if variable.kind is Kind.ACTIVITY:
                yield (*key[:position], not key[position], *key[position + 1 :])

    @cached_property
    def uncontrollable(self) -> dict[Key, frozenset[Key]]:
        """What the environment can make of each state, faults included."""
        return self._uncontrollable(self.automaton.effects)

    @cached_property
    def helpful(self) -> dict[Key, frozenset[Key]]:
        """What it can be counted on to be able to do: the same without faults."""
        if not any(effect.fault for effect in self.automaton.effects):
            return self.uncontrollable
        return self._uncontrollable([effect for effect in self.automaton.effects if not effect.fault])

    @cached_property
    def starts(self) -> dict[Key, dict[str, Key]]:
        """Where the start of each ability leads, by the written guards."""
        return {key: dict(self._starts(state)) for key, state in self.states.items()}

    def _starts(self, state: State) -> Iterator[tuple[str, Key]]:
        for ability in self.automaton.abilities.values():
            if not ability.restart and (after := self.started(state, ability)) is not None:
                yield ability.name, self.key(after)

    def started(self, state: State, ability: Ability) -> State | None:
        """The state after a start, by the written guards alone."""
        return start(self.automaton, state, ability) if start_guard_holds(ability, state) else None

    @cached_property
    def forbidden(self) -> frozenset[Key]:
        """The states that satisfy a specification's forbidden predicate."""
        predicates = [specification.forbidden for specification in self.automaton.specifications.values()]
        return frozenset(key for key, state in self.states.items() if any(holds(p, state) for p in predicates))

    @cached_property
    def safe(self) -> frozenset[Key]:
        """The greatest set of states that are not forbidden, that U cannot leave, and that can reach rest inside it."""
        rest = TRUE if self.automaton.rest is None else self.automaton.rest
        marked = {key for key, state in self.states.items() if holds(rest, state)}
        safe = set(self.states) - self.forbidden
        while True:
            closed = {key for key in safe if self.uncontrollable[key] <= safe}
            kept = {key for key in closed if key in marked}
            while True:
                more = {key for key in closed - kept if (self.helpful[key] | set(self.starts[key].values())) & kept}
                if not more:
                    break
                kept |= more
            if kept == safe:
                return frozenset(safe)
            safe = kept

    def reachable(self, supervised: bool) -> frozenset[Key]:
        """The states reachable from the initial one, with or without the supervisor."""
        reached, pending = {self.initial}, [self.initial]
        while pending:
            key = pending.pop()
            targets = set(self.uncontrollable[key])
            for after in self.starts[key].values():
                if not supervised or (key in self.safe and after in self.safe):
                    targets.add(after)
            pending.extend(targets - reached)
            reached |= targets
        return frozenset(reached)
