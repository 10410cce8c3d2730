"""Planning engine by decomposition into operations, with their relaxed task as guidance."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.compiler import CompiledTick
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.core.immutable import replace
from sequence_planner.language.evaluator import evaluate, holds
from sequence_planner.language.syntax import And, Expression, Implies, Not, Or, Variable, variables
from sequence_planner.language.types import Value
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.heuristic.relaxation import Possible, reachable
from sequence_planner.planning.heuristic.relaxed_task import (
    Estimator,
    Operator,
    RelaxedGraph,
    RelaxedPredicates,
    RuleKind,
)
from sequence_planner.planning.heuristic.search import HeuristicSearch
from sequence_planner.planning.heuristic.shorten import Trimmer
from sequence_planner.planning.heuristic.space import Interference, Move, RunPosition, Space
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import Goal, Plan, PlanTick
from sequence_planner.process.budget import Budget, SpentError
from sequence_planner.process.gc_tuning import collection_put_off

# The relaxed task of operations: which of them, in which order, seem to lead to goals.
#
# An operation is taken to bring every value that its goal allows, once its precondition holds, and nothing to undo any.
# Where its goal allows several values of a variable, it does not bring one that is all that another one's goal allows:
# a bolt that is no longer missing is not tight yet, if there is an operation for that. What no operation brings is
# assumed to come about, at a price, if it can at all: the plan of each operation sees to it.

_Fact = tuple[str, Value]

_PRICES = {RuleKind.ASSUMPTION: 4}  # of operations: what one of them brings is seldom cheaper to be had otherwise


class OperationTask(RelaxedPredicates):
    """Reads the operations of an automaton into a graph once, to be asked about from many states."""

    def __init__(self, automaton: Automaton) -> None:
        super().__init__(automaton)
        brought = _attributed(
            {name: dict.fromkeys(self._allowed(each.goal)) for name, each in automaton.operations.items()}
        )
        self._brought = frozenset(fact for facts in brought.values() for fact in facts)
        self._assumed: dict[Operator, tuple[str, Value | None]] = {}
        for name, operation in automaton.operations.items():
            heads = tuple(self.graph.fact(*fact) for fact in brought[name])
            self.graph.rule(self._needs(operation.precondition), heads, (RuleKind.OPERATION, name))

    def towards(
        self, state: State, goals: Iterable[Expression], possible: Possible | None = None
    ) -> tuple[str, ...] | None:
        """Operations that seem to lead from `state` to `goals`, where variables may have the values `possible`, or any.

        Those that can be pursued sooner come first. None if nothing seems to lead there.
        """
        nodes = [self.reaching(goal) for goal in goals]
        done = (
            (RuleKind.OPERATION, name) for name, each in self._automaton.operations.items() if holds(each.goal, state)
        )
        never = (
            operator
            for operator, (name, value) in self._assumed.items()
            if possible is not None and value not in possible[name]
        )
        found = Estimator(self.graph, frozenset((*done, *never)), _PRICES).estimate(state, nodes)
        if found is None:
            return None
        return tuple(step.operator[1] for step in found.steps if step.operator[0] is RuleKind.OPERATION)

    def _fact(self, name: str, value: Value) -> int:
        new = value not in self.graph.facts.get(name, {})
        node = super()._fact(name, value)
        if new and name not in self._automaton.flag_predicates and (name, value) not in self._brought:
            operator = (RuleKind.ASSUMPTION, f"{name} == {value}")
            self._assumed[operator] = (name, value)
            self.graph.rule((RelaxedGraph.TRUE,), (node,), operator)
        return node

    def _allowed(self, predicate: Expression, truth: bool = True) -> Iterator[_Fact]:
        """The values of variables that a part of `predicate` has if it is `truth`."""
        match predicate:
            case Not(operand):
                yield from self._allowed(operand, not truth)
            case And(operands) | Or(operands):
                for part in operands:
                    yield from self._allowed(part, truth)
            case Implies(left, right):
                yield from self._allowed(left, not truth)
                yield from self._allowed(right, truth)
            case Variable(name) if name in self._automaton.flag_predicates:
                yield from self._allowed(self._automaton.flag_predicates[name], truth)
            case _:
                names = sorted(set(variables(predicate)))
                if any(name in self._automaton.flag_predicates for name in names) or not self._few(names):
                    return
                for values in self._combinations(names):
                    if evaluate(predicate, values) is truth:
                        yield from values.items()


def _attributed(allowed: Mapping[str, Iterable[_Fact]]) -> dict[str, list[_Fact]]:
    """Return what each operation brings of what its goal allows."""
    only: set[_Fact] = set()
    for facts in allowed.values():
        values = Counter(name for name, _ in facts)
        only.update(fact for fact in facts if values[fact[0]] == 1)
    brought: dict[str, list[_Fact]] = {}
    for operation, facts in allowed.items():
        values = Counter(name for name, _ in facts)
        own = [fact for fact in facts if values[fact[0]] == 1 or fact not in only]
        brought[operation] = own or list(facts)
    return brought


# The engine that plans for one operation after the other, as those who modelled the station have sliced the work.
#
# A goal that is a hundred ticks away is out of reach of engines that search or unroll. The operations on the way to it
# are not: each is planned for from where the last one has ended, and after each of them it is looked anew which lead
# on. What is found is a plan like any other, made short, and says nothing about others.

_MOST_POSITIONS = 400  # that the search for one operation's goal may come to
_LEAST_TRIMMING = 0.2  # seconds of work, or as much as finding the plan took


class _Work:
    """The work done on a task: the ticks so far, where they lead, and what was tried in vain from there."""

    def __init__(self, task: PlanningTask, space: Space, possible: Possible) -> None:
        self.task = task
        self.space = space
        self.possible = possible
        self.ticks: tuple[PlanTick, ...] = ()
        self.position = space.begin()
        self.in_vain: set[Goals] = set()
        self.seconds = 0.0


class OperationByOperation:
    """Plans for one automaton under one supervisor; asked again, it goes on where the budget was spent."""

    name = "operation by operation"

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._work: _Work | None = None

    @collection_put_off()
    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        """A plan by way of operations; nothing for goals that are near, or where no operation leads on."""
        began = time.process_time()
        if self._work is None or self._work.task is not task:
            self._work = self._begun(task)
        work = self._work
        try:
            while work is not None and work.position.goals:
                if not self._advanced(work, budget):
                    work = None
        except SpentError:
            return Finding()
        finally:
            if work is not None:
                work.seconds += time.process_time() - began
        self._work = None
        if work is None:
            return Finding()
        trimming = budget.part(0.5).working(max(work.seconds, _LEAST_TRIMMING))
        trimmer = Trimmer(work.space, self._interference, None, trimming)
        ticks = trimmer.trimmed(work.ticks)
        if len(ticks) > task.longest:
            return Finding()
        return Finding(Plan(ticks, minimal_ticks=False, minimal_starts=False))

    @cached_property
    def _operations(self) -> OperationTask:
        return OperationTask(self._automaton)

    @cached_property
    def _search(self) -> HeuristicSearch:
        return HeuristicSearch(self._automaton, self._supervisor)

    @cached_property
    def _compiled(self) -> CompiledTick:
        return CompiledTick(self._automaton, hot=False)

    @cached_property
    def _interference(self) -> Interference:
        return Interference(self._automaton)

    def _begun(self, task: PlanningTask) -> _Work | None:
        """Nothing done yet; None where all operations on the way can be pursued already: those are not far."""
        operations = self._automaton.operations
        goals = [goal.predicate for goal in task.goals]
        on_the_way = self._operations.towards(task.state, goals) if operations else None
        if not on_the_way or all(holds(operations[name].precondition, task.state) for name in on_the_way):
            return None
        possible = reachable(self._automaton, task.state, task.circumstances).possible
        return _Work(task, Space(self._compiled, self._supervisor, task, at_once=False), possible)

    def _advanced(self, work: _Work, budget: Budget) -> bool:
        """Go on to the next milestone that can be reached, or to the goals; False when there is no way on."""
        for goals in (*self._milestones(work), work.position.goals):
            if goals in work.in_vain:
                continue
            part = replace(work.task, state=dict(work.position.run.values), goals=goals)
            ticks = self._search.ticks(part, budget, _MOST_POSITIONS)
            if ticks and len(work.ticks) + len(ticks) <= work.task.longest:
                after = _walked(work.space, work.position, ticks)
                if after is not None:
                    work.position, work.ticks, work.in_vain = after, (*work.ticks, *ticks), set()
                    return True
            work.in_vain.add(goals)
        return False

    def _milestones(self, work: _Work) -> list[Goals]:
        """Of the operations that seem to lead to what is missing: goals that can be pursued, then preconditions."""
        values, goals = work.position.run.values, [goal.predicate for goal in work.position.goals]
        now: list[Goals] = []
        later: list[Goals] = []
        for name in self._operations.towards(values, goals, work.possible) or ():
            operation = self._automaton.operations[name]
            if holds(operation.precondition, values):
                now.append((Goal(name, operation.goal),))
            else:
                later.append((Goal(name, operation.precondition),))
        return now + later


def _walked(space: Space, position: RunPosition, ticks: tuple[PlanTick, ...]) -> RunPosition | None:
    """Return where `ticks` lead, at most as far as the goals; None if that must not be."""
    here: RunPosition | None = position
    for tick in ticks:
        moves: tuple[Move, ...] = (tick.effects, *tick.starts)
        for move in moves:
            if here is not None and here.goals:
                here = space.moved(here, move)
    return here
