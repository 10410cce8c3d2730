"""Which variables keep a condition from being true, what they would have to be, and who could see to that."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.structure import Ability, Automaton, State, target
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import Assignment, Constant, Expression
from sequence_planner.expressions.types import Value


class _Partly(dict[str, Value | None]):
    """The values of some variables, all others unknown, and the flags that follow from them."""

    def __init__(self, automaton: Automaton, values: Mapping[str, Value | None]) -> None:
        super().__init__(values)
        self._predicates = automaton.flag_predicates

    def __missing__(self, name: str) -> Value | None:
        predicate = self._predicates.get(name)
        self[name] = None if predicate is None else evaluate(predicate, self)
        return self[name]


def responsible(automaton: Automaton, condition: Expression, state: State) -> tuple[str, ...]:
    """Variables that alone keep `condition` from being true in `state`: whatever all others were, it would not be.

    None of them could be spared. Flags are followed to the variables behind them. Where the condition is open, the
    unknown variables that it reads; none where it is true.
    """
    read = [name for name in automaton.variables if name in read_variables(automaton, (condition,))]
    truth = evaluate(condition, _Partly(automaton, {name: state[name] for name in read}))
    if truth is True:
        return ()
    if truth is None:
        return tuple(name for name in read if state[name] is None)
    kept = {name: state[name] for name in read if state[name] is not None}
    for name in read:
        fewer = {other: value for other, value in kept.items() if other != name}
        if name in kept and evaluate(condition, _Partly(automaton, fewer)) is False:
            kept = fewer
    return tuple(kept)


def wanted(automaton: Automaton, condition: Expression, state: State, name: str) -> tuple[Value, ...]:
    """The values of a variable with which the condition would be true, all other variables as in `state`."""
    values = {each: state[each] for each in automaton.variables}
    domain = automaton.variables[name].type.domain
    return tuple(value for value in domain if evaluate(condition, _Partly(automaton, {**values, name: value})) is True)


@dataclass(frozen=True)
class Changer:
    """An ability that can change a variable by its `start`, its `finish` or an `effect` of it."""

    how: str
    ability: Ability


def changers(automaton: Automaton, name: str, values: Sequence[Value]) -> Iterator[Changer]:
    """The abilities that could give the variable one of the values; any other value if there are none."""
    for ability in automaton.abilities.values():
        if _writes(ability.start_actions, name, values):
            yield Changer("start", ability)
        if _writes(ability.finish_actions, name, values):
            yield Changer("finish", ability)
    seen: set[str] = set()
    for effect in automaton.effects:
        owner = automaton.abilities.get(effect.name.rpartition(".")[0])
        if owner is None or effect.fault or owner.name in seen or not _writes(effect.actions, name, values):
            continue
        seen.add(owner.name)
        yield Changer("effect", owner)


def _writes(actions: Sequence[Assignment], name: str, values: Sequence[Value]) -> bool:
    return any(target(action) == name and _may_be(action.value, values) for action in actions)


def _may_be(written: Expression, values: Sequence[Value]) -> bool:
    return not values or not isinstance(written, Constant) or written.value in values
