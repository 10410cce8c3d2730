"""Operator plans in restart mode (resumption, rest, safe states), without stalled effects, and validated."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence

from sequence_planner.automaton.automaton import Ability, Automaton, Effect, State, reads, target
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.tick import (
    apply_effects,
    effect_writes,
    finish,
    start_guard_holds,
    supervised_start,
    synchronise,
    writes,
)
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.language.evaluator import evaluate, holds
from sequence_planner.language.syntax import TRUE, Expression, Not, conjunction, variables
from sequence_planner.language.types import Value
from sequence_planner.planning.goals.pursuit import Goals, moved, settled
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import DEPTH, Goal, Plan, PlanTick, starts_of
from sequence_planner.planning.recovery.proposals import all_equal
from sequence_planner.planning.recovery.prover import ProofFinding, Prover
from sequence_planner.planning.recovery.request import RecoverySituation
from sequence_planner.planning.recovery_path import WaysBack, violated
from sequence_planner.process.budget import Budget

# Effects that should have happened by now, and the same station without counting on them.
#
# A device that does not do what it was told will not do it for being waited for. It may when it is told something else,
# or when a person has helped: an effect is counted on again as soon as anything has changed that it reads or writes.


class Stall(Immutable):
    """An effect that does not happen as long as these variables have these values."""

    effect: str
    values: tuple[tuple[str, Value], ...]


def stalled_effects(automaton: Automaton, state: State, resources: Iterable[str]) -> frozenset[str]:
    """The effects of these resources, whose abilities are overdue, that should have changed something by now."""
    late = frozenset(resources)
    return frozenset(
        effect.name
        for effect in automaton.effects
        if effect.resource in late and not effect.fault and changes_something(effect, state)
    )


def changes_something(effect: Effect, state: State) -> bool:
    """Return whether the effect can happen, and then something is different."""
    written = effect_writes(effect, state) or {}
    return any(state[name] != value for name, value in written.items())


def stalls(automaton: Automaton, state: State, names: frozenset[str]) -> frozenset[Stall]:
    """Tell what it is that does not happen now."""
    return frozenset(_stall(automaton, state, effect) for effect in automaton.effects if effect.name in names)


def stalling(automaton: Automaton, stalled: frozenset[Stall]) -> Automaton:
    """The station in which these do not happen."""
    conditions = {stall.effect: all_equal(automaton, stall.values) for stall in stalled}
    effects = (
        replace(effect, guard=conjunction(effect.guard, Not(conditions[effect.name])))
        if effect.name in conditions
        else effect
        for effect in automaton.effects
    )
    return replace(automaton, effects=tuple(effects))


def only_written(automaton: Automaton, names: frozenset[str]) -> frozenset[str]:
    """The variables that these effects write, and none of them reads: no device is helped by their values."""
    effects = [effect for effect in automaton.effects if effect.name in names]
    written = {target(action) for effect in effects for action in effect.actions}
    read = {name for effect in effects for name in variables(effect.guard)}
    return frozenset(written - read)


def written_by(automaton: Automaton, names: frozenset[str]) -> frozenset[str]:
    """The variables that these effects should have changed: whoever changes one has helped their device, if it is one
    that is to blame.
    """
    return frozenset(target(action) for each in automaton.effects if each.name in names for action in each.actions)


def _stall(automaton: Automaton, state: State, effect: Effect) -> Stall:
    acted = (name for action in effect.actions for name in (target(action), *reads(action)))
    local = {*variables(effect.guard), *acted} & automaton.variables.keys()
    return Stall(effect.name, tuple((name, value) for name in sorted(local) if (value := state[name]) is not None))


# Manual plans held against the reference tick, step by step and by everything that is demanded of them.

_UNSUPERVISED = Supervisor(StateSet((), ()), {})


class Stop(Immutable):
    """After step 3 of a tick, and the goals of operations that are missing there."""

    state: State
    goals: Goals


class Walk(Immutable):
    """The stops of a manual plan, one for each tick, and the specifications that it alone violates.

    `unsupervised` says that it starts something outside the safe states.
    """

    stops: tuple[Stop, ...]
    breaks: tuple[str, ...]
    unsupervised: bool

    @property
    def end(self) -> Stop:
        """The last stop."""
        return self.stops[-1]


def walked(
    automaton: Automaton, supervisor: Supervisor, begin: RecoverySituation, ticks: Sequence[PlanTick]
) -> Walk | None:
    """The walk that `ticks` are in restart mode; None if they are none, or fail a formula of an operation on the way.

    As long as the state is outside the safe states abilities start by their written guards, and from the first safe
    one on by the supervisor.
    """
    effects = {effect.name: effect for effect in automaton.effects if not effect.fault}
    offline = begin.circumstances.offline
    state, goals = begin.state, begin.goals
    inside, unsupervised = supervisor.safe.includes(state), False
    before = violated(automaton, state)
    broken: set[str] = set()
    stops: list[Stop] = []
    for tick in ticks:
        published = state
        if any(name not in effects or effects[name].resource in offline for name in tick.effects):
            return None
        sensed = apply_effects(state, [effects[name] for name in tick.effects])
        if sensed is None or len({*tick.effects, *tick.starts}) < len(tick.effects) + len(tick.starts):
            return None
        state = synchronise(automaton, finish(automaton, sensed).state)
        left = settled(goals, state)
        if left is None or not _allowed(begin, state):
            return None
        goals = left
        inside = inside or supervisor.safe.includes(state)
        broken.update(violated(automaton, state))
        stops.append(Stop(state, goals))
        for name in tick.starts:
            ability = automaton.abilities[name]
            if _barred(begin, ability):
                return None
            unsupervised = unsupervised or not inside
            after = supervised_start(automaton, supervisor if inside else _UNSUPERVISED, published, state, ability)
            left = None if after is None else moved(goals, after)
            if after is None or left is None or not _allowed(begin, after):
                return None
            state, goals = after, left
            inside = inside or supervisor.safe.includes(state)
            broken.update(violated(automaton, state))
    breaks = tuple(name for name in automaton.specifications if name in broken.difference(before))
    return Walk(tuple(stops), breaks, unsupervised)


def _allowed(begin: RecoverySituation, state: State) -> bool:
    return all(evaluate(avoided, state) is False for avoided in begin.circumstances.avoid)


def _barred(begin: RecoverySituation, ability: Ability) -> bool:
    """As in restart mode: restart abilities are not."""
    return ability.resource in begin.circumstances.offline or ability.name in begin.circumstances.barred


# Manual plans in restart mode: to where production can go on, to rest, to a precondition, and into the safe states.

_TIGHTENING = 0.1  # of the time that is left

GOAL = "errand"  # the name of a manual plan's goal

Find = Callable[[PlanningTask], ProofFinding]


class ManualPlan(Immutable):
    """`ticks` of restart mode that reach `goal` and walk as `walk` says, to the situation `end`.

    One `into_safe` begins outside the safe states, and has not come to its end before it is inside, whatever else it is
    for. `rest` is a plan from there, if it is one.
    """

    ticks: tuple[PlanTick, ...]
    goal: Expression
    walk: Walk
    end: RecoverySituation
    rest: Plan | None = None
    into_safe: bool = False


class ManualPlanner:
    """Makes manual plans by plans that `find` finds, and ways into the safe states, within what `budget` is by then."""

    def __init__(self, prover: Prover, ways: WaysBack, find: Find, budget: Callable[[], Budget]) -> None:
        self._prover = prover
        self._ways = ways
        self._find = find
        self._budget = budget
        self._automaton = prover.automaton

    def startable(self, here: RecoverySituation) -> Iterator[ManualPlan]:
        """To have done each restart ability that could start now."""
        for ability in self._automaton.abilities.values():
            if ability.restart and not _absent(here, ability) and start_guard_holds(ability, here.state):
                written = writes(ability.start_actions, here.state)
                if written is not None and (manual := self.to(here, self._done((ability,), written))) is not None:
                    yield manual

    def onwards(self, here: RecoverySituation) -> Iterator[ManualPlan]:
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
        manual = self.to(here, done)
        if manual is not None:
            yield manual
        # What is done for that alone may end elsewhere; the beginning of the plan itself does not. Some of it may still
        # be under way where the goals are reached.
        ticks = (*plan.ticks[:cut], replace(plan.ticks[cut], starts=()))
        rest = (replace(plan.ticks[cut], effects=()), *plan.ticks[cut + 1 :])
        finished = [ability for ability in abilities if not state[ability.flag("executing")]]
        whole = self._manual_plan(here, ticks, self._done(finished, written))
        if whole is not None and (manual is None or whole.ticks != manual.ticks):
            yield replace(whole, rest=replace(plan, ticks=rest))

    def to_rest(self, here: RecoverySituation) -> ManualPlan | None:
        """To rest, unless the station rests already."""
        rest = self._automaton.rest
        return None if rest is None or holds(rest, here.state) else self.to(here, rest)

    def to(self, here: RecoverySituation, goal: Expression, restart: bool = True) -> ManualPlan | None:
        """To where `goal` holds, from a safe state; without ticks if it does here."""
        task = here.restart((Goal(GOAL, goal),))
        if not restart:
            task = replace(task, circumstances=here.circumstances)
        plan = self._find(task).plan
        return None if plan is None else self._manual_plan(here, self._early(task, plan).ticks, goal)

    def into_safe(self, here: RecoverySituation, share: float) -> ManualPlan | None:
        """The shortest way into the safe states, by written guards. Raises `SearchTimeoutError`."""
        way = self._ways.way(here.state, here.circumstances, min(here.longest, DEPTH), self._budget().part(share))
        if way is None:
            return None
        # The goal of a manual plan is looked at after step 3.
        ticks = (*way.ticks, PlanTick((), ())) if way.ticks[-1].starts else way.ticks
        manual = self._manual_plan(here, ticks, TRUE)
        return None if manual is None else replace(manual, into_safe=True)

    def joined(self, here: RecoverySituation, first: ManualPlan, second: ManualPlan) -> ManualPlan | None:
        """One manual plan that does one after the other."""
        both = self._manual_plan(here, (*first.ticks, *second.ticks), second.goal)
        return None if both is None else replace(both, rest=second.rest, into_safe=first.into_safe)

    def _early(self, task: PlanningTask, plan: Plan) -> Plan:
        """Somebody watches a manual plan, and waits for it."""
        return self._prover.tightened(task, plan, self._budget().part(_TIGHTENING)) if plan.starts else plan

    def _manual_plan(self, here: RecoverySituation, ticks: tuple[PlanTick, ...], goal: Expression) -> ManualPlan | None:
        if not ticks:
            return ManualPlan((), goal, Walk((), (), unsupervised=False), here)
        walk = self._walk(here, ticks)
        if walk is None or not self._prover.is_safe(walk.end.state) or not holds(goal, walk.end.state):
            return None
        return ManualPlan(ticks, goal, walk, replace(here, state=walk.end.state, goals=walk.end.goals))

    def _walk(self, here: RecoverySituation, ticks: Sequence[PlanTick]) -> Walk | None:
        return walked(self._automaton, self._prover.supervisor, here, ticks)

    def _done(self, abilities: Iterable[Ability], written: dict[str, Value]) -> Expression:
        """Say that what the abilities have written is so, and none of them is under way any more."""
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


def _absent(here: RecoverySituation, ability: Ability) -> bool:
    return ability.resource in here.circumstances.offline or ability.name in here.circumstances.barred
