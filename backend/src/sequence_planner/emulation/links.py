"""The devices' way to the network: each resource has endpoints of its own, which can go and come again."""

from __future__ import annotations

from collections.abc import Callable, Sequence, Set

from sequence_planner.pipelines.graph import StationPipelines
from sequence_planner.ros.transport import Sample, Transport, TransportError

Hear = Callable[[Sequence[Sample]], None]


class Links:
    """The endpoints of the devices of `resources`; `hear` takes their commands."""

    def __init__(
        self, pipelines: StationPipelines, resources: Set[str], connect: Callable[[], Transport], hear: Hear
    ) -> None:
        self._pipelines = pipelines
        self._resources = sorted(resources)
        self._connect = connect
        self._hear = hear
        self._open: dict[str, Transport] = {}

    def keep(self, offline: Set[str]) -> None:
        """Have the devices of all resources but these on the network. Raises `TransportError`."""
        for resource in self._resources:
            if resource in offline and resource in self._open:
                self._open.pop(resource).close()
            elif resource not in offline and resource not in self._open:
                self._open[resource] = self._joined(resource)

    def publish(self, topic: str, type_name: str, data: bytes) -> None:
        """Send a message of a device that is on the network. Raises `TransportError`."""
        link = self._open.get(self._pipelines.incoming[topic].topic.resource)
        if link is None:
            raise TransportError(f"the device on {topic} is not on the network")
        link.publish(topic, type_name, data)

    def close(self) -> None:
        """Leave the network."""
        for link in self._open.values():
            link.close()
        self._open.clear()

    def _joined(self, resource: str) -> Transport:
        link = self._connect()
        for incoming in self._pipelines.incoming.values():
            if incoming.topic.resource == resource:
                link.advertise(incoming.topic.name, incoming.topic.type_name, incoming.topic.quality)
        for outgoing in self._pipelines.outgoing.values():
            if outgoing.topic.resource == resource:
                link.subscribe(outgoing.topic.name, outgoing.topic.type_name, outgoing.topic.quality, self._hear)
        return link
