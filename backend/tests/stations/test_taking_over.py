"""A person does the work of a robot that is off or dead, in the hall whose world alone says what was truly done."""

from __future__ import annotations

import math

import pytest

from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.vocabulary import Mode, ServiceKind
from sequence_planner.simulation.truck_station.poses import PAIRS
from stations.simulated import HallRig
from support.examples import SHARE

IN_CAMPAIGNS = pytest.mark.skipif(SHARE < 1, reason="an engine by hand takes long: `make campaign`")
HOME = "HomeJOINTPose"


def moment(rig: HallRig) -> Timestamp:
    return Timestamp(rig.now, rig.now)


def put(rig: HallRig, *, in_service: bool) -> None:
    """Take the robot out of service, or put it back."""
    rig.execution.set_service(ServiceKind.RESOURCE, "robot", in_service, "Eva", "it rattles", moment(rig))


def tightened(rig: HallRig) -> list[str]:
    """The pairs whose bolts are tight, as the world has seen it."""
    return [event for _, event in rig.hall.world.verdict.events if event.startswith("bolt tightened")]


def engine_is_done(rig: HallRig) -> bool:
    return "engine done" in [event for _, event in rig.hall.world.verdict.events]


def test_with_the_robot_switched_off_the_watch_gets_its_work_and_the_engine_is_rightly_built() -> None:
    rig = HallRig(seed=3)
    rig.improves = False
    rig.start_production()
    assert rig.live(200, until=lambda: "mount_ladder_frame" in rig.completed)
    put(rig, in_service=False)
    rig.hall.world.person.takes_over = True

    before = len(rig.started)
    assert rig.live(300, until=lambda: len(tightened(rig)) == len(PAIRS))
    assert tightened(rig) == [f"bolt tightened: {pair} by hand" for pair in PAIRS]
    assert not [name for name in rig.started[before:] if name.startswith("robot.")]
    by_hand = [name for name in rig.started if name.startswith("operator.guide_nutrunner")]
    assert by_hand == [f"operator.guide_nutrunner({pair})" for pair in PAIRS]
    assert rig.value("robot.pose") == HOME == rig.value("robot.target_pose")

    rig.hall.world.person.takes_over = False
    put(rig, in_service=True)
    assert rig.live(200, until=lambda: engine_is_done(rig))
    assert not rig.hall.world.verdict.wrong


@pytest.mark.parametrize("pose", ["UNKNOWN", pytest.param(PAIRS[1], marks=IN_CAMPAIGNS)])
def test_a_robot_that_dies_in_the_middle_of_a_bolt_is_worked_around_by_hand(pose: str) -> None:
    """On its way down with the turning tool, or while that turns on the bolts; then the tool is stopped by Hold."""
    rig = HallRig(seed=3)
    rig.improves = False
    world = rig.hall.world
    rig.start_production()
    assert rig.live(200, until=lambda: (rig.value("robot.target_pose"), rig.value("robot.pose")) == (PAIRS[1], pose))
    rig.patience = 1.0  # what the robot cannot do takes the planner as long as it is given
    world.arm.jammed = True
    rig.hall.leave("ur10", math.inf)
    rig.execution.change_mode(Mode.HOLD, "Eva", moment(rig))
    rig.live(3)
    assert rig.value("robot.pose") is None
    assert not rig.execution.safe  # it may stand on bolts that are loose, and the tool does not turn
    assert len(tightened(rig)) == 1

    rig.patience = 20.0
    world.person.takes_over = True
    rig.live(1)
    assert rig.execution.safe
    rig.execution.change_mode(Mode.AUTOMATIC, "Eva", moment(rig))
    before = len(rig.started)
    assert rig.live(200, until=lambda: len(tightened(rig)) == len(PAIRS))
    assert rig.started[before:] == [
        "operator.free_nutrunner",
        *(f"operator.guide_nutrunner({pair})" for pair in PAIRS[1:]),
    ]
    assert tightened(rig)[1:] == [f"bolt tightened: {pair} by hand" for pair in PAIRS[1:]]

    world.arm.jammed = False
    rig.hall.restart("ur10", 0.5)
    rig.live(3)
    world.person.takes_over = False
    assert rig.live(200, until=lambda: engine_is_done(rig))
    assert not world.verdict.wrong
