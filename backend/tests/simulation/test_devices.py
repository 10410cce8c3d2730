"""Emulated devices follow the effects of the model, in time, and know only what messages tell them."""

from __future__ import annotations

import contextlib
import math
import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.language.types import Value
from sequence_planner.pipelines.chain_runtime import first_message
from sequence_planner.pipelines.runtime import RunningPipelines
from sequence_planner.simulation.devices import EmulatedDevices
from sequence_planner.simulation.messages import CannotSpeakError
from sequence_planner.station import prepare_station
from support.examples import examples
from support.places import BOLT_TIGHTENING, CELL

READY = prepare_station(CELL)
TRUCK = prepare_station(BOLT_TIGHTENING)
HOME, OUT = (0.0, 0.0), (1.0, 0.5)
STEP = 0.02


class Bench:
    """Emulated devices with their clock, spoken to by messages alone."""

    def __init__(self, speed: float = 1.0, seed: int = 0, station: str = "cell") -> None:
        self.station = {"cell": READY, "truck": TRUCK}[station]
        self.devices = EmulatedDevices(self.station.automaton, self.station.pipelines, speed, seed)
        self.pipelines = RunningPipelines(self.station.pipelines)
        self.now = 100.0
        self.outputs = dict(self.station.automaton.initial_valuation)

    def command(self, **outputs: Value) -> None:
        """Change outputs (`robot__target_pose="home"`) and send every message, through the wire's encoding."""
        self.outputs |= {name.replace("__", "."): value for name, value in outputs.items()}
        registry = self.station.registry
        for topic, pipeline in self.station.pipelines.outgoing.items():
            type_name = pipeline.topic.type_name
            message = first_message(pipeline, self.outputs)
            assert message is not None
            data = registry.encode(type_name, message)
            assert self.devices.command(topic, registry.decode(type_name, data)) == []

    def reported(self) -> dict[str, Value | None]:
        """What a controller would read from the reports now."""
        for topic, pipeline in self.station.pipelines.incoming.items():
            type_name = pipeline.topic.type_name
            data = self.station.registry.encode(type_name, self.devices.report(topic))
            self.pipelines.take(topic, self.station.registry.decode(type_name, data), self.now)
            assert not self.pipelines.trouble(topic)
        return self.pipelines.values(dict.fromkeys(self.station.pipelines.incoming, True))

    def wait(self, seconds: float) -> None:
        for _ in range(round(seconds / STEP)):
            self.now += STEP
            self.devices.advance(self.now)

    def until(self, name: str, value: Value, at_most: float = 10.0) -> float:
        """Seconds until a report says so."""
        began = self.now
        while self.reported()[name] != value:
            assert self.now - began < at_most, f"{name} is {self.reported()[name]} and does not become {value}"
            self.wait(STEP)
        return self.now - began

    def joints(self) -> tuple[float, ...]:
        joints = self.devices.report("/arm/state")["joints"]
        assert isinstance(joints, list)
        return tuple(joints)


@pytest.mark.parametrize("station", ["cell", "truck"])
def test_nothing_moves_before_a_command_was_heard(station: str) -> None:
    bench = Bench(station=station)
    before = bench.reported()
    bench.wait(20)
    assert bench.reported() == before
    assert all(bench.devices.state[name] is None for name in bench.station.automaton.outputs)


def test_a_command_is_followed_in_the_time_its_effects_take() -> None:
    bench = Bench()
    bench.command(arm__goto="out")
    left = bench.until("arm.pose", "unknown")
    assert 0.1 <= left <= 0.3 + 2 * STEP
    assert bench.reported()["arm.moving"] is True
    arriving = bench.until("arm.pose", "out")
    still_moving = bench.until("arm.moving", False)
    # It is within the tolerance of its goal a little before it stands still there.
    assert 0.85 <= arriving < arriving + still_moving
    assert 1.0 <= arriving + still_moving <= 1.0 + 2 * STEP
    assert bench.reported() == {"arm.pose": "out", "arm.last": "out", "arm.moving": False}
    assert bench.joints() == OUT


def test_delays_are_drawn_from_the_seed() -> None:
    def leaving(seed: int) -> float:
        bench = Bench(seed=seed)
        bench.command(arm__goto="out")
        return bench.until("arm.pose", "unknown")

    drawn = [leaving(seed) for seed in range(8)]
    assert drawn == [leaving(seed) for seed in range(8)]
    assert len(set(drawn)) > 1
    assert all(0.1 <= delay <= 0.3 + 2 * STEP for delay in drawn)


def test_speed_divides_every_delay() -> None:
    bench = Bench(speed=10)
    bench.command(arm__goto="out")
    assert bench.until("arm.pose", "out") <= 0.03 + 0.1 + 4 * STEP


