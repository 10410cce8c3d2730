"""Lookahead in every tick: simulation of the remaining plan on the compiled tick, with memoization."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping, Sequence

from sequence_planner.automaton.automaton import State
from sequence_planner.automaton.compiled_tick import CompiledRun
from sequence_planner.automaton.compiler import CompiledTick, Compiler
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.tick import Writes
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.types import Value
from sequence_planner.planning.goals.compiled import CompiledGoals, CompiledProgress
from sequence_planner.planning.problem import Circumstances, Goal, PlanTick, goals_of
from sequence_planner.planning.validation.replay import starts_now

# Moments that may come, and the steps between them: the reference tick's, on compiled runs.

Values = tuple[Value | None, ...]


class PlanMoment(Immutable):
    """A moment after step 3 or a start of its tick.

    `published` are the outputs as last published, `begun` the starts of the tick that are not to be taken again.
    """

    run: CompiledRun
    published: Values
    progress: CompiledProgress
    begun: frozenset[str] = frozenset()

    def forked(self) -> PlanMoment:
        """The same moment with a run of its own."""
        return PlanMoment(self.run.fork(), self.published, self.progress, self.begun)


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

    def present(self, run: CompiledRun, published: State, goals: Iterable[Goal]) -> PlanMoment:
        """The moment that `run` has come to; goals that are met already need nothing."""
        progress = self._goals.missing(self._goals.progress(goals), run.values)
        return PlanMoment(run, tuple(map(published.__getitem__, self._outputs)), progress)

    def after_start(self, moment: PlanMoment, name: str) -> PlanMoment | None:
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
        return None if progress is None else PlanMoment(run, moment.published, progress, moment.begun | {name})

    def after_tick(self, moment: PlanMoment, sensed: Writes) -> PlanMoment | None:
        """The moment after step 3 of the next tick, in which the run of `moment` goes on; None when it must not be."""
        run = moment.run
        published = tuple(map(run.values.__getitem__, self._outputs))
        run.sense(sensed)
        run.finish()
        run.synchronise()
        if not self._allowed(run.values):
            return None
        progress = self._goals.settled(moment.progress, run.values)
        return None if progress is None else PlanMoment(run, published, progress)

    def everything(self, run: CompiledRun) -> Writes:
        """Return what a largest set of effects writes that can happen now, earlier ones first."""
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
        """Return what those of `effects` write that can happen now, earlier ones first."""
        together: Writes = {}
        for name in effects:
            written = None if name in self._absent else run.effect(name)
            if written and all(together.get(variable, value) == value for variable, value in written.items()):
                together |= written
        return together

    def together(self, run: CompiledRun, effects: Iterable[str]) -> Writes | None:
        """Return what all of `effects` write now, or None if one cannot happen or two are incompatible."""
        together: Writes = {}
        for name in effects:
            written = None if name in self._absent else run.effect(name)
            if written is None or any(together.get(variable, value) != value for variable, value in written.items()):
                return None
            together |= written
        return together

    def _allowed(self, state: State) -> bool:
        return all(avoided(state) is False for avoided in self._avoided)


# The rest of a plan, simulated in every tick: `replay` on the compiled tick, which remembers what it has seen.
#
# Devices report one after the other, and each report leads to another state; but what follows from it soon is again
# what followed from the one before. So a look ahead mostly ends after a few ticks, at a moment that is known already.

LOOKAHEAD = 250  # moments that one look may visit: it belongs to a tick, which must not be held up
_REMEMBERED = 1_000_000  # values of moments; then all are forgotten
_NEVER = -1

# The values, the outputs published, the goals, what is left of the order and, of that, what this tick has started.
_Key = tuple[Values, Values, CompiledProgress, tuple[str, ...], frozenset[str]]


class Lookahead:
    """Looks ahead of runs of one automaton under one supervisor. Runs that are handed over stay as they are.

    With a set `within`, goals are reached in its states alone.
    """

    def __init__(self, compiled: CompiledTick, supervisor: Supervisor, within: StateSet | None = None) -> None:
        self._compiled = compiled
        self._supervisor = supervisor
        self._goals = CompiledGoals(compiled.names, within)
        self._goals.progress(goals_of(compiled.automaton, compiled.automaton.operations))  # not first in some tick
        self._most = max(_REMEMBERED // max(len(compiled.names), 1), LOOKAHEAD)
        self._known: dict[_Key, int] = {}  # how many ticks the goals take from there, eagerly; or that they never come
        self._exact: dict[tuple[_Key, tuple[PlanTick, ...]], bool] = {}
        self._written: dict[tuple[_Key, tuple[PlanTick, ...]], bool] = {}
        self.face(Circumstances())

    def face(self, circumstances: Circumstances) -> None:
        """From now on runs go on in these circumstances."""
        self._moments = Moments(self._compiled, self._supervisor, self._goals, circumstances)
        self._known.clear()
        self._exact.clear()
        self._written.clear()

    def length(self, run: CompiledRun, published: State, goals: Iterable[Goal], order: Sequence[str]) -> int | None:
        """In how many ticks `order`, each start taken now or later, reaches `goals` when all that can happen happens.

        None when it does not, or not within what one look may visit. See `Replay.eagerly`.
        """
        present = self._moments.present(run, published, goals)
        if not present.progress:
            return 0
        if len(self._known) > self._most:
            self._known.clear()
        ticks = self._known.get(_key(present, tuple(order)))
        if ticks is None:
            ticks = self._search(present, tuple(order))
        return None if ticks == _NEVER else ticks

    def exactly(
        self, run: CompiledRun, published: State, goals: Iterable[Goal], now: Sequence[str], ticks: Sequence[PlanTick]
    ) -> bool:
        """Return whether the starts `now`, then `ticks` as they are written, reach `goals`. See `Replay.exactly`."""
        present = self._moments.present(run, published, goals)
        key = (_key(present, tuple(now)), tuple(ticks))
        if key not in self._exact:
            if len(self._exact) > self._most:
                self._exact.clear()
            self._exact[key] = self._replays(present, now, ticks)
        return self._exact[key]

    def remaining(
        self, run: CompiledRun, published: State, goals: Sequence[Goal], order: Sequence[str], ticks: Sequence[PlanTick]
    ) -> int | None:
        """In how many ticks `order` still reaches `goals`, eagerly or else as `ticks` are written; None if it does not.

        See `Replay.still_reaches`.
        """
        eagerly = self.length(run, published, goals, order)
        if eagerly is not None:
            return eagerly
        return len(ticks) if self.exactly(run, published, goals, starts_now(order, ticks), ticks) else None

    def may_go_on(
        self,
        before: CompiledRun,
        after: CompiledRun,
        published: State,
        goals: Sequence[Goal],
        order: Sequence[str],
        ticks: Sequence[PlanTick],
    ) -> bool:
        """Return whether a start that leads from `before` to `after` leaves `order` able to reach what then are the
        `goals`.

        See `Replay.may_go_on`.
        """
        if self.length(after, published, goals, order) is not None:
            return True
        if self._moments.everything(before):
            return False
        return self.exactly(after, published, goals, starts_now(order, ticks), ticks)

    def as_written(
        self, run: CompiledRun, published: State, goals: Iterable[Goal], order: Sequence[str], ticks: Sequence[PlanTick]
    ) -> bool:
        """Return whether `order` reaches `goals` when what `ticks` have happens in its turn, unless it has happened
        already.

        A start that has to wait comes as soon as it may. So a plan that somebody has seen and taken is carried out as
        it was written, whatever else happens meanwhile: by people who take their time, and by devices beside it.
        """
        present = self._moments.present(run, published, goals)
        key = (_key(present, tuple(order)), tuple(ticks))
        if key not in self._written:
            if len(self._written) > self._most:
                self._written.clear()
            self._written[key] = self._comes_about(present.forked(), order, ticks)
        return self._written[key]

    def _comes_about(self, moment: PlanMoment, order: Sequence[str], ticks: Sequence[PlanTick]) -> bool:
        pending, later = list(starts_now(order, ticks)), deque(ticks)
        while moment.progress:
            while pending and (after := self._moments.after_start(moment, pending[0])) is not None:
                moment = after
                del pending[0]
            if not later:
                return not moment.progress
            tick = later.popleft()
            settled = self._moments.after_tick(moment, self._moments.possible(moment.run, tick.effects))
            if settled is None:
                return False
            moment = settled
            pending += tick.starts
        return True

    def _search(self, present: PlanMoment, order: tuple[str, ...]) -> int:
        """Depth-first over starting the first of the order now, or waiting a tick.

        A moment has no way to the goals when all that was visited from it has been tried, and none led there: only
        waiting can lead back to an earlier moment, and there the start had been tried before.
        """
        visited: set[_Key] = set()
        path: list[tuple[_Key, int]] = []  # each moment on it, with the ticks since the present
        waiting: list[tuple[PlanMoment, tuple[str, ...], int]] = []  # to be tried after a start, and the path to there
        moment: PlanMoment | None = present.forked()
        ticks = 0
        for _ in range(LOOKAHEAD):
            if moment is None:
                if not waiting:
                    self._known |= dict.fromkeys(visited, _NEVER)
                    return _NEVER
                moment, order, depth = waiting.pop()
                del path[depth:]
                ticks = path[-1][1] + 1
                moment = self._waited(moment)
                continue
            key = _key(moment, order)
            left = self._known.get(key) if moment.progress else 0
            if left is not None and left != _NEVER:
                ways = {each: ticks + left - at for each, at in path}
                self._known |= dict.fromkeys(visited - ways.keys(), _NEVER) | ways
                return ticks + left
            if left == _NEVER or key in visited:
                moment = None
                continue
            visited.add(key)
            path.append((key, ticks))
            started = self._moments.after_start(moment, order[0]) if order else None
            if started is None:
                moment = self._waited(moment)
                ticks += 1
            else:
                waiting.append((moment, order, len(path)))
                moment, order = started, order[1:]
        self._known[path[0][0]] = _NEVER
        return _NEVER

    def _waited(self, moment: PlanMoment) -> PlanMoment | None:
        return self._moments.after_tick(moment, self._moments.everything(moment.run))

    def _replays(self, present: PlanMoment, now: Sequence[str], ticks: Sequence[PlanTick]) -> bool:
        moment = self._all_started(present.forked(), now)
        for tick in ticks:
            sensed = None if moment is None else self._moments.together(moment.run, tick.effects)
            settled = None if moment is None or sensed is None else self._moments.after_tick(moment, sensed)
            moment = self._all_started(settled, tick.starts)
        return moment is not None and not moment.progress

    def _all_started(self, moment: PlanMoment | None, names: Iterable[str]) -> PlanMoment | None:
        for name in names:
            if moment is None:
                return None
            moment = self._moments.after_start(moment, name)
        return moment


def _key(moment: PlanMoment, order: tuple[str, ...]) -> _Key:
    again = moment.begun.intersection(order) if moment.begun else moment.begun
    return (tuple(moment.run.values.values()), moment.published, moment.progress, order, again)
