"""Whether a plan is one: step by step on the reference tick, and by everything that a task demands.

Whoever made the plan, nothing of it is taken on trust. The functions of the tick are given no more of the automaton
than what a step can affect: flags and finishes whose variables have not changed stay what they are.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Set
from dataclasses import dataclass, replace

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State, target
from sequence_planner.automaton.tick import apply_effects, finish, supervised_start, synchronise
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.planning.engine import Task
from sequence_planner.planning.goals.pursuit import Goals, moved, settled
from sequence_planner.planning.plan import Plan, PlanTick
from sequence_planner.planning.sat.following import Following

_KEPT = 1000  # parts of the automaton for steps that come again


@dataclass(frozen=True)
class _Position:
    """A state after step 3 or a start, and the goals that are missing there.

    `sensed` is the state in which abilities last finished, and `finished` are those whose finish actions were due.
    """

    state: State
    goals: Goals
    sensed: State | None = None
    finished: frozenset[str] = frozenset()


class Acceptance:
    """Accepts plans of one automaton under one supervisor."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._effects = {effect.name: effect for effect in automaton.effects}
        self._following = Following(automaton)
        self._narrow: dict[frozenset[str], Automaton] = {}  # by the variables that have changed

    def accepts(self, task: Task, plan: Plan) -> bool:
        """Whether the ticks of `plan`, exactly as they are written, are a run that the task asks for."""
        return self.ends(task, plan) is not None

    def ends(self, task: Task, plan: Plan) -> tuple[tuple[State, Goals], ...] | None:
        """The states at the ends of the plan's ticks, each with the goals missing there; None if it is not accepted."""
        if len(plan.ticks) > task.longest or not all(self._counted_on(task, tick) for tick in plan.ticks):
            return None
        position = _Position(task.state, task.goals)
        ends: list[tuple[State, Goals]] = []
        for tick in plan.ticks:
            after = self._after(task, position, tick)
            if after is None:
                return None
            position = after
            ends.append((after.state, after.goals))
        return None if position.goals else tuple(ends)

    def _counted_on(self, task: Task, tick: PlanTick) -> bool:
        """Whether the circumstances allow that this happens and that this starts, each of it once."""
        effects = [self._effects.get(name) for name in tick.effects]
        abilities = [self._automaton.abilities.get(name) for name in tick.starts]
        offline, restart = task.circumstances.offline, task.circumstances.restart
        return (
            all(effect and not effect.fault and effect.resource not in offline for effect in effects)
            and all(a and a.resource not in offline and (restart or not a.restart) for a in abilities)
            and max(Counter((*tick.effects, *tick.starts)).values(), default=1) == 1
        )

    def _after(self, task: Task, position: _Position, tick: PlanTick) -> _Position | None:
        before = position.state
        sensed = apply_effects(before, [self._effects[name] for name in tick.effects])
        if sensed is None:
            return None
        finishing = finish(self._finishers(position, sensed), sensed)
        due = frozenset(
            (*finishing.finished, *(name for one, other, _ in finishing.conflicts for name in (one, other)))
        )
        begins = position.sensed is None  # the flags of the state to plan from may still be those of an earlier tick
        changed = _changed(before, finishing.state)
        state = synchronise(self._automaton if begins else self._affected(changed), finishing.state)
        left = settled(position.goals, state)
        for name in tick.starts:
            ability = self._automaton.abilities[name]
            affected = self._affected(frozenset(map(target, ability.start_actions)))
            after = supervised_start(affected, self._supervisor, before, state, ability)
            if after is None or left is None or self._to_avoid(task, state):
                return None
            state, left = after, moved(left, after)
        if left is None or self._to_avoid(task, state):
            return None
        return _Position(state, left, sensed, due)

    def _finishers(self, position: _Position, sensed: State) -> Automaton:
        """The automaton with no other abilities than those that can finish now."""
        if position.sensed is None:
            return self._automaton
        names = set(position.finished)
        for name in _changed(position.sensed, sensed):
            names.update(self._automaton.finish_readers.get(name, ()))
        abilities = self._automaton.abilities
        return replace(self._automaton, abilities={name: abilities[name] for name in abilities if name in names})

    def _affected(self, changed: Iterable[str]) -> Automaton:
        """The automaton with no other flags than those that can follow what has changed."""
        key = frozenset(changed)
        if key not in self._narrow:
            if len(self._narrow) == _KEPT:
                self._narrow.clear()
            self._narrow[key] = replace(self._automaton, flags=tuple(self._following.flags(key)))
        return self._narrow[key]

    def _to_avoid(self, task: Task, state: State) -> bool:
        return any(evaluate(condition, state) is not False for condition in task.circumstances.avoid)


def _changed(before: State, after: State) -> Set[str]:
    return {name for name, value in after.items() if value != before[name]}
