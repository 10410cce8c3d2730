"""A station's state, taken from step to step of the tick; only what a change can affect is evaluated again.

Whatever is derived from the state is kept: the flags in the state itself, the finishes that are due, the operations
whose goal or precondition holds, the abilities whose start guard holds. A change notes which of these it may affect,
and the step that needs them looks at those noted. A note too many costs time and nothing else.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Set
from copy import copy
from heapq import heappop, heappush

from sequence_planner.automaton.automaton import State
from sequence_planner.automaton.compiler import CompiledTick
from sequence_planner.automaton.tick import Conflicts, Writes, conflicts_of
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.types import Value


class Finished(Immutable):
    """The outcome of step 2: who finished, and which abilities would have written different values to one variable."""

    finished: tuple[str, ...] = ()
    conflicts: Conflicts = ()


class CompiledRun:
    """One run of the tick. Its methods are the functions of `automaton.tick`, taken on its state in place."""

    def __init__(self, compiled: CompiledTick, state: State) -> None:
        self._compiled = compiled
        self._values = {name: state[name] for name in compiled.names}
        self._snapshot: State | None = None
        self._levels: list[int] = []  # a heap of those in `_flags`
        self._flags: dict[int, set[str]] = {}  # to be looked at again, by level
        for flag, level in compiled.level.items():
            self._note_flags(level, (flag,))
        self._finishes = set(compiled.finish_guards)
        self._due: dict[str, Writes] = {}  # of each ability whose finish guard holds
        self._finished = Finished()
        self._written: Writes = {}  # by all that finish
        # What nobody has asked for yet is None, and nothing is noted about it.
        self._operations: set[str] | None = None
        self._activating: set[str] = set()
        self._completing: set[str] = set()
        self._recorded: frozenset[str] | None = None
        self._starts: set[str] | None = None
        self._startable: set[str] = set()
        self._effects: set[str] | None = None
        self._possible: dict[str, Writes] = {}  # what each enabled effect would change

    def fork(self) -> CompiledRun:
        """A run of its own that goes on from here."""
        fork = copy(self)
        fork._values = self._values.copy()
        fork._levels = self._levels.copy()
        fork._flags = {level: set(flags) for level, flags in self._flags.items()}
        fork._finishes, fork._due = self._finishes.copy(), self._due.copy()
        fork._operations, fork._starts, fork._effects = map(_copied, (self._operations, self._starts, self._effects))
        # Also what is still empty is filled by each run for itself.
        fork._activating, fork._completing = self._activating.copy(), self._completing.copy()
        fork._startable, fork._possible = self._startable.copy(), self._possible.copy()
        return fork

    @property
    def values(self) -> State:
        """The state now, to be read before the next step."""
        return self._values

    @property
    def state(self) -> State:
        """The state now, which later steps do not change."""
        if self._snapshot is None:
            self._snapshot = self._values.copy()
        return self._snapshot

    def sense(self, measured: Mapping[str, Value | None]) -> None:
        """Step 1: take the measured values; None makes a variable unknown."""
        values = self._values
        for name, value in measured.items():
            if values[name] != value:
                self._set(name, value)

    def finish(self) -> Finished:
        """Step 2: every ability whose finish guard holds takes its finish actions, all on the state before them."""
        compiled, values, due = self._compiled, self._values, self._due
        writes: list[Writes] = []
        changed = False
        for name in self._finishes:
            before = due.get(name)
            after = compiled.finish_actions[name].writes(values) if compiled.finish_guards[name](values) else None
            if after is not None:
                due[name] = after
                writes.append(after)
            elif before is not None:
                del due[name]
            changed = changed or before != after
        self._finishes.clear()
        if changed:
            self._settle_finishes()
            writes = [self._written]
        for written in writes:
            for name, value in written.items():
                if values[name] != value and name in self._written:
                    self._set(name, value)
        return self._finished

    def synchronise(self) -> None:
        """Step 3: each flag takes the value of its predicate; one that is undetermined keeps its value."""
        predicates, values = self._compiled.flags, self._values
        while self._levels:
            for flag in self._flags.pop(heappop(self._levels)):
                truth = predicates[flag](values)
                if truth is not None and truth is not values[flag]:
                    self._set(flag, truth)

    def update_operations(self, active: frozenset[str]) -> frozenset[str]:
        """Step 4: the operations active after it, given those active before."""
        compiled, values = self._compiled, self._values
        for name in compiled.goals if self._operations is None else self._operations:
            goal = compiled.goals[name](values)
            _keep(self._completing, name, goal is True)
            _keep(self._activating, name, goal is False and bool(compiled.preconditions[name](values)))
        self._operations = set()
        if self._activating <= active and self._completing.isdisjoint(active):
            return active
        return (active | self._activating) - self._completing

    def record_activity(self, active: frozenset[str]) -> None:
        """After step 4, the operations that expressions read are active or not, and flags that read them follow."""
        if active == self._recorded:
            return
        for name, activity in self._compiled.activities:
            if self._values[activity] is not (name in active):
                self._set(activity, name in active)
        self.synchronise()
        self._recorded = active

    def startable(self) -> Set[str]:
        """The abilities whose `enabled` and written start guard hold. What is returned is true until a change."""
        guards, values = self._compiled.start_guards, self._values
        for name in guards if self._starts is None else self._starts:
            _keep(self._startable, name, bool(guards[name](values)))
        self._starts = set()
        return self._startable

    def effects(self) -> Mapping[str, Writes]:
        """The effects, faults apart, that are enabled and would change something, each with what it would change.

        An unknown variable stays unknown. What is returned is true until a change.
        """
        compiled, values = self._compiled, self._values
        for name in compiled.effect_guards if self._effects is None else self._effects:
            writes = compiled.effect_actions[name].writes(values) if compiled.effect_guards[name](values) else None
            changes = {n: v for n, v in (writes or {}).items() if values[n] is not None and values[n] != v}
            if changes:
                self._possible[name] = changes
            else:
                self._possible.pop(name, None)
        self._effects = set()
        return self._possible

    def effect(self, name: str) -> Writes | None:
        """Return what the effect writes if it is enabled; None if it is not, or is a fault. An unknown variable stays
        so.
        """
        compiled, values = self._compiled, self._values
        if name not in compiled.effect_guards or not compiled.effect_guards[name](values):
            return None
        writes = compiled.effect_actions[name].writes(values)
        return None if writes is None else {n: v for n, v in writes.items() if values[n] is not None}

    def may_start(self, name: str) -> bool:
        """Return whether `name` is among those that are startable, without looking at the others."""
        return bool(self._compiled.start_guards[name](self._values))

    def start(self, name: str) -> bool:
        """Step 5, one start: its actions, then synchronise. False, and nothing done, when they are undetermined."""
        written = self._compiled.start_actions[name].writes(self._values)
        if written is None:
            return False
        self.sense(written)
        self.synchronise()
        return True

    def _set(self, name: str, value: Value | None) -> None:
        self._values[name] = value
        self._snapshot = None
        flags, finishes, operations, starts, effects = self._compiled.dependants[name]
        for level, readers in flags:
            self._note_flags(level, readers)
        self._finishes.update(finishes)
        if self._operations is not None:
            self._operations.update(operations)
        if self._starts is not None:
            self._starts.update(starts)
        if self._effects is not None:
            self._effects.update(effects)

    def _note_flags(self, level: int, flags: Iterable[str]) -> None:
        noted = self._flags.get(level)
        if noted is None:
            heappush(self._levels, level)
            self._flags[level] = set(flags)
        else:
            noted.update(flags)

    def _settle_finishes(self) -> None:
        """Settle who finishes, now that others are due; of two that would write different values, neither."""
        due = sorted(self._due, key=self._compiled.position.__getitem__)
        conflicts = _conflicts({name: self._due[name] for name in due})
        refused = {ability for one, other, _ in conflicts for ability in (one, other)}
        finished = tuple(name for name in due if name not in refused)
        self._finished = Finished(finished, conflicts)
        self._written = {}
        for name in finished:
            self._written |= self._due[name]


def _copied(names: set[str] | None) -> set[str] | None:
    return None if names is None else names.copy()


def _keep(names: set[str], name: str, belongs: bool) -> None:
    if belongs:
        names.add(name)
    else:
        names.discard(name)


def _conflicts(due: Mapping[str, Writes]) -> Conflicts:
    """The conflicts among those that finish, of which there are mostly none."""
    first: Writes = {}
    agree = all(first.setdefault(name, value) == value for writes in due.values() for name, value in writes.items())
    return () if agree else conflicts_of(due)
