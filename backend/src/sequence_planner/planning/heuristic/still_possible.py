"""Possibilities left while some resources and abilities are absent, told at once and without a search.

It is a relaxation (`relaxation`), so what it calls impossible is; what it does not may be so all the same.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from sequence_planner.automaton.automaton import Automaton, Operation, State, target
from sequence_planner.automaton.transitions import Phase, Transition, transitions
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.syntax import Constant, Expression
from sequence_planner.language.types import Value
from sequence_planner.planning.heuristic.relaxation import Relaxation
from sequence_planner.planning.heuristic.relaxed_plan import RelaxedPlan


class Absent(Immutable):
    """The parts that start nothing: all abilities of `resources`, and some `abilities` of others."""

    resources: frozenset[str] = frozenset()
    abilities: frozenset[str] = frozenset()

    def only(self, name: str) -> Absent:
        """The same when all but this resource, or ability, is there again."""
        return Absent(self.resources & {name}, self.abilities & {name})

    @property
    def names(self) -> frozenset[str]:
        """All of it."""
        return self.resources | self.abilities


class StillPossible(Immutable):
    """One way in which it might be done: the resources that `start` something, and what somebody does by hand before,
    which the model has as faults: the values that it gives.
    """

    by: tuple[str, ...]
    once: tuple[tuple[str, Value], ...]


class Remaining:
    """The values that can still come of `state` while `absent`; abilities for restart mode may start.

    Faults happen as well: the model says with them what people may do by themselves. What is unknown of the resources
    that are `silent` stays so; of others it may be anything, as it may be known in the next moment.
    """

    def __init__(self, automaton: Automaton, state: State, absent: Absent, silent: Collection[str]) -> None:
        self._automaton = automaton
        self._state = state
        self._absent = absent
        first: dict[str, set[Value | None]] = {name: {value} for name, value in state.items()}
        for name, variable in automaton.variables.items():
            if state[name] is None and variable.resource not in silent:
                first[name] = set(variable.type.domain)
        self._relaxed = Relaxation(automaton, first, _moves(automaton, absent))
        self._plans: list[RelaxedPlan] = []  # without faults, and with them

    def may_complete(self, operation: Operation, active: bool) -> bool:
        """False only where the operation cannot be completed, whatever is started in whatever order."""
        return all(map(self._relaxed.may, _goals(operation, active)))

    def doing(self, operation: Operation, active: bool) -> StillPossible:
        """A way in which it might be completed, by as little as a relaxed plan has; by nobody where there is none."""
        if not self._plans:
            moves = _moves(self._automaton, self._absent)
            expected = [move for move in moves if not move.fault]
            self._plans = [RelaxedPlan(self._automaton, self._state, some) for some in (expected, moves)]
        goals = _goals(operation, active)
        found = next((way for plan in self._plans if (way := plan.towards(goals)) is not None), ())
        by = dict.fromkeys(
            self._automaton.abilities[move.name.removesuffix(".start")].resource
            for move in found
            if move.phase is Phase.START
        )
        return StillPossible(tuple(by), tuple(self._written(found)))

    def _written(self, moves: Iterable[Transition]) -> Iterator[tuple[str, Value]]:
        """Yield what the faults among them write, where that is said."""
        for move in moves:
            for action in move.actions if move.fault else ():
                if isinstance(action.value, Constant):
                    yield target(action), action.value.value


def _goals(operation: Operation, active: bool) -> tuple[Expression, ...]:
    """Return what has to come true for it: one that is not active begins with its precondition."""
    return (operation.goal,) if active else (operation.precondition, operation.goal)


def _moves(automaton: Automaton, absent: Absent) -> list[Transition]:
    """All that may happen, and all that may be started."""
    idle = {
        f"{name}.start"
        for name, ability in automaton.abilities.items()
        if ability.resource in absent.resources or name in absent.abilities
    }
    return [move for move in transitions(automaton) if move.name not in idle]
