"""A run of the reference tick, taken on from step to step in place.

Predicates and actions are evaluated as in `automaton.tick`, but no more of them than a step can affect: flags and
finishes whose variables have not changed stay what they are.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from copy import copy
from functools import cached_property, lru_cache

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, Flag, State, reads, target
from sequence_planner.automaton.tick import Writes, conflicts_of, effect_writes, start_guard_holds, writes
from sequence_planner.expressions.evaluation import evaluate, holds
from sequence_planner.expressions.syntax import variables
from sequence_planner.expressions.types import Value
from sequence_planner.planning.engine import Task
from sequence_planner.planning.goals.pursuit import Goals, moved, settled
from sequence_planner.planning.sat.following import Following

_KEPT = 1000  # sets of variables that have changed


class ReferenceTick:
    """What all runs of one automaton under one supervisor have in common."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._flags = Following(automaton)
        self.automaton = automaton
        self.safe = None if supervisor.safe.everything else supervisor.safe
        self.following = lru_cache(_KEPT)(self._following)  # the flags that can change when the variables have
        self.effects = {effect.name: effect for effect in automaton.effects}

    def _following(self, changed: frozenset[str]) -> tuple[Flag, ...]:
        return tuple(self._flags.flags(changed))

    @cached_property
    def effect_readers(self) -> Mapping[str, tuple[str, ...]]:
        """By variable or flag, the effects, faults apart, whose guard or actions read it or whose actions write it."""
        readers: dict[str, dict[str, None]] = defaultdict(dict)
        for effect in self.automaton.effects:
            acted = (name for action in effect.actions for name in (target(action), *reads(action)))
            for name in () if effect.fault else (*variables(effect.guard), *acted):
                readers[name][effect.name] = None
        return {name: tuple(names) for name, names in readers.items()}


