"""Plans made short: no needless starts, and as few ticks as an eager environment lets them have."""

from __future__ import annotations

from collections.abc import Iterable

from sequence_planner.immutable import Immutable
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.heuristic.elimination import Elimination
from sequence_planner.planning.heuristic.interference import Interference
from sequence_planner.planning.heuristic.space import Position, Space
from sequence_planner.planning.plan import PlanTick, starts_of

Ticks = tuple[PlanTick, ...]

_MOST_LOST = 12  # starts that become impossible in a trial: with more it is likely to fail, late


class _Moment(Immutable):
    """The position before a tick, and what happened in it."""

    before: Position
    tick: PlanTick


class Trimmer:
    """Trims plans of one task; `elimination` takes those where nothing happens by itself, however long they are."""

    def __init__(
        self, space: Space, interference: Interference, elimination: Elimination | None, budget: Budget
    ) -> None:
        self._space = space
        self._interference = interference
        self._elimination = elimination
        self._budget = budget

    def trimmed(self, ticks: Ticks) -> Ticks:
        """`ticks` with fewer starts and ticks if possible; as they are when the budget is spent."""
        order = _order(ticks)
        if self._elimination is not None and self._elimination.suits(order):
            order = self._elimination.eliminated(order, self._budget)
            return self._followed(order, (), free=False, most=len(order) + 1) or ticks
        best, found = self._shortened(self._quicker(ticks) or ticks), True
        while found and not self._budget.spent:
            quicker = self._quicker(best)
            found = quicker is not None
            if quicker is not None:
                best = self._shortened(quicker)
        return best

    def _quicker(self, ticks: Ticks) -> Ticks | None:
        """A smaller run with the starts of `ticks`, each as soon as it can be; None if neither way leads to one."""
        helpful = tuple(dict.fromkeys(effect for tick in ticks for effect in tick.effects))
        for free in (True, False):
            quicker = self._followed(_order(ticks), helpful, free, len(ticks))
            if quicker is not None and _size(quicker) < _size(ticks):
                return quicker
        return None

    def _shortened(self, ticks: Ticks) -> Ticks:
        return self._lighter(self._denser(self._lighter(ticks)))

    def _lighter(self, ticks: Ticks) -> Ticks:
        """Without starts that can be left out, one by one with all that cannot happen without them.

        Whatever else there is stays in its tick. What reaches the goals although all happens that can still does: a
        start that is needless only if some device tarries stays.
        """
        best = self._as_written((), self._space.begin(), ticks, eager=True)
        eager = best is not None
        best = best or self._as_written((), self._space.begin(), ticks)
        found = best is not None
        while best is not None and found:  # what was tried may have become needless
            found = False
            number = len(best) - 1
            while number >= 0 and not self._budget.spent:
                lighter = self._lighter_tick(best, number, eager)
                if lighter is None:
                    number -= 1
                else:
                    best, found = lighter, True
                    number = min(number, len(best) - 1)
        return ticks if best is None else tuple(moment.tick for moment in best)

    def _lighter_tick(self, run: tuple[_Moment, ...], number: int, eager: bool) -> tuple[_Moment, ...] | None:
        """The run without one of the starts of a tick, a late one if possible; None if each is needed."""
        tick = run[number].tick
        rest = tuple(moment.tick for moment in run[number + 1 :])
        for index in reversed(range(len(tick.starts))):
            without = PlanTick(tick.effects, tick.starts[:index] + tick.starts[index + 1 :])
            trial = self._as_written(run[:number], run[number].before, (without, *rest), eager)
            if trial is not None:
                return trial
        return None

    def _denser(self, ticks: Ticks) -> Ticks:
        """With fewer ticks: what starts in one is put off to the next, and all that follows comes a tick earlier."""
        best = self._as_written((), self._space.begin(), ticks)
        number = 0
        while best is not None and number < len(best) - 1 and not self._budget.spent:
            late, next_, *rest = (moment.tick for moment in best[number:])
            starts = late.starts + next_.starts
            effects = tuple(dict.fromkeys(late.effects + next_.effects))
            before = best[number].before
            trial = self._as_written(best[:number], before, (PlanTick(effects, starts), *rest), eager=True)
            if trial is None:
                number += 1
            else:
                best = trial
        return ticks if best is None else tuple(moment.tick for moment in best)

    def _as_written(
        self, begun: tuple[_Moment, ...], position: Position, ticks: Iterable[PlanTick], eager: bool = False
    ) -> tuple[_Moment, ...] | None:
        """The run that goes on from `position` with `ticks`, less what cannot happen in its tick, up to the goals.

        Ticks in which nothing happens are left out. When it is `eager`, all else that can happen in a tick happens too.
        None if the goals are not reached, or if too much gets lost.
        """
        moments = list(begun)
        lost = 0
        for tick in ticks:
            if eager:
                effects = self._space.everything(position, tick.effects)
            else:
                possible = self._space.effects(position)
                effects = tuple(name for name in tick.effects if name in possible)
            after = self._space.wait(position, effects)
            if after is None:
                return None
            if not tick.starts and position.begun and after.key == position.key:
                continue  # nothing waits for such a tick
            before, position = position, after
            taken: list[str] = []
            for name in tick.starts if position.goals else ():
                started = self._space.start(position, name)
                if started is None:
                    lost += 1
                else:
                    position = started
                    taken.append(name)
            if lost > _MOST_LOST:
                return None
            moments.append(_Moment(before, PlanTick(effects, tuple(taken))))
            if not position.goals:
                return tuple(moments)
        return None

    def _followed(self, order: Iterable[str], helpful: Iterable[str], free: bool, most: int) -> Ticks | None:
        """The run in which all that can happen does, and each start of `order` comes as soon as it can.

        With `free` a start may overtake others even if it can get in their way. What can never start any more is left
        out. None if goals are not reached in `most` ticks.
        """
        helpful = tuple(helpful)
        position, left = self._space.begin(), list(order)
        ticks: list[PlanTick] = []
        while position.goals:
            happening = self._space.everything(position, helpful)
            later = self._space.wait(position, happening)
            if later is None or len(ticks) >= most or self._budget.spent:
                return None
            if position.begun and later.key == position.key:
                if not left:
                    return None
                del left[0]  # nothing will ever let it start
                position, starts = self._started(position, left, free)
                ticks[-1] = PlanTick(ticks[-1].effects, (*ticks[-1].starts, *starts))
            else:
                position, starts = self._started(later, left, free)
                ticks.append(PlanTick(happening, starts))
        return tuple(ticks)

    def _started(self, position: Position, left: list[str], free: bool) -> tuple[Position, tuple[str, ...]]:
        """The position after all starts of `left` that can be taken in this tick, which are taken out of it."""
        starts: list[str] = []
        index = 0
        while index < len(left) and position.goals:
            name = left[index]
            waits = not free and any(self._interference.between(name, other) for other in left[:index])
            after = None if waits else self._space.start(position, name)
            if after is None:
                index += 1
            else:
                position = after
                starts.append(left.pop(index))
                index = 0
        return position, tuple(starts)


def _order(ticks: Iterable[PlanTick]) -> tuple[str, ...]:
    return tuple(name for _, name in starts_of(ticks))


def _size(ticks: Ticks) -> tuple[int, int]:
    return len(ticks), len(_order(ticks))
