"""Errands in restart mode: to where production can go on, to rest, to a precondition, and into the safe states."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence

from sequence_planner.automaton.structure import Ability, target
from sequence_planner.automaton.tick import start_guard_holds, writes
from sequence_planner.expressions.evaluation import holds
from sequence_planner.expressions.syntax import TRUE, Expression
from sequence_planner.expressions.types import Value
from sequence_planner.immutable import Immutable, replace
from sequence_planner.planning.advice.conjoining import all_equal
from sequence_planner.planning.advice.proving import Finding, Prover
from sequence_planner.planning.advice.situation import Situation
from sequence_planner.planning.advice.walking import Walk, walked
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Task
from sequence_planner.planning.plan import DEPTH, Goal, Plan, PlanTick, starts_of
from sequence_planner.planning.way_back import WaysBack

_TIGHTENING = 0.1  # of the time that is left

GOAL = "errand"  # the name of an errand's goal

Find = Callable[[Task], Finding]


class Errand(Immutable):
    """`ticks` of restart mode that reach `goal` and walk as `walk` says, to the situation `end`.

    One `into_safe` begins outside the safe states, and has not come to its end before it is inside, whatever else it is
    for. `rest` is a plan from there, if it is one.
    """

    ticks: tuple[PlanTick, ...]
    goal: Expression
    walk: Walk
    end: Situation
    rest: Plan | None = None
    into_safe: bool = False


class Errands:
    """Makes errands by plans that `find` finds, and ways into the safe states, within what `budget` is by then."""

    def __init__(self, prover: Prover, ways: WaysBack, find: Find, budget: Callable[[], Budget]) -> None:
        self._prover = prover
        self._ways = ways
        self._find = find
        self._budget = budget
        self._automaton = prover.automaton

    def startable(self, here: Situation) -> Iterator[Errand]:
        """To have done each restart ability that could start now."""
        for ability in self._automaton.abilities.values():
            if ability.restart and not _absent(here, ability) and start_guard_holds(ability, here.state):
                written = writes(ability.start_actions, here.state)
                if written is not None and (errand := self.to(here, self._done((ability,), written))) is not None:
                    yield errand

    def onwards(self, here: Situation) -> Iterator[Errand]:
        """To where a plan for all goals that has restart abilities needs them no more."""
        plan = self._find(here.restart()).plan
        walk = None if plan is None else self._walk(here, plan.ticks)
        if plan is None or walk is None:
            return
        restarting = [(tick, name) for tick, name in starts_of(plan.ticks) if self._automaton.abilities[name].restart]
        if not restarting:
            return
        abilities = [self._automaton.abilities[name] for name in dict.fromkeys(name for _, name in restarting)]
        cut = self._cut(walk, max(tick for tick, _ in restarting), abilities)
        state = walk.stops[cut].state
        outputs = {target(action) for ability in abilities for action in ability.start_actions}
        written = {name: value for name in sorted(outputs) if (value := state[name]) is not None}
        done = self._done(abilities, written)
        errand = self.to(here, done)
        if errand is not None:
            yield errand
        # What is done for that alone may end elsewhere; the beginning of the plan itself does not.
        ticks = (*plan.ticks[:cut], replace(plan.ticks[cut], starts=()))
        rest = (replace(plan.ticks[cut], effects=()), *plan.ticks[cut + 1 :])
        whole = self._errand(here, ticks, done)
        if whole is not None and (errand is None or whole.ticks != errand.ticks):
            yield replace(whole, rest=replace(plan, ticks=rest))

    def to_rest(self, here: Situation) -> Errand | None:
        """To rest, unless the station rests already."""
        rest = self._automaton.rest
        return None if rest is None or holds(rest, here.state) else self.to(here, rest)

    def to(self, here: Situation, goal: Expression, restart: bool = True) -> Errand | None:
        """To where `goal` holds, from a safe state; without ticks if it does here."""
        task = here.restart((Goal(GOAL, goal),))
        if not restart:
            task = replace(task, circumstances=here.circumstances)
        plan = self._find(task).plan
        return None if plan is None else self._errand(here, self._early(task, plan).ticks, goal)

    def into_safe(self, here: Situation, share: float) -> Errand | None:
        """The shortest way into the safe states, by written guards. Raises `SearchTimeoutError`."""
        way = self._ways.way(here.state, here.circumstances, min(here.longest, DEPTH), self._budget().part(share))
        if way is None:
            return None
        # The goal of an errand is looked at after step 3.
        ticks = (*way.ticks, PlanTick((), ())) if way.ticks[-1].starts else way.ticks
        errand = self._errand(here, ticks, TRUE)
        return None if errand is None else replace(errand, into_safe=True)

    def joined(self, here: Situation, first: Errand, second: Errand) -> Errand | None:
        """One errand that does one after the other."""
        both = self._errand(here, (*first.ticks, *second.ticks), second.goal)
        return None if both is None else replace(both, rest=second.rest, into_safe=first.into_safe)

    def _early(self, task: Task, plan: Plan) -> Plan:
        """Somebody watches an errand, and waits for it."""
        return self._prover.tightened(task, plan, self._budget().part(_TIGHTENING)) if plan.starts else plan

    def _errand(self, here: Situation, ticks: tuple[PlanTick, ...], goal: Expression) -> Errand | None:
        if not ticks:
            return Errand((), goal, Walk((), (), unsupervised=False), here)
        walk = self._walk(here, ticks)
        if walk is None or not self._prover.is_safe(walk.end.state) or not holds(goal, walk.end.state):
            return None
        return Errand(ticks, goal, walk, replace(here, state=walk.end.state, goals=walk.end.goals))

    def _walk(self, here: Situation, ticks: Sequence[PlanTick]) -> Walk | None:
        return walked(self._automaton, self._prover.supervisor, here, ticks)

    def _done(self, abilities: Iterable[Ability], written: dict[str, Value]) -> Expression:
        """What the abilities have written is so, and none of them is under way any more."""
        running = (ability.flag("executing") for ability in abilities)
        return self._all_of([*written.items(), *((name, False) for name in running)])

    def _all_of(self, values: Iterable[tuple[str, Value]]) -> Expression:
        return all_equal(self._automaton, values)

    def _cut(self, walk: Walk, last: int, abilities: Sequence[Ability]) -> int:
        """The first stop after tick number `last`, counted from 1, at which none of the abilities is under way."""
        flags = [ability.flag("executing") for ability in abilities]
        stops = range(last, len(walk.stops))
        done = (number for number in stops if not any(walk.stops[number].state[flag] for flag in flags))
        return next(done, len(walk.stops) - 1)


def _absent(here: Situation, ability: Ability) -> bool:
    return ability.resource in here.circumstances.offline or ability.name in here.circumstances.barred
