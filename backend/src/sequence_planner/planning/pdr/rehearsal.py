"""Ways to the goals, found through some of the variables, tried on the reference tick."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Ability, Automaton, State, target
from sequence_planner.automaton.tick import apply_effects, effect_writes, finish, supervised_start, synchronise
from sequence_planner.expressions.evaluation import evaluate, holds
from sequence_planner.expressions.syntax import Expression, conjunction, conjuncts
from sequence_planner.immutable import Immutable
from sequence_planner.planning.engine import Task
from sequence_planner.planning.goals.pursuit import settled
from sequence_planner.planning.pdr.relation import Relation
from sequence_planner.planning.pdr.steps import Step

Names = frozenset[str]
_NOTHING: Names = frozenset()


class _Failed(Exception):
    """It fails, and these variables, which are not seen, may tell why."""

    def __init__(self, names: Iterable[str]) -> None:
        super().__init__()
        self.names = frozenset(names)


class Rehearsal(Immutable):
    """Tries what is planned for `task` with sight of the variables `kept` alone; `oracles` spoke for the others."""

    automaton: Automaton
    supervisor: Supervisor
    task: Task
    kept: Names
    oracles: Mapping[str, Names]

    def missing(self, begin: State, run: Iterable[Step], relation: Relation) -> Names | None:
        """None when it succeeds; else variables that matter where it fails first, if these can be told."""
        state, goals = begin, self.task.goals
        try:
            for step in run:
                if not relation.includes(step.cube, state):
                    return _NOTHING
                after = self._settled(state, step)
                left = settled(goals, after)
                if not left:
                    return _NOTHING if left is None else None
                state, goals = self._started(state, after, step), left
                if step.following is not None and not relation.includes(step.following.cube, state):
                    raise _Failed(name for oracle in step.oracles for name in self.oracles[oracle])
        except _Failed as failed:
            return failed.names - self.kept
        return _NOTHING

    def _settled(self, state: State, step: Step) -> State:
        """The state after step 3 of the tick."""
        effects = [effect for effect in self.automaton.effects if effect.name in step.effects]
        for effect in effects:
            if effect_writes(effect, state) is None:
                raise _Failed(self._denied(effect.guard, state))
        sensed = apply_effects(state, effects)
        if sensed is None:
            raise _Failed(target(action) for effect in effects for action in effect.actions)
        return self._allowed(synchronise(self.automaton, finish(self.automaton, sensed).state))

    def _started(self, published: State, state: State, step: Step) -> State:
        for name in step.starts:
            ability = self.automaton.abilities[name]
            after = supervised_start(self.automaton, self.supervisor, published, state, ability)
            if after is None:
                raise _Failed(self._kept_from(ability, state))
            state = self._allowed(after)
        return state

    def _kept_from(self, ability: Ability, state: State) -> Iterable[str]:
        """What may keep `ability` from its start."""
        guard = conjunction(ability.enabled, ability.start_guard)
        if not holds(guard, state):
            return self._denied(guard, state)
        allowed = self.supervisor.guards.get(ability.name, self.supervisor.safe)
        return allowed.names if not allowed.includes(state) else map(target, ability.start_actions)

    def _allowed(self, state: State) -> State:
        if any(evaluate(condition, state) is not False for condition in self.task.circumstances.avoid):
            raise _Failed(())
        return state

    def _denied(self, guard: Expression, state: State) -> Names:
        """The hidden variables of the first part of `guard` that fails and has any."""
        for part in conjuncts(guard):
            hidden = read_variables(self.automaton, (part,)) - self.kept
            if hidden and not holds(part, state):
                return hidden
        return _NOTHING