class ReferenceRun:
    """The state after step 3 or a start, and the goals of a task that are missing there.

    Once a step has failed, the run is of no use any more.
    """

    def __init__(self, tick: ReferenceTick, task: Task) -> None:
        self.values = dict(task.state)
        self.goals = task.goals
        self._tick = tick
        self._circumstances = task.circumstances
        self._published: State = task.state
        self._due: dict[str, Writes] = {}  # what each ability whose finish guard holds writes
        # To be looked at in the next step 2. The flags of the state to begin with may still be those of an earlier
        # tick, so at first that is everything.
        self._finishers = set(tick.automaton.abilities)
        self._synchronised = False
        self._possible: dict[str, Writes] = {}  # what each effect that would change something writes
        self._effects: set[str] | None = None  # to be looked at; None before somebody has asked

    def look_ahead(self) -> None:
        """Evaluate everything once, so that forks that begin here need not, each for itself."""
        before = self.values
        self.values = before.copy()
        self._synchronise(set())
        self._synchronised = self.values == before
        self.values = before
        self._finished()

    def fork(self, goals: Goals | None = None) -> ReferenceRun:
        """A run of its own that goes on from here, towards other `goals` if there are any."""
        fork = copy(self)
        if goals is not None:
            fork.goals = goals
        fork.values, fork._due, fork._finishers = self.values.copy(), self._due.copy(), self._finishers.copy()
        fork._possible = self._possible.copy()
        fork._effects = None if self._effects is None else self._effects.copy()
        return fork

    @property
    def key(self) -> object:
        """Equal where the same can follow."""
        values, published = self.values, self._published
        unseen = tuple(name for name in self._tick.automaton.outputs if values[name] != published[name])
        seen = tuple(published[name] for name in unseen)
        return tuple(values.values()), tuple((goal.name, goal.at) for goal in self.goals), unseen, seen

    def everything(self, first: Iterable[str]) -> tuple[str, ...]:
        """A largest set of effects that can happen together and change something, those of `first` before others."""
        possible = self._changing()
        chosen: list[str] = []
        together: Writes = {}
        for name in dict.fromkeys((*(name for name in first if name in possible), *sorted(possible))):
            written = possible[name]
            if all(together.get(each, value) == value for each, value in written.items()):
                chosen.append(name)
                together |= written
        return tuple(chosen)

    def happening(self, effects: Iterable[str]) -> tuple[str, ...]:
        """Those of `effects` that can happen and would change something, each once."""
        return tuple(name for name in dict.fromkeys(effects) if self._changes(name) is not None)

    def may_start(self, name: str) -> bool:
        """Whether its guards hold; the supervisor and what it would revert may still keep it."""
        return start_guard_holds(self._tick.automaton.abilities[name], self.values)

    def has_started(self, name: str) -> bool:
        """Whether what its start writes is so already."""
        written = writes(self._tick.automaton.abilities[name].start_actions, self.values)
        return written is not None and all(self.values[each] == value for each, value in written.items())

    def take(self, effects: Iterable[str], starts: Iterable[str]) -> bool:
        """One tick: whether all of it can be, and may be."""
        return self.settle(effects) and all(map(self.start, starts))

    def settle(self, effects: Iterable[str]) -> bool:
        """The next tick up to step 3, `effects` happening in its sense; whether that can be, and may be."""
        self._published = self.values.copy()
        together: Writes = {}
        for name in effects:
            written = effect_writes(self._tick.effects[name], self.values)
            if written is None or any(together.get(each, value) != value for each, value in written.items()):
                return False
            together |= written
        changed = self._write(together)
        changed |= self._write(self._finished())
        self._synchronise(changed)
        goals = settled(self.goals, self.values)
        if goals is None or not self._allowed():
            return False
        self.goals = goals
        return True

    def start(self, name: str) -> bool:
        """Step 5, one start, which must not set back an output that nobody has seen yet; whether it may be taken."""
        values, automaton = self.values, self._tick.automaton
        written = writes(automaton.abilities[name].start_actions, values) if self.may_start(name) else None
        if written is None or not self._is_safe():
            return False
        published = self._published
        outputs = automaton.outputs.intersection(written)
        if any(values[output] != published[output] and written[output] == published[output] for output in outputs):
            return False
        self._synchronise(self._write(written))
        goals = moved(self.goals, values)
        if goals is None or not self._is_safe() or not self._allowed():
            return False
        self.goals = goals
        return True

    def _changing(self) -> Mapping[str, Writes]:
        """The effects that are counted on and would change something, with all that each writes."""
        for name in self._tick.effects if self._effects is None else self._effects:
            written = self._changes(name)
            if written is None:
                self._possible.pop(name, None)
            else:
                self._possible[name] = written
        self._effects = set()
        return self._possible

    def _changes(self, name: str) -> Writes | None:
        """All that an effect writes; None if it is not counted on, cannot happen, or changes nothing."""
        effect = self._tick.effects[name]
        if effect.fault or effect.resource in self._circumstances.offline:
            return None
        written = effect_writes(effect, self.values)
        changes = written is not None and any(self.values[each] != value for each, value in written.items())
        return written if changes else None

    def _finished(self) -> Writes:
        """What step 2 writes: of two abilities that would write different values neither does."""
        for name in self._finishers:
            ability = self._tick.automaton.abilities[name]
            self._due.pop(name, None)
            if ability.finish_guard is not None and holds(ability.finish_guard, self.values):
                written = writes(ability.finish_actions, self.values)
                if written is not None:
                    self._due[name] = written
        self._finishers.clear()
        together: Writes = {}
        due = self._due.values()
        if all(together.setdefault(name, value) == value for written in due for name, value in written.items()):
            return together
        refused = {name for one, other, _ in conflicts_of(self._due) for name in (one, other)}
        applied = (written for name, written in self._due.items() if name not in refused)
        return {name: value for written in applied for name, value in written.items()}

    def _write(self, written: Writes) -> set[str]:
        """The variables that have changed."""
        changed = {name for name, value in written.items() if self.values[name] != value}
        for name in changed:
            self._set(name, written[name])
        return changed

    def _synchronise(self, changed: set[str]) -> None:
        for flag in self._tick.following(frozenset(changed)) if self._synchronised else self._tick.automaton.flags:
            truth = evaluate(flag.predicate, self.values)
            if truth is not None and truth is not self.values[flag.name]:
                self._set(flag.name, truth)
        self._synchronised = True

    def _set(self, name: str, value: Value) -> None:
        self.values[name] = value
        self._finishers.update(self._tick.automaton.finish_readers.get(name, ()))
        if self._effects is not None:
            self._effects.update(self._tick.effect_readers.get(name, ()))

    def _allowed(self) -> bool:
        return all(evaluate(condition, self.values) is False for condition in self._circumstances.avoid)

    def _is_safe(self) -> bool:
        return self._tick.safe is None or self._tick.safe.includes(self.values)
