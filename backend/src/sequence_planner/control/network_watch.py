"""What the ROS graph says about the station's topics: peers, and peers that cannot be understood."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence

from sequence_planner.control.mismatches import call_uses, mismatches, not_understood, uses
from sequence_planner.pipelines.graph import StationPipelines
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.service_graph import ServiceEnd
from sequence_planner.ros.transport import Endpoint


class NetworkWatch:
    """The last look at the graph, as it concerns the station's topics.

    `peers` counts those that can be understood, `troubles` and `rivals` say in words what is wrong with others. They go
    by topic, or by the part of a service or action that answers. As long as the station only listens (`commands` is
    false), whoever commands its devices is no rival, unless the station `waits` for that one to end.
    `seen` is all that there was, also on other topics, and of services where the transport can tell; when that is
    something else than before, `changed` is set.
    """

    def __init__(self, pipelines: StationPipelines, registry: MessageRegistry) -> None:
        self.uses = uses(pipelines, registry)
        self._calls = call_uses(pipelines)
        self.commands = self.waits = False
        self._speaking: set[str] = set()  # incoming topics that had a publisher
        self.seen: tuple[Sequence[Endpoint], Sequence[ServiceEnd] | None] = ((), None)
        self.changed = asyncio.Event()
        self.peers: dict[str, int] = dict.fromkeys(self.uses, 0)
        self.troubles: dict[str, str] = {}
        self.rivals: dict[str, str] = {}  # who else publishes a topic with which the station commands, in words

    def look(self, graph: Sequence[Endpoint], ends: Sequence[ServiceEnd] | None = None) -> frozenset[str]:
        """Take a new look; returns the incoming topics whose publishers have all gone since the last one."""
        if self.seen != (graph, ends):
            self.changed.set()
        self.seen = (graph, ends)
        self.peers = dict.fromkeys(self.uses, 0)
        self.troubles, self.rivals = {}, {}
        speaking: set[str] = set()
        for endpoint in graph:
            use = self.uses.get(endpoint.topic)
            if endpoint.own or use is None:
                continue
            if use.own == "subscriber" and endpoint.direction == "publisher":
                speaking.add(endpoint.topic)
            found = mismatches(endpoint, use)
            for each in found:
                if each.kind == "rival" and not (self.commands or self.waits):
                    continue
                (self.rivals if each.kind == "rival" else self.troubles)[endpoint.topic] = each.text
            if not found and endpoint.direction == use.peer:
                self.peers[endpoint.topic] += 1
        for end in ends or ():
            call = self._calls.get(end.service)
            if call is not None and end.role == "server" and not (end.own or end.understood):
                self.troubles[call.part] = not_understood(end)
        gone, self._speaking = self._speaking - speaking, speaking
        return frozenset(gone)

    def resource_of(self, trouble: str) -> str:
        """The resource whose topic, or whose service or action, has trouble."""
        if trouble in self.uses:
            return self.uses[trouble].topic.resource
        return next(call.resource for call in self._calls.values() if call.part == trouble)

    def strangers(self, graph: Sequence[Endpoint], node: str) -> list[str]:
        """What speaks against the devices being those of `node` alone: topics it is missing on, and who else is there.

        A node that does not tell its name counts as somebody else; one that only listens to devices does not count.
        """
        there = {(e.topic, e.direction) for e in self._foreign(graph) if e.node == node}
        missing = [f"{node} is not yet on {t}" for t, use in self.uses.items() if (t, use.peer) not in there]
        return [*missing, *self.others(graph, node)]

    def others(self, graph: Sequence[Endpoint], node: str) -> list[str]:
        """Who but `node` is there to be commanded, or reports as a device does, in words."""
        return sorted({f"{e.node or 'another node'} is on {e.topic}" for e in self._foreign(graph) if e.node != node})

    def _foreign(self, graph: Sequence[Endpoint]) -> list[Endpoint]:
        return [
            e
            for e in graph
            if not e.own
            and (use := self.uses.get(e.topic)) is not None
            and (e.direction == "publisher" or use.own == "publisher")
        ]
