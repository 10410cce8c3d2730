"""The whole station with more devices beside, and a topic that is answered: a model for measurements of messages."""

from __future__ import annotations

import random
import shutil
from collections.abc import Mapping
from pathlib import Path

from ruamel.yaml import YAML

from sequence_planner.language.types import Value
from sequence_planner.simulation.messages import spoken
from sequence_planner.station import ReadyStation

ASKED, ANSWERED, NUMBER = "/echo/asked", "/echo/answered", "echo_msgs/msg/Number"
NUMBERS = 256

# The station's own devices speak on 8 topics; with these there are 20, and the one that is answered.
_COPIES = {"robot": 2, "scene": 2, "end_effector": 2, "nutrunner": 2, "agv": 1, "dock": 1, "engine": 1, "operator": 1}

# The answer follows from what was measured, by a tick, as any command does.
_ECHO = f"""\
title: Echo
topics:
  {ASKED}: {{type: {NUMBER}, direction: in}}
  {ANSWERED}: {{type: {NUMBER}, direction: out}}
measured:
  number: {{type: 0..{NUMBERS - 1}, initial: 0}}
"""


def write_station(original: Path, folder: Path) -> None:
    """Write a copy of the station in `original` to `folder`, with its devices' topics several times, and the echo."""
    shutil.copytree(original, folder)
    messages = folder / "messages" / "echo_msgs" / "msg"
    messages.mkdir(parents=True)
    (messages / "Number.msg").write_text("uint8 number\n", encoding="utf-8")
    resources = folder / "resources"
    (resources / "echo.yaml").write_text(_ECHO, encoding="utf-8")
    yaml = YAML(typ="safe")
    for resource, copies in _COPIES.items():
        written = yaml.load(resources / f"{resource}.yaml")
        for number in range(1, copies + 1):
            yaml.dump(_copy(written, number), resources / f"{resource}_{number}.yaml")


def _copy(resource: Mapping[str, object], number: int) -> dict[str, object]:
    """A resource that only reports what the given one does, on topics of its own."""
    topics = resource["topics"]
    assert isinstance(topics, dict)
    reports = {f"/copy_{number}{name}": each for name, each in topics.items() if each["direction"] == "in"}
    for each in reports.values():
        each.pop("examples", None)
    return {"title": f"{resource['title']} {number}", "topics": reports, "measured": resource.get("measured", {})}


def reports(station: ReadyStation, many: int, seed: int = 0) -> dict[str, list[bytes]]:
    """For each device's topic `many` messages of random states of it."""
    drawn = random.Random(seed)
    return {
        topic: [_report(station, topic, drawn) for _ in range(many)]
        for topic in station.pipelines.incoming
        if topic != ASKED
    }


def _report(station: ReadyStation, topic: str, drawn: random.Random) -> bytes:
    pipelines, automaton = station.pipelines, station.automaton
    state: dict[str, Value | None] = dict(automaton.initial_valuation)
    for variable, source in pipelines.feeds.items():
        if topic in pipelines.topics_of(source):
            state[variable] = drawn.choice(list(automaton.variables[variable].type.domain))
    return station.registry.encode(pipelines.incoming[topic].topic.type_name, spoken(pipelines, topic, state, {}))
