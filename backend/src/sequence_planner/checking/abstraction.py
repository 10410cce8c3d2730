"""A proof that a state cannot be reached, over a few variables, with everything else unknown.

Measured values and all variables left out may be anything, so whatever the station reaches the abstraction reaches
(existential abstraction: Clarke, Grumberg and Long 1994). Conditions are read with three truth values; what is not
false for certain may be true.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import product
from math import prod

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.structure import Automaton, Kind, State, target
from sequence_planner.automaton.tick import synchronise
from sequence_planner.automaton.transitions import Phase, Transition
from sequence_planner.checking.growth import every_move
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import Assignment, Expression
from sequence_planner.expressions.types import Value

MOST_STATES = 2_000
MOST_TOGETHER = 6  # finishes in one tick


def cannot_be(automaton: Automaton, predicates: Sequence[Expression]) -> bool:
    """Whether it is certain that all `predicates` together are never seen by a finish guard in a reachable state.

    They are read like finish guards: over new measured values, and flags of the tick before.
    """
    own = Kind.OUTPUT, Kind.ESTIMATED
    names = [n for n in read_variables(automaton, predicates) if automaton.variables[n].kind in own]
    if prod(len(automaton.variables[name].type.domain) for name in names) > MOST_STATES:
        return False
    moves = [move for move in every_move(automaton) if move.phase is not Phase.SENSE and move.writes & set(names)]
    unknown = dict.fromkeys(automaton.types)
    pending = [{name: automaton.variables[name].initial for name in names}]
    reached = {tuple(pending[0].values())}
    while pending:
        values = pending.pop()
        state = synchronise(automaton, {**unknown, **values})
        if _forbidden(automaton, state):
            continue
        if all(_may(predicate, state) for predicate in predicates):
            return False
        enabled = [move for move in moves if _may(move.guard, state)]
        finishing = [move for move in enabled if move.phase is Phase.FINISH]
        if len(finishing) > MOST_TOGETHER:
            return False
        groups = [[move] for move in enabled if move.phase is Phase.START] + list(_subsets(finishing))
        for after in (each for group in groups for each in _outcomes(automaton, group, state, values)):
            if (key := tuple(after.values())) not in reached:
                reached.add(key)
                pending.append(after)
    return True


def _may(predicate: Expression, state: State) -> bool:
    return evaluate(predicate, state) is not False


def _forbidden(automaton: Automaton, state: State) -> bool:
    """Whether a specification forbids the state for certain: the supervisor then keeps the station out of it."""
    return any(evaluate(each.forbidden, state) is True for each in automaton.specifications.values())


def _subsets(moves: Sequence[Transition]) -> Iterator[list[Transition]]:
    for chosen in product((False, True), repeat=len(moves)):
        if any(chosen):
            yield [move for move, taken in zip(moves, chosen, strict=True) if taken]


def _outcomes(
    automaton: Automaton, moves: Iterable[Transition], state: State, before: Mapping[str, Value]
) -> Iterator[dict[str, Value]]:
    """All values that `moves`, taken at once in `state`, could leave behind."""
    possible: dict[str, set[Value]] = {name: {value} for name, value in before.items()}
    written: dict[str, set[Value]] = {}
    for action in (action for move in moves for action in move.actions if target(action) in before):
        name, condition = target(action), True if action.condition is None else evaluate(action.condition, state)
        if condition is not False:
            values = _written(automaton, action, state)
            written[name] = written.get(name, set()) | values | (set() if condition else possible[name])
    possible |= written
    for choice in product(*possible.values()):
        yield dict(zip(possible, choice, strict=True))


def _written(automaton: Automaton, action: Assignment, state: State) -> set[Value]:
    value = evaluate(action.value, state)
    return set(automaton.variables[target(action)].type.domain) if value is None else {value}
