"""Findings that keep a station from being started though its model means something."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.language.types import Place
from sequence_planner.model.launch_requirements import StartNeeds
from sequence_planner.model.source import Finding, SourceText
from sequence_planner.simulation.supported import emulation_findings
from sequence_planner.station import ReadyStation


def start_findings(station: ReadyStation, needs: StartNeeds) -> list[Finding]:
    """Return what keeps it, or its emulated devices, from being started where it is run so; each at its place."""
    return [*(emulation_findings(station) if needs.emulated else ()), *_unbridged(station, needs)]


def _unbridged(station: ReadyStation, needs: StartNeeds) -> Iterator[Finding]:
    for topic in sorted(station.ros_1) if not needs.rosbridge else ():
        place = topic.place if isinstance(topic, SourceText) else Place(topic, 1, 1)
        yield Finding(
            place,
            f"`{topic}` is a topic of ROS 1, and this station runs without a rosbridge server: run it with "
            "--rosbridge, or let the topic be one of ROS 2",
        )
