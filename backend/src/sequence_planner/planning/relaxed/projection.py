"""The engine that freezes all that a relaxed plan does not touch, and plans with the rest.

What is left is small however large the station is. A plan of it counts only when it replays on the whole; as long as
it does not, or there is none, more variables are let loose, and in the end other engines decide.
"""

from __future__ import annotations

import operator
from collections.abc import Sequence, Set
from dataclasses import replace

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Ability, Automaton, State, target
from sequence_planner.automaton.transitions import Phase, Transition, transitions
from sequence_planner.expressions.syntax import Assignment, Constant, Expression, conjunction, variables
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Finding, Task
from sequence_planner.planning.plan import Contract, Plan
from sequence_planner.planning.relaxed.relaxed_plan import RelaxedPlan
from sequence_planner.planning.replaying.replay import Replay
from sequence_planner.planning.sat.search import Search, SearchTimeoutError
from sequence_planner.planning.sat.sweep import Sweep

# A plan that is much longer than the relaxed one, in ticks, is left to others.
_LONGER, _MORE = 2, 4
_SHARE = 0.4  # of the time that is left, for each attempt
_FLAGS = ("enabled", "executing", "finished")
_MOST = 0.7  # of the variables; beyond, nothing is gained


class Projection:
    """Fast plans for one automaton under one supervisor."""

    name = "projection"

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._transitions = transitions(automaton)
        self._resources = {effect.name: effect.resource for effect in automaton.effects}

    def solve(self, task: Task, budget: Budget) -> Finding:
        """A plan, if freezing what does not seem to matter leaves one that replays; nothing by another contract."""
        if task.contract is not Contract.FAST:
            return Finding()
        moves = self._moves(task)
        guess = RelaxedPlan(self._automaton, task.state, moves)
        relaxed = guess.towards([goal.predicate for goal in task.goals])
        if relaxed is None:
            return Finding()
        longest = min(task.longest, _LONGER * guess.layers + _MORE)
        loose = self._concerned(task, relaxed)
        replay = Replay(self._automaton, self._supervisor, task.circumstances)
        while not budget.spent and len(loose) <= _MOST * len(self._automaton.variables):
            plan = self._planned(task, loose, longest, budget.part(_SHARE))
            if plan is not None and replay.exactly(task.state, task.state, task.goals, (), plan.ticks):
                return Finding(replace(plan, minimal_ticks=False, minimal_starts=False))
            wider = self._widened(loose, moves)
            if wider == loose:
                break
            loose = wider
        return Finding()

    def _moves(self, task: Task) -> list[Transition]:
        """What a plan may be made of; what has not started must do so before it finishes."""
        offline, restart = task.circumstances.offline, task.circumstances.restart
        moves: list[Transition] = []
        for move in self._transitions:
            if move.phase is Phase.SENSE:
                if not move.fault and self._resources[move.name] not in offline:
                    moves.append(move)
                continue
            ability = self._automaton.abilities[move.name.rpartition(".")[0]]
            if move.phase is Phase.FINISH:
                if task.state[ability.flag("executing")] is not True:
                    move = replace(move, guard=conjunction(move.guard, ability.enabled, ability.start_guard))
                moves.append(move)
            elif ability.resource not in offline and (restart or not ability.restart):
                moves.append(move)
        return moves

    def _concerned(self, task: Task, relaxed: Sequence[Transition]) -> frozenset[str]:
        """The variables that the relaxed plan reads and writes, and those of what is asked."""
        found = set(read_variables(self._automaton, _asked(task)))
        for move in relaxed:
            found |= self._touched(move)
            if move.phase is Phase.START:
                found |= self._ending(self._automaton.abilities[move.name.rpartition(".")[0]])
        return frozenset(found)

    def _touched(self, move: Transition) -> frozenset[str]:
        values = (action.value for action in move.actions)
        conditions = (action.condition for action in move.actions if action.condition is not None)
        return move.writes | read_variables(self._automaton, (move.guard, *values, *conditions))

    def _ending(self, ability: Ability) -> frozenset[str]:
        """What comes after a start in any case."""
        if ability.finish_guard is None:
            return frozenset()
        written = frozenset(map(target, ability.finish_actions))
        return written | read_variables(self._automaton, (ability.finish_guard,))

    def _widened(self, loose: frozenset[str], moves: Sequence[Transition]) -> frozenset[str]:
        """With all that transitions touch which write a loose variable, and all that keeps starts of these."""
        found = set(loose)
        for move in moves:
            if not move.writes.isdisjoint(loose):
                found |= self._touched(move)
                guard = self._supervisor.guards.get(move.name.removesuffix(".start"))
                found |= set(() if guard is None else guard.names)
        return frozenset(found)

    def _planned(self, task: Task, loose: Set[str], longest: int, budget: Budget) -> Plan | None:
        state = task.state
        part = self._part(task, loose)
        frozen = {name: value for name in part.variables if name not in loose and (value := state[name]) is not None}
        unknown = frozenset(name for name in part.types if state[name] is None)
        # Twice through the abilities leaves room for nearly every order of starts.
        order = Sweep(part, self._supervisor).quick() * 2
        inside = self._supervisor.safe.includes(state)
        search = Search(part, self._supervisor, order, unknown, inside, frozen, once=True)
        try:
            return search.plan(state, task.goals, task.circumstances, longest, budget, Contract.FAST)
        except SearchTimeoutError:
            return None
        finally:
            search.close()

    def _part(self, task: Task, loose: Set[str]) -> Automaton:
        """The automaton without what would write another variable than those `loose`, and the flags it then needs."""

        def kept(*actions: Assignment) -> bool:
            written = [target(action) in loose for action in actions]
            idle = (_idle(action, task.state) for action in actions)
            return any(written) and all(map(operator.or_, written, idle))

        abilities = {
            name: ability
            for name, ability in self._automaton.abilities.items()
            if kept(*ability.start_actions, *ability.finish_actions)
        }
        effects = tuple(effect for effect in self._automaton.effects if kept(*effect.actions))
        part = replace(self._automaton, abilities=abilities, effects=effects)
        read = [name for move in transitions(part) for name in move.reads]
        read += [
            ability.flag(which) for ability in abilities.values() for which in ("enabled", "executing", "finished")
        ]
        for asked in _asked(task):
            read += variables(asked)
        predicates, needed = self._automaton.flag_predicates, set[str]()
        while read:
            name = read.pop()
            if name in predicates and name not in needed:
                needed.add(name)
                read += variables(predicates[name])
        return replace(part, flags=tuple(flag for flag in self._automaton.flags if flag.name in needed))


def _asked(task: Task) -> list[Expression]:
    """The predicates and formulas of a task."""
    return [*task.circumstances.avoid, *(part for goal in task.goals for part in (goal.predicate, goal.local))]


def _idle(action: Assignment, state: State) -> bool:
    """Whether the action leaves the variable as it is in `state`; what is unknown stays so."""
    value = state[target(action)]
    return value is None or action.value == Constant(value)
