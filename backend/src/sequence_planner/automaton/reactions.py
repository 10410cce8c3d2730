"""The question whether a change of a measured variable is one that the model's effects can bring about.

What is seen of a device lags behind and has gaps: between two messages it can have done several things, and on the way
from one named value to another it is between them. So what a few effects can do one after the other is explained, in
doubt about unknown values too. Faults are effects: the model knows of them.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from itertools import chain

from sequence_planner.automaton.automaton import Automaton, Effect, State, reads, target
from sequence_planner.automaton.tick import writes
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import variables
from sequence_planner.language.types import Value

_DEPTH = 4  # effects one after the other, between two messages
_MOST = 400  # states that are looked at for one change; what is more than that counts as explained


class _Cone(Immutable):
    """The effects that can play a part in what becomes of a variable, and all that they read or write."""

    effects: tuple[Effect, ...]
    names: frozenset[str]


class Reactions:
    """The effects of `automaton`; `between` says what a variable can be while it goes from one value to another."""

    def __init__(self, automaton: Automaton, between: Mapping[str, Collection[Value]] | None = None) -> None:
        self._between = between or {}
        self._writers: dict[str, list[Effect]] = {}
        for effect in automaton.effects:
            for name in {target(action) for action in effect.actions}:
                self._writers.setdefault(name, []).append(effect)
        self._cones: dict[str, _Cone] = {}

    @property
    def variables(self) -> frozenset[str]:
        """Those of whose changes the model says anything."""
        return frozenset(self._writers)

    def about(self, name: str) -> frozenset[str]:
        """All that can play a part in what becomes of a variable."""
        return self._cone(name).names

    def explain(self, states: Iterable[State], name: str, value: Value) -> bool:
        """Return whether in a run of effects from one of the states the variable gets the value."""
        cone = self._cone(name)
        looked = 0
        seen: set[tuple[Value | None, ...]] = set()
        names = tuple(cone.names)
        frontier = [{each: state[each] for each in names} for state in states]
        for _ in range(_DEPTH):
            following: list[dict[str, Value | None]] = []
            for state in frontier:
                key = tuple(state[each] for each in names)
                if key in seen:
                    continue
                seen.add(key)
                looked += 1
                if looked > _MOST:
                    return True
                for effect in cone.effects:
                    if evaluate(effect.guard, state) is False:
                        continue
                    written = writes(effect.actions, state)
                    if written is None:
                        if any(target(action) == name for action in effect.actions):
                            return True
                        continue
                    if self._does(name, value, written, state):
                        return True
                    changed = {n: v for n, v in written.items() if state[n] is not None and state[n] != v}
                    if changed:
                        following.append({**state, **changed})
            frontier = following
        return False

    def _does(self, name: str, value: Value, written: Mapping[str, Value], state: State) -> bool:
        if name not in written:
            return False
        return written[name] == value or (value in self._between.get(name, ()) and written[name] != state[name])

    def _cone(self, name: str) -> _Cone:
        if name not in self._cones:
            effects: dict[str, Effect] = {}
            names: set[str] = set()
            to_see = [name]
            while to_see:
                each = to_see.pop()
                if each in names:
                    continue
                names.add(each)
                for effect in self._writers.get(each, ()):
                    if effect.name not in effects:
                        effects[effect.name] = effect
                        to_see += chain(variables(effect.guard), *((target(a), *reads(a)) for a in effect.actions))
            self._cones[name] = _Cone(tuple(effects.values()), frozenset(names))
        return self._cones[name]
