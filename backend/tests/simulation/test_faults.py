"""Faults of emulated devices: what is said while they last, and that they leave no trace."""

from __future__ import annotations

from dataclasses import dataclass, field

import pytest
from hypothesis import given
from hypothesis.strategies import SearchStrategy

from core.choices import Choices, made_by
from sequence_planner.language.types import Value
from sequence_planner.pipelines.chain_runtime import first_message
from sequence_planner.pipelines.runtime import RunningPipelines
from sequence_planner.ros.types.errors import MalformedMessageError
from sequence_planner.simulation.devices import EmulatedDevices
from sequence_planner.simulation.faults import Clear, Fault, FaultKind, FaultReader, FaultyDevices
from sequence_planner.station import ReadyStation, prepare_station
from support.examples import examples
from support.places import CELL, MODELS

READY = prepare_station(CELL)
SHIPPED = sorted(each.parent for each in MODELS.glob("*/station.yaml"))
STATE = "/arm/state"
STEP = 0.02
# In what is said, not in what the device does.
SAID = (FaultKind.SILENT, FaultKind.STUCK, FaultKind.WRONG, FaultKind.OFFLINE, FaultKind.DROP, FaultKind.GARBAGE)


@dataclass
class Bench:
    """Devices with faults, their clock, and what is heard of them; `None` is what could not be read."""

    station: ReadyStation = READY
    seed: int = 0
    now: float = 100.0
    heard: list[tuple[str, dict[str, object] | None]] = field(default_factory=list)

    def __post_init__(self) -> None:
        automaton, pipelines = self.station.automaton, self.station.pipelines
        self.devices = EmulatedDevices(automaton, pipelines, seed=self.seed)
        self.faulty = FaultyDevices(self.devices, pipelines, self.seed)
        self.reader = FaultReader(automaton, pipelines, self.devices.emulates)

    def begin(self, text: str) -> None:
        fault = self.reader.read(text)
        assert isinstance(fault, Fault)
        self.faulty.start(fault, self.now)

    def command(self, **outputs: Value) -> None:
        """Change outputs (`arm__goto="out"`) and send every message that comes to its device."""
        commanded = {name.replace("__", "."): value for name, value in outputs.items()}
        state = {**self.station.automaton.initial_valuation, **commanded}
        for topic, pipeline in self.station.pipelines.outgoing.items():
            message = first_message(pipeline, state)
            assert message is not None
            if self.faulty.hears(topic):
                assert self.devices.command(topic, message) == []

    def wait(self, seconds: float) -> None:
        """Let time pass, and hear what every device says at each step."""
        registry = self.station.registry
        for _ in range(round(seconds / STEP)):
            self.now += STEP
            self.faulty.advance(self.now)
            for topic, pipeline in self.station.pipelines.incoming.items():
                message = self.faulty.says(topic)
                data = None if message is None else registry.encode(pipeline.topic.type_name, message)
                sent = None if data is None else self.faulty.sent(topic, data)
                if sent is None:
                    continue
                try:
                    self.heard.append((topic, registry.decode(pipeline.topic.type_name, sent)))
                except MalformedMessageError:
                    self.heard.append((topic, None))

    def read(self) -> dict[str, Value | None]:
        """The variables as the last message of each topic has them."""
        running = RunningPipelines(self.station.pipelines)
        last = {topic: message for topic, message in self.heard if message is not None}
        for topic, message in last.items():
            running.take(topic, message, self.now)
            assert running.trouble(topic) is None
        return running.values({topic: topic in last for topic in self.station.pipelines.sources})


def test_a_silent_device_says_nothing_and_then_where_it_is() -> None:
    bench = Bench()
    bench.command(arm__goto="out")
    bench.begin("arm silent for 3 s")
    bench.wait(2.9)
    assert bench.heard == []
    bench.wait(0.2)
    assert bench.read()["arm.pose"] == "out"


def test_a_stuck_topic_repeats_its_message_and_a_stuck_variable_its_value() -> None:
    for what, moving in (("arm", False), (STATE, False), ("arm.pose", True)):
        bench = Bench()
        bench.wait(0.1)
        bench.command(arm__goto="out")
        bench.begin(f"{what} stuck")
        bench.wait(0.5)
        assert (bench.read()["arm.pose"], bench.read()["arm.moving"]) == ("home", moving)
        assert [str(fault) for fault in bench.faulty.clear(Clear(what))] == [f"{what} stuck"]
        bench.wait(3)
        assert bench.read()["arm.pose"] == "out"


def test_a_wrong_value_is_kept_while_the_device_does_something_else() -> None:
    bench = Bench()
    bench.begin("arm.moving wrong true for 1 s")
    bench.wait(0.5)
    assert bench.read() == {"arm.pose": "home", "arm.last": "home", "arm.moving": True}
    assert bench.devices.state["arm.moving"] is False
    bench.wait(1)
    assert bench.read()["arm.moving"] is False


def test_a_device_that_is_offline_hears_no_command() -> None:
    bench = Bench()
    bench.begin("arm offline for 1 s")
    assert bench.faulty.offline_resources == {"arm"}
    bench.command(arm__goto="out")
    bench.wait(3)
    assert bench.read()["arm.pose"] == "home"
    assert bench.faulty.offline_resources == frozenset()


