"""What of a part of the automaton serves a relaxed plan, what brings back that which the plan takes away included."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from itertools import chain

from sequence_planner.automaton.structure import Ability, Automaton, Effect, target
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import (
    TRUE,
    And,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    Variable,
)
from sequence_planner.expressions.types import Value
from sequence_planner.immutable import replace
from sequence_planner.planning.known import Known

Fact = tuple[str, Value]

_JUNCTIONS = (And, Or)


def useful(automaton: Automaton, taken: Iterable[str], goals: Iterable[Expression]) -> Automaton:
    """`automaton` with no other abilities and effects than those `taken`, by name, and those that bring values which
    these or the goals ask for, whether or not the values are there already; and so on.
    """
    units: dict[str, Ability | Effect] = {
        **automaton.abilities,
        **{effect.name: effect for effect in automaton.effects},
    }
    writers: dict[Fact, list[str]] = defaultdict(list)
    for name, unit in units.items():
        for action in _actions(unit):
            for value in _values(automaton, action):
                writers[target(action), value].append(name)
    found: set[str] = set()
    facts: set[Fact] = set()
    waiting = [name for name in taken if name in units]
    asked: Iterable[Fact] = chain.from_iterable(_asked(automaton, goal, True) for goal in goals)
    while True:
        for fact in asked:
            if fact not in facts:
                facts.add(fact)
                waiting += writers[fact]
        if not waiting:
            break
        name = waiting.pop()
        asked = () if name in found else _asked_by(automaton, units[name])
        found.add(name)
    return replace(
        automaton,
        abilities={name: ability for name, ability in automaton.abilities.items() if name in found},
        effects=tuple(effect for effect in automaton.effects if effect.name in found),
    )


def written_by(part: Automaton) -> dict[str, set[Value]]:
    """The variables that abilities and effects write, with all that they can write."""
    written: dict[str, set[Value]] = defaultdict(set)
    units: list[Ability | Effect] = [*part.abilities.values(), *part.effects]
    for action in (action for unit in units for action in _actions(unit)):
        written[target(action)].update(_values(part, action))
    return written


def _actions(unit: Ability | Effect) -> tuple[Assignment, ...]:
    return unit.actions if isinstance(unit, Effect) else (*unit.start_actions, *unit.finish_actions)


def _values(automaton: Automaton, action: Assignment) -> Iterable[Value]:
    if isinstance(action.value, Constant):
        return (action.value.value,)
    return automaton.variables[target(action)].type.domain


def _asked_by(automaton: Automaton, unit: Ability | Effect) -> Iterator[Fact]:
    conditions = (action.condition for action in _actions(unit) if action.condition is not None)
    guards = (unit.guard,) if isinstance(unit, Effect) else (unit.enabled, unit.start_guard, unit.finish_guard or TRUE)
    for predicate in (*guards, *conditions):
        yield from _asked(automaton, predicate, True)


def _asked(automaton: Automaton, predicate: Expression, truth: bool) -> Iterator[Fact]:
    """The values by which `predicate` can get the value `truth`; a difference asks for none."""
    # What is most frequent comes first, and without patterns, as in `expressions.evaluation.evaluate`.
    if isinstance(predicate, _JUNCTIONS):
        for part in predicate.operands:
            yield from _asked(automaton, part, truth)
        return
    if isinstance(predicate, Variable):
        flag = automaton.flag_predicates.get(predicate.name)
        yield from ((predicate.name, truth),) if flag is None else _asked(automaton, flag, truth)
        return
    match predicate:
        case Comparison("==" | "!=" as relation, Variable(name), Constant(value)):
            if truth is (relation == "=="):
                yield name, value
        case Not(operand):
            yield from _asked(automaton, operand, not truth)
        case Implies(left, right):
            yield from _asked(automaton, left, not truth)
            yield from _asked(automaton, right, truth)
        case Comparison(_, Variable(name) as variable, Constant()) | Membership(Variable(name) as variable, _):
            for value in variable.type.domain:
                if evaluate(predicate, Known({name: value})) is truth:
                    yield name, value
