"""The rest of a plan, simulated in every tick: `replay` on the compiled tick, which remembers what it has seen.

Devices report one after the other, and each report leads to another state; but what follows from it soon is again what
followed from the one before. So a look ahead mostly ends after a few ticks, at a moment that is known already.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence

from sequence_planner.automaton.compiled import CompiledRun, CompiledTick
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.structure import State
from sequence_planner.planning.goals.compiled_goals import CompiledGoals, Progress
from sequence_planner.planning.plan import Circumstances, Goal, PlanTick, goals_of
from sequence_planner.planning.replaying.moments import Moment, Moments, Values
from sequence_planner.planning.replaying.replay import starts_now

LOOKAHEAD = 250  # moments that one look may visit: it belongs to a tick, which must not be held up
_REMEMBERED = 1_000_000  # values of moments; then all are forgotten
_NEVER = -1

# The values, the outputs published, the goals, what is left of the order and, of that, what this tick has started.
_Key = tuple[Values, Values, Progress, tuple[str, ...], frozenset[str]]


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
        """Whether the starts `now`, then `ticks` as they are written, reach `goals`. See `Replay.exactly`."""
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
        """Whether a start that leads from `before` to `after` leaves `order` able to reach what then are the `goals`.

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
        """Whether `order` reaches `goals` when what `ticks` have happens in its turn, unless it has happened already.

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

    def _comes_about(self, moment: Moment, order: Sequence[str], ticks: Sequence[PlanTick]) -> bool:
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

    def _search(self, present: Moment, order: tuple[str, ...]) -> int:
        """Depth-first over starting the first of the order now, or waiting a tick.

        A moment has no way to the goals when all that was visited from it has been tried, and none led there: only
        waiting can lead back to an earlier moment, and there the start had been tried before.
        """
        visited: set[_Key] = set()
        path: list[tuple[_Key, int]] = []  # each moment on it, with the ticks since the present
        waiting: list[tuple[Moment, tuple[str, ...], int]] = []  # to be tried after a start, and the path to there
        moment: Moment | None = present.forked()
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

    def _waited(self, moment: Moment) -> Moment | None:
        return self._moments.after_tick(moment, self._moments.everything(moment.run))

    def _replays(self, present: Moment, now: Sequence[str], ticks: Sequence[PlanTick]) -> bool:
        moment = self._all_started(present.forked(), now)
        for tick in ticks:
            sensed = None if moment is None else self._moments.together(moment.run, tick.effects)
            settled = None if moment is None or sensed is None else self._moments.after_tick(moment, sensed)
            moment = self._all_started(settled, tick.starts)
        return moment is not None and not moment.progress

    def _all_started(self, moment: Moment | None, names: Iterable[str]) -> Moment | None:
        for name in names:
            if moment is None:
                return None
            moment = self._moments.after_start(moment, name)
        return moment


def _key(moment: Moment, order: tuple[str, ...]) -> _Key:
    again = moment.begun.intersection(order) if moment.begun else moment.begun
    return (tuple(moment.run.values.values()), moment.published, moment.progress, order, again)