def test_a_device_that_starts_again_is_as_at_the_beginning() -> None:
    bench = Bench()
    bench.command(arm__goto="out")
    bench.wait(3)
    bench.begin("arm restarted")
    bench.wait(0.9)
    assert bench.faulty.offline_resources == {"arm"}
    bench.wait(3)
    assert bench.read() == {"arm.pose": "home", "arm.last": "home", "arm.moving": False}
    assert bench.devices.state["arm.goto"] is None
    bench.command(arm__goto="out")
    bench.wait(3)
    assert bench.read()["arm.pose"] == "out"


def test_a_slow_device_takes_so_many_times_as_long_and_only_while_it_is_slow() -> None:
    def arrival(*faults: str) -> float:
        bench = Bench()
        for fault in faults:
            bench.begin(fault)
        bench.command(arm__goto="out")
        while bench.devices.state["arm.pose"] != "out" or bench.devices.state["arm.moving"]:
            bench.wait(STEP)
        return bench.now - 100.0

    normal = arrival()
    assert arrival("arm slow 3") == pytest.approx(3 * normal, abs=0.2)
    assert arrival("arm slow 3 for 0.6 s") == pytest.approx(normal + 0.4, abs=0.1)


def test_a_share_of_messages_is_lost_as_the_seed_says() -> None:
    def heard(seed: int) -> int:
        bench = Bench(seed=seed)
        bench.begin("arm drop 0.3")
        bench.wait(20)
        return len(bench.heard)

    assert 600 < heard(0) < 800
    assert heard(0) == heard(0)
    assert len({heard(seed) for seed in range(4)}) > 1


@pytest.mark.parametrize("station", [READY, *map(prepare_station, SHIPPED)], ids=lambda station: station.automaton.name)
def test_garbage_is_no_message_whatever_there_is_to_say(station: ReadyStation) -> None:
    bench = Bench(station)
    resources = {pipeline.topic.resource for pipeline in station.pipelines.incoming.values()}
    for resource in sorted(resources):
        bench.begin(f"{resource} garbage for 5 s")
    bench.wait(4.9)
    assert bench.heard == [(topic, None) for topic in station.pipelines.incoming] * 245
    bench.heard.clear()
    bench.wait(0.2)
    assert bench.heard[-1][1] is not None


@dataclass(frozen=True)
class Story:
    """Commands and faults with the seconds that pass after each; all is over long before it ends."""

    seed: int
    steps: tuple[tuple[str, float], ...]


def story(kinds: tuple[FaultKind, ...]) -> SearchStrategy[Story]:
    def make(choices: Choices) -> Story:
        def step() -> tuple[str, float]:
            kind = choices.pick(kinds)
            target = choices.pick(["arm.pose", "arm.moving"]) if kind is FaultKind.WRONG else "arm"
            behind = {
                FaultKind.WRONG: f" {choices.pick(['home', 'out', 'unknown'])}"
                if target == "arm.pose"
                else f" {choices.pick(['true', 'false'])}",
                FaultKind.SLOW: " 2.5",
                FaultKind.DROP: " 0.5",
            }.get(kind, "")
            fault = f"{target} {kind}{behind} for {choices.number(1, 20) / 10} s"
            return choices.pick(["out", "home", fault]), choices.number(0, 15) / 10

        return Story(choices.number(0, 9), tuple(step() for _ in range(choices.number(1, 8))))

    return made_by(make)


def told(bench: Bench, told_story: Story, *, with_faults: bool) -> None:
    for text, seconds in told_story.steps:
        if text in ("out", "home"):
            bench.command(arm__goto=text)
        elif with_faults:
            bench.begin(text)
        bench.wait(seconds)
    bench.wait(2.1)


@examples(60)
@given(story(tuple(kind for kind in SAID if kind not in (FaultKind.OFFLINE, FaultKind.DROP))))
def test_a_fault_in_what_is_said_leaves_no_trace(drawn: Story) -> None:
    healthy, faulty = Bench(seed=drawn.seed), Bench(seed=drawn.seed)
    told(healthy, drawn, with_faults=False)
    told(faulty, drawn, with_faults=True)
    assert faulty.faulty.faults == ()
    assert faulty.devices.state == healthy.devices.state
    for bench in (healthy, faulty):
        bench.heard.clear()
        bench.command(arm__goto="out")
        bench.wait(3)
    assert faulty.heard == healthy.heard


@examples(60)
@given(story(tuple(FaultKind)))
def test_after_all_faults_a_device_goes_where_it_is_told(drawn: Story) -> None:
    bench = Bench(seed=drawn.seed)
    told(bench, drawn, with_faults=True)
    bench.command(arm__goto="out")
    bench.wait(6)
    assert bench.read() == {"arm.pose": "out", "arm.last": "out", "arm.moving": False}


@examples(60)
@given(story(tuple(kind for kind in FaultKind if kind is not FaultKind.GARBAGE)))
def test_without_garbage_every_message_can_be_read_and_says_values_of_the_domains(drawn: Story) -> None:
    bench = Bench(seed=drawn.seed)
    told(bench, drawn, with_faults=True)
    running = RunningPipelines(READY.pipelines)
    for number, (topic, message) in enumerate(bench.heard):
        assert message is not None
        running.take(topic, message, float(number))
        assert running.trouble(topic) is None
        said = running.values({STATE: True})
        assert None not in (said["arm.pose"], said["arm.moving"])


@examples(40)
@given(story(tuple(FaultKind)))
def test_the_same_seed_is_the_same_story(drawn: Story) -> None:
    first, second = Bench(seed=drawn.seed), Bench(seed=drawn.seed)
    told(first, drawn, with_faults=True)
    told(second, drawn, with_faults=True)
    assert repr(first.heard) == repr(second.heard)  # not a number is not equal to itself
