"""Who is to blame where several devices are late: what the others only wait for, and what follows once it has happened.

A device can seem late because another one is: a tool that is felt in the gripper should be lost, as the robot still
says that it is elsewhere. Once the robot has said what it should have said long ago, there is nothing wrong with it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.structure import Ability, Automaton, Effect, State, reads, target
from sequence_planner.automaton.tick import effect_writes, synchronise
from sequence_planner.planning.advice.stalling import changes_something

_MOST_STEPS = 4  # of a device that goes on


class Culprits:
    """What follows from what at the devices of one station: among `effects`, by name, those that are counted on."""

    def __init__(self, automaton: Automaton, effects: Mapping[str, Effect]) -> None:
        self._automaton = automaton
        self._effects = effects
        self._upstream: dict[str, frozenset[str]] = {}

    def of_effect(self, name: str, state: State, since: Mapping[str, float]) -> str:
        """The effect for whose absence this one has not happened; itself where it is its own device that is late.

        `since` are the effects that take longer than they ever do, with the moment from which they were possible: only
        what was to happen before is to blame.
        """
        seen = {name}
        while (earlier := self._explaining(name, state, since, seen)) is not None:
            seen.add(earlier)
            name = earlier
        return name

    def of_run(self, ability: Ability, state: State, since: Mapping[str, float]) -> frozenset[str]:
        """The effects for whose absence a run of the ability goes on; none where its own device is to blame, or nobody
        is known to be.
        """
        late = {self.of_effect(name, state, since) for name in self._led_to(ability) & since.keys()}
        own = any(self._effects[name].resource == ability.resource for name in late)
        return frozenset() if own else frozenset(late)

    def has_to_act(self, ability: Ability, state: State) -> bool:
        """Whether there is something that the ability's own device should do so that a run of it goes on."""
        own = (self._effects[name] for name in self._led_to(ability))
        return any(each.resource == ability.resource and changes_something(each, state) for each in own)

    def _explaining(self, name: str, state: State, since: Mapping[str, float], seen: Collection[str]) -> str | None:
        effect = self._effects[name]
        for earlier in sorted(since.keys() - seen, key=lambda each: (since[each], each)):
            before = since[earlier] <= since.get(name, since[earlier])
            if before and self._effects[earlier].resource != effect.resource and self._ends(effect, earlier, state):
                return earlier
        return None

    def _ends(self, effect: Effect, earlier: str, state: State) -> bool:
        """Whether there is nothing to be done by `effect` once the device of the `earlier` one has gone on."""
        device = [each for each in self._effects.values() if each.resource == self._effects[earlier].resource]
        due: Effect | None = self._effects[earlier]
        for _ in range(_MOST_STEPS):
            if due is None:
                return False
            state = synchronise(self._automaton, {**state, **(effect_writes(due, state) or {})})
            if not changes_something(effect, state):
                return True
            due = next((each for each in device if changes_something(each, state)), None)
        return False

    def _led_to(self, ability: Ability) -> frozenset[str]:
        """The effects that can lead to its end, also by what they make possible."""
        if ability.name not in self._upstream:
            guards = (ability.executing, *(() if ability.finish_guard is None else (ability.finish_guard,)))
            self._upstream[ability.name] = self._upstream_of(read_variables(self._automaton, guards))
        return self._upstream[ability.name]

    def _upstream_of(self, names: Iterable[str]) -> frozenset[str]:
        relevant, found = set(names), set[str]()
        while True:
            further = [
                effect
                for name, effect in self._effects.items()
                if name not in found and not relevant.isdisjoint(target(action) for action in effect.actions)
            ]
            if not further:
                return frozenset(found)
            for effect in further:
                found.add(effect.name)
                relevant |= read_variables(self._automaton, (effect.guard,))
                relevant.update(name for action in effect.actions for name in reads(action))
