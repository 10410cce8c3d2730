"""A pause when the product that is in work is done: what still starts until then, and that nothing does after it."""

from __future__ import annotations

import pytest

from controller.bench_of_jobs import STATION, Bench
from controller.test_conduct import CART, Station
from sequence_planner.automaton.automaton import WorkMaster
from sequence_planner.core.immutable import replace
from sequence_planner.execution.events import CycleStopChanged
from sequence_planner.execution.products import final_operations
from sequence_planner.execution.vocabulary import Mode
from support.automata import predicate_of

# The cart drills one piece after the other: each is brought home, and another one lies there at once.
MASTER = WorkMaster("piece", "A piece", {"make": frozenset(), "bring": frozenset({"make"})})
ENDLESS = replace(
    CART,
    operations={
        **CART.operations,
        "bring": replace(
            CART.operations["make"],
            name="bring",
            precondition=predicate_of(CART, "done and at == work"),
            goal=predicate_of(CART, "at == home"),
        ),
    },
    work_masters={"piece": MASTER},
)


@pytest.fixture
def station() -> Station:
    made = Station(ENDLESS)
    made.begin()
    return made


def until_brought(station: Station) -> list[str]:
    """What starts until the piece lies at home, with devices that do what they are told."""
    started: list[str] = []
    for _ in range(20):
        state = station.execution.state
        started += station.tick(at=state["target"], turns=state["drill"])
        if started[-1:] == ["home"]:
            break
    return started


def test_the_product_that_is_in_work_is_finished_and_nothing_starts_in_the_tick_in_which_it_is(
    station: Station,
) -> None:
    assert final_operations(ENDLESS) == {"bring"}
    station.execution.set_cycle_stop(True, "Eva", "the shift ends", station.now)
    assert until_brought(station) == ["go", "drill", "home"], "it goes on to the end of the piece"
    station.tick(at="home", turns=False)
    stop = station.execution.conduct.cycle_stop
    assert stop is not None
    assert (stop.by, stop.reached) == ("Eva", True)
    assert station.execution.mode is Mode.AUTOMATIC, "whoever runs it changes the mode"
    station.execution.correct({"done": False}, "a device", "another piece", station.now)
    assert [station.tick() for _ in range(3)] == [(), (), ()]
    station.execution.change_mode(Mode.PAUSED, stop.by, station.now)
    assert station.execution.conduct.cycle_stop == stop, "it says why the station is paused"
    station.execution.change_mode(Mode.AUTOMATIC, "Eva", station.now)
    assert station.execution.conduct.cycle_stop is None
    assert station.tick() + station.tick() == ("go",)


def test_who_takes_the_wish_back_has_the_station_go_on(station: Station) -> None:
    station.execution.set_cycle_stop(True, "Eva", "", station.now)
    station.execution.set_cycle_stop(False, "Bo", "", station.now)
    until_brought(station)
    station.tick(at="home", turns=False)
    station.execution.correct({"done": False}, "a device", "another piece", station.now)
    assert station.tick() + station.tick() == ("go",)
    changes = [heard.happening for heard in station.heard if isinstance(heard.happening, CycleStopChanged)]
    assert [(each.on, each.by) for each in changes] == [(True, "Eva"), (False, "Bo")]


def test_a_wish_ends_with_the_mode(station: Station) -> None:
    station.execution.set_cycle_stop(True, "Eva", "", station.now)
    station.execution.change_mode(Mode.HOLD, "Eva", station.now)
    assert station.execution.conduct.cycle_stop is None


def test_no_job_begins_meanwhile_and_it_is_reached_when_those_that_have_begun_are_over() -> None:
    on = Bench()
    on.by_order()
    on.execution.start_production()
    on.take("a", "bottle")
    on.tick()
    on.execution.set_cycle_stop(True, "Eva", "", on.now)
    on.take("b", "box")
    on.ticks(2)
    assert [on.jobs[job].state for job in ("a", "b")] == ["running", "waiting"]
    assert any("Eva" in each for each in on.jobs["b"].waits_for)
    on.correct({"content": "full"})
    on.ticks(2)
    on.tick(checked=True, labelled=True)
    on.ticks(2)
    assert [on.jobs[job].state for job in ("a", "b")] == ["ended", "waiting"]
    stop = on.execution.conduct.cycle_stop
    assert stop is not None
    assert stop.reached
    on.execution.change_mode(Mode.PAUSED, "Eva", on.now)
    on.execution.change_mode(Mode.AUTOMATIC, "Eva", on.now)
    on.tick()
    assert on.jobs["b"].state == "running"


def test_a_station_by_order_with_nothing_in_work_has_reached_the_end_at_once() -> None:
    on = Bench()
    on.by_order()
    on.execution.start_production()
    on.execution.set_cycle_stop(True, "Eva", "", on.now)
    on.tick()
    stop = on.execution.conduct.cycle_stop
    assert stop is not None
    assert stop.reached


def test_the_final_operation_is_the_one_that_comes_after_all_others() -> None:
    assert final_operations(STATION) == {"pack_it", "label_it"}, "of the box and of the crate; a bottle has two ends"
