"""Engines by order: what a job of the truck engine station consists of, and that engine after engine is made so."""

from __future__ import annotations

import pytest

from core.budget import SHARE
from sequence_planner.actor import SYSTEM
from sequence_planner.control.job_commands import SetByOrder, TakeJob
from sequence_planner.control.job_desk import JobDesk
from sequence_planner.control.moment import Moment
from sequence_planner.emulation.truck_station.poses import PAIRS
from sequence_planner.station import prepare_station
from stations.simulated import MODEL, HallRig

TOOLS = {"take_lf_tool", "take_nutrunner", "take_filter_tool"}


def test_a_job_is_all_the_work_on_an_engine_and_what_the_robot_holds_is_none() -> None:
    automaton = prepare_station(MODEL).automaton
    engine = automaton.work_masters["engine"]
    assert automaton.operations.keys() - engine.operations.keys() == TOOLS
    assert engine.operations["release_engine"] == {"tighten_oil_filter", "return_kit"}
    brought = {"ladder_frame", "oil_filter_is_tight", *(f"bolts[{pair}]" for pair in PAIRS)}
    assert len(engine.brings) == len(brought)


@pytest.mark.skipif(SHARE < 1, reason="two engines take long: `make campaign` makes them")
def test_engine_after_engine_is_made_to_order() -> None:
    rig = HallRig()
    desk = JobDesk(rig.execution)

    def now() -> Moment:
        return Moment(rig.now, rig.now)

    desk.carry_out(SetByOrder(actor=SYSTEM, on=True, reason="so"), now())
    rig.start_production()
    assert not rig.live(3, lambda: bool(rig.started)), "without a job there is nothing to do"
    for number in (1, 2):
        name = f"engine-{number}"
        desk.carry_out(TakeJob(actor=SYSTEM, job=name, title=name, work_master="engine"), now())

        def over(name: str = name) -> bool:
            job = rig.execution.conduct.jobs.get(name)
            return job is not None and job.state == "ended"

        assert rig.live(300, over)
        made = [what for _, what in rig.hall.world.verdict.events if what == "oil filter tightened"]
        assert len(made) == number
