"""The tool change while a node hears nothing: what it was told has not happened before it says so."""

from __future__ import annotations

from stations.simulated import HallRig

LONG_ENOUGH = 150.0  # seconds to the second tool of an engine


def at_work() -> HallRig:
    """The station with production started."""
    rig = HallRig()
    rig.improves = False
    rig.start_production()
    return rig


def test_the_robot_leaves_its_tool_only_when_the_scene_says_that_it_has_let_go_of_it() -> None:
    rig = at_work()
    assert rig.live(LONG_ENOUGH, until=lambda: "scene.detach" in rig.started)
    assert rig.hall.world.scene == ["LFTOOL"]
    rig.hall.freeze("scene", 4.0)
    rig.live(3.8)
    assert rig.value("robot.target_pose") == rig.value("robot.pose") == "AttachLFToolTCPPose"
    assert rig.live(LONG_ENOUGH, until=lambda: rig.hall.world.scene == ["ATLASTOOL"])


def test_the_robot_pulls_the_nutrunner_only_when_its_lift_floats() -> None:
    rig = at_work()
    assert rig.live(LONG_ENOUGH, until=lambda: "nutrunner.float" in rig.started)
    rig.hall.freeze("tool_ecu", 25.0)
    rig.live(24.8)
    assert rig.hall.world.nutrunner.lift == "hold"
    assert "ATLASTOOL" not in rig.hall.world.away
    assert rig.live(LONG_ENOUGH, until=lambda: "ATLASTOOL" in rig.hall.world.away)


def test_the_robot_lets_go_of_the_nutrunner_only_when_its_lift_holds() -> None:
    rig = at_work()
    assert rig.live(LONG_ENOUGH, until=lambda: "nutrunner.lift" in rig.started)
    rig.hall.restart("tool_ecu", 2.8)
    assert rig.live(LONG_ENOUGH, until=lambda: rig.hall.world.held == "OFTOOL")
