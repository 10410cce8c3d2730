"""Moments that may come, and the steps between them: the reference tick's, on compiled runs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from sequence_planner.automaton.compiled import CompiledRun, CompiledTick
from sequence_planner.automaton.compiled.functions import Compiler
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import State
from sequence_planner.automaton.tick import Writes
from sequence_planner.expressions.types import Value
from sequence_planner.immutable import Immutable
from sequence_planner.planning.goals.compiled_goals import CompiledGoals, Progress
from sequence_planner.planning.plan import Circumstances, Goal

Values = tuple[Value | None, ...]


class Moment(Immutable):
    """A moment after step 3 or a start of its tick.

    `published` are the outputs as last published, `begun` the starts of the tick that are not to be taken again.
    """

    run: CompiledRun
    published: Values
    progress: Progress
    begun: frozenset[str] = frozenset()

    def forked(self) -> Moment:
        """The same moment with a run of its own."""
        return Moment(self.run.fork(), self.published, self.progress, self.begun)


class Moments:
    """Goes from moment to moment of one automaton under one supervisor in given circumstances."""

    def __init__(
        self, compiled: CompiledTick, supervisor: Supervisor, goals: CompiledGoals, circumstances: Circumstances
    ) -> None:
        automaton, offline = compiled.automaton, circumstances.offline
        self._safe = supervisor.safe
        self._goals = goals
        self._outputs = tuple(sorted(automaton.outputs))
        self._places = {effect.name: place for place, effect in enumerate(automaton.effects)}
        self._absent = frozenset(effect.name for effect in automaton.effects if effect.resource in offline)
        self._barred = frozenset(name for name, ability in automaton.abilities.items() if circumstances.bars(ability))
        self._avoided = Compiler(compiled.names).truths(circumstances.avoid)

    def present(self, run: CompiledRun, published: State, goals: Iterable[Goal]) -> Moment:
        """The moment that `run` has come to; goals that are met already need nothing."""
        progress = self._goals.missing(self._goals.progress(goals), run.values)
        return Moment(run, tuple(map(published.__getitem__, self._outputs)), progress)

    def after_start(self, moment: Moment, name: str) -> Moment | None:
        """The moment after the start of an ability, with a run of its own; None while something keeps it."""
        if name in self._barred or name in moment.begun or not moment.run.may_start(name):
            return None
        if not self._safe.includes(moment.run.values):
            return None
        pending = [
            (output, published)
            for output, published in zip(self._outputs, moment.published, strict=True)
            if moment.run.values[output] != published
        ]
        run = moment.run.fork()
        if not run.start(name) or any(run.values[output] == published for output, published in pending):
            return None
        if not self._safe.includes(run.values) or not self._allowed(run.values):
            return None
        progress = self._goals.moved(moment.progress, run.values)
        return None if progress is None else Moment(run, moment.published, progress, moment.begun | {name})

    def after_tick(self, moment: Moment, sensed: Writes) -> Moment | None:
        """The moment after step 3 of the next tick, in which the run of `moment` goes on; None when it must not be."""
        run = moment.run
        published = tuple(map(run.values.__getitem__, self._outputs))
        run.sense(sensed)
        run.finish()
        run.synchronise()
        if not self._allowed(run.values):
            return None
        progress = self._goals.settled(moment.progress, run.values)
        return None if progress is None else Moment(run, published, progress)

    def everything(self, run: CompiledRun) -> Writes:
        """What a largest set of effects writes that can happen now, earlier ones first."""
        possible: Mapping[str, Writes] = run.effects()
        if self._absent:
            possible = {name: changes for name, changes in possible.items() if name not in self._absent}
        if len(possible) < 2:
            return next(iter(possible.values()), {})
        together: Writes = {}
        for name in sorted(possible, key=self._places.__getitem__):
            written = run.effect(name) or {}
            if all(together.get(variable, value) == value for variable, value in written.items()):
                together |= written
        return together

    def possible(self, run: CompiledRun, effects: Iterable[str]) -> Writes:
        """What those of `effects` write that can happen now, earlier ones first."""
        together: Writes = {}
        for name in effects:
            written = None if name in self._absent else run.effect(name)
            if written and all(together.get(variable, value) == value for variable, value in written.items()):
                together |= written
        return together

    def together(self, run: CompiledRun, effects: Iterable[str]) -> Writes | None:
        """What all of `effects` write now, or None if one cannot happen or two are incompatible."""
        together: Writes = {}
        for name in effects:
            written = None if name in self._absent else run.effect(name)
            if written is None or any(together.get(variable, value) != value for variable, value in written.items()):
                return None
            together |= written
        return together

    def _allowed(self, state: State) -> bool:
        return all(avoided(state) is False for avoided in self._avoided)
