"""Whether an action writes values of its target's domain: against trying every state."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.strategies import DrawFn, SearchStrategy

from sequence_planner.language import fitting
from sequence_planner.language.evaluator import evaluate, holds
from sequence_planner.language.fitting import fits_condition, misfit
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse, parse_assignment
from sequence_planner.language.printer import print_expression
from sequence_planner.language.resolver import resolve_assignment, resolve_predicate
from sequence_planner.language.syntax import (
    TRUE,
    Arithmetic,
    Assignment,
    Constant,
    Expression,
    Variable,
    conjunction,
    variables,
)
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value, contains

from .trees import VARIABLES, predicates

TYPES: dict[str, Type] = {
    "count": IntegerRange(0, 3),
    "other": IntegerRange(0, 3),
    "level": IntegerRange(-500, 499),
    "pressure": IntegerRange(0, 999),
    "part": EnumerationType(("bolt", "nut")),
    "seen": EnumerationType(("nothing", "bolt", "nut")),
    "place.executing": BOOLEAN,
    "ready": BOOLEAN,
}


def action(text: str) -> Assignment:
    return resolve_assignment(parse_assignment(text), NameScope(TYPES))


def predicate(text: str) -> Expression:
    return resolve_predicate(parse(text), NameScope(TYPES))


@st.composite
def _actions(draw: DrawFn) -> Assignment:
    """Actions of any value, also one that never fits; integers and enumerations alike."""
    name = draw(st.sampled_from(["count", "balance", "robot.target", "robot.pose", "idle"]))
    target = Variable(name, VARIABLES[name])
    condition = draw(st.none() | predicates)
    value: Expression
    if isinstance(target.type, IntegerRange):
        numbers = st.sampled_from(["count", "balance"]).map(lambda one: Variable(one, VARIABLES[one]))
        leaves: SearchStrategy[Expression] = st.one_of(numbers, st.integers(-2, 4).map(Constant))
        value = draw(
            st.recursive(leaves, lambda part: st.builds(Arithmetic, st.sampled_from("+-"), part, part), max_leaves=3)
        )
    elif target.type == BOOLEAN:
        value = draw(predicates)
    else:
        source = Variable("robot.pose", VARIABLES["robot.pose"])
        values: list[Expression] = [source, *map(Constant, source.type.domain)]
        value = draw(st.sampled_from(values))
    return Assignment(target, value, condition)


actions = _actions()


@given(actions, predicates)
def test_a_misfit_is_found_just_when_some_state_has_one(action: Assignment, guard: Expression) -> None:
    taken = conjunction(guard, action.condition or TRUE)
    possible = [state for state in states(action.value, taken) if holds(taken, state)]
    found = misfit(action, guard)
    if any(not fits(action, state) for state in possible):
        assert found is not None
        assert not contains(type_of(action), found.value)
        assert evaluate(action.value, found.valuation) == found.value
        assert any(found.valuation.items() <= state.items() for state in possible)
    elif possible:  # where nothing is possible at all, a misfit may be reported
        assert found is None


@given(actions, predicates, st.sampled_from([0, 1, 4, 12]))
def test_no_misfit_is_overlooked_however_few_combinations_are_tried(
    action: Assignment, guard: Expression, limit: int
) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fitting, "MOST_COMBINATIONS", limit)
        found = misfit(action, guard)
    if found is None:
        taken = conjunction(guard, action.condition or TRUE)
        assert all(fits(action, state) for state in states(action.value, taken) if holds(taken, state))


@given(actions)
def test_the_condition_is_true_just_where_the_value_fits(action: Assignment) -> None:
    condition = fits_condition(action)
    for state in states(action.value, condition):
        assert evaluate(condition, state) is fits(action, state)


@given(actions)
def test_what_fits_by_its_condition_has_no_misfit(action: Assignment) -> None:
    assert misfit(action, fits_condition(action)) is None


@pytest.mark.parametrize(
    ("text", "guard"),
    [
        ("count := count + 1 if count < 3", "true"),
        ("count := count + 1", "ready and count != 3"),
        ("count := count + other", "count + other <= 3"),
        ("count := count + other if other == 1", "count in {0, 1, 2}"),
        ("count := count + other", "other == count and count < 2"),
        ("count := count + 1", "ready == (count < 3) and (place.executing implies ready) and place.executing"),
        ("part := seen if seen != nothing", "true"),
        ("part := seen", "seen in {bolt, nut}"),
        ("part := seen", "seen == part"),
        ("level := level + 1", "level < 499"),
        ("level := level + pressure", "pressure < 100 and level < 400"),  # too many to try: the bounds decide
        ("ready := count == 4 - other", "true"),
    ],
)
def test_actions_that_fit(text: str, guard: str) -> None:
    assert misfit(action(text), predicate(guard)) is None


@pytest.mark.parametrize(
    ("text", "guard", "message"),
    [
        ("count := count + 1", "true", "`count := count + 1` may write 4 where count == 3, which is not in 0..3"),
        (
            "count := count + other if other != 0",
            "count != 0",
            "`count := count + other if other != 0` may write 4 where count == 1 and other == 3, which is not in 0..3",
        ),
        (
            "count := count - 1",
            "place.executing or count > 0",
            "`count := count - 1` may write -1 where count == 0 and place.executing == true, which is not in 0..3",
        ),
        (
            "part := seen",
            "ready",
            "`part := seen` may write nothing where seen == nothing, which is not in {bolt, nut}",
        ),
        (
            "level := level + pressure",
            "ready",
            "`level := level + pressure` may write 1498, which is not in -500..499",
        ),
    ],
)
def test_what_is_said_of_a_misfit(text: str, guard: str, message: str) -> None:
    found = misfit(action(text), predicate(guard))
    assert str(found) == message


@pytest.mark.parametrize(
    ("text", "condition"),
    [
        ("count := count + 1", "count + 1 <= 3"),
        ("count := count - 1", "count - 1 >= 0"),
        ("count := count - other + 1", "count - other + 1 >= 0 and count - other + 1 <= 3"),
        ("level := pressure", "pressure <= 499"),
        ("part := seen", "seen in {bolt, nut}"),
        ("seen := part", "true"),
        ("count := 3", "true"),
        ("ready := count == 3", "true"),
    ],
)
def test_the_condition_is_written_in_the_language(text: str, condition: str) -> None:
    assert print_expression(fits_condition(action(text))) == condition
    assert predicate(condition) == fits_condition(action(text))


def type_of(action: Assignment) -> Type:
    assert isinstance(action.target, Variable)
    return action.target.type


def fits(action: Assignment, state: dict[str, Value]) -> bool:
    return contains(type_of(action), evaluate(action.value, state))


def states(*read: Expression) -> Iterator[dict[str, Value]]:
    """Every valuation of the variables that are read."""
    names = sorted({name for part in read for name in variables(part)})
    for values in product(*(VARIABLES[name].domain for name in names)):
        yield dict(zip(names, values, strict=True))
