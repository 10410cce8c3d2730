"""Ticks one after another in one solver, and what is asked of them as literals of it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from functools import cached_property

from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.structure import Ability, Automaton, State
from sequence_planner.collection import collection_put_off
from sequence_planner.expressions.syntax import Expression
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.goals.tracking import Progress, Tracker, beginning
from sequence_planner.planning.plan import Circumstances, Goal, PlanTick
from sequence_planner.planning.sat.circuit import Circuit
from sequence_planner.planning.sat.encoding import SymbolicTick
from sequence_planner.planning.sat.solver import Solver
from sequence_planner.planning.sat.succession import ANY_START, Singly, in_order
from sequence_planner.planning.sat.symbolic import Reading
from sequence_planner.planning.sat.template import Template


class Unrolling:
    """Runs from any state that gives exactly `unknown`, variables and flags, no value; with `inside`, any safe one."""

    def __init__(
        self,
        automaton: Automaton,
        supervisor: Supervisor,
        order: Sequence[Ability],
        unknown: frozenset[str],
        inside: bool,
        frozen: State,
        oracles: frozenset[str],
        budget: Budget,
        singly: Singly = ANY_START,
    ) -> None:
        """Of runs in which the variables `frozen` have these values throughout, which no transition writes to others,
        and the `oracles`, which none writes, any value anew in each tick. Of runs of single starts only those in which
        one follows another as `singly` says, if it says anything.

        Raises `SpentError` when the budget is spent before the first tick is encoded."""
        self.solver = Solver()
        self.circuit = Circuit(self.solver)
        self.ticks: list[SymbolicTick] = []
        with collection_put_off():
            self._template = Template(
                automaton, supervisor, order, unknown, inside, frozen, oracles, budget.require, singly.starts
            )
        self.circuit.reserve(self._template.top)
        self._renaming = self._template.first()
        self._reading = Reading(self.circuit)
        self._tracker = Tracker(self.circuit)
        self._progress: dict[Goal, list[Progress]] = {}
        self._succession = singly.succession
        self._avoided: dict[Expression, list[int]] = {}
        self._counted: dict[tuple[str, int], tuple[int, int]] = {}  # by ability and number: in how many ticks, and how

    def extend(self, length: int, budget: Budget) -> None:
        """So many ticks at least. Raises `SpentError` when the budget is spent meanwhile."""
        while len(self.ticks) < length:
            budget.require()
            if self.ticks:
                self._renaming = self._template.next(self._renaming, self.circuit.top)
                self.circuit.reserve(max(self._renaming))
            self.solver.add_clauses(self._template.renamed(self._renaming))
            tick = self._template.tick(self._renaming, self._reading)
            if self.ticks and tick.earlier:
                self.solver.add_clauses(in_order(self._succession, self.ticks[-1], tick))
            self.ticks.append(tick)
            # A needless choice is one that the solver makes without being asked.
            self.solver.prefer([-choice for choice in (*tick.effects.values(), *(c for _, c in tick.starts))])

    def given(self, state: State, circumstances: Circumstances) -> list[int]:
        """The literals that say runs begin in `state`, and what may happen."""
        literals = self._template.assumptions(circumstances)
        for name, symbol in self._template.start.items():
            for value, literal in symbol.literals.items():
                literals.append(literal if state[name] == value else -literal)
        return literals

    def reached(self, goal: Goal, length: int) -> int:
        """The literal that says the goal was reached in one of the first `length` ticks."""
        progress = self._progress.setdefault(goal, [beginning(goal)])
        while len(progress) <= length:
            progress.append(self._tracker.after(goal, progress[-1], self.ticks[len(progress) - 1]))
        return progress[length].reached

    def keeps(self, circumstances: Circumstances, length: int) -> list[int]:
        """The literals that say the tick at `length` starts nothing barred, and avoids what is to be avoided."""
        barred = self.ticks[length - 1].without(circumstances.barred)
        return [*barred, *(self._avoids(condition, length) for condition in circumstances.avoid)]

    def _avoids(self, condition: Expression, length: int) -> int:
        """The literal that says no position of the tick at `length` satisfies `condition` or leaves it open."""
        avoided = self._avoided.setdefault(condition, [])
        while len(avoided) < length:
            tick = self.ticks[len(avoided)]
            positions = ((Circuit.TRUE, tick.synchronised), *tick.positions)
            avoided.append(
                self.circuit.conjunction(
                    self.circuit.disjunction((-chosen, self._reading.truth(condition, each).no))
                    for chosen, each in positions
                )
            )
        return avoided[length - 1]

    def inside(self, states: StateSet, length: int) -> int:
        """The literal that says the tick at `length` leads into `states`, after step 3 or at its end."""
        last = self.ticks[length - 1]
        return self.circuit.disjunction(self._reading.member(states, each) for each in (last.synchronised, last.end))

    def starts(self, length: int) -> list[int]:
        """The literals that say a start is taken in one of the first `length` ticks."""
        return [choice for tick in self.ticks[:length] for _, choice in tick.starts]

    @cached_property
    def places(self) -> dict[str, list[int]]:
        """By ability, its places in the order of starts, which is the same in all ticks, one of which there must be."""
        places: dict[str, list[int]] = defaultdict(list)
        for place, (name, _) in enumerate(self.ticks[0].starts):
            places[name].append(place)
        return places

    def starting_more(self, ability: str, length: int, number: int) -> int:
        """A literal that is true wherever more than `number` starts of `ability` are taken in the first `length` ticks.

        It may be elsewhere. Where it was asked of more ticks before, it says the same of those: a run to be looked for
        in the first ticks goes on without starts just as well.
        """
        counted, literal = self._counted.get((ability, number), (0, Circuit.FALSE))
        if counted < length:
            places = self.places[ability]
            choices = [tick.starts[place][1] for tick in self.ticks[:length] for place in places]
            literal = self.circuit.exceeding(choices, number)
            self._counted[ability, number] = length, literal
        return literal

    def read(self, length: int, starting: int, model: Sequence[int]) -> tuple[PlanTick, ...]:
        """The run of a model of the solver; only the first `starting` ticks have starts."""
        true = set(model)
        return tuple(
            PlanTick(
                tuple(name for name, choice in tick.effects.items() if choice in true),
                tuple(name for name, choice in tick.starts if choice in true) if number <= starting else (),
            )
            for number, tick in enumerate(self.ticks[:length], start=1)
        )

    def finishing(self, length: int, model: Sequence[int]) -> frozenset[str]:
        """The abilities that finish in the first `length` ticks of a model."""
        true = set(model)
        ticks = self.ticks[:length]
        return frozenset(name for tick in ticks for name, applied in tick.finishes.items() if applied in true)
