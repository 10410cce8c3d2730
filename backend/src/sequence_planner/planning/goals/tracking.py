"""Progress of goals on a symbolic run: what is carried from tick to tick besides the state."""

from __future__ import annotations

from collections.abc import Mapping

from sequence_planner.core.immutable import Immutable
from sequence_planner.language.syntax import TRUE
from sequence_planner.planning.goals.monitor import Choice, Decision, Monitor, leaves, monitor_of
from sequence_planner.planning.problem import Goal
from sequence_planner.planning.sat.encoding import SymbolicTick
from sequence_planner.planning.sat.solver import Circuit
from sequence_planner.planning.sat.symbolic import Reading, SymbolicState


class Progress(Immutable):
    """A literal that says the goal has been reached, and one for each state its formula's automaton may be in.

    None of these is true once the goal's predicate has held; a goal without a formula has none.
    """

    reached: int
    at: Mapping[int, int]


def beginning(goal: Goal) -> Progress:
    """Before the first tick of a run."""
    return Progress(Circuit.FALSE, {} if goal.local == TRUE else {goal.at: Circuit.TRUE})


class Tracker:
    """Reads the progress of goals into a circuit."""

    def __init__(self, circuit: Circuit) -> None:
        self._circuit = circuit
        self._reading = Reading(circuit)

    def after(self, goal: Goal, before: Progress, tick: SymbolicTick) -> Progress:
        """The progress of `goal` after `tick`."""
        circuit = self._circuit
        holds = self._reading.truth(goal.predicate, tick.synchronised).yes
        if goal.local == TRUE:
            return Progress(circuit.disjunction((before.reached, holds)), {})
        monitor = monitor_of(goal.local)
        satisfied = circuit.disjunction(
            circuit.conjunction((literal, self._decided(monitor.ends[state], tick.synchronised).get(1, circuit.FALSE)))
            for state, literal in before.at.items()
        )
        reached = circuit.disjunction((before.reached, circuit.conjunction((holds, satisfied))))
        stepped = self._stepped(monitor, before.at, tick.synchronised)
        at = {state: circuit.conjunction((literal, -holds)) for state, literal in stepped.items()}
        for choice, after in tick.positions:
            further = self._stepped(monitor, at, after)
            at = {
                state: circuit.choice(choice, further.get(state, circuit.FALSE), at.get(state, circuit.FALSE))
                for state in at.keys() | further.keys()
            }
        return Progress(reached, {state: at[state] for state in sorted(at)})

    def _stepped(self, monitor: Monitor, at: Mapping[int, int], position: SymbolicState) -> dict[int, int]:
        ways: dict[int, list[int]] = {}
        for state, literal in at.items():
            for following, condition in self._decided(monitor.steps[state], position).items():
                if following not in monitor.hopeless:
                    ways.setdefault(following, []).append(self._circuit.conjunction((literal, condition)))
        return {following: self._circuit.disjunction(each) for following, each in ways.items()}

    def _decided(self, decision: Decision, position: SymbolicState) -> Mapping[int, int]:
        """Return where a decision leads, each with the literal that says so."""
        circuit = self._circuit
        if not isinstance(decision, Choice):
            return {decision: circuit.TRUE}
        truth = self._reading.truth(decision.predicate, position)
        unknown = circuit.conjunction((-truth.yes, -truth.no))
        ways: dict[int, list[int]] = {leaf: [] for leaf in leaves(decision)}
        for condition, branch in ((truth.yes, decision.true), (truth.no, decision.false), (unknown, decision.unknown)):
            if condition != circuit.FALSE:
                for leaf, further in self._decided(branch, position).items():
                    ways[leaf].append(circuit.conjunction((condition, further)))
        return {leaf: circuit.disjunction(each) for leaf, each in ways.items()}
