"""Emulated devices with faults in them.

Most faults are in what a device says: behind them it goes on as ever, and once they end it says the truth again. Only
a device that is slow or starts again does something else than it would.
"""

from __future__ import annotations

import math
import random
from collections.abc import Mapping
from dataclasses import dataclass, field

from sequence_planner.emulation.devices import EmulatedDevices
from sequence_planner.emulation.faults import Clear, Fault, FaultKind
from sequence_planner.emulation.spoken import CannotSpeakError, Message, spoken
from sequence_planner.expressions.types import Value
from sequence_planner.pipelines.graph import StationPipelines

_OFFLINE = (FaultKind.OFFLINE, FaultKind.RESTARTED)
RESTART = 1.0  # seconds for which a device that starts again is offline, if nothing else is said
_SURPLUS = b"\xff" * 8  # more than a message may be padded with


@dataclass
class _Underway:
    """A fault that has begun, when it ends, and what was said when it began."""

    fault: Fault
    until: float | None
    messages: Mapping[str, Message] = field(default_factory=dict)
    values: Mapping[str, Value] = field(default_factory=dict)


class FaultyDevices:
    """What comes of what `devices` say and hear while they have faults. Times are on the clock of the devices.

    `seed` draws which messages are lost.
    """

    def __init__(self, devices: EmulatedDevices, pipelines: StationPipelines, seed: int = 0) -> None:
        self.devices = devices
        self._pipelines = pipelines
        self._random = random.Random(f"faults {seed}")
        self._underway: list[_Underway] = []

    @property
    def faults(self) -> tuple[Fault, ...]:
        """Those that have begun and not ended, the oldest first."""
        return tuple(each.fault for each in self._underway)

    @property
    def offline_resources(self) -> frozenset[str]:
        """The resources whose devices are not on the network."""
        return frozenset(each.fault.target for each in self._underway if each.fault.kind in _OFFLINE)

    def begin(self, fault: Fault, now: float) -> None:
        """Let a fault begin. It takes the place of one of the same kind at the same target."""
        self._end(
            [each for each in self._underway if (each.fault.kind, each.fault.target) == (fault.kind, fault.target)]
        )
        seconds = RESTART if fault.seconds is None and fault.kind is FaultKind.RESTARTED else fault.seconds
        begun = _Underway(fault, None if seconds is None else now + seconds)
        if fault.kind is FaultKind.WRONG and fault.value is not None:
            begun.values = {fault.target: fault.value}
        elif fault.kind is FaultKind.STUCK and fault.target in self.devices.topics:
            value = self.devices.state[fault.target]
            begun.values = {} if value is None else {fault.target: value}
        elif fault.kind is FaultKind.STUCK:
            begun.messages = {topic: self.devices.report(topic) for topic in self._topics(fault.target)}
        self._underway.append(begun)
        self._slow()

    def clear(self, clear: Clear) -> list[Fault]:
        """End faults now; returns which."""
        ended = [each for each in self._underway if clear.target in (None, each.fault.target)]
        self._end(ended)
        return [each.fault for each in ended]

    def advance(self, now: float) -> None:
        """Let time pass: faults end whose time is over, and the devices do what is due."""
        self._end([each for each in self._underway if each.until is not None and each.until <= now])
        self.devices.advance(now)

    @property
    def due(self) -> float:
        """When the next thing happens by itself, after the last `advance`; inf if none will."""
        ends = min((each.until for each in self._underway if each.until is not None), default=math.inf)
        return min(ends, self.devices.due)

    def says(self, topic: str) -> Message | None:
        """The message with which a device would report now; None while it says nothing."""
        if self._has(topic, *_OFFLINE, FaultKind.SILENT):
            return None
        values: dict[str, Value] = {}
        for each in self._underway:
            if topic in each.messages:
                return each.messages[topic]
            values |= {name: value for name, value in each.values.items() if topic in self.devices.topics[name]}
        message = self.devices.report(topic)
        if not values:
            return message
        try:
            return spoken(self._pipelines, topic, {**self.devices.state, **values}, message)
        except CannotSpeakError:  # beside what else the device says now, the value cannot be said
            return message

    def sent(self, topic: str, data: bytes) -> bytes | None:
        """What a message is on the network: itself, bytes that are no message, or None for one that is lost."""
        if self._is_lost(topic):
            return None
        return garbage(data) if self._has(topic, FaultKind.GARBAGE) else data

    def hears(self, topic: str) -> bool:
        """Whether a command that is sent on a topic of the station comes to the device."""
        return not self._has(topic, *_OFFLINE) and not self._is_lost(topic)

    def _end(self, ended: list[_Underway]) -> None:
        if not ended:
            return
        for each in ended:
            self._underway.remove(each)
            if each.fault.kind is FaultKind.RESTARTED:
                self.devices.restart(each.fault.target)
        self._slow()

    def _slow(self) -> None:
        self.devices.slow({f.target: f.amount for f in self.faults if f.kind is FaultKind.SLOW})

    def _topics(self, target: str) -> list[str]:
        """The topics on which the devices of a resource speak, or the topic itself."""
        return [name for name, each in self._pipelines.incoming.items() if target in (name, each.topic.resource)]

    def _has(self, topic: str, *kinds: FaultKind) -> bool:
        return any(f.kind in kinds and self._is_at(f, topic) for f in self.faults)

    def _is_at(self, fault: Fault, topic: str) -> bool:
        described = self._pipelines.incoming.get(topic) or self._pipelines.outgoing[topic]
        return fault.target in (topic, described.topic.resource)

    def _is_lost(self, topic: str) -> bool:
        kept = math.prod(1 - f.amount for f in self.faults if f.kind is FaultKind.DROP and self._is_at(f, topic))
        return kept < 1 and self._random.random() >= kept


def garbage(data: bytes) -> bytes:
    """A message with more behind it than its type has, as a node sends it that was built with another definition.

    Other nonsense does not reach a station: the middleware sends no text without its length and no message that is too
    short, and of any byte that stands for a truth it makes `true`.
    """
    return data + _SURPLUS
