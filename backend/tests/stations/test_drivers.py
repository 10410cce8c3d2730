"""The computers at the devices: what they make of commands, and what they say."""

from __future__ import annotations

from itertools import product

import pytest

from sequence_planner.simulation.truck_station.drivers import (
    END_EFFECTOR,
    FORGOTTEN_AFTER,
    LIFTS,
    RUNS,
    EndEffectorDriver,
    RobotDriver,
    SceneDriver,
    ToolDriver,
    WatchDriver,
)
from sequence_planner.simulation.truck_station.poses import POSES

HOME = list(POSES["HomeJOINTPose"])
STILL = [0.0] * 6


def test_the_nutrunner_runs_only_if_exactly_one_bit_is_set() -> None:
    for bits in product((False, True), repeat=4):
        driver = ToolDriver()
        driver.on_command(dict(zip(RUNS, bits, strict=True)), 0.0)
        only = [run for run, bit in zip(RUNS.values(), bits, strict=True) if bit]
        assert driver.signals(0.1)["run"] == (only[0] if len(only) == 1 else "idle")


def test_the_lift_floats_holds_or_stays() -> None:
    told = {}
    for bits in product((False, True), repeat=2):
        driver = ToolDriver()
        driver.on_command(dict(zip(LIFTS, bits, strict=True)), 0.0)
        told[bits] = driver.signals(0.1)["lift"]
    expected = {(False, False): None, (True, False): "float", (False, True): "hold", (True, True): None}
    assert told == expected


def test_the_valves_move_only_if_exactly_one_bit_is_set() -> None:
    alone = {
        "lock_rsp": {"lock": True},
        "unlock_rsp": {"lock": False},
        "open_gripper": {"close": False},
        "close_gripper": {"close": True},
    }
    for bits in product((False, True), repeat=4):
        driver = EndEffectorDriver()
        driver.on_command(dict(zip(END_EFFECTOR, bits, strict=True)), 0.0)
        only = [name for name, bit in zip(END_EFFECTOR, bits, strict=True) if bit]
        assert driver.signals(0.1) == (alone[only[0]] if len(only) == 1 else {})


def test_a_driver_echoes_what_it_hears_and_forgets_it_when_nothing_comes_any_more() -> None:
    driver = ToolDriver()
    assert driver.signals(0.0) == {}  # a device stays as it is until its computer has heard something
    driver.on_command({"run_tool_forward": True, "activate_unload": True}, 10.0)
    read = {"turning": True, "reverse": False, "torque": False, "home": False}
    said = driver.say(read, 10.0 + FORGOTTEN_AFTER - 0.1)
    echoes = {name: value for name, value in said.items() if "got" in name and value}
    assert set(echoes) == {
        "aecu_unidriver_got_msg_from_sp",
        "got_cmd_run_tool_forward",
        "got_cmd_activate_unload",
    }
    later = 10.0 + FORGOTTEN_AFTER
    said = driver.say(read, later)
    assert not any(value for name, value in said.items() if "got" in name)
    assert driver.signals(later) == {"run": "idle", "lift": None}
    assert said["tool_is_running_forward"] is True  # what is measured is true all the same


def test_a_watch_that_hears_nothing_sets_nothing() -> None:
    assert WatchDriver().signals(0.0) == {"task": None, "pair": None}


def test_the_scene_says_what_the_robot_holds() -> None:
    driver = SceneDriver()
    driver.on_command({"object_action": "ATTACH", "object_name": "LFTOOL"}, 0.0)
    assert driver.signals(0.1) == {"action": "ATTACH", "object": "LFTOOL"}
    said = driver.say({"attached": ["LFTOOL"]}, 0.1)
    assert said["attached_objects"] == ["LFTOOL"]
    assert said["ricochet"] == {"got_object_action": "ATTACH", "got_object_name": "LFTOOL"}


def command(pose: str, speed: float = 0.25, name: str = "TARS") -> dict[str, object]:
    return {
        "action": "PLANNED",
        "robot_type": "UR10",
        "robot_name": name,
        "pose_type": "JOINT",
        "pose_name": pose,
        "speed_scaling": speed,
    }


def test_the_robot_is_at_a_saved_pose_on_its_way_or_nowhere() -> None:
    driver = RobotDriver()
    assert driver.say({"joints": HOME, "speeds": STILL}, 0.0)["actual_pose"] == "HomeJOINTPose"
    driver.on_command(command("AboveKitJOINTPose"), 0.1)
    said = driver.say({"joints": HOME, "speeds": [0.0, 0.02, 0.0, 0.0, 0.0, 0.0]}, 0.2)
    assert (said["moving"], said["actual_pose"]) == (True, "moving from HomeJOINTPose to AboveKitJOINTPose")
    said = driver.say({"joints": [9.0] * 6, "speeds": [0.0, 0.0, 0.0, 0.0, 0.0, 1.0]}, 0.3)
    assert (said["moving"], said["actual_pose"]) == (False, "UNKNOWN")  # the sixth joint does not count


@pytest.mark.parametrize("forget", ["UNKNOWN", "RESET"])
def test_a_command_that_equals_the_one_before_is_ignored_until_it_is_forgotten(forget: str) -> None:
    driver = RobotDriver()
    driver.on_command(command("AboveKitJOINTPose"), 0.0)
    assert driver.signals(0.0) == {"pose": "AboveKitJOINTPose", "action": "PLANNED", "scaling": 0.25}
    driver.on_command(command(forget), 1.0)
    assert driver.signals(1.0) == {}
    driver.on_command(command("AboveKitJOINTPose"), 2.0)
    assert driver.signals(2.0)["pose"] == "AboveKitJOINTPose"


@pytest.mark.parametrize(
    ("wrong", "error"),
    [
        (command("AboveKitJOINTPose", name="KIPP"), "robot name mismatch: KIPP"),
        (command("BehindTheMoon"), "no such pose is saved: BehindTheMoon"),
    ],
)
def test_a_command_for_another_robot_or_pose_is_an_error_and_moves_nothing(
    wrong: dict[str, object], error: str
) -> None:
    driver = RobotDriver()
    driver.on_command(command("HomeJOINTPose"), 0.0)
    driver.on_command(wrong, 1.0)
    info = driver.say({"joints": HOME, "speeds": STILL}, 1.0)["info"]
    assert info == {"robot_name": "TARS", "fresh_msg": True, "error_list": [error]}
    assert driver.signals(1.0)["pose"] == "HomeJOINTPose"
