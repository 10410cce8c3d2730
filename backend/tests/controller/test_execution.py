"""The truck engine station in simulated time, through everything but the network."""

from __future__ import annotations

from collections import Counter

import pytest

from sequence_planner.controller.commands.tasks import WaitingTask
from sequence_planner.controller.recovery.explain import waits_for
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.vocabulary import Mode, PlanStatus
from sequence_planner.pipelines.chain_runtime import first_message
from support.simulated import PAIRS, Rig, at_once, never

MOVES = [f"robot.move_to_position({p})" for p in ("home", "above_engine", *PAIRS)]


def engines(rig: Rig) -> int:
    return rig.completed.count("new_engine")


@pytest.mark.parametrize("seed", range(4))
def test_engines_are_assembled_one_after_the_other(seed: int) -> None:
    rig = Rig(seed=seed)
    rig.start_production()
    assert rig.run(180, until=lambda: engines(rig) >= 3)
    for pair in PAIRS:
        assert rig.completed.count(f"tighten_bolt_pair({pair})") == 3


def test_no_move_is_made_in_vain() -> None:
    """A plan that leaves a bolt pair before its torque is reached counts on a slow robot, and goes round in circles."""
    rig = Rig(seed=1)
    rig.start_production()
    assert rig.run(300, until=lambda: engines(rig) >= 5)
    started = Counter(rig.started)
    for pair in PAIRS:
        assert started[f"robot.move_to_position({pair})"] <= rig.completed.count(f"place_bolt_pair({pair})")
    assert started["nutrunner.run_nut"] <= sum(rig.completed.count(f"place_bolt_pair({pair})") for pair in PAIRS)


def test_the_robot_does_not_wait_for_a_task_it_has_nothing_to_do_with() -> None:
    placed: list[str] = []

    def only_the_first(task: WaitingTask, now: float) -> bool:
        if not placed:
            placed.append(task.ability)
        return task.ability == placed[0]

    rig = Rig(acknowledges=only_the_first)
    rig.start_production()
    assert rig.run(60, until=lambda: any(name.startswith("tighten") for name in rig.completed))


def test_nothing_happens_before_production_is_started() -> None:
    rig = Rig()
    rig.run(5)
    assert not rig.started
    assert not rig.desk.open
    assert all(rig.devices.state[name] is None for name in rig.station.automaton.outputs), "no command was sent"
    assert rig.execution.active, "what there is to do is shown all the same"


def test_paused_lets_the_running_finish_and_starts_nothing() -> None:
    rig = Rig()
    rig.start_production()
    assert rig.run(60, until=lambda: rig.value("nutrunner.run_nut.executing") is True)
    rig.execution.change_mode(Mode.PAUSED, "Eva", Timestamp(rig.now, rig.now))
    before = len(rig.started)
    assert rig.run(30, until=lambda: not [s for s in rig.execution.plan.order.running if s.ability in MOVES])
    rig.run(10)
    assert len(rig.started) == before
    assert waits_for(rig.execution, "nutrunner.run_nut", {}) == ["automatic mode: the station is paused"]
    rig.execution.change_mode(Mode.AUTOMATIC, "Eva", Timestamp(rig.now, rig.now))
    assert rig.run(90, until=lambda: engines(rig) >= 1)


def test_a_silent_topic_stops_the_starts_and_its_return_resumes_them() -> None:
    rig = Rig()
    rig.start_production()
    assert rig.run(60, until=lambda: rig.value("robot.pose") == "unknown")
    rig.silent = {"/ur10/state"}
    rig.run(1)
    assert rig.value("robot.pose") is None
    before = list(rig.started)
    rig.run(20)
    assert not set(rig.started[len(before) :]) & set(MOVES)
    assert not [n for n in rig.started[len(before) :] if n.startswith("operator")], "nobody can say where the robot is"
    rig.silent = set()
    assert rig.run(120, until=lambda: engines(rig) >= 1)


def test_devices_that_were_started_again_are_brought_back_to_work() -> None:
    rig = Rig(seed=3)
    rig.start_production()
    assert rig.run(60, until=lambda: rig.value("nutrunner.run_nut.executing") is True)
    rig.silent = set(rig.station.pipelines.incoming)
    rig.run(2)
    fresh = Rig(seed=4)
    rig.devices = fresh.devices
    rig.silent = set()
    for name, pipeline in rig.station.pipelines.outgoing.items():
        rig.devices.command(name, first_message(pipeline, rig.execution.state) or {})
    rig.devices.advance(rig.now)
    assert rig.run(150, until=lambda: engines(rig) >= 1)


@pytest.mark.parametrize("pose", ["home", "above_engine", "bolt_pair_2"])
def test_a_robot_moved_by_hand_is_recovered(pose: str) -> None:
    rig = Rig(seed=2)
    rig.start_production()
    assert rig.run(60, until=lambda: rig.value("robot.pose") == "above_engine")
    rig.devices.set_value("robot.pose", pose)
    assert rig.run(150, until=lambda: engines(rig) >= 1)


def test_a_departure_that_breaks_the_plan_is_answered_with_a_new_one() -> None:
    rig = Rig(acknowledges=never)
    rig.start_production()
    rig.run(3)
    assert rig.value("robot.tool_is_attached") is True
    # Somebody takes the bolts away that the operator has placed: the tighten operation has nothing to work on.
    rig.acknowledges = at_once
    assert rig.run(60, until=lambda: "nutrunner.run_nut" in rig.started)
    pair = next(p for p in PAIRS if rig.value(f"bolts[{p}]") == "placed")
    rig.execution.state = {**rig.execution.state, f"bolts[{pair}]": "empty"}
    rig.acknowledges = never
    rig.run(0.3)
    assert rig.execution.plan.status is PlanStatus.FOLLOWED
    assert f"place_bolt_pair({pair})" in rig.execution.active
    rig.acknowledges = at_once
    assert rig.run(120, until=lambda: engines(rig) >= 1)


def test_the_next_step_says_what_it_waits_for() -> None:
    rig = Rig(acknowledges=never)
    rig.start_production()
    rig.run(5)
    feeds = rig.station.pipelines.feeds
    assert waits_for(rig.execution, rig.execution.plan.order.names[0], feeds) == ["operator.requested_pair == none"]
    rig.silent = {"/ur10/state"}
    rig.run(0.2)
    assert "a message on /ur10/state" in waits_for(rig.execution, "robot.move_to_position(above_engine)", feeds)
    rig.silent = set()
    rig.run(0.2)
    rig.execution.state = {**rig.execution.state, "bolts[bolt_pair_1]": "placed"}
    rig.devices.set_value("robot.pose", "above_engine")
    rig.execution.state = {**rig.execution.state, "robot.pose": "above_engine", "robot.target_pose": "above_engine"}
    rig.tick()
    waiting = waits_for(rig.execution, "robot.move_to_position(bolt_pair_1)", feeds)
    assert waiting == [
        "a safe start: The nutrunner must turn before it meets placed bolts "
        "(no_standing_tool_on_placed_bolts(bolt_pair_1))"
    ]


def test_a_start_taken_while_the_planner_thought_is_not_planned_again() -> None:
    rig = Rig(thinking=3)
    rig.start_production()

    def planned_again() -> bool:
        order = rig.execution.plan.order
        return any(step.ability in order.names for step in order.running if step.ability.startswith("operator"))

    rig.run(90, until=lambda: planned_again() or engines(rig) >= 2)
    assert not planned_again()
    assert engines(rig) >= 2
