"""What is true in the station: right steps, and each wrong step that the judge must see."""

from __future__ import annotations

import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.choices import Choices, made_by
from sequence_planner.simulation.truck_station.poses import HOME, PAIRS, POSES
from sequence_planner.simulation.truck_station.signals import NODES, read, set_signals
from sequence_planner.simulation.truck_station.world import World
from sequence_planner.simulation.truck_station.world_server import WorldServer
from support.examples import examples

STEP = 0.01
FRAME_TOOL = ["PreAttachLFToolFarJOINTPose", "AttachLFToolTCPPose"]
NUTRUNNER = ["PreAttachAtlasFarJOINTPose", "AttachAtlasTCPPose"]
FILTER_TOOL = ["PreAttachOFToolFarJOINTPose", "AttachOFToolTCPPose"]


def pass_time(world: World, seconds: float) -> None:
    for _ in range(round(seconds / STEP)):
        world.advance(STEP)


def go(world: World, *poses: str, action: str = "MOVEJ") -> None:
    for pose in poses:
        set_signals(world, "ur10", {"pose": pose, "action": action, "scaling": 1.0})
        pass_time(world, 3)
        assert world.arm.joints == POSES[pose]


def valve(world: World, **signals: bool) -> None:
    set_signals(world, "rsp_ecu", signals)
    pass_time(world, 0.6)


def with_nutrunner() -> World:
    """The robot above the engine with the floating nutrunner, and the bolts of the first pair placed."""
    world = World()
    assert world.line.engine is not None
    world.line.engine.bolts[PAIRS[0]] = "placed"
    go(world, *NUTRUNNER)
    valve(world, lock=True)
    set_signals(world, "tool_ecu", {"lift": "float"})
    go(world, NUTRUNNER[0], "AboveEngineTCPPose")
    assert not world.verdict.events
    return world


def run(world: World, run_: str) -> None:
    set_signals(world, "tool_ecu", {"run": run_})
    pass_time(world, 0.5)


def test_a_turning_tool_tightens_placed_bolts_and_stops_at_its_torque() -> None:
    world = with_nutrunner()
    run(world, "forward")
    go(world, PAIRS[0])
    assert world.verdict.counted == {f"bolt tightened: {PAIRS[0]}": 1}
    assert read(world, "tool_ecu") == {"turning": False, "reverse": False, "torque": True, "home": False}
    run(world, "idle")
    assert read(world, "tool_ecu")["torque"] is False


def test_a_standing_tool_collides_with_placed_bolts() -> None:
    world = with_nutrunner()
    go(world, PAIRS[0])
    assert world.verdict.wrong == [f"collision: a standing tool is driven onto the bolts of {PAIRS[0]}"]


def test_bolts_that_are_tight_are_tightened_too_much() -> None:
    world = with_nutrunner()
    run(world, "forward")
    go(world, PAIRS[0])
    run(world, "idle")
    run(world, "forward")
    pass_time(world, 1)
    assert world.verdict.wrong == [f"over-torque: {PAIRS[0]}"]


def test_a_tool_that_turns_where_no_bolts_are_runs_on_air() -> None:
    world = with_nutrunner()
    run(world, "forward")
    go(world, PAIRS[1])
    assert world.verdict.wrong == [f"the tool runs on air: {PAIRS[1]}"]


def test_a_tool_that_its_place_holds_is_not_to_be_pulled() -> None:
    world = World()
    go(world, *NUTRUNNER)
    valve(world, lock=True)
    go(world, NUTRUNNER[0])
    assert world.verdict.wrong == ["collision: ATLASTOOL is pulled while its place holds it"]


def test_a_tool_that_is_unlocked_anywhere_else_drops() -> None:
    world = with_nutrunner()
    valve(world, lock=False)
    assert world.verdict.wrong == ["tool dropped: ATLASTOOL"]
    assert read(world, "rsp_ecu")["tool"] is None


def test_a_tool_is_not_driven_into_the_place_of_another() -> None:
    world = with_nutrunner()
    go(world, *FILTER_TOOL)
    assert world.verdict.wrong == ["collision: ATLASTOOL is driven into the place of OFTOOL"]


def test_a_way_is_planned_around_what_the_robot_holds() -> None:
    world = with_nutrunner()
    go(world, "HomeJOINTPose", action="PLANNED")
    assert world.verdict.wrong == ["wrong plan: the scene has [], and the robot ATLASTOOL"]
    set_signals(world, "scene", {"action": "ATTACH", "object": "ATLASTOOL"})
    go(world, "AboveEngineTCPPose", action="PLANNED")
    assert len(world.verdict.wrong) == 1


