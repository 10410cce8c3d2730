"""One order of starts has every order in it that can make a difference."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import permutations

import pytest
from hypothesis import given

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.tick import initial_state
from sequence_planner.language.types import BOOLEAN, IntegerRange
from sequence_planner.planning.demands import Demands, Domains
from sequence_planner.planning.pdr.ic3 import Reachability
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import Circumstances, goals_of
from sequence_planner.planning.sat.bmc import BoundedModelChecking
from sequence_planner.planning.sat.start_order import StartPairs, Sweep, circles, linear
from sequence_planner.process.budget import Budget
from sequence_planner.synthesis.supervisor import synthesise
from support.automata import Does, automaton
from support.examples import examples

from .choices import Choices, made_by
from .order_comparison import compare_orders, compare_pairs, ends
from .random_problems import Problem, problem

OFF = (BOOLEAN, False)
Before = Mapping[str, Mapping[str, None]]


def demands(choices: Choices) -> tuple[Before, tuple[str, ...]]:
    """Which names must stand before which, and an order of some of them."""
    names = "abcdef"[: choices.number(1, 6)]
    before = {name: {other: None for other in names if other != name and choices.chance(3)} for name in names}
    return before, tuple(choices.different(names, 0, min(len(names), 5)))


def exchanged(before: Before, order: Sequence[str]) -> list[tuple[str, ...]]:
    """All orders that come of it by exchanging neighbours of which the first need not stand before the second."""
    kept = [(one, other) for n, one in enumerate(order) for other in order[n + 1 :] if one in before[other]]
    return [each for each in permutations(order) if all(each.index(one) < each.index(other) for one, other in kept)]


def is_part(some: Sequence[str], whole: Sequence[str]) -> bool:
    left = iter(whole)
    return all(name in left for name in some)


@examples(300)
@given(made_by(demands))
def test_every_order_can_be_exchanged_until_it_is_a_part(given_: tuple[Before, tuple[str, ...]]) -> None:
    before, order = given_
    whole = tuple(linear(before))
    assert set(whole) == set(before)
    assert any(is_part(each, whole) for each in exchanged(before, order))


@examples(200)
@given(made_by(demands))
def test_only_members_of_circles_are_repeated(given_: tuple[Before, tuple[str, ...]]) -> None:
    before, _ = given_
    places = Counter(linear(before))
    for circle in circles(before):
        assert all(1 <= places[name] <= len(circle) for name in circle)


@examples(60)
@given(made_by(problem))
def test_what_texts_show_the_solver_finds_too(given_: Problem) -> None:
    station, supervisor = given_.automaton, given_.supervisor
    asked = {name: Demands(Domains(station), ability) for name, ability in station.abilities.items()}
    told, merely_known = (StartPairs(station, supervisor, known) for known in (False, True))
    for one, other in permutations(asked, 2):
        if asked[one].excludes(asked[other]):
            assert not told.order_matters(one, other)
        if asked[one].undone_by(asked[other]):
            assert not merely_known.order_matters(one, other)
        guarded = any(name in supervisor.guards or station.abilities[name].restart for name in (one, other))
        if not guarded and asked[one].commutes_with(asked[other]):
            assert not told.order_matters(one, other)


@examples(100)
@given(made_by(problem))
def test_a_tick_without_needless_starts_ends_wherever_one_can(given_: Problem) -> None:
    station = given_.automaton
    sweep = Sweep(station, given_.supervisor, known=True)
    for restart in (False, True):
        order = [ability.name for ability in sweep.complete(Budget.seconds(60), restart=restart)]
        assert restart or not any(station.abilities[name].restart for name in order)
        if given_.supervisor.safe.includes(given_.state):
            of = (station, given_.supervisor, given_.state, given_.state)
            assert ends(*of, order, restart).keys() == ends(*of, None, restart).keys()


@pytest.mark.parametrize("seed", range(40))
def test_an_order_of_many_abilities_has_all_others_in_it(seed: int) -> None:
    assert compare_orders(f"orders.0.{seed}")["orders"]


@pytest.mark.parametrize("seed", range(20))
def test_the_order_of_two_starts_matters_where_it_makes_a_difference_in_some_state(seed: int) -> None:
    assert compare_pairs(f"pairs.0.{seed}")


LEVEL = IntegerRange(0, 2)


def test_a_start_that_another_one_makes_possible_comes_after_it() -> None:
    """Nothing else does: `use` cannot start before `two`, though it could at other times."""
    station = automaton(
        {
            "use": Does(start=("x := 1", "done := true"), when="x == 2"),
            "two": Does(start=("x := 2",), finish="x == 2", finally_=("x := 0",)),
            "one": Does(start=("x := 1",)),
            "zero": Does(start=("x := 0",)),
            "mark": Does(start=("o := true",), when="x == 1"),
        },
        estimated={"x": (LEVEL, 1), "done": OFF, "o": OFF},
        goals={"done": "done"},
    )
    found_in_two_ticks(station, Circumstances())


def test_what_the_safe_states_ask_of_a_restart_ability_comes_before_it() -> None:
    station = automaton(
        {
            "reset": Does(start=("a := true",), restart=True),
            "open": Does(start=("shut := false",), finish="not a", finally_=("shut := true",)),
        },
        estimated={"a": OFF, "shut": (BOOLEAN, True)},
        forbidden={"shut": "a and shut"},
        goals={"a": "a"},
    )
    found_in_two_ticks(station, Circumstances(restart=True))


def found_in_two_ticks(station: Automaton, circumstances: Circumstances) -> None:
    goals, supervisor = goals_of(station, station.operations), synthesise(station)
    task = PlanningTask(initial_state(station), goals, circumstances)
    plan = BoundedModelChecking(station, supervisor).solve(task, Budget.seconds(60)).plan
    assert plan is not None
    assert len(plan.ticks) == 2
    assert Reachability(station, supervisor).solve(task, Budget.seconds(60)).proof is None


def test_what_is_done_and_undone_at_will_is_not_repeated() -> None:
    """A tool is picked up or put back in a tick; both together would be for nothing."""
    station = automaton(
        {
            "pick": Does(start=("held := true",), enabled="not held"),
            "put": Does(start=("held := false",), enabled="held"),
        },
        estimated={"held": OFF},
        goals={"reach": "held"},
    )
    supervisor = synthesise(station)
    assert initial_state(station)["held"] is False
    for known, places in ((False, 3), (True, 2)):
        assert len(Sweep(station, supervisor, known).complete(Budget.seconds(60))) == places
