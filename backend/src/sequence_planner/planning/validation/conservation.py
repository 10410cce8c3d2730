"""Verification of sums that no start changes: each start is tried with all values that it reads and writes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import product
from math import prod

from sequence_planner.automaton.automaton import Ability, Automaton, target
from sequence_planner.automaton.tick import writes
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import Assignment, Expression, conjunction, conjuncts, variables
from sequence_planner.language.types import Value
from sequence_planner.planning.partial_states import PartialState
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import CertificateError, ConservedSum

_MOST = 10_000  # valuations of what a start reads and writes; of more it is taken to write any value


def check_conserved(
    automaton: Automaton, task: PlanningTask, conserved: ConservedSum, pause: Callable[[], object]
) -> None:
    """Raises `CertificateError` unless the sum shows that the goals of `task` are never reached by starts alone."""
    if automaton.effects or any(ability.finish_guard is not None for ability in automaton.abilities.values()):
        raise CertificateError("more than starts changes the values that the sum is of")
    if not conserved.holds_in(task.state):
        raise CertificateError("the sum is another one in the state to plan from")
    for ability in automaton.abilities.values():
        pause()
        if conserved.is_other(_change(automaton, ability, conserved)):
            raise CertificateError(f"{ability.name} changes the sum")
    if not any(_excluded(automaton, goal.predicate, conserved) for goal in task.goals):
        raise CertificateError("each goal may hold where the sum is the same")


def _change(automaton: Automaton, ability: Ability, conserved: ConservedSum) -> int:
    """Return by how much every start of it changes the sum. Raises `CertificateError` where not all do alike."""
    parts = [*conjuncts(conjunction(ability.enabled, ability.start_guard))]
    total = 0
    for action in ability.start_actions:
        weights = conserved.weights.get(target(action))
        if weights:
            changes = {conserved.residue(change) for change in _changes(automaton, parts, action, weights)}
            if not changes:
                return 0  # it never starts
            if len(changes) > 1:
                raise CertificateError(f"{ability.name} changes the sum by one or by another number")
            total += changes.pop()
    return total


def _changes(
    automaton: Automaton, parts: Sequence[Expression], action: Assignment, weights: Mapping[Value, int]
) -> Iterator[int]:
    """Return all that one action can make of the sum, as far as the `parts` of the guard that read no more say."""
    written = target(action)
    read = {written, *variables(action.value)}
    if action.condition is not None:
        read.update(variables(action.condition))
    domains = {name: automaton.variables[name].type.domain for name in sorted(read)}
    if prod(map(len, domains.values())) > _MOST:
        domain = domains[written]
        yield from (weights.get(after, 0) - weights.get(before, 0) for before in domain for after in domain)
        return
    asked = [part for part in parts if read.issuperset(variables(part))]
    for values in product(*domains.values()):
        state = PartialState(zip(domains, values, strict=True))
        if all(evaluate(part, state) is True for part in asked):
            before = state[written]
            after = (writes((action,), state) or {}).get(written, before)
            if before is not None and after is not None and after in domains[written]:
                yield weights.get(after, 0) - weights.get(before, 0)


def _excluded(automaton: Automaton, goal: Expression, conserved: ConservedSum) -> bool:
    """Return whether the sum is another one wherever the parts of `goal` hold that read one variable."""
    least = most = 0
    for name, weights in conserved.weights.items():
        asked = [part for part in conjuncts(goal) if set(variables(part)) == {name}]
        possible = {
            conserved.residue(weights.get(value, 0))
            for value in automaton.variables[name].type.domain
            if all(evaluate(part, PartialState({name: value})) is True for part in asked)
        }
        if not possible:
            return True
        least, most = least + min(possible), most + max(possible)
    if conserved.modulus:
        return least == most and conserved.is_other(least - conserved.total)
    return not least <= conserved.total <= most
