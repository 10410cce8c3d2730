"""Stations for the tests of pipelines: the cell, and beside its arm a resource as a test writes it."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path

from sequence_planner.language.types import Value
from sequence_planner.pipelines.runtime import RunningPipelines
from sequence_planner.station import ReadyStation, prepare_station
from support.places import CELL


def write_station(folder: Path, resource: str, messages: Mapping[str, str], enumerations: str = "") -> Path:
    """The cell with `resources/tank.yaml` and messages `tank_msgs/msg/<name>.msg`; returns its folder."""
    station = Path(shutil.copytree(CELL, folder / "cell"))
    (station / "resources" / "tank.yaml").write_text(resource, encoding="utf-8")
    text = (station / "station.yaml").read_text(encoding="utf-8")
    added = "".join(f"  {line}\n" for line in enumerations.splitlines())
    (station / "station.yaml").write_text(text.replace("enumerations:\n", f"enumerations:\n{added}"), encoding="utf-8")
    definitions = station / "messages" / "tank_msgs" / "msg"
    definitions.mkdir(parents=True)
    for name, fields in messages.items():
        (definitions / f"{name}.msg").write_text(fields, encoding="utf-8")
    return station


def station_with(folder: Path, resource: str, messages: Mapping[str, str], enumerations: str = "") -> ReadyStation:
    """The same, ready to run."""
    return prepare_station(write_station(folder, resource, messages, enumerations))


class Heard:
    """The incoming pipelines of a station, with every topic fresh, in time that a test tells."""

    def __init__(self, station: ReadyStation) -> None:
        self.running = RunningPipelines(station.pipelines)
        self._station = station
        self._fresh = dict.fromkeys(station.pipelines.incoming, True)

    def take(self, topic: str, now: float = 0.0, /, **fields: object) -> dict[str, Value | None]:
        """What is known after a message, which travels as bytes; fields left out have their default."""
        type_name = self._station.pipelines.incoming[topic].topic.type_name
        registry = self._station.registry
        self.running.take(topic, registry.decode(type_name, registry.encode(type_name, fields)), now)
        return self.known()

    def wake(self, now: float) -> dict[str, Value | None]:
        """What is known when time has passed."""
        self.running.wake(now)
        return self.known()

    def known(self, *stale: str) -> dict[str, Value | None]:
        """What is known; the topics in `stale` have fallen silent."""
        return self.running.values(self._fresh | dict.fromkeys(stale, False))
