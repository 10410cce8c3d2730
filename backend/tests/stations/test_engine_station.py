"""The model of the truck engine station of eight nodes: what it says, and that it can be planned with."""

from __future__ import annotations

import time
from collections.abc import Mapping
from functools import cache

import pytest

from sequence_planner.automaton.automaton import Kind, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import initial_state, synchronise
from sequence_planner.language.evaluator import holds
from sequence_planner.language.types import Value
from sequence_planner.planning.diagnosis import MemberKind, diagnose
from sequence_planner.planning.pdr.invariants import check
from sequence_planner.planning.planner import InTurn, Planner
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.portfolio.engines import Engines, Lane
from sequence_planner.planning.problem import (
    Circumstances,
    Contract,
    PlanAnswer,
    PlanRequest,
    Verdict,
    goal_of,
    goals_of,
)
from sequence_planner.process.budget import Budget
from sequence_planner.simulation.messages import spoken
from sequence_planner.simulation.truck_station.nodes import NODE_TYPES, PACKAGE, PREFIX
from sequence_planner.simulation.truck_station.poses import PAIRS, POSES
from sequence_planner.station import ReadyStation, prepare_station
from sequence_planner.synthesis.supervisor import FewerSpecifications, synthesise
from support.examples import ONLY_TIMED, TIMED
from support.places import TRUCK_ENGINE_STATION

LONGEST_SYNTHESIS, LONGEST_PLAN = 10.0, 1.0  # seconds of CPU time, on a busy machine

LONGEST_FAR, LONGEST_WHOLE = 4.0, 8.0  # twice what is wanted
_WORK = (
    "identify_engine",
    "bring_kit",
    "return_kit",
    "take_lf_tool",
    "mount_ladder_frame",
    *(f"place_bolt_pair({pair})" for pair in PAIRS),
    "take_nutrunner",
    *(f"tighten_bolt_pair({pair})" for pair in PAIRS),
    "take_filter_tool",
    "tighten_oil_filter",
)
FAR = {  # operations that are far away, and ticks that a plan for them stays below
    ("mount_ladder_frame",): 35,
    ("tighten_bolt_pair(AtBoltPair1TCPPose)",): 70,
    ("tighten_bolt_pair(AtBoltPair6TCPPose)",): 70,
    ("tighten_oil_filter",): 120,
    _WORK: 180,
}

EMPTY: dict[str, Value] = {f"bolts[{pair}]": "empty" for pair in PAIRS}
PLACED: dict[str, Value] = {f"bolts[{pair}]": "placed" for pair in PAIRS}
TIGHT: dict[str, Value] = {f"bolts[{pair}]": "tightened" for pair in PAIRS}
KIT: dict[str, Value] = {"engine.tag_is_read": True, "agv.act_pos": "station", "agv.ref_pos": "station"}
MOUNTED: dict[str, Value] = {"engine.tag_is_read": True, "ladder_frame": "on_engine"}


def holding(tool: str) -> dict[str, Value]:
    """The robot at home with a tool."""
    return {
        "end_effector.tool": tool,
        "end_effector.rsp_is_locked": True,
        "end_effector.gripper_is_closed": tool != "LFTOOL",
        "scene.attached": tool,
        "scene.wanted": tool,
        "nutrunner.activate_lift": tool != "ATLASTOOL",
        "nutrunner.lift_state": "floats" if tool == "ATLASTOOL" else "holds",
        "nutrunner.positioned_at_home_station": tool != "ATLASTOOL",
        "dock.lf_tool_home": tool != "LFTOOL",
        "dock.filter_tool_home": tool != "OFTOOL",
    }


SITUATIONS: dict[str, dict[str, Value]] = {
    "identify_engine": {},
    "bring_kit": {"engine.tag_is_read": True},
    "return_kit": KIT | MOUNTED | PLACED,
    "take_lf_tool": KIT | {"ladder_frame": "in_kit"} | holding("OFTOOL"),
    "mount_ladder_frame": KIT | {"ladder_frame": "in_kit"} | holding("LFTOOL"),
    "place_bolt_pair(AtBoltPair3TCPPose)": KIT | MOUNTED | EMPTY | holding("LFTOOL"),
    "take_nutrunner": KIT | MOUNTED | PLACED | holding("LFTOOL"),
    "tighten_bolt_pair(AtBoltPair1TCPPose)": KIT | MOUNTED | PLACED | holding("ATLASTOOL"),
    "take_filter_tool": MOUNTED | TIGHT | holding("ATLASTOOL"),
    "tighten_oil_filter": MOUNTED | TIGHT | holding("OFTOOL"),
    "release_engine": MOUNTED | TIGHT | holding("OFTOOL") | {"oil_filter_is_tight": True},
}


@cache
def ready() -> tuple[ReadyStation, Supervisor, Planner, float]:
    """The station with its supervisor and a planner, and the seconds of CPU time that the safe states took."""
    station = prepare_station(TRUCK_ENGINE_STATION)
    began = time.process_time()
    supervisor = synthesise(station.automaton)
    seconds = time.process_time() - began
    return station, supervisor, Planner(station.automaton, supervisor), seconds