def test_a_command_that_changes_nothing_starts_nothing() -> None:
    bench = Bench()
    bench.command(arm__goto="home")
    bench.wait(5)
    assert bench.reported() == {"arm.pose": "home", "arm.last": "home", "arm.moving": False}
    assert bench.joints() == HOME


def test_numbers_glide_and_never_jump() -> None:
    bench = Bench()
    bench.command(arm__goto="out")
    bench.until("arm.pose", "unknown")
    before, first = bench.joints(), bench.joints()
    while bench.reported()["arm.pose"] == "unknown":
        bench.wait(STEP)
        after = bench.joints()
        assert all(abs(a - b) <= 1.5 * STEP for a, b in zip(before, after, strict=True))
        assert after[0] >= before[0]
        before = after
    assert before[0] >= OUT[0] - 0.1
    assert first[0] > 0.1  # outside the tolerance from the first moment


def test_a_new_command_on_the_way_is_a_new_journey_from_there() -> None:
    bench = Bench()
    bench.command(arm__goto="out")
    bench.until("arm.pose", "unknown")
    bench.wait(0.7)
    there = bench.joints()
    bench.command(arm__goto="home")
    bench.wait(STEP)
    assert all(abs(a - b) <= 1.5 * STEP for a, b in zip(there, bench.joints(), strict=True))
    assert bench.until("arm.pose", "home") >= 0.8
    bench.wait(1)
    assert bench.joints() == HOME


def test_a_command_withdrawn_in_time_has_no_effect() -> None:
    bench = Bench()
    bench.command(arm__goto="out")
    bench.wait(0.08)
    bench.command(arm__goto="home")
    bench.wait(5)
    assert bench.reported()["arm.pose"] == "home"
    assert bench.joints() == HOME


def test_moved_by_hand_it_reports_that_and_goes_where_it_is_told() -> None:
    bench = Bench()
    bench.command(arm__goto="home")
    bench.devices.set_value("arm.pose", "out")
    assert bench.reported()["arm.pose"] == "out"
    bench.until("arm.pose", "home")
    bench.devices.set_value("arm.pose", "unknown")
    assert bench.reported()["arm.pose"] == "unknown"


def test_moved_by_hand_on_the_way_it_sets_out_anew() -> None:
    bench = Bench()
    bench.command(arm__goto="out")
    bench.until("arm.pose", "unknown")
    bench.wait(0.5)
    bench.devices.set_value("arm.pose", "unknown")
    bench.wait(0.7)
    assert bench.reported()["arm.pose"] == "unknown"
    assert bench.until("arm.moving", False) <= 0.3 + 2 * STEP


def test_by_hand_it_takes_what_it_has_and_says_what_that_is() -> None:
    bench = Bench()
    with pytest.raises(
        ValueError, match=r"no emulated device has `arm.goto`; there are arm.last, arm.moving, arm.pose"
    ):
        bench.devices.set_value("arm.goto", "home")
    with pytest.raises(ValueError, match=r"`away` is no value of arm.pose, which ranges over \{unknown, home, out\}"):
        bench.devices.set_value("arm.pose", "away")
    with pytest.raises(ValueError, match=r"`1` is no value of arm\.moving, which ranges over bool"):
        bench.devices.set_value("arm.moving", 1)


def test_a_command_without_sense_is_said_and_makes_the_command_unknown() -> None:
    bench = Bench()
    bench.command(arm__goto="out")
    troubles = bench.devices.command("/arm/command", {"joints": [float("nan"), 0.0], "speed": 0.5})
    assert troubles == ["joints is [nan, 0.0]: no command makes it so"]
    bench.wait(5)
    assert bench.reported()["arm.pose"] == "home"


@given(st.lists(st.sampled_from(["home", "out", "unknown"]), min_size=1, max_size=5))
def test_whatever_is_done_by_hand_is_what_is_reported(poses: list[str]) -> None:
    bench = Bench()
    for pose in poses:
        bench.devices.set_value("arm.pose", pose)
        assert bench.reported()["arm.pose"] == pose


@examples(20)
@given(st.lists(st.tuples(st.sampled_from(["home", "out"]), st.floats(0, 2)), max_size=8), st.integers(0, 5))
def test_it_ends_where_it_was_told_last_whatever_came_before(commands: list[tuple[str, float]], seed: int) -> None:
    bench = Bench(seed=seed)
    for goto, seconds in [*commands, ("out", 3.0)]:
        bench.command(arm__goto=goto)
        bench.wait(seconds)
    assert bench.reported() == {"arm.pose": "out", "arm.last": "out", "arm.moving": False}


