"""Recordings of ROS 2 traffic as `ros2 bag record` makes them, written by another program's library."""

from __future__ import annotations

import asyncio
import threading
import time
import zipfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys.store import Typestore

from sequence_planner.ros.transport import Sample
from sequence_planner.ros.transports.choice import open_transport
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.station import ReadyStation
from support.network import DOMAIN

BEGAN = 1_700_000_000  # seconds since the epoch
NS = 1_000_000_000
Storage = Literal["MCAP", "SQLITE3"]
STORAGES: tuple[Storage, ...] = ("MCAP", "SQLITE3")
# A message: its topic, its type, when it came in nanoseconds since the epoch, and its bytes.
Recorded = tuple[str, str, int, bytes]


def definitions(registry: MessageRegistry) -> Typestore:
    """All types of a station, as whoever records them knows them."""
    store = Typestore()
    store.register({name: ([], fields) for name, fields in registry.declared().items() if name.split("/")[1] == "msg"})
    return store


def write_recording(
    folder: Path,
    registry: MessageRegistry,
    messages: Iterable[Recorded],
    storage: Storage = "MCAP",
    *,
    topics: Mapping[str, str] | None = None,
    packed: CompressionMode | None = None,
) -> Path:
    """Write a recording into a folder that is not there yet; returns its file of messages. `topics` are recorded though
    nothing is said there.
    """
    store = definitions(registry)
    writer = Writer(folder, version=9, storage_plugin=StoragePlugin[storage])
    if packed is not None:
        writer.set_compression(packed, CompressionFormat.ZSTD)
    with writer:
        known = {
            (topic, type_name): writer.add_connection(topic, type_name, typestore=store)
            for topic, type_name in (topics or {}).items()
        }
        for topic, type_name, at, data in messages:
            if (topic, type_name) not in known:
                known[topic, type_name] = writer.add_connection(topic, type_name, typestore=store)
            writer.write(known[topic, type_name], at, data)
    return next(each for each in folder.iterdir() if each.name != "metadata.yaml")


def zipped(folder: Path, archive: Path) -> Path:
    """An archive of a folder."""
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as made:
        for each in sorted(folder.iterdir()):
            made.write(each, f"{folder.name}/{each.name}")
    return archive


@dataclass
class Recorder:
    """All that is heard of topics, as `ros2 bag record` hears it."""

    station: ReadyStation
    messages: list[Recorded] = field(default_factory=list)

    def take(self, samples: Sequence[Sample]) -> None:
        """Note what has come, when it came by the clock of the day."""
        behind = time.time() - time.monotonic()
        for each in samples:
            at = int((each.received + behind) * NS)
            self.messages.append((each.topic, self.types[each.topic], at, each.data))

    @property
    def types(self) -> Mapping[str, str]:
        """The types of all topics of the station."""
        pipelines = self.station.pipelines
        types = {name: each.topic.type_name for name, each in pipelines.incoming.items()}
        return types | {name: each.topic.type_name for name, each in pipelines.outgoing.items()}

    def write(self, folder: Path, storage: Storage = "MCAP") -> Path:
        """Write the recording."""
        ordered = sorted(self.messages, key=lambda each: each[2])
        return write_recording(folder, self.station.registry, ordered, storage)


@contextmanager
def recording(station: ReadyStation, domain: int = DOMAIN) -> Iterator[Recorder]:
    """Record the topics of a station that runs, as long as the block lasts."""
    recorder, loop = Recorder(station), asyncio.new_event_loop()
    pipelines = station.pipelines
    topics = [each.topic for each in pipelines.incoming.values()] + [each.topic for each in pipelines.outgoing.values()]
    thread = threading.Thread(target=loop.run_forever)
    transport = open_transport("cyclonedds", station.registry, "recorder", loop, domain)
    try:
        for topic in topics:
            transport.subscribe(topic.name, topic.type_name, topic.quality, recorder.take)
        thread.start()
        yield recorder
    finally:
        loop.call_soon_threadsafe(loop.stop)
        thread.join()
        transport.close()
        loop.close()