def planned(operation: str, state: State) -> PlanAnswer:
    """A first plan for an operation in a state."""
    station, _, planner, _ = ready()
    goal = goal_of(station.automaton.operations[operation])
    return planner.answer(PlanRequest(state, (goal,), 20.0, 60, Contract.FAST))


def situation(values: Mapping[str, Value | None]) -> State:
    """The initial state but for some values."""
    automaton = ready()[0].automaton
    return synchronise(automaton, {**initial_state(automaton), **values})


@ONLY_TIMED
def test_the_safe_states_are_computed_in_seconds() -> None:
    assert ready()[3] < LONGEST_SYNTHESIS


@pytest.mark.parametrize("operation", SITUATIONS)
def test_every_operation_is_planned_from_its_precondition(operation: str) -> None:
    station, supervisor, _, _ = ready()
    state = situation(SITUATIONS[operation])
    assert holds(station.automaton.operations[operation].precondition, state)
    assert supervisor.safe.includes(state)
    began = time.process_time()
    answer = planned(operation, state)
    assert answer.verdict is Verdict.FOUND
    assert not TIMED or time.process_time() - began < LONGEST_PLAN


@pytest.mark.parametrize("operations", FAR, ids=lambda each: each[-1])
def test_what_is_an_engine_away_is_planned_from_the_empty_station(operations: tuple[str, ...]) -> None:
    """By way of the operations, of which nobody asked for most; every plan has been replayed on the reference tick."""
    station, supervisor, _, _ = ready()
    automaton = station.automaton
    request = PlanRequest(
        initial_state(automaton), goals_of(automaton, operations), 60.0, contract=Contract.FAST
    )  # a planner that remembers nothing
    began = time.process_time()
    answer = Planner(automaton, supervisor).answer(request)
    assert (answer.verdict, answer.left_out) == (Verdict.FOUND, ())
    assert answer.plan is not None
    # How short it becomes in a turn is a matter of the processor: that is asserted by counted clocks, below.
    assert not TIMED or time.process_time() - began < (LONGEST_FAR if len(operations) == 1 else LONGEST_WHOLE)


class CountedClocks:
    """Clocks that go by how often they are looked at: each look is as much work, while others work `held_up` times."""

    LOOK = 1e-4  # seconds

    def __init__(self, held_up: int) -> None:
        self.looks = 0
        self._held_up = held_up

    def process_time(self) -> float:
        """What this process has worked."""
        self.looks += 1
        return self.LOOK * self.looks

    def monotonic(self) -> float:
        """What has passed meanwhile."""
        return self._held_up * self.process_time()