def test_a_bolt_pair_is_tightened_by_messages_alone() -> None:
    bench = Bench(station="truck", speed=2)
    bench.command(nutrunner__run_tool_forward=True, nutrunner__set_tool_idle=False, robot__target_pose="above_engine")
    bench.until("nutrunner.tool_is_running_forward", True)
    bench.until("robot.pose", "above_engine")
    assert bench.reported()["nutrunner.tool_is_idle"] is False
    bench.wait(5)
    assert bench.reported()["nutrunner.programmed_torque_reached"] is False  # there is no bolt up there
    bench.command(robot__target_pose="bolt_pair_2")
    bench.until("robot.pose", "bolt_pair_2")
    bench.until("nutrunner.programmed_torque_reached", True)
    bench.command(nutrunner__run_tool_forward=False, nutrunner__set_tool_idle=True)
    bench.until("nutrunner.tool_is_idle", True)
    assert bench.reported() | {"nutrunner.tool_is_running_forward": False} == {
        "nutrunner.tool_is_idle": True,
        "nutrunner.tool_is_running_forward": False,
        "nutrunner.programmed_torque_reached": False,
        "robot.pose": "bolt_pair_2",
        "robot.previous_pose": "bolt_pair_2",
        "robot.moving": False,
        "robot.tool_is_attached": False,
    }


@pytest.mark.parametrize("seed", range(3))
def test_on_every_way_the_robot_reports_start_between_and_end_and_nothing_else(seed: int) -> None:
    bench = Bench(station="truck", seed=seed)
    poses = ("home", "bolt_pair_1", "bolt_pair_2", "bolt_pair_3")
    way = [goal for pose in poses for goal in ("above_engine", pose)]
    for goal in way:
        start = bench.reported()["robot.pose"]
        bench.command(robot__target_pose=goal)
        seen = [start]
        while seen[-1] != goal:
            bench.wait(STEP)
            if (pose := bench.reported()["robot.pose"]) != seen[-1]:
                seen.append(pose)
        assert seen == [start, "unknown", goal]


def test_nobody_emulates_the_person() -> None:
    bench = Bench(station="truck")
    bench.command(operator__requested_pair="bolt_pair_1")
    bench.wait(20)
    assert bench.devices.state["operator.acknowledged"] is False
    with pytest.raises(ValueError, match=r"no emulated device has `operator.acknowledged`"):
        bench.devices.set_value("operator.acknowledged", True)


DONE = st.one_of(
    st.tuples(st.just("command"), st.integers(0, 10**6)),
    st.tuples(st.just("put"), st.integers(0, 10**6)),
    st.tuples(st.just("slow"), st.integers(0, 10**6)),
    st.tuples(st.just("wait"), st.integers(1, 40)),
)


@given(st.sampled_from(["cell", "truck"]), st.lists(DONE, max_size=12), st.integers(0, 3))
@examples(200)
def test_who_looks_only_when_something_is_due_or_new_sees_the_same(
    station: str, done: list[tuple[str, int]], seed: int
) -> None:
    always, when_due = Bench(seed=seed, station=station), Bench(seed=seed, station=station)
    news = [True]
    when_due.devices.on_change = lambda: news.append(True)
    step = 0.0201  # so that nothing is due on a grid point to the last bit
    for what, number in done:
        for bench in (always, when_due):
            _do(bench, what, number)
        for _ in range(number if what == "wait" else 1):
            always.now += step
            when_due.now += step
            always.devices.advance(always.now)
            if news or when_due.devices.due <= when_due.now:
                news.clear()
                when_due.devices.advance(when_due.now)
            assert when_due.devices.state == always.devices.state
            assert all(when_due.devices.report(t) == always.devices.report(t) for t in always.devices.spoken)
    if not news and when_due.devices.due == math.inf:
        before = dict(always.devices.state)
        always.wait(20)
        assert always.devices.state == before, "nothing was due"


def _do(bench: Bench, what: str, number: int) -> None:
    draw = random.Random(number)
    automaton = bench.station.automaton
    if what == "command":
        name = draw.choice(sorted(automaton.outputs))
        bench.command(**{name: draw.choice(automaton.variables[name].type.domain)})
    elif what == "put":
        name = draw.choice(sorted(bench.devices.topics))
        with contextlib.suppress(CannotSpeakError):
            bench.devices.set_value(name, draw.choice(automaton.variables[name].type.domain))
    elif what == "slow":
        resource = draw.choice(sorted(automaton.resources))
        bench.devices.advance(bench.now)
        bench.devices.slow(draw.choice([{}, {resource: 2.0}]))
