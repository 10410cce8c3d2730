"""The smaller stations in `models`, in simulated time: they go round and round, and survive what can go wrong."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from sequence_planner.execution.vocabulary import PlanStatus
from support.places import MODELS
from support.simulated import Acknowledging, Rig, at_once, never

BUFFER, AGV = MODELS / "robots_with_buffer", MODELS / "docking_agv"


def started(folder: Path, seed: int = 0, acknowledges: Acknowledging = at_once) -> Rig:
    rig = Rig(folder=folder, seed=seed, acknowledges=acknowledges)
    rig.start_production()
    return rig


@pytest.mark.parametrize("seed", range(3))
def test_parts_flow_over_the_buffer(seed: int) -> None:
    rig = started(BUFFER, seed=seed)
    assert rig.run(120, until=lambda: rig.completed.count("deliver_part") >= 6)
    count = Counter(rig.started)
    assert count["robot_2.put"] == 6
    assert 6 <= count["robot_1.place"] <= 6 + 2
    assert count["robot_1.open_gripper"] + count["robot_2.open_gripper"] == 0  # no part was lost, none taken in vain


def test_the_robots_work_at_the_same_time_and_not_at_the_same_place() -> None:
    rig = started(BUFFER)
    both_away: list[float] = []

    def look() -> bool:
        first, second = ((rig.value(f"{robot}.at"), rig.value(f"{robot}.target")) for robot in ("robot_1", "robot_2"))
        assert not ("buffer" in first and "buffer" in second)
        if first[0] != first[1] and second[0] != second[1]:
            both_away.append(rig.now)
        return False

    rig.run(60, until=look)
    assert both_away


def test_a_part_lost_on_its_way_is_replaced() -> None:
    rig = started(BUFFER)
    assert rig.run(30, until=lambda: rig.value("robot_1.at") == "between" and rig.value("robot_1.target") == "buffer")
    rig.devices.set_value("robot_1.part_in_gripper", False)
    assert rig.run(120, until=lambda: rig.completed.count("deliver_part") >= 2)
    count = Counter(rig.started)
    assert count["robot_1.open_gripper"] == 1
    assert count["robot_1.pick"] > count["robot_1.place"] >= 2


@pytest.mark.parametrize("seed", range(3))
def test_kits_are_fetched_handed_over_and_assembled(seed: int) -> None:
    rig = started(AGV, seed=seed)
    assert rig.run(240, until=lambda: rig.completed.count("assemble") >= 6)
    assert rig.completed.count("hand_over_kit") == 6
    assert rig.started.count("dock.charge") >= 2


def test_the_agv_never_strands_and_never_moves_in_the_lock() -> None:
    rig = started(AGV, seed=5)

    def look() -> bool:
        away = rig.value("agv.at") != "bench"
        battery = rig.value("agv.battery")
        assert isinstance(battery, int)
        assert battery > 0
        assert not (away and (rig.value("dock.lock") or rig.value("dock.locked")))
        return rig.completed.count("hand_over_kit") >= 5

    assert rig.run(240, until=look)


def test_without_the_assembler_the_agv_waits_docked_with_the_kit() -> None:
    rig = started(AGV, acknowledges=never)
    rig.run(60)
    assert rig.completed == ["fetch_kit"]
    assert [task.text for task in rig.desk.open.values()] == ["Take the kit off the AGV and put it on the bench."]
    assert rig.value("dock.locked") is True
    assert rig.execution.plan.status is PlanStatus.FOLLOWED


def test_a_kit_is_handed_over_only_when_it_is_gone() -> None:
    """A person who presses Done too early completes nothing: the sensor on the AGV decides as well."""
    rig = started(AGV, acknowledges=lambda task, now: True)
    too_early: list[float] = []

    def look() -> bool:
        if rig.value("assembler.done") is True and rig.value("agv.kit_on_board") is True:
            too_early.append(rig.now)
            assert rig.value("bench_holds") == "empty"
        return rig.completed.count("hand_over_kit") >= 1

    assert rig.run(60, until=look)
    assert too_early
