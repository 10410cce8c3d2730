"""Peers that do not agree with one of our own endpoints, in words."""

from __future__ import annotations

from collections.abc import Iterable

from sequence_planner.ros.quality import Direction, QualityOfService, disagreements
from sequence_planner.ros.transport import Endpoint


def both_sides(graph: Iterable[Endpoint], topic: str, direction: Direction, quality: QualityOfService) -> str:
    """Say what each peer of our endpoint offers or wants otherwise; empty when they have gone again."""
    found = []
    for peer in graph:
        if peer.topic == topic and peer.direction != direction:
            sides = (quality, peer.quality) if direction == "publisher" else (peer.quality, quality)
            who = "this node" if peer.own else peer.node or "another node"
            found += [f"{text} ({who})" for text in disagreements(*sides)]
    return "; ".join(found)
