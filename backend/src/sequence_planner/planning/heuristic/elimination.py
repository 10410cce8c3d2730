"""Needless starts of long plans, where nothing happens by itself: action elimination (Nakhost and Müller 2010).

A start is left out, and with it all that can then no longer start; if the goals hold in the end nevertheless, none of
them was needed. Only what reads a variable that differs is looked at again, so a trial takes little time.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from sequence_planner.automaton.compiled.closures import closure
from sequence_planner.automaton.compiled.functions import Function
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.structure import Automaton, State, reads
from sequence_planner.automaton.tick import writes
from sequence_planner.expressions.evaluation import holds
from sequence_planner.expressions.syntax import TRUE, Assignment, conjunction, variables
from sequence_planner.expressions.types import Value
from sequence_planner.immutable import Immutable
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Task

Values = dict[str, Value | None]


class _Start(Immutable):
    """What a start of a plan needs, reads and does; `written` is what it wrote in the plan."""

    name: str
    guard: Function
    actions: tuple[Assignment, ...]
    reads: frozenset[str]
    written: Mapping[str, Value]


class Elimination:
    """Leaves needless starts out of orders in which every start can follow at once, tick after tick."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, task: Task) -> None:
        self._automaton = automaton
        self._safe: StateSet | None = None if supervisor.safe.everything else supervisor.safe
        self._task = task
        self._goal_reads = frozenset(name for goal in task.goals for name in variables(goal.predicate))
        self._guards = {a.name: conjunction(a.enabled, a.start_guard) for a in automaton.abilities.values()}

    def suits(self, order: Sequence[str]) -> bool:
        """Whether the trials mean what they say: nothing but the variables decides, and only the end counts."""
        names = set(self._goal_reads).union(() if self._safe is None else self._safe.names)
        for name in set(order):
            names.update(self._reads(name))
        plain = all(goal.local == TRUE for goal in self._task.goals) and not self._task.circumstances.avoid
        return plain and names <= self._automaton.variables.keys() and self._reached(self._after(order))

    def eliminated(self, order: Sequence[str], budget: Budget) -> tuple[str, ...]:
        """`order` without needless starts, or with some when the budget is spent."""
        base = self._variables()
        plan = self._starts(order)
        kept = 0
        while kept < len(plan) and not budget.spent:
            without = self._without(plan, kept, base)
            if without is None:
                base |= plan[kept].written
                kept += 1
            else:
                plan = [*plan[:kept], *without]
        return tuple(start.name for start in plan)

    def _without(self, plan: Sequence[_Start], left_out: int, base: Mapping[str, Value | None]) -> list[_Start] | None:
        """What follows the start that is left out from the state `base` before it, if the goals still are reached."""
        planned: Values = {**base, **plan[left_out].written}
        current: Values = dict(base)
        different = {name for name in plan[left_out].written if current[name] != planned[name]}
        following: list[_Start] = []
        for start in plan[left_out + 1 :]:
            written: Mapping[str, Value] | None = start.written
            if not different.isdisjoint(start.reads):
                written = self._written(start, current)
            planned |= start.written
            if written is not None:
                current |= written
                following.append(_Start(start.name, start.guard, start.actions, start.reads, written))
            for name in (*start.written, *(written or ())):
                if current[name] == planned[name]:
                    different.discard(name)
                else:
                    different.add(name)
        return following if different.isdisjoint(self._goal_reads) or self._reached(current) else None

    def _written(self, start: _Start, state: Values) -> Mapping[str, Value] | None:
        written = writes(start.actions, state) if start.guard(state) is True else None
        if written is None or (self._safe is not None and not self._safe.includes({**state, **written})):
            return None
        return written

    def _starts(self, order: Sequence[str]) -> list[_Start]:
        state = self._variables()
        starts: list[_Start] = []
        for name in order:
            actions = self._automaton.abilities[name].start_actions
            written = writes(actions, state) or {}
            starts.append(_Start(name, closure(self._guards[name]), actions, self._reads(name), written))
            state |= written
        return starts

    def _reads(self, name: str) -> frozenset[str]:
        actions = self._automaton.abilities[name].start_actions
        safe = () if self._safe is None else self._safe.names
        return frozenset(variables(self._guards[name])).union(safe, *map(reads, actions))

    def _variables(self) -> Values:
        return {name: self._task.state[name] for name in self._automaton.variables}

    def _after(self, order: Sequence[str]) -> State:
        state = self._variables()
        for start in self._starts(order):
            state |= start.written
        return state

    def _reached(self, state: State) -> bool:
        return all(holds(goal.predicate, state) for goal in self._task.goals)
