"""Engines by order: what a job of the truck engine station consists of, that engine after engine is made so, and that
one whose order was aborted is made to its end by the next order."""

from __future__ import annotations

from functools import partial

import pytest

from controller.carrying_out import carry_out
from sequence_planner.automaton.automaton import target
from sequence_planner.controller.commands.jobs import CommandJob, SetByOrder, TakeJob
from sequence_planner.controller.features.jobs import JobHandler
from sequence_planner.core.actor import SYSTEM
from sequence_planner.core.clock import Timestamp
from sequence_planner.simulation.truck_station.poses import PAIRS
from sequence_planner.station import prepare_station
from stations.simulated import HallRig
from support.examples import SHARE
from support.places import TRUCK_ENGINE_STATION

LONG = pytest.mark.skipif(SHARE < 1, reason="engines take long: `make campaign` makes them")
TOOLS = {"take_lf_tool", "take_nutrunner", "take_filter_tool"}


def test_a_job_is_all_the_work_on_an_engine_and_what_the_robot_holds_is_none() -> None:
    automaton = prepare_station(TRUCK_ENGINE_STATION).automaton
    engine = automaton.work_masters["engine"]
    assert automaton.operations.keys() - engine.operations.keys() == TOOLS
    assert engine.operations["release_engine"] == {"tighten_oil_filter", "return_kit"}
    assert not engine.brings, "an engine that stands half built on the line would be taken for an empty one"
    about_engine = {"ladder_frame", "oil_filter_is_tight", *(f"bolts[{pair}]" for pair in PAIRS)}
    assert {target(action) for action in automaton.abilities["engine.release"].start_actions} >= about_engine


def order(rig: HallRig, job: str) -> None:
    take = TakeJob(actor=SYSTEM, job=job, title=job, work_master="engine")
    carry_out(JobHandler(rig.execution), take, Timestamp(rig.now, rig.now))


def ended(rig: HallRig, job: str) -> bool:
    found = rig.execution.conduct.jobs.get(job)
    return found is not None and not found.under_way


@pytest.mark.parametrize(
    "after",
    [
        pytest.param("ladder frame gripped", marks=LONG),
        pytest.param("bolts placed", marks=LONG),
        "oil filter tightened",
    ],
)
def test_an_engine_whose_order_was_aborted_is_made_to_its_end_by_the_next(after: str) -> None:
    rig = HallRig()
    now = Timestamp(rig.now, rig.now)
    desk, events = JobHandler(rig.execution), rig.hall.world.verdict.events
    carry_out(desk, SetByOrder(actor=SYSTEM, on=True, reason="so"), now)
    rig.start_production()
    order(rig, "first")
    assert rig.live(300, lambda: any(event.startswith(after) for _, event in events))
    carry_out(desk, CommandJob(actor=SYSTEM, job="first", what="abort"), Timestamp(rig.now, rig.now))
    order(rig, "second")
    assert rig.live(300, lambda: ended(rig, "second"))
    counted = rig.hall.world.verdict.counted
    assert [counted[event] for event in ("engine done", "ladder frame mounted", "oil filter tightened")] == [1, 1, 1]


@LONG
def test_engine_after_engine_is_made_to_order() -> None:
    rig = HallRig()
    desk = JobHandler(rig.execution)
    carry_out(desk, SetByOrder(actor=SYSTEM, on=True, reason="so"), Timestamp(rig.now, rig.now))
    rig.start_production()
    assert not rig.live(3, lambda: bool(rig.started)), "without a job there is nothing to do"
    for number in (1, 2):
        name = f"engine-{number}"
        order(rig, name)
        assert rig.live(300, partial(ended, rig, name))
        made = [what for _, what in rig.hall.world.verdict.events if what == "engine done"]
        assert len(made) == number
