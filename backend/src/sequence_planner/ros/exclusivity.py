"""Others who command the same devices: two publishers of one topic would fight over it.

A publisher that was killed stays known for as long as its lease lasts, so an endpoint alone proves nothing at once: one
that is heard speaking is alive, and one that outlasts every lease without a word is taken to be.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Mapping, Sequence

from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import Sample, Transport, TransportError


class NotAloneError(TransportError):
    """Somebody else publishes the same topics."""


DISCOVERY = 1.5  # seconds in which peers on the same machine are found
LONGEST_LEASE = 22.0  # seconds after which a dead participant of any vendor is forgotten


async def require_sole_publisher(
    transport: Transport, topics: Mapping[str, str], who: str, discovery: float | None = None
) -> None:
    """Wait until nobody else publishes `topics` (name to type); `who` says for whom in the message.

    Others are looked for during `discovery` seconds. `transport` is one of its own for this question, which must not
    publish them. Raises `NotAloneError` naming the topic and the other node, and `TransportError`.
    """
    heard: set[str] = set()

    def listen(samples: Sequence[Sample]) -> None:
        heard.update(sample.topic for sample in samples)

    for topic, type_name in topics.items():
        transport.subscribe(topic, type_name, QualityOfService.SENSOR_DATA, listen)
    await asyncio.sleep(DISCOVERY if discovery is None else discovery)
    patience = time.monotonic() + LONGEST_LEASE
    while others := {
        endpoint.topic: endpoint.node
        for endpoint in transport.graph()
        if endpoint.direction == "publisher" and not endpoint.own and endpoint.topic in topics
    }:
        alive = heard & others.keys()
        if alive or time.monotonic() > patience:
            topic = min(alive or others)
            node = f" (node {others[topic]})" if others[topic] else ""
            raise NotAloneError(
                f"somebody else publishes {topic}{node}: {who} would fight with it. "
                "Stop the other one, or choose another ROS_DOMAIN_ID"
            )
        await asyncio.sleep(0.1)
