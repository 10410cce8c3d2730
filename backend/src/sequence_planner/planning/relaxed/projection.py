"""The engine that freezes all that a relaxed plan does not touch, and plans with the rest.

What is left is small however large the station is. A plan of it counts only when it replays on the whole; as long as
it does not, or there is none, more variables are let loose, and in the end other engines decide.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence, Set

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State, target
from sequence_planner.automaton.transitions import Phase, Transition
from sequence_planner.collection import collection_put_off
from sequence_planner.expressions.syntax import Expression
from sequence_planner.immutable import Immutable
from sequence_planner.planning.budget import Budget, SpentError
from sequence_planner.planning.engine import Finding, Task
from sequence_planner.planning.plan import Plan
from sequence_planner.planning.relaxed.likely_order import likely_order
from sequence_planner.planning.relaxed.part import part_of
from sequence_planner.planning.relaxed.relaxed_plan import RelaxedPlan
from sequence_planner.planning.relaxed.relevance import Relevance
from sequence_planner.planning.relaxed.shortest import Shortest
from sequence_planner.planning.relaxed.usefulness import written_by
from sequence_planner.planning.replaying.acceptance import Acceptance
from sequence_planner.planning.sat.unrolling import Unrolling

# A plan that is much longer than the relaxed one, in ticks, is left to others.
_LONGER, _MORE = 2, 4
# Of the variables, unless they are few; beyond, nothing is gained.
_MOST, _FEW = 0.7, 50


class Outline(Immutable):
    """A relaxed plan of `task`, its layers, and the variables that it writes."""

    task: Task
    relaxed: Sequence[Transition]
    layers: int
    written: frozenset[str]


class _Work:
    """What has been begun on a task: the parts of the automaton still to be tried, and the one that is being tried."""

    def __init__(self, task: Task, longest: int, parts: Iterator[Automaton]) -> None:
        self.task = task
        self.longest = longest
        self.parts = parts
        self.shortest: Shortest | None = None


class Projection:
    """Fast plans for one automaton under one supervisor, by any contract; asked again, it goes on where it stopped."""

    name = "projection"

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._relevance = Relevance(automaton)
        self._acceptance = Acceptance.of(automaton, supervisor)
        # Where nothing happens by itself, a search is sooner done.
        self._reacts = any(not effect.fault for effect in automaton.effects) or any(
            ability.finish_guard is not None for ability in automaton.abilities.values()
        )
        self._work: _Work | None = None

    @collection_put_off()
    def solve(self, task: Task, budget: Budget) -> Finding:
        """A plan, if freezing what does not seem to matter leaves one that replays; nothing is proven of it."""
        if self._work is None or self._work.task is not task:
            outline = self.outline(task)
            if outline is None:
                return Finding()
            self.take_up(outline)
        assert self._work is not None
        try:
            plan = self._plan(self._work, budget)
        except SpentError:
            return Finding()
        self._work = None
        return Finding(plan)

    def outline(self, task: Task) -> Outline | None:
        """None if there is no relaxed plan of `task`, or this is no engine for it.

        The plan is made of what seems to matter if possible.
        """
        goals = [goal.predicate for goal in task.goals]
        for moves in self._moves(task, goals) if self._reacts else ():
            guess = RelaxedPlan(self._automaton, task.state, moves)
            relaxed = guess.towards(goals)
            if relaxed is not None:
                return Outline(task, relaxed, guess.layers, self._written(relaxed))
        return None

    def take_up(self, outline: Outline) -> None:
        """Begin to work on its task, which is asked for next."""
        longest = min(outline.task.bound, _LONGER * outline.layers + _MORE)
        self._work = _Work(outline.task, longest, self._parts(outline))

    def _plan(self, work: _Work, budget: Budget) -> Plan | None:
        """A plan of the first part that has one which replays. Raises `SpentError`."""
        while True:
            if work.shortest is None:
                budget.require()
                part = next(work.parts, None)
                if part is None:
                    return None
                work.shortest = Shortest(self._unrolling(work.task.state, part, budget), work.task)
            plan = work.shortest.plan(work.longest, budget)
            if plan is not None and self._acceptance.accepts(work.task, plan):
                return plan
            work.shortest = None

    def _unrolling(self, state: State, part: Automaton, budget: Budget) -> Unrolling:
        written = written_by(part)
        frozen = {n: value for n in part.variables if n not in written and (value := state[n]) is not None}
        unknown = frozenset(name for name in part.types if state[name] is None)
        order = likely_order(part)
        inside = self._supervisor.safe.includes(state)
        return Unrolling(part, self._supervisor, order, unknown, inside, frozen, oracles=frozenset(), budget=budget)

    def _parts(self, outline: Outline) -> Iterator[Automaton]:
        """The parts to be tried, from the smallest on: of the first only what serves the relaxed plan."""
        task = outline.task
        serving: list[str] | None = [_unit(move) for move in outline.relaxed]
        last: Set[str] = frozenset()
        for loose in self._loosened(outline):
            if loose == last or len(loose) > max(_MOST * len(self._automaton.variables), _FEW):
                return
            part = part_of(self._automaton, self._supervisor, self._relevance, task.state, loose, _asked(task), serving)
            yield part
            serving, last = None, loose

    def _moves(self, task: Task, goals: Sequence[Expression]) -> Iterator[Sequence[Transition]]:
        yield self._relevance.towards(goals, task.state, task.circumstances)
        yield self._relevance.counted_on(task.state, task.circumstances)

    def _loosened(self, outline: Outline) -> Iterator[frozenset[str]]:
        """Sets of variables to be let loose, each larger than the one before.

        First those that the relaxed plan writes, then those that it reads, and at last all that transitions touch which
        write one of these, and all that keeps starts of these.
        """
        yield outline.written
        loose = outline.written | read_variables(self._automaton, _asked(outline.task))
        yield loose.union(*map(self._touched, outline.relaxed))
        while True:
            loose = self._widened(loose)
            yield loose

    def _written(self, relaxed: Iterable[Transition]) -> frozenset[str]:
        return frozenset(name for move in relaxed for name in (*move.writes, *self._ending(move)))

    def _touched(self, move: Transition) -> frozenset[str]:
        values = (action.value for action in move.actions)
        conditions = (action.condition for action in move.actions if action.condition is not None)
        return move.writes | read_variables(self._automaton, (move.guard, *values, *conditions))

    def _ending(self, move: Transition) -> frozenset[str]:
        """What comes after a start in any case."""
        if move.phase is not Phase.START:
            return frozenset()
        return frozenset(map(target, self._automaton.abilities[move.name.removesuffix(".start")].finish_actions))

    def _widened(self, loose: frozenset[str]) -> frozenset[str]:
        found = set(loose)
        for move in self._relevance.writing(loose):
            found |= self._touched(move)
            guard = self._supervisor.guards.get(move.name.removesuffix(".start"))
            found |= set(() if guard is None else guard.names)
        return frozenset(found)


def _unit(move: Transition) -> str:
    """The effect or the ability that a transition is of."""
    return move.name if move.phase is Phase.SENSE else move.name.rpartition(".")[0]


def _asked(task: Task) -> list[Expression]:
    """The predicates and formulas of a task."""
    return [*task.circumstances.avoid, *(part for goal in task.goals for part in (goal.predicate, goal.local))]
