"""Sets of states as tables: what they say of a state with unknown values, and what fewer variables may say for them."""

from __future__ import annotations

from itertools import product

import numpy as np
from hypothesis import given

from sequence_planner.automaton.state_set import StateSet, Table
from sequence_planner.expressions.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value

from .budget import examples
from .choices import Choices, made_by

TYPES: tuple[Type, ...] = (BOOLEAN, EnumerationType(("p", "q", "r")), IntegerRange(0, 1), IntegerRange(-1, 1))
Values = dict[str, Value | None]


def a_table(choices: Choices, shape: tuple[int, ...]) -> Table:
    cells = int(np.prod(shape, dtype=np.int64))
    return np.array([choices.chance(2) for _ in range(cells)], dtype=np.bool_).reshape(shape)


def a_set(choices: Choices) -> StateSet:
    """A set over up to three variables."""
    types = [choices.pick(TYPES) for _ in range(choices.number(0, 3))]
    domains = tuple(type_.domain for type_ in types)
    names = tuple(f"x{number}" for number in range(len(types)))
    return StateSet(names, domains, a_table(choices, tuple(map(len, domains))))


def a_set_and_a_state(choices: Choices) -> tuple[StateSet, Values]:
    states = a_set(choices)
    values: Values = {
        name: choices.pick((None, *domain)) for name, domain in zip(states.names, states.domains, strict=True)
    }
    return states, {**values, "elsewhere": None}


def completions(states: StateSet, values: Values) -> list[Values]:
    """Every state that `values` could be."""
    options = [
        (values[name],) if values[name] is not None else domain
        for name, domain in zip(states.names, states.domains, strict=True)
    ]
    return [dict(zip(states.names, chosen, strict=True)) for chosen in product(*options)]


@examples(300)
@given(made_by(a_set_and_a_state))
def test_a_state_with_unknowns_is_included_when_all_that_it_could_be_is(given_: tuple[StateSet, Values]) -> None:
    states, values = given_
    members = states.members()
    assert states.includes(values) == all(each in members for each in completions(states, values))


@examples(300)
@given(made_by(a_set_and_a_state))
def test_for_all_says_the_same_without_the_unknown_variables(given_: tuple[StateSet, Values]) -> None:
    states, values = given_
    unknown = frozenset(name for name in states.names if values[name] is None)
    without = states.for_all(unknown)
    assert set(without.names) == set(states.names) - unknown
    assert without.includes(values) == states.includes(values)


def a_set_and_what_matters(choices: Choices) -> tuple[StateSet, Table]:
    states = a_set(choices)
    care = a_table(choices, states.table.shape)
    if choices.chance(2):
        care &= a_table(choices, states.table.shape)
    return states, care


@examples(300)
@given(made_by(a_set_and_what_matters))
def test_a_reduced_set_agrees_wherever_it_matters_and_no_variable_of_it_is_needless(
    given_: tuple[StateSet, Table],
) -> None:
    states, care = given_
    reduced = states.reduced(care)
    assert set(reduced.names) <= set(states.names)
    seen: dict[tuple[Value, ...], list[tuple[dict[str, Value], bool]]] = {}
    for index in np.argwhere(care).tolist():
        state = {n: d[i] for n, d, i in zip(states.names, states.domains, index, strict=True)}
        member = bool(states.table[tuple(index)])
        assert reduced.includes(state) == member
        for dropped in reduced.names:
            rest = (dropped, *(state[name] for name in reduced.names if name != dropped))
            seen.setdefault(rest, []).append((state, member))
    for dropped in reduced.names:  # without it, two states that matter would come to differ
        assert any(len({m for _, m in found}) == 2 for rest, found in seen.items() if rest[0] == dropped)


def test_a_set_over_no_variables_is_everything_or_nothing() -> None:
    for truth in (True, False):
        states = StateSet((), (), np.array(truth))
        assert states.includes({"x": None}) is truth
        assert len(states.members()) == truth