def test_an_engine_that_leaves_unfinished_is_wrong_and_says_what_is_missing() -> None:
    world = World()
    set_signals(world, "rfidcam", {"release": True})
    pass_time(world, 3)
    assert read(world, "rfidcam") == {"in_place": False, "tag": ""}
    (wrong,) = world.verdict.wrong
    assert wrong.startswith("engine wrong: no ladder frame, AtBoltPair1TCPPose empty")
    assert wrong.endswith("oil filter loose")


def test_an_engine_assembled_step_by_step_is_done() -> None:
    world = World()
    set_signals(world, "mircom", {"goal": "station"})
    go(world, *FRAME_TOOL)
    valve(world, lock=True)
    valve(world, close=False)
    go(world, FRAME_TOOL[0], "AboveKitJOINTPose", "AtLadderFrameTCPPose")
    valve(world, close=True)
    go(world, "AboveKitJOINTPose", "AboveEngineTCPPose", "LadderFrameOnEngineTCPPose")
    valve(world, close=False)
    go(world, "AboveEngineTCPPose", *FRAME_TOOL)
    valve(world, close=True)
    valve(world, lock=False)
    for pair in PAIRS:
        set_signals(world, "watch", {"task": "place", "pair": pair})
        pass_time(world, 4)
        assert read(world, "watch")["acknowledged"] is True
        set_signals(world, "watch", {"task": "none"})
        pass_time(world, 0.1)
    go(world, FRAME_TOOL[0], *NUTRUNNER)
    valve(world, lock=True)
    set_signals(world, "tool_ecu", {"lift": "float"})
    for pair in PAIRS:
        go(world, "AboveEngineTCPPose")
        run(world, "forward")
        go(world, pair)
        run(world, "idle")
    go(world, "AboveEngineTCPPose", *NUTRUNNER)
    set_signals(world, "tool_ecu", {"lift": "hold"})
    valve(world, lock=False)
    go(world, NUTRUNNER[0], *FILTER_TOOL)
    valve(world, lock=True)
    go(world, FILTER_TOOL[0], "PRE_OF_1_UNTIGHTENED", "OF_1_TIGHTENED", "PRE_OF_1_UNTIGHTENED", "HomeJOINTPose")
    set_signals(world, "rfidcam", {"release": True})
    pass_time(world, 3)
    assert world.verdict.wrong == []
    assert world.verdict.counted["engine done"] == 1
    set_signals(world, "rfidcam", {"release": False, "read": True})
    pass_time(world, 4)
    assert read(world, "rfidcam") == {"in_place": True, "tag": "D13-00002"}


def test_a_hand_and_the_robot_are_not_at_the_same_bolts() -> None:
    world = with_nutrunner()
    assert world.line.engine is not None
    world.line.engine.frame = True
    set_signals(world, "watch", {"task": "place", "pair": PAIRS[1]})
    run(world, "forward")
    go(world, PAIRS[1])
    assert f"collision: the robot and a hand at {PAIRS[1]}" in world.verdict.wrong


def test_a_robot_that_is_switched_off_is_pushed_home_and_goes_only_where_it_is_sent_once_it_is_on_again() -> None:
    world = with_nutrunner()
    world.person.takes_over = True
    for pose in (PAIRS[0], "AboveKitJOINTPose"):
        set_signals(world, "ur10", {"pose": pose, "action": "MOVEL", "scaling": 1.0})
        pass_time(world, 2)
        assert world.arm.joints == POSES[HOME]
    world.person.takes_over = False
    set_signals(
        world, "ur10", {"pose": "AboveKitJOINTPose", "action": "MOVEL", "scaling": 1.0}
    )  # as its computer repeats it
    pass_time(world, 2)
    assert world.arm.joints == POSES[HOME]
    go(world, "AboveEngineTCPPose")
    assert not world.verdict.events


def test_the_nutrunner_comes_off_a_robot_that_is_switched_off_and_tightens_by_hand() -> None:
    world = with_nutrunner()
    world.person.takes_over = True
    for task in ("free", "none", "guide", "none", "guide", "none"):
        set_signals(world, "watch", {"task": task, "pair": PAIRS[0]})
        pass_time(world, 9)
    assert read(world, "rsp_ecu") == {"tool": None, "frame": False, "locked": False, "closed": True}
    assert read(world, "tool_ecu")["home"] is True
    assert [event for _, event in world.verdict.events] == [
        "nutrunner taken off by hand",
        f"bolt tightened: {PAIRS[0]} by hand",
        f"bolt found tight: {PAIRS[0]} by hand",
    ]


