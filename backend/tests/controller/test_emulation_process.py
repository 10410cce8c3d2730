"""The process of the emulated devices, on a network inside one process."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import pytest

from sequence_planner.language.syntax import ExpressionError
from sequence_planner.ros import exclusivity
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import Sample
from sequence_planner.ros.transports.memory import MemoryNetwork
from sequence_planner.simulation.device_state import read
from sequence_planner.simulation.devices import EmulatedDevices
from sequence_planner.simulation.fault_script import Scripted
from sequence_planner.simulation.faults import Fault, FaultKind
from sequence_planner.simulation.manual_interface import (
    BY_HAND_TOPIC,
    FAULTS_TOPIC,
    SAID_TOPIC,
    TEXT_TYPE,
    move,
)
from sequence_planner.simulation.messages import spoken
from sequence_planner.simulation.service import Emulation, emulate
from sequence_planner.station import prepare_station
from support.cell import COMMAND, COMMAND_TYPE, POSES, STATE, STATE_TYPE, cell
from support.places import BOLT_TIGHTENING
from support.waiting import until_async


def devices() -> EmulatedDevices:
    return EmulatedDevices(cell()[0].automaton, cell()[0].pipelines)


def test_devices_obey_report_and_survive_what_cannot_be_read(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exclusivity, "DISCOVERY", 0.05)
    registry = cell()[0].registry
    heard: list[object] = []

    def hear(samples: Sequence[Sample]) -> None:
        heard.extend(registry.decode(STATE_TYPE, sample.data)["joints"] for sample in samples)

    def is_at(pose: str) -> Callable[[], bool]:
        return lambda: heard[-1:] == [POSES[pose]]

    async def scenario() -> None:
        network = MemoryNetwork()
        loop = asyncio.get_running_loop()
        emulating = asyncio.create_task(
            emulate(Emulation(cell()[0], speed=20), lambda node: network.join(registry, node, loop))
        )
        person = network.join(registry, "person", loop)
        person.subscribe(STATE, STATE_TYPE, QualityOfService.RELIABLE, hear)
        person.advertise(COMMAND, COMMAND_TYPE, QualityOfService.RELIABLE)
        person.advertise(BY_HAND_TOPIC, TEXT_TYPE, QualityOfService.RELIABLE)
        await until_async(is_at("home"))
        for nonsense in (b"", b"\x00\x01\x00\x00\xff"):
            person.publish(COMMAND, COMMAND_TYPE, nonsense)
            person.publish(BY_HAND_TOPIC, TEXT_TYPE, nonsense)
        person.publish(COMMAND, COMMAND_TYPE, registry.encode(COMMAND_TYPE, {"joints": POSES["out"]}))
        await until_async(is_at("out"))
        for change in ("what?", "arm.pose := nowhere", "arm.pose := home if arm.moving"):
            person.publish(BY_HAND_TOPIC, TEXT_TYPE, registry.encode(TEXT_TYPE, {"data": change}))
        person.publish(COMMAND, COMMAND_TYPE, registry.encode(COMMAND_TYPE, {"joints": POSES["home"]}))
        await until_async(is_at("home"))
        person.publish(COMMAND, COMMAND_TYPE, registry.encode(COMMAND_TYPE, {"joints": POSES["out"]}))
        await until_async(is_at("out"))
        assert not emulating.done()
        emulating.cancel()
        await asyncio.gather(emulating, return_exceptions=True)
        assert all(endpoint.own for endpoint in person.graph()), "it has left the network"

    asyncio.run(scenario())


def test_how_devices_stand_is_written_down_while_they_move(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """They may be killed, and others go on from there."""
    monkeypatch.setattr(exclusivity, "DISCOVERY", 0.05)
    registry, file = cell()[0].registry, tmp_path / "standing.json"

    def stood() -> object:
        return read(file).values.get("arm.pose")

    async def scenario() -> None:
        network, loop = MemoryNetwork(), asyncio.get_running_loop()
        emulation = Emulation(cell()[0], speed=20, kept_in=file)
        emulating = asyncio.create_task(emulate(emulation, lambda node: network.join(registry, node, loop)))
        await until_async(lambda: stood() == "home")
        person = network.join(registry, "person", loop)
        person.advertise(COMMAND, COMMAND_TYPE, QualityOfService.RELIABLE)
        person.publish(COMMAND, COMMAND_TYPE, registry.encode(COMMAND_TYPE, {"joints": POSES["out"]}))
        await until_async(lambda: stood() == "out")
        assert not emulating.done()
        emulating.cancel()
        await asyncio.gather(emulating, return_exceptions=True)

    asyncio.run(scenario())


def test_a_device_is_moved_by_hand() -> None:
    arm = devices()
    move(arm, "arm.pose := out")
    move(arm, "arm.moving := true")
    assert (arm.state["arm.pose"], arm.state["arm.moving"]) == ("out", True)


@pytest.mark.parametrize(
    "text", ["", "arm.pose", "arm.pose := sideways", "arm.goto := out", "arm.pose := out if true", "x := 1 + 1"]
)
def test_what_is_no_move_says_so(text: str) -> None:
    arm = devices()
    before = dict(arm.state)
    with pytest.raises((ExpressionError, ValueError)):
        move(arm, text)
    assert arm.state == before


Line = tuple[str, str]  # the topic on which it is said, and the line


def answered(*lines: Line, emulation: Emulation | None = None) -> list[str]:
    """What running devices answer to lines, one after the other."""
    registry = cell()[0].registry
    answers: list[str] = []

    def hear(samples: Sequence[Sample]) -> None:
        answers.extend(str(registry.decode(TEXT_TYPE, sample.data)["data"]) for sample in samples)

    async def scenario() -> None:
        network = MemoryNetwork()
        loop = asyncio.get_running_loop()
        emulating = asyncio.create_task(
            emulate(emulation or Emulation(cell()[0]), lambda node: network.join(registry, node, loop))
        )
        person = network.join(registry, "person", loop)
        person.subscribe(SAID_TOPIC, TEXT_TYPE, QualityOfService.RELIABLE, hear)
        for topic in (BY_HAND_TOPIC, FAULTS_TOPIC):
            person.advertise(topic, TEXT_TYPE, QualityOfService.RELIABLE)
        await until_async(
            lambda: any(each.topic == SAID_TOPIC and each.direction == "publisher" for each in person.graph())
        )
        for topic, line in lines:
            so_far = tuple(answers)
            person.publish(topic, TEXT_TYPE, registry.encode(TEXT_TYPE, {"data": line}))
            await until_async(partial(differs, answers, so_far))
        emulating.cancel()
        await asyncio.gather(emulating, return_exceptions=True)

    asyncio.run(scenario())
    return answers


def differs(now: Sequence[str], before: Sequence[str]) -> bool:
    return tuple(now) != tuple(before)


def test_nobody_is_left_without_an_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exclusivity, "DISCOVERY", 0.05)
    assert answered(
        (BY_HAND_TOPIC, "arm.pose := out"),
        (BY_HAND_TOPIC, "arm.pose := sideways"),
        (FAULTS_TOPIC, "arm silent for 5 s"),
        (FAULTS_TOPIC, "arm loud"),
        (FAULTS_TOPIC, "clear arm"),
        (FAULTS_TOPIC, "clear"),
    ) == [
        "arm.pose := out => done",
        "arm.pose := sideways => refused: `sideways` is no value of arm.pose, which ranges over {unknown, home, out}",
        "arm silent for 5 s => begins",
        "arm loud => refused: `loud` is no fault: write one of silent, stuck, wrong, offline, restarted, slow, drop, "
        "garbage; did you mean `slow`?",
        "clear arm => ended: arm silent for 5 s",
        "clear => there was nothing to end",
    ]


def test_a_device_that_goes_offline_by_script_has_no_endpoints_and_comes_back(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exclusivity, "DISCOVERY", 0.05)
    registry = cell()[0].registry

    async def scenario() -> None:
        network = MemoryNetwork()
        loop = asyncio.get_running_loop()
        person = network.join(registry, "person", loop)

        def on_the_network() -> set[tuple[str, str]]:
            return {(e.topic, e.direction) for e in person.graph() if e.topic in (STATE, COMMAND)}

        script = (Scripted(0.2, Fault(FaultKind.OFFLINE, "arm", seconds=0.5)),)
        emulation = Emulation(cell()[0], script=script, jitter=0.05)
        emulating = asyncio.create_task(emulate(emulation, lambda node: network.join(registry, node, loop)))
        both = {(STATE, "publisher"), (COMMAND, "subscriber")}
        await until_async(lambda: on_the_network() == both)
        await until_async(lambda: on_the_network() == set())
        await until_async(lambda: on_the_network() == both)
        emulating.cancel()
        await asyncio.gather(emulating, return_exceptions=True)

    asyncio.run(scenario())


def test_only_the_devices_that_are_asked_for_are_emulated_and_they_see_the_others(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(exclusivity, "DISCOVERY", 0.05)
    station = prepare_station(BOLT_TIGHTENING)
    registry, pipelines = station.registry, station.pipelines
    torque = "nutrunner.programmed_torque_reached"

    async def scenario() -> None:
        network = MemoryNetwork()
        loop = asyncio.get_running_loop()
        heard: dict[str, object] = {}

        def hear(samples: Sequence[Sample]) -> None:
            heard.update(registry.decode(pipelines.incoming[nut].topic.type_name, samples[-1].data))

        nut, tool, arm = "/smart_nutrunner/state", "/smart_nutrunner/command", "/ur10/state"
        person = network.join(registry, "person", loop)
        person.subscribe(nut, pipelines.incoming[nut].topic.type_name, QualityOfService.RELIABLE, hear)
        person.advertise(arm, pipelines.incoming[arm].topic.type_name, pipelines.incoming[arm].topic.quality)
        person.advertise(tool, pipelines.outgoing[tool].topic.type_name, pipelines.outgoing[tool].topic.quality)
        emulation = Emulation(station, speed=20, resources=frozenset({"nutrunner"}))
        emulating = asyncio.create_task(emulate(emulation, lambda node: network.join(registry, node, loop)))
        await until_async(lambda: bool(heard))
        assert {e.topic for e in person.graph() if not e.own and e.direction == "publisher"} == {nut, SAID_TOPIC}

        def say_and_see(pose: str) -> bool:
            state = {**station.automaton.initial_valuation, "robot.pose": pose}
            type_name = pipelines.incoming[arm].topic.type_name
            person.publish(arm, type_name, registry.encode(type_name, spoken(pipelines, arm, state, {})))
            command = {"run_tool_forward": True, "set_tool_idle": False}
            type_name = pipelines.outgoing[tool].topic.type_name
            person.publish(tool, type_name, registry.encode(type_name, command))
            return bool(heard[torque.split(".")[1]])

        await until_async(lambda: not say_and_see("above_engine") and bool(heard["tool_is_running_forward"]))
        await until_async(lambda: say_and_see("bolt_pair_1"))
        emulating.cancel()
        await asyncio.gather(emulating, return_exceptions=True)

    asyncio.run(scenario())
