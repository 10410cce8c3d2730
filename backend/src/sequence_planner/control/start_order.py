"""The plan that is being followed: what was started, what runs, what comes next."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

from sequence_planner.control.moment import Moment
from sequence_planner.planning.plan import Plan, PlanTick

# An operator looks back on the last minute, and on a few steps at least; older ones are history, and so are those of
# abilities that follow one another faster than can be read.
LOOK_BACK = 60.0
FEWEST_STEPS = 12
REMEMBERED_STEPS = 40


@dataclass
class Step:
    """One start, planned or taken; `ended` is None while it runs. It has `reacted` once it was seen executing."""

    number: int
    ability: str
    tick: int
    started: Moment | None = None
    ended: Moment | None = None
    reacted: bool = False


@dataclass
class StartOrder:
    """What is left of a plan, and the steps taken so far, of this plan and of those before."""

    plan: Plan | None = None
    goals: frozenset[str] = frozenset()  # what it was made for and is not reached yet
    requested: frozenset[str] = frozenset()  # what was asked of the planner, left out or not
    past: list[Step] = field(default_factory=list)
    ahead: list[Step] = field(default_factory=list)
    _numbers: int = 0

    def adopt(self, plan: Plan | None, goals: Iterable[str], requested: Iterable[str]) -> None:
        """Follow `plan` from now on; steps already taken stay what they are."""
        self.plan = plan
        self.goals = frozenset(goals)
        self.requested = frozenset(requested)
        self.ahead = [self._step(ability, tick) for tick, ability in plan.starts] if plan else []

    def copy(self) -> StartOrder:
        """One that does not change when this one does."""
        return replace(self, past=[replace(step) for step in self.past], ahead=[replace(step) for step in self.ahead])

    def drop(self) -> None:
        """What is left of the plan has become needless."""
        self.ahead.clear()

    def start(self, now: Moment) -> Step:
        """The first step ahead is taken. An earlier run of its ability that was never seen to finish is over."""
        step = self.ahead.pop(0)
        self.finish(step.ability, now)
        step.started = now
        self.past.append(step)
        self._forget(now)
        return step

    def _forget(self, now: Moment) -> None:
        ended = [(past, past.ended.monotonic) for past in self.past if past.ended is not None]
        since = now.monotonic - LOOK_BACK
        for age, (step, at) in enumerate(reversed(ended), 1):
            if age > REMEMBERED_STEPS or (age > FEWEST_STEPS and at < since):
                self.past.remove(step)

    def pull_forward(self, index: int) -> None:
        """The step ahead at `index` becomes the next. The order then is no longer that of the plan's ticks."""
        self.ahead.insert(0, self.ahead.pop(index))

    def finish(self, ability: str, now: Moment) -> bool:
        """The ability finished; whether it was running."""
        for step in self.past:
            if step.ability == ability and step.ended is None:
                step.ended = now
                return True
        return False

    @property
    def running(self) -> list[Step]:
        """The steps that have started and not finished."""
        return [step for step in self.past if step.ended is None]

    @property
    def names(self) -> tuple[str, ...]:
        """The abilities still to be started, in order."""
        return tuple(step.ability for step in self.ahead)

    def rest(self, taken: int = 0) -> tuple[tuple[str, ...], Sequence[PlanTick]]:
        """The starts ahead after the next `taken`, and those ticks of the plan that lie behind the tick under way.

        The tick under way is the one of the last start taken, or the beginning of the plan. There are no such ticks
        when the order is no longer the plan's.
        """
        names = self.names[taken:]
        planned = self.plan.starts if self.plan is not None else ()
        done = len(planned) - len(names)
        if self.plan is None or tuple(name for _, name in planned[done:]) != names:
            return names, ()
        current = planned[done - 1][0] if done else 0
        return names, self.plan.ticks[current:]

    def _step(self, ability: str, tick: int) -> Step:
        self._numbers += 1
        return Step(self._numbers, ability, tick)