def test_nobody_takes_the_nutrunner_off_a_robot_that_is_on() -> None:
    world = with_nutrunner()
    set_signals(world, "watch", {"task": "free"})
    pass_time(world, 9)
    assert world.verdict.wrong == ["wrong task: no nutrunner can be taken off the robot"]
    assert read(world, "rsp_ecu")["tool"] == "ATLASTOOL"


def drawn_signals(choices: Choices) -> tuple[str, dict[str, object]]:
    """What a node might set, sensible or not."""
    node = choices.pick(NODES)
    scalings: tuple[object, ...] = (1.0, 0.2, 7.0, -1.0, "fast")
    switches: tuple[object, ...] = (True, False, None)
    signals: dict[str, object] = {
        "pose": choices.pick((*POSES, "nowhere")),
        "action": choices.pick(("PLANNED", "MOVEL", "ATTACH", "DETACH")),
        "scaling": choices.pick(scalings),
        "object": choices.pick(("ATLASTOOL", "LFTOOL", "OFTOOL")),
        "run": choices.pick(("idle", "forward", "reverse", "sideways")),
        "lift": choices.pick(("hold", "float", "up")),
        "lock": choices.pick(switches),
        "close": choices.pick(switches),
        "goal": choices.pick(("kitting", "station", "home")),
        "read": choices.pick((True, False)),
        "release": choices.pick((True, False)),
        "task": choices.pick(("none", "place", "guide", "free", "sleep")),
        "pair": choices.pick((*PAIRS, "elsewhere")),
    }
    return node, signals


@examples(60)
@given(made_by(lambda choices: [drawn_signals(choices) for _ in range(12)]))
def test_whatever_is_set_the_world_goes_on_and_bolts_are_tightened_only_once_placed(
    acts: list[tuple[str, dict[str, object]]],
) -> None:
    worlds = World(seed=3), World(seed=3)
    for world in worlds:
        before = dict.fromkeys(PAIRS, "empty")
        number = 1
        for node, signals in acts:
            set_signals(world, node, signals)
            for _ in range(20):
                world.advance(0.05)
                engine = world.line.engine
                if engine is None or engine.number != number:
                    before, number = dict.fromkeys(PAIRS, "empty"), engine.number if engine else number
                    continue
                steps = {(before[pair], state) for pair, state in engine.bolts.items()}
                assert ("empty", "tightened") not in steps
                assert not steps & {("tightened", "placed"), ("tightened", "empty"), ("placed", "empty")}
                before = dict(engine.bolts)
            assert set(world.away) <= {"LFTOOL", "ATLASTOOL", "OFTOOL"}
            for each in NODES:
                read(world, each)
    assert worlds[0].verdict == worlds[1].verdict


@given(
    st.recursive(
        st.none() | st.booleans() | st.integers() | st.text(), lambda x: st.lists(x) | st.dictionaries(st.text(), x)
    )
)
@examples(60)
def test_the_server_answers_whatever_it_is_asked(question: object) -> None:
    assert WorldServer(World()).answer(question) == {"error": "not understood"}


@pytest.mark.parametrize("kind", ["silent", "offline"])
def test_a_fault_is_told_to_the_node_that_has_it_until_it_is_over(kind: str) -> None:
    server = WorldServer(World())
    asked = {"node": "scene", "put": {}}
    assert server.answer({"fault": {"node": "scene", "kind": kind, "seconds": 60}}) == {"done": True}
    assert server.answer(asked)["fault"] == {"kind": kind, "fields": {}}
    assert server.answer({"node": "ur10", "put": {}})["fault"] == {}
    server.answer({"fault": {"node": "scene", "kind": kind, "seconds": 0}})
    assert server.answer(asked)["fault"] == {}


def test_a_device_that_is_stuck_says_what_it_said_and_hears_nothing() -> None:
    server = WorldServer(World())
    server.answer({"fault": {"node": "scene", "kind": "stuck", "seconds": 60}})
    answer = server.answer({"node": "scene", "put": {"action": "ATTACH", "object": "LFTOOL"}})
    assert answer["read"] == {"attached": []}
    assert server.world.scene == []


def test_the_truth_knows_nothing_of_the_model() -> None:
    code = (
        "import sys, sequence_planner.simulation.truck_station.__main__\n"
        "own = [name.split('.') for name in sys.modules if name.startswith('sequence_planner.')]\n"
        "print(sorted({'.'.join(name[1:3]) for name in own if name[1] not in ('ros', 'language', 'texts', 'core')}))\n"
    )
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert told.stdout.strip() == "['simulation', 'simulation.truck_station']"
