"""The relaxed task of an automaton: what can become true if nothing is ever undone, as an AND/OR graph.

This is the delete relaxation of planning (Bonet and Geffner 2001) over finite domains, as in `planning.relaxation`,
made once per automaton so that it can be asked from thousands of states.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from sequence_planner.automaton.state_set import EVERYTHING, FIRST_NODE, NOTHING, StateSet, Supervisor
from sequence_planner.automaton.structure import Automaton, reads, target
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import Assignment, Constant
from sequence_planner.expressions.types import Value
from sequence_planner.planning.heuristic.graph import Graph, Kind, Operator
from sequence_planner.planning.heuristic.relaxed_predicates import RelaxedPredicates

_MOST_NODES = 64  # of a supervisor's guard; one with more is left out


class RelaxedTask(RelaxedPredicates):
    """Reads an automaton into a graph; predicates come to it as they are asked for."""

    def __init__(
        self, automaton: Automaton, supervisor: Supervisor, pause: Callable[[], object] = lambda: None
    ) -> None:
        """`pause` is called for each ability, and may raise."""
        super().__init__(automaton)
        self._sets: dict[tuple[int, int], int] = {}
        for effect in automaton.effects:
            if not effect.fault:
                self._operator((Kind.EFFECT, effect.name), self._needs(effect.guard), effect.actions)
        for ability in automaton.abilities.values():
            pause()
            if ability.finish_guard is not None:
                needs = self._needs(ability.finish_guard)
                self._operator((Kind.FINISH, ability.name), needs, ability.finish_actions)
            needs = [*self._needs(ability.enabled), *self._needs(ability.start_guard)]
            guard = supervisor.guards.get(ability.name)
            if guard is not None and len(guard.nodes) <= _MOST_NODES:
                needs.append(self._member(guard, guard.root))
            self._operator((Kind.START, ability.name), needs, ability.start_actions)

    def _operator(self, operator: Operator, needs: list[int], actions: Iterable[Assignment]) -> None:
        always: list[int] = []
        for action in actions:
            for condition, value in self._written(action):
                fact = self.graph.fact(target(action), value)
                if condition:
                    self.graph.rule([*needs, *condition], (fact,), operator)
                else:
                    always.append(fact)
        self.graph.rule(needs, tuple(always), operator)

    def _written(self, action: Assignment) -> Iterator[tuple[list[int], Value]]:
        """What an action can write, each with what it takes for that."""
        domain = self._automaton.variables[target(action)].type.domain
        condition = [] if action.condition is None else self._needs(action.condition)
        if isinstance(action.value, Constant):
            yield condition, action.value.value
            return
        names = sorted(reads(Assignment(action.target, action.value)))
        if not self._few(names):
            yield from ((condition, value) for value in domain)
            return
        for values in self._combinations(names):
            value = evaluate(action.value, values)
            if value is not None and value in domain:
                yield [*condition, *(self._fact(name, each) for name, each in values.items())], value

    def _member(self, states: StateSet, reference: int) -> int:
        """The node that is true when a state may be among those that begin at `reference`."""
        if reference in (NOTHING, EVERYTHING):
            return Graph.TRUE if reference == EVERYTHING else Graph.FALSE
        key = (id(states), reference)
        if key not in self._sets:
            axis, children = states.nodes[reference - FIRST_NODE]
            name = states.names[axis]
            branches = [
                self.graph.all_of((self._fact(name, value), self._member(states, child)))
                for value, child in zip(states.domains[axis], children, strict=True)
            ]
            # What is unknown is left to the supervisor itself.
            self._sets[key] = self.graph.any_of((*branches, self.graph.fact(name, None)))
        return self._sets[key]
