"""Goals followed along a run as compiled functions: what `pursuit` says, for whoever looks ahead in every tick."""

from __future__ import annotations

from collections.abc import Iterable

from sequence_planner.automaton.automaton import State
from sequence_planner.automaton.compiler import Compiler, Predicate, Truth
from sequence_planner.automaton.state_set import StateSet
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.syntax import TRUE, Expression
from sequence_planner.planning.goals.monitor import Choice, Decision, monitor_of
from sequence_planner.planning.problem import Goal

# Of each goal that is still missing its number, and the state that its formula's automaton has come to.
CompiledProgress = tuple[tuple[int, int], ...]

_Branch = int | tuple[Truth, "_Branch", "_Branch", "_Branch"]  # where a position leads: when true, false, unknown


class _Formula(Immutable):
    """A monitor of which every predicate is a function."""

    steps: tuple[_Branch, ...]
    ends: tuple[_Branch, ...]
    hopeless: frozenset[int]


class _CompiledGoal(Immutable):
    goal: Goal
    holds: Predicate
    formula: _Formula | None


class CompiledGoals:
    """Compiles each goal when it is first met. A goal keeps its number while predicate and formula stay the same.

    No goal is reached but in a state `within` that set.
    """

    def __init__(self, names: Iterable[str], within: StateSet | None = None) -> None:
        self._compiler = Compiler(names)
        self._within = within
        self._compiled: list[_CompiledGoal] = []
        self._numbers: dict[str, int] = {}

    def progress(self, goals: Iterable[Goal]) -> CompiledProgress:
        """Return how far `goals` have come, none of them reached."""
        return tuple(sorted((self._number(goal), goal.at) for goal in goals))

    def missing(self, progress: CompiledProgress, state: State) -> CompiledProgress:
        """Return what is left without the goals that are met already; with a formula, none is before the next step
        3.
        """
        goals = self._compiled
        return tuple(
            (number, at)
            for number, at in progress
            if goals[number].formula is not None or not goals[number].holds(state)
        )

    def settled(self, progress: CompiledProgress, state: State) -> CompiledProgress | None:
        """Return what is left after step 3 has led to `state`; None when a goal can never be reached any more."""
        missing: list[tuple[int, int]] = []
        for number, at in progress:
            goal = self._compiled[number]
            if not goal.holds(state):
                missing.append((number, at))
            elif goal.formula is not None and _decided(goal.formula.ends[at], state) != 1:
                return None
        return self.moved(progress if len(missing) == len(progress) else tuple(missing), state)

    def moved(self, progress: CompiledProgress, state: State) -> CompiledProgress | None:
        """The same after a start that has led to `state`; None when a goal can never be reached any more."""
        if all(self._compiled[number].formula is None for number, _ in progress):
            return progress
        after: list[tuple[int, int]] = []
        for number, at in progress:
            formula = self._compiled[number].formula
            if formula is not None:
                at = _decided(formula.steps[at], state)
                if at in formula.hopeless:
                    return None
            after.append((number, at))
        return tuple(after)

    def _number(self, goal: Goal) -> int:
        number = self._numbers.get(goal.name)
        if number is not None:
            known = self._compiled[number].goal
            same = known.predicate is goal.predicate and known.local is goal.local
            if same or (known.predicate, known.local) == (goal.predicate, goal.local):
                return number
        self._numbers[goal.name] = len(self._compiled)
        formula = None if goal.local == TRUE else self._formula(goal.local)
        self._compiled.append(_CompiledGoal(goal, self._predicate(goal.predicate), formula))
        return self._numbers[goal.name]

    def _predicate(self, written: Expression) -> Predicate:
        (holds,), within = self._compiler.predicates([written]), self._within
        return holds if within is None else lambda state: holds(state) and within.includes(state)

    def _formula(self, local: Expression) -> _Formula:
        monitor = monitor_of(local)
        truths = dict(zip(monitor.predicates, self._compiler.truths(monitor.predicates), strict=True))

        def branch(decision: Decision) -> _Branch:
            if not isinstance(decision, Choice):
                return decision
            branches = branch(decision.true), branch(decision.false), branch(decision.unknown)
            return (truths[decision.predicate], *branches)

        return _Formula(tuple(map(branch, monitor.steps)), tuple(map(branch, monitor.ends)), monitor.hopeless)


def _decided(branch: _Branch, state: State) -> int:
    while not isinstance(branch, int):
        predicate, true, false, unknown = branch
        truth = predicate(state)
        branch = unknown if truth is None else true if truth else false
    return branch
