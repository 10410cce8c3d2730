"""What the ROS graph says about the station's topics: peers, and peers that cannot be understood."""

from __future__ import annotations

from collections.abc import Sequence

from sequence_planner.pipelines.pipeline import StationPipelines, Topic
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.transport import Direction, Endpoint


class NetworkWatch:
    """The last look at the graph, as it concerns the station's topics.

    `peers` counts those that can be understood, `troubles` and `rivals` say in words what is wrong with others.
    """

    def __init__(self, pipelines: StationPipelines, registry: MessageRegistry) -> None:
        self._registry = registry
        self._topics: dict[str, tuple[Topic, Direction]] = {
            **{n: (p.topic, "publisher") for n, p in pipelines.incoming.items()},
            **{n: (p.topic, "subscriber") for n, p in pipelines.outgoing.items()},
        }
        self._outgoing = frozenset(pipelines.outgoing)
        self._speaking: set[str] = set()  # incoming topics that had a publisher
        self.peers: dict[str, int] = dict.fromkeys(self._topics, 0)
        self.troubles: dict[str, str] = {}
        self.rivals: dict[str, str] = {}  # who else publishes a topic with which the station commands, in words

    def look(self, graph: Sequence[Endpoint]) -> frozenset[str]:
        """Take a new look; returns the incoming topics whose publishers have all gone since the last one."""
        self.peers = dict.fromkeys(self._topics, 0)
        self.troubles, self.rivals = {}, {}
        speaking: set[str] = set()
        for endpoint in graph:
            if endpoint.own or endpoint.topic not in self._topics:
                continue
            topic, wanted = self._topics[endpoint.topic]
            if topic.name not in self._outgoing and endpoint.direction == "publisher":
                speaking.add(topic.name)
            if (trouble := self._trouble(endpoint, topic, wanted)) is not None:
                self.troubles[topic.name] = trouble
            elif (rival := self._rival(endpoint, topic)) is not None:
                self.rivals[topic.name] = rival
            elif endpoint.direction == wanted:
                self.peers[topic.name] += 1
        gone, self._speaking = self._speaking - speaking, speaking
        return frozenset(gone)

    def strangers(self, graph: Sequence[Endpoint], node: str) -> list[str]:
        """What speaks against the devices being those of `node` alone: topics it is missing on, and who else is there.

        A node that does not tell its name counts as somebody else; one that only listens to devices does not count.
        """
        foreign = [
            e
            for e in graph
            if not e.own and e.topic in self._topics and (e.direction == "publisher" or e.topic in self._outgoing)
        ]
        there = {(e.topic, e.direction) for e in foreign if e.node == node}
        missing = [f"{node} is not yet on {t}" for t, (_, wanted) in self._topics.items() if (t, wanted) not in there]
        others = {f"{e.node or 'another node'} is on {e.topic}" for e in foreign if e.node != node}
        return [*missing, *sorted(others)]

    def _trouble(self, endpoint: Endpoint, topic: Topic, wanted: Direction) -> str | None:
        who = endpoint.node or "another node"
        does = "publishes" if endpoint.direction == "publisher" else "subscribes to"
        if endpoint.type_name != topic.type_name:
            if endpoint.direction != wanted:
                return None
            return f"{who} {does} {topic.name} as {endpoint.type_name}, and the station's model says {topic.type_name}"
        ours = self._registry.type_hash(topic.type_name)
        if endpoint.direction == wanted and endpoint.type_hash not in (None, ours):
            return (
                f"{who} {does} {topic.name} with another definition of {topic.type_name}: "
                f"theirs is {endpoint.type_hash}, ours is {ours}"
            )
        return None

    def _rival(self, endpoint: Endpoint, topic: Topic) -> str | None:
        if endpoint.direction != "publisher" or topic.name not in self._outgoing:
            return None
        return f"{endpoint.node or 'another node'} also publishes {topic.name}: two would command the same device"
