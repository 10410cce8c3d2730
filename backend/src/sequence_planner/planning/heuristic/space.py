"""Search space of the heuristic engines: positions, moves, and interference between abilities."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Set
from functools import cached_property, lru_cache

from sequence_planner.automaton.automaton import Ability, Automaton, State, target
from sequence_planner.automaton.compiled_tick import CompiledRun
from sequence_planner.automaton.compiler import CompiledTick
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import Writes
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import TRUE
from sequence_planner.language.types import Value
from sequence_planner.planning.goals.pursuit import Goals, moved, settled
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import PlanTick

# Which abilities can get in each other's way: what either touches, while it runs, matters to the other.


class Interference:
    """The things that each ability of an automaton touches and reads, with the effects that it sets off."""

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
        """Return whether it can matter which of the two starts first."""
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


# The positions of runs, and the moves between them: waiting a tick, and one start within the tick.
#
# Steps are those of `automaton.tick`, taken on compiled runs, with goals and circumstances as plans must respect them.

# Of a wait the effects that happen, of a start its name: what a run is made of.
Move = tuple[str, ...] | str


class RunPosition(Immutable):
    """A moment after step 3 or a start, or, with nothing `begun`, before the first tick.

    `published` has the outputs as last published, `started` the abilities that have started in this tick, and `goals`
    what is still missing.
    """

    run: CompiledRun
    published: Mapping[str, Value | None]
    started: frozenset[str]
    goals: Goals
    begun: bool = True

    @cached_property
    def key(self) -> object:
        """Equal where the same can follow."""
        values = self.run.values
        unseen = tuple((name, value) for name, value in self.published.items() if values[name] != value)
        return self.settled_key, unseen, self.started, self.begun

    @cached_property
    def settled_key(self) -> object:
        """Equal where the same can follow the next step 3."""
        return tuple(self.run.values.values()), tuple((goal.name, goal.at) for goal in self.goals)


class Space:
    """All runs of one task. With `at_once` a tick ends with its first start, as suits abilities done at their start."""

    def __init__(self, compiled: CompiledTick, supervisor: Supervisor, task: PlanningTask, at_once: bool) -> None:
        self._compiled = compiled
        self._task = task
        self.at_once = at_once
        self._safe = None if supervisor.safe.everything else supervisor.safe
        self._follows = any(goal.local != TRUE for goal in task.goals)
        automaton, circumstances = compiled.automaton, task.circumstances
        self._outputs = tuple(automaton.outputs)
        self._written_outputs = {
            a.name: tuple(automaton.outputs.intersection(map(target, a.start_actions)))
            for a in automaton.abilities.values()
        }
        self.idle_effects = frozenset(e.name for e in automaton.effects if e.resource in circumstances.offline)
        self.idle_abilities = frozenset(n for n, a in automaton.abilities.items() if circumstances.bars(a))

    def begin(self) -> RunPosition:
        """Before the first tick."""
        run = CompiledRun(self._compiled, self._task.state)
        return RunPosition(run, {}, frozenset(), self._task.goals, begun=False)

    def effects(self, position: RunPosition) -> dict[str, Writes]:
        """The effects that could happen in the next sense and would change something, with all that they write."""
        values = position.run.values
        possible: dict[str, Writes] = {}
        for effect in position.run.effects():
            written = self._compiled.effect_actions[effect].writes(values)
            if written is not None and effect not in self.idle_effects:
                possible[effect] = {name: value for name, value in written.items() if values[name] is not None}
        return possible

    def everything(self, position: RunPosition, first: Iterable[str] = ()) -> tuple[str, ...]:
        """A largest set of effects that can happen together, those of `first` first."""
        possible = self.effects(position)
        chosen: list[str] = []
        together: Writes = {}
        for name in dict.fromkeys((*(name for name in first if name in possible), *sorted(possible))):
            written = possible[name]
            if all(together.get(each, value) == value for each, value in written.items()):
                chosen.append(name)
                together |= written
        return tuple(chosen)

    def wait(self, position: RunPosition, effects: tuple[str, ...]) -> RunPosition | None:
        """The position after the next step 3, `effects` having happened; None if it must not or cannot be."""
        before = position.run.values
        published = {name: before[name] for name in self._outputs}
        run = position.run.fork()
        together: Writes = {}
        for name in effects:
            written = self._compiled.effect_actions[name].writes(before)
            if written is None or name in self.idle_effects or not self._compiled.effect_guards[name](before):
                return None
            known = {each: value for each, value in written.items() if before[each] is not None}
            if any(together.get(each, value) != value for each, value in known.items()):
                return None
            together |= known
        run.sense(together)
        run.finish()
        run.synchronise()
        goals = settled(position.goals, run.values)
        if goals is None or self._avoided(run.values):
            return None
        return RunPosition(run, published, frozenset(), goals)

    def start(self, position: RunPosition, name: str) -> RunPosition | None:
        """The position after the start of `name`, None if it may not start."""
        before = position.run.values
        if not position.begun or name in position.started or name in self.idle_abilities:
            return None
        if not position.run.may_start(name) or (self._safe is not None and not self._safe.includes(before)):
            return None
        run = position.run.fork()
        if not run.start(name):
            return None
        after = run.values
        if self._reverts(name, position.published, before, after):
            return None
        if (self._safe is not None and not self._safe.includes(after)) or self._avoided(after):
            return None
        goals = moved(position.goals, after) if self._follows else position.goals
        if goals is None:
            return None
        started = RunPosition(run, position.published, position.started | {name}, goals)
        return self.wait(started, ()) if self.at_once else started

    def moved(self, position: RunPosition, move: Move) -> RunPosition | None:
        """The position after a move, None if it may not or cannot be taken."""
        return self.start(position, move) if isinstance(move, str) else self.wait(position, move)

    def _reverts(self, name: str, published: Mapping[str, Value | None], before: State, after: State) -> bool:
        return any(
            before[output] != published[output] and after[output] == published[output]
            for output in self._written_outputs[name]
        )

    def _avoided(self, state: State) -> bool:
        return any(evaluate(condition, state) is not False for condition in self._task.circumstances.avoid)


def ticks_of(moves: Iterable[Move]) -> tuple[PlanTick, ...]:
    """The ticks of a run, which begins with a wait; those after the last wait have no starts."""
    ticks: list[PlanTick] = []
    for move in moves:
        if isinstance(move, str):
            ticks[-1] = PlanTick(ticks[-1].effects, (*ticks[-1].starts, move))
        else:
            ticks.append(PlanTick(move, ()))
    return tuple(ticks)
