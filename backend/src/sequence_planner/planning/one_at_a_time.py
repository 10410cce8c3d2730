"""The fewest transitions of plain automata by bounded model checking: each step of the unrolled run is one of them."""

from __future__ import annotations

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.immutable import replace
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.plan import Goal
from sequence_planner.planning.sat.circuit import Circuit
from sequence_planner.planning.sat.encoding import Encoding
from sequence_planner.planning.sat.solver import Solver
from sequence_planner.planning.sat.symbolic import Symbol, SymbolicState


class OneAtATime:
    """Runs of an automaton without effects and finishes from a safe `state`, in which nothing is unknown."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, state: State, goals: Goals) -> None:
        self._solver = Solver()
        self._circuit = Circuit(self._solver)
        # Flags only repeat what guards say: `enabled` of each ability is taken to be true.
        self._automaton = replace(automaton, flags=())
        self._encoding = Encoding(self._automaton, supervisor, self._circuit, frozenset(), inside=True)
        self._goals = goals
        true = Symbol({False: Circuit.FALSE, True: Circuit.TRUE})
        self._enabled = {ability.flag("enabled"): true for ability in automaton.abilities.values()}
        self._states: list[SymbolicState] = [
            {
                name: Symbol({value: Circuit.TRUE if value == state[name] else Circuit.FALSE for value in type_.domain})
                for name, type_ in self._automaton.types.items()
            }
        ]
        self._choices: list[dict[str, int]] = []
        self._reached = [self._now(self._states[0])]

    def fewest(self, least: int, most: int, budget: Budget) -> tuple[tuple[str, ...] | None, int]:
        """A plan with the fewest transitions, if there is one with `least` to `most`; and how many it takes at least.

        No plan may have fewer than `least`. When the budget is spent, what is proven by then.
        """
        for length in range(least, most + 1):
            while len(self._choices) < length:
                if budget.spent:
                    return None, length
                self._extend()
            answer = self._solver.solve(list(self._reached[length].values()), budget)
            if answer is None:
                return None, length
            if answer:
                true = set(self._solver.model())
                taken = [name for step in self._choices[:length] for name, choice in step.items() if choice in true]
                return tuple(taken), length
        return None, most + 1

    def _extend(self) -> None:
        circuit, encoding, before = self._circuit, self._encoding, self._states[-1]
        readable: SymbolicState = {**before, **self._enabled}
        after = dict(before)
        choices: dict[str, int] = {}
        for ability in self._automaton.abilities.values():
            choice = choices[ability.name] = circuit.fresh()
            allowed, alone = encoding.start(ability, readable, readable, choice)
            circuit.require(-choice, allowed)
            for name in before:
                if alone[name] is not readable[name]:
                    after[name] = encoding.reading.chosen(choice, alone[name], after[name])
        circuit.at_most_one(list(choices.values()))
        if self._choices:  # whoever has come to rest stays there
            circuit.require(circuit.disjunction(self._choices[-1].values()), -circuit.disjunction(choices.values()))
        self._choices.append(choices)
        self._states.append(after)
        now = self._now(after)
        self._reached.append({g: circuit.disjunction((now[g], before)) for g, before in self._reached[-1].items()})

    def _now(self, state: SymbolicState) -> dict[Goal, int]:
        return {goal: self._encoding.reading.truth(goal.predicate, state).yes for goal in self._goals}
