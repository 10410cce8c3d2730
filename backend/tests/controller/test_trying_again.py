"""A grip that misses its part, at an example station: it is opened and closed again, and at last done without."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from sequence_planner.execution.vocabulary import ServiceKind
from sequence_planner.simulation.devices import EmulatedDevices
from support.places import MODELS
from support.simulated import Rig

BUFFER = MODELS / "robots_with_buffer"
PICK = "robot_1.pick"


@dataclass
class Slipping:
    """The devices, of which the first robot does not hear the first commands to close its gripper."""

    devices: EmulatedDevices
    misses: int
    closing: bool = False

    def command(self, topic: str, message: Mapping[str, object]) -> object:
        if topic == "/robot_1/command":
            begins, self.closing = message["close_gripper"] and not self.closing, bool(message["close_gripper"])
            self.misses -= bool(begins)
            if self.closing and self.misses >= 0:
                message = {**message, "close_gripper": False}
        return self.devices.command(topic, message)

    def report(self, topic: str) -> object:
        return self.devices.report(topic)

    def advance(self, now: float) -> None:
        self.devices.advance(now)


def working(misses: int) -> Rig:
    rig = Rig(folder=BUFFER)
    rig.devices = Slipping(rig.devices, misses)  # type: ignore[assignment]
    rig.start_production()
    return rig


def test_what_was_missed_is_tried_again() -> None:
    rig = working(misses=2)
    assert rig.run(60, until=lambda: rig.value("robot_1.part_in_gripper") is True)
    assert rig.started.count(PICK) == 3
    called_off = [outcome.called_off for outcome in rig.ticks if outcome.called_off]
    assert called_off == [(PICK,), (PICK,)]
    assert not rig.execution.conduct.service


def test_what_is_missed_again_and_again_is_done_without() -> None:
    rig = working(misses=100)
    assert rig.run(60, until=lambda: (ServiceKind.ABILITY, PICK) in rig.execution.conduct.service)
    given_up = rig.execution.conduct.service[ServiceKind.ABILITY, PICK]
    assert (given_up.by, given_up.why) == (None, "has not finished within 10 s, tried 3 times")
    assert rig.value("robot_1.close_gripper") is False
    before = rig.started.count(PICK)
    rig.run(30)
    assert rig.started.count(PICK) == before == 3
