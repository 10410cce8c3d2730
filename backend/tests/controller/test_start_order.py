"""The start order: what has run, what runs, what comes next."""

from __future__ import annotations

from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.plan_tracker import FEWEST_STEPS, REMEMBERED_STEPS, PlanCursor
from sequence_planner.planning.problem import Plan, PlanTick


def at(seconds: float) -> Timestamp:
    return Timestamp(1000 + seconds, seconds)


def plan(*ticks: tuple[str, ...]) -> Plan:
    return Plan(tuple(PlanTick((), starts) for starts in ticks), minimal_ticks=True, minimal_starts=True)


def following(*ticks: tuple[str, ...]) -> PlanCursor:
    order = PlanCursor()
    order.adopt(plan(*ticks), ["goal"], ["goal"])
    return order


def test_steps_go_from_ahead_to_running_to_past() -> None:
    order = following(("a", "b"), ("c",))
    step = order.start(at(1))
    assert (step.ability, step.tick, order.names) == ("a", 1, ("b", "c"))
    assert [running.ability for running in order.running] == ["a"]
    assert order.finish("a", at(2))
    assert not order.finish("a", at(3)), "it is over"
    assert (step.started, step.ended) == (at(1), at(2))


def test_a_run_that_was_never_seen_to_finish_is_over_when_its_ability_starts_again() -> None:
    """Else it would be shown as running, and be overdue, for ever."""
    order = following(("a",), ("a",))
    first, second = order.start(at(1)), order.start(at(5))
    assert first.ended == at(5)
    assert order.running == [second]


def test_a_new_plan_keeps_what_was_done_and_gives_new_numbers() -> None:
    order = following(("a",), ("b",))
    order.start(at(1))
    order.adopt(plan(("c",)), ["goal"], ["goal"])
    assert [step.ability for step in (*order.past, *order.ahead)] == ["a", "c"]
    assert len({step.number for step in (*order.past, *order.ahead)}) == 2


def test_only_so_many_past_steps_are_remembered_but_all_that_run() -> None:
    names = [f"a{number}" for number in range(REMEMBERED_STEPS + 20)]
    order = following(tuple(names))
    for name in names:
        order.start(at(1))
        if name != "a0":
            order.finish(name, at(2))
    assert [step.ability for step in order.running] == ["a0"]
    assert len(order.past) <= REMEMBERED_STEPS + 2


def test_a_minute_is_looked_back_on_and_a_few_steps_however_long_ago() -> None:
    def after(seconds: list[float]) -> int:
        order = following(tuple(f"a{number}" for number, _ in enumerate(seconds)))
        for number, second in enumerate(seconds):
            order.start(at(second))
            order.finish(f"a{number}", at(second))
        return len(order.past)

    assert after([*map(float, range(30)), 59]) == 31
    assert after([*map(float, range(30)), 500]) == FEWEST_STEPS + 1


def test_the_rest_of_the_plan_begins_behind_the_last_start() -> None:
    order = following(("a",), (), ("b", "c"))
    assert order.rest() == (("a", "b", "c"), plan(("a",), (), ("b", "c")).ticks)
    assert order.rest(taken=1) == (("b", "c"), plan((), ("b", "c")).ticks)
    order.start(at(1))
    order.pull_forward(1)
    assert order.rest() == (("c", "b"), ()), "it is no longer the order of the plan"


def test_a_copy_does_not_follow() -> None:
    order = following(("a",), ("b",))
    order.start(at(1))
    kept = order.copy()
    order.start(at(2))
    order.finish("a", at(3))
    assert kept.names == ("b",)
    assert [step.ended for step in kept.past] == [None]
