"""Orders of starts for ticks of an automaton, and of what is seen of it."""

from __future__ import annotations

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Task
from sequence_planner.planning.pdr.localisation import Localised
from sequence_planner.planning.sat.sweep import Order, Sweep

# Abilities up to which one order for all of them is soon found.
_FEW = 80

# Places in an order above which it is worth to look for a shorter one, if abilities are repeated.
_MANY = 80


class Orders:
    """Orders of which every order is a part that can make a difference to a task; what is found out is kept.

    If one is `given`, it is such an order.
    """

    def __init__(self, automaton: Automaton, supervisor: Supervisor, given: Order | None = None) -> None:
        self._given = given
        self._sweep = Sweep(automaton, supervisor)
        self._automaton = automaton
        self._whole: dict[tuple[bool, frozenset[str]], Order] = {}

    def whole(self, task: Task, budget: Budget) -> Order:
        """For the automaton. Raises `SpentError`."""
        if self._given is not None:
            return self._given
        told_apart = _told_apart(self._sweep, self._automaton, task)
        restart = task.circumstances.restart
        if (restart, told_apart) not in self._whole:
            self._whole[restart, told_apart] = self._sweep.complete(budget, told_apart, restart)
        return self._whole[restart, told_apart]

    def part(self, seen: Localised, task: Task, budget: Budget) -> Order:
        """For what is seen of it; what is not seen can make starts exclude each other. Raises `SpentError`."""
        if self._given is None and len(self._automaton.abilities) > _FEW:
            sweep = Sweep(seen.automaton, seen.supervisor)
            told_apart = _told_apart(sweep, seen.automaton, task)
            own = seen.order(sweep.complete(budget, told_apart, task.circumstances.restart))
            if len(own) <= max(_MANY, len(seen.automaton.abilities)):
                return own
        return seen.order(self.whole(task, budget))


def _told_apart(sweep: Sweep, automaton: Automaton, task: Task) -> frozenset[str]:
    """The abilities between whose starts formulas and conditions to be avoided look at the state."""
    demands = (*task.circumstances.avoid, *(goal.local for goal in task.goals))
    return sweep.writers(read_variables(automaton, demands))
