"""Which abilities can get in each other's way: what either touches, while it runs, matters to the other."""

from __future__ import annotations

from collections.abc import Set
from functools import lru_cache

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.structure import Ability, Automaton, target


class Interference:
    """What each ability of an automaton touches and reads, with the effects that it sets off."""

    def __init__(self, automaton: Automaton) -> None:
        self._automaton = automaton
        self._effects = [
            (read_variables(automaton, (effect.guard,)), frozenset(map(target, effect.actions)))
            for effect in automaton.effects
            if not effect.fault
        ]
        self._between = lru_cache(maxsize=None)(self._compared)
        self._footprint = lru_cache(maxsize=None)(self._found)

    def between(self, one: str, other: str) -> bool:
        """Whether it can matter which of the two starts first."""
        return self._between(one, other)

    def _compared(self, one: str, other: str) -> bool:
        (touched, read), (other_touched, other_read) = self._footprint(one), self._footprint(other)
        return not (touched.isdisjoint(other_read) and other_touched.isdisjoint(read))

    def _found(self, name: str) -> tuple[Set[str], Set[str]]:
        """The variables it touches, and those as well as what it reads."""
        ability = self._automaton.abilities[name]
        touched = {target(action) for action in (*ability.start_actions, *ability.finish_actions)}
        more = set(touched)
        while more:
            found = {name for reads, writes in self._effects if not more.isdisjoint(reads) for name in writes}
            more = found - touched
            touched |= more
        return touched, touched | self._reads(ability)

    def _reads(self, ability: Ability) -> Set[str]:
        guards = [ability.enabled, ability.start_guard]
        guards += [ability.finish_guard] if ability.finish_guard is not None else []
        for action in (*ability.start_actions, *ability.finish_actions):
            guards += [action.value] if action.condition is None else [action.value, action.condition]
        return frozenset(read_variables(self._automaton, tuple(guards)))
