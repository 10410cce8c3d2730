"""The process of the emulated devices, on a network inside one process."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence

import pytest

from control.bench import COMMAND, COMMAND_TYPE, POSES, STATE, STATE_TYPE, cell, until
from sequence_planner.emulation.devices import EmulatedDevices
from sequence_planner.emulation.process import BY_HAND_TOPIC, BY_HAND_TYPE, Emulation, emulate, move
from sequence_planner.expressions.syntax import ExpressionError
from sequence_planner.ros import exclusivity
from sequence_planner.ros.memory import MemoryNetwork
from sequence_planner.ros.transport import QualityOfService, Sample


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
        person.advertise(BY_HAND_TOPIC, BY_HAND_TYPE, QualityOfService.RELIABLE)
        await until(is_at("home"))
        for nonsense in (b"", b"\x00\x01\x00\x00\xff"):
            person.publish(COMMAND, COMMAND_TYPE, nonsense)
            person.publish(BY_HAND_TOPIC, BY_HAND_TYPE, nonsense)
        person.publish(COMMAND, COMMAND_TYPE, registry.encode(COMMAND_TYPE, {"joints": POSES["out"]}))
        await until(is_at("out"))
        for change in ("what?", "arm.pose := nowhere", "arm.pose := home if arm.moving"):
            person.publish(BY_HAND_TOPIC, BY_HAND_TYPE, registry.encode(BY_HAND_TYPE, {"data": change}))
        person.publish(COMMAND, COMMAND_TYPE, registry.encode(COMMAND_TYPE, {"joints": POSES["home"]}))
        await until(is_at("home"))
        person.publish(COMMAND, COMMAND_TYPE, registry.encode(COMMAND_TYPE, {"joints": POSES["out"]}))
        await until(is_at("out"))
        assert not emulating.done()
        emulating.cancel()
        await asyncio.gather(emulating, return_exceptions=True)
        assert all(endpoint.own for endpoint in person.graph()), "it has left the network"

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
