"""What is commanded on the network of a station, as a device hears it."""

from __future__ import annotations

import asyncio
import threading
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager

from sequence_planner.automaton.automaton import Kind
from sequence_planner.language.types import Value
from sequence_planner.ros.transport import OnBatch, Sample
from sequence_planner.ros.transports.choice import open_transport
from sequence_planner.simulation.devices import CommandReader
from sequence_planner.station import ReadyStation
from support.network import DOMAIN

Command = Mapping[str, Value | None]


class Wire:
    """By topic the commands as they came, each once for as long as it was repeated."""

    def __init__(self, station: ReadyStation) -> None:
        automaton, outgoing = station.automaton, station.pipelines.outgoing
        self.heard: dict[str, list[Command]] = defaultdict(list)
        self._types = {name: each.topic.type_name for name, each in outgoing.items()}
        self._readers = {name: CommandReader(each, automaton) for name, each in outgoing.items()}
        self._registry = station.registry
        self._outputs = frozenset(automaton.names(Kind.OUTPUT))

    def take(self, samples: Sequence[Sample]) -> None:
        for sample in samples:
            values, troubles = self._readers[sample.topic].read(
                self._registry.decode(self._types[sample.topic], sample.data)
            )
            assert not troubles, troubles
            said = {name: value for name, value in values.items() if name in self._outputs}
            if self.heard[sample.topic][-1:] != [said]:
                self.heard[sample.topic].append(said)


@contextmanager
def listening(station: ReadyStation, also: OnBatch = lambda samples: None) -> Iterator[Wire]:
    """Listen as long as the block lasts; `also` is told each message."""

    def take(samples: Sequence[Sample]) -> None:
        also(samples)
        wire.take(samples)

    wire, loop = Wire(station), asyncio.new_event_loop()
    thread = threading.Thread(target=loop.run_forever)
    transport = open_transport("cyclonedds", station.registry, "listener", loop, DOMAIN)
    try:
        for name, each in station.pipelines.outgoing.items():
            transport.subscribe(name, each.topic.type_name, each.topic.quality, take)
        thread.start()
        yield wire
    finally:
        loop.call_soon_threadsafe(loop.stop)
        thread.join()
        transport.close()
        loop.close()