@pytest.mark.parametrize("operations", FAR, ids=lambda each: each[-1])
def test_a_planner_that_others_hold_up_finds_the_same_short_plan_as_long_as_there_is_time(
    operations: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """By engines that look at no clock from another thread, so that each look is counted alike each time."""
    station, supervisor, _, _ = ready()
    automaton, deadline = station.automaton, 60.0
    lane = Lane("here", {Contract.FAST: ("operation by operation", "search"), Contract.MINIMAL: ("search",)})
    request = PlanRequest(initial_state(automaton), goals_of(automaton, operations), deadline, contract=Contract.FAST)

    def held_up(times: int) -> tuple[PlanAnswer, int]:
        clocks = CountedClocks(times)
        planner = Planner(automaton, supervisor, InTurn(Engines(automaton, supervisor, lane)))
        with monkeypatch.context() as patch:
            patch.setattr(time, "process_time", clocks.process_time)
            patch.setattr(time, "monotonic", clocks.monotonic)
            return planner.answer(request), clocks.looks

    (alone, looks), (busy, as_many) = held_up(1), held_up(50)
    assert (alone.verdict, alone.left_out) == (Verdict.FOUND, ())
    assert alone.plan is not None
    assert len(alone.plan.ticks) < FAR[operations]
    assert (busy.plan, as_many) == (alone.plan, looks)
    too_busy, _ = held_up(2000)
    assert deadline / 2 < too_busy.seconds < 1.1 * deadline


@pytest.mark.parametrize("operation", ["mount_ladder_frame", "tighten_bolt_pair(AtBoltPair1TCPPose)"])
def test_without_its_planning_scene_the_robot_is_known_at_once_to_go_nowhere(operation: str) -> None:
    """What the scene has is not known, so the supervisor lets nothing start that moves the robot."""
    station, supervisor, _, _ = ready()
    goals = goals_of(station.automaton, (operation,))
    silent = situation({"scene.attached": None})
    circumstances = Circumstances(offline=frozenset({"scene"}))
    request = PlanRequest(silent, goals, 60.0, contract=Contract.FAST, circumstances=circumstances)
    answer = Planner(station.automaton, supervisor).answer(request)
    assert (answer.verdict, answer.engine) == (Verdict.NONE_AT_ALL, "relaxation")
    assert answer.proof is not None
    check(station.automaton, supervisor, PlanningTask(silent, goals, circumstances), answer.proof, Budget.seconds(60))


def test_what_a_robot_that_is_offline_makes_impossible_is_explained_by_that_alone() -> None:
    """Of the twenty specifications none is named, as none of them matters, and what would help has been planned."""
    station, supervisor, _, _ = ready()
    automaton, state = station.automaton, situation({})
    goals = goals_of(automaton, ("mount_ladder_frame",))
    task = PlanningTask(state, goals, Circumstances(offline=frozenset({"robot"})))
    found = diagnose(automaton, supervisor, FewerSpecifications(automaton, supervisor), task, Budget.seconds(60))
    assert found.reason is not None
    assert found.reason.minimal
    assert {(each.part, each.name) for each in found.reason.members} == {
        (MemberKind.VALUE, "ladder_frame"),
        (MemberKind.VALUE, "robot.pose"),
        (MemberKind.OFFLINE, "robot"),
        (MemberKind.GOAL, "mount_ladder_frame"),
    }
    changes = [[change.name for change in each.changes] for each in found.corrections]
    assert changes[0] == ["robot"]


def test_the_robot_goes_down_to_placed_bolts_only_once_the_tool_was_told_to_turn() -> None:
    answer = planned(
        "tighten_bolt_pair(AtBoltPair1TCPPose)", situation(SITUATIONS["tighten_bolt_pair(AtBoltPair1TCPPose)"])
    )
    assert answer.plan is not None
    starts = [name for tick in answer.plan.ticks for name in tick.starts]
    down = starts.index("robot.move_to_position(AtBoltPair1TCPPose)")
    assert "nutrunner.run_nut" in starts[:down]


def test_a_person_who_takes_over_is_asked_to_tighten_by_hand() -> None:
    by_hand = KIT | MOUNTED | PLACED | {"operator.takes_over": True}
    answer = planned("tighten_bolt_pair(AtBoltPair1TCPPose)", situation(by_hand))
    assert answer.plan is not None
    starts = [name for tick in answer.plan.ticks for name in tick.starts]
    assert starts == ["nutrunner.float", "operator.guide_nutrunner(AtBoltPair1TCPPose)"]


@pytest.mark.parametrize("pose", [None, "UNKNOWN", PAIRS[0]])
def test_the_nutrunner_is_taken_off_a_dead_robot_first_wherever_it_stands(pose: str | None) -> None:
    dead: dict[str, Value | None] = {"robot.target_pose": PAIRS[0], "robot.pose": pose, "operator.takes_over": True}
    answer = planned("tighten_bolt_pair(AtBoltPair1TCPPose)", situation(MOUNTED | PLACED | holding("ATLASTOOL") | dead))
    assert answer.plan is not None
    starts = [name for tick in answer.plan.ticks for name in tick.starts]
    assert starts == ["operator.free_nutrunner", "operator.guide_nutrunner(AtBoltPair1TCPPose)"]


def test_a_robot_that_is_switched_off_is_sent_nowhere() -> None:
    station, _, _, _ = ready()
    state = situation(KIT | MOUNTED | PLACED | holding("ATLASTOOL") | {"operator.takes_over": True})
    robot = [ability for ability in station.automaton.abilities.values() if ability.resource == "robot"]
    assert robot
    assert not any(state[ability.flag("enabled")] for ability in robot)


def test_an_emulated_lift_says_what_it_was_told() -> None:
    station = ready()[0]
    lift = spoken(station.pipelines, f"{PREFIX}/aecu_uni_to_sp", initial_state(station.automaton), {})
    assert (lift["got_cmd_activate_lift"], lift["got_cmd_activate_unload"]) == (True, False)
    floating = situation({"nutrunner.lift_state": "floats"})
    lift = spoken(station.pipelines, f"{PREFIX}/aecu_uni_to_sp", floating, {})
    assert (lift["got_cmd_activate_lift"], lift["got_cmd_activate_unload"]) == (False, True)


def test_what_is_measured_is_fed_and_what_is_commanded_leaves() -> None:
    station = ready()[0]
    automaton, pipelines = station.automaton, station.pipelines
    assert set(automaton.names(Kind.MEASURED)) <= set(pipelines.feeds)
    assert {name for outgoing in pipelines.outgoing.values() for name in outgoing.variables} >= automaton.outputs


def test_the_model_and_the_nodes_in_the_hall_mean_the_same_topics_and_poses() -> None:
    station = ready()[0]
    says = {f"{PREFIX}/{t}": f"{PACKAGE}/{m}" for t, m in (kind.says for kind in NODE_TYPES.values())}
    hears = {f"{PREFIX}/{k.hears[0]}": f"{PACKAGE}/{k.hears[1]}" for k in NODE_TYPES.values() if k.hears is not None}
    assert {p.topic.name: p.topic.type_name for p in station.pipelines.incoming.values()} == says
    assert {p.topic.name: p.topic.type_name for p in station.pipelines.outgoing.values()} == hears
    assert set(station.automaton.variables["robot.target_pose"].type.domain) == set(POSES)
