"""Hands at emulated devices, and ears on what they say: a node of its own on the station's network."""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import Sample, Transport
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.simulation.manual_interface import (
    BY_HAND_TOPIC,
    FAULTS_TOPIC,
    SAID_TOPIC,
    TEXT_TYPE,
    answer_start,
)
from support.station import foreign_node
from support.waiting import PATIENCE, until

Hear = Callable[[Mapping[str, object]], None]


class Floor:
    """The emulated devices, as who stands beside them reaches and hears them. Methods are called on any thread."""

    def __init__(self, loop: asyncio.AbstractEventLoop, transport: Transport, registry: MessageRegistry) -> None:
        self._loop = loop
        self._transport = transport
        self._registry = registry
        self._said: list[str] = []

    async def open(self, topics: Mapping[str, tuple[str, Hear]]) -> None:
        """Be heard by the devices, and hear `topics`."""
        for topic in (BY_HAND_TOPIC, FAULTS_TOPIC):
            self._transport.advertise(topic, TEXT_TYPE, QualityOfService.RELIABLE)
        self._listen(SAID_TOPIC, TEXT_TYPE, lambda message: self._said.append(str(message["data"])))
        for topic, (type_name, hear) in topics.items():
            self._listen(topic, type_name, hear)

    def _listen(self, topic: str, type_name: str, hear: Hear) -> None:
        def take(samples: object) -> None:
            assert isinstance(samples, (list, tuple))
            for sample in samples:
                assert isinstance(sample, Sample)
                hear(self._registry.decode(type_name, sample.data))

        self._transport.subscribe(topic, type_name, QualityOfService.RELIABLE, take)

    def by_hand(self, variable: str, value: object) -> None:
        """Bring a measured variable to a value."""
        self._line(BY_HAND_TOPIC, f"{variable} := {str(value).lower() if isinstance(value, bool) else value}")

    def fault(self, line: str) -> None:
        """Let a fault begin or end."""
        self._line(FAULTS_TOPIC, line)

    def _line(self, topic: str, line: str) -> None:
        seen = len(self._said)
        data = self._registry.encode(TEXT_TYPE, {"data": line})
        self._loop.call_soon_threadsafe(self._transport.publish, topic, TEXT_TYPE, data)

        def answers() -> list[str]:
            return [said for said in self._said[seen:] if said.startswith(answer_start(line))]

        until(lambda: bool(answers()))
        assert "refused" not in answers()[0], answers()[0]


@contextmanager
def floor(messages: Path, topics: Mapping[str, tuple[str, Hear]]) -> Iterator[Floor]:
    """Stand there until left again. `topics` are heard: each with its type and who hears it."""
    opened: list[Floor] = []
    leave: list[asyncio.Event] = []
    ready = threading.Event()

    async def live() -> None:
        loop, left = asyncio.get_running_loop(), asyncio.Event()
        leave.append(left)
        async with foreign_node(messages) as (transport, registry):
            place = Floor(loop, transport, registry)
            await place.open(topics)

            def there() -> bool:
                found = {(each.topic, each.direction) for each in transport.graph() if not each.own}
                return {(BY_HAND_TOPIC, "subscriber"), (SAID_TOPIC, "publisher")} <= found

            while not there():
                with contextlib.suppress(TimeoutError):
                    await asyncio.wait_for(left.wait(), 0.05)
                    return
            await asyncio.sleep(0.3)  # those who were found find us
            opened.append(place)
            ready.set()
            await left.wait()

    thread = threading.Thread(target=lambda: asyncio.run(live()), daemon=True)
    thread.start()
    try:
        assert ready.wait(PATIENCE), "no emulated devices are there"
        yield opened[0]
    finally:
        if opened:
            opened[0]._loop.call_soon_threadsafe(leave[0].set)
        thread.join(10)
