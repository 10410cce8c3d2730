"""Network diagnostics: the ROS graph of the station's topics and services, and mismatches with peers."""

from __future__ import annotations

import asyncio
from collections.abc import Generator, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, cast

from sequence_planner.controller.views.details import (
    CallView,
    EndpointView,
    GraphTopicView,
    MismatchView,
    NetworkView,
    NodeView,
    QualityView,
    StationUseView,
)
from sequence_planner.pipelines.graph import StationPipelines, Topic
from sequence_planner.ros.actions import ActionNames
from sequence_planner.ros.environment import worded as worded_vendor
from sequence_planner.ros.qos import Direction, QualityOfService, disagreements
from sequence_planner.ros.transport import NetworkEndpoint, Role, ServiceEnd
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.ros.types.standard_types import GOAL_STATUSES
from sequence_planner.texts.message import Message, message

# Where the station and others on its topics do not understand one another, each with both sides.

Policy = Literal["reliability", "durability", "deadline", "liveliness"]


@dataclass(frozen=True)
class Mismatch:
    """A difference between what the station and an endpoint have; `policy` is of a quality of service, `text` for
    people.
    """

    kind: Literal["type", "definition", "quality", "rival"]
    node: str | None
    ours: str
    theirs: str
    text: Message
    policy: Policy | None = None


@dataclass(frozen=True)
class Use:
    """A topic as the station uses it: `own` is its own endpoint there, and `peer` what it wants to meet."""

    topic: Topic
    own: Direction
    type_hash: str

    @property
    def peer(self) -> Direction:
        """The other end."""
        return "publisher" if self.own == "subscriber" else "subscriber"


def uses(pipelines: StationPipelines, registry: MessageRegistry) -> dict[str, Use]:
    """The station's topics by name, and those on which actions tell of their goals."""
    found: dict[str, Use] = {}
    for name, incoming in pipelines.incoming.items():
        found[name] = Use(incoming.topic, "subscriber", registry.type_hash(incoming.topic.type_name))
    for name, action in pipelines.actions.items():
        names, resource = ActionNames(name), action.status.topic.resource
        told = {names.status: GOAL_STATUSES, names.feedback: registry.action(action.type_name).feedback_message}
        for topic, type_name in told.items():
            quality = QualityOfService.LATCHED if topic == names.status else QualityOfService.RELIABLE
            found[topic] = Use(Topic(topic, type_name, resource, quality), "subscriber", registry.type_hash(type_name))
    for name, outgoing in pipelines.outgoing.items():
        found[name] = Use(outgoing.topic, "publisher", registry.type_hash(outgoing.topic.type_name))
    return found


@dataclass(frozen=True)
class CallUse:
    """The use that the station makes of a service or an action: `part` is the name of the pipeline that its answers
    come by.
    """

    part: str
    resource: str


def call_uses(pipelines: StationPipelines) -> dict[str, CallUse]:
    """The services that the station calls, by name; an action's is the one that takes its goals."""
    services = {name: use.response for name, use in pipelines.services.items()}
    goals = {ActionNames(name).send_goal: use.status for name, use in pipelines.actions.items()}
    return {name: CallUse(part.name, part.topic.resource) for name, part in (services | goals).items()}


def not_understood(end: ServiceEnd) -> Message:
    """Return what to say of a server that puts the numbers of calls elsewhere than the station does."""
    name, is_action, _ = end.service.partition("/_action/")
    told = message("graph.node") if end.node is None else end.node
    what = "graph.action" if is_action else "graph.call"
    return message(what, node=told, name=name, vendor=worded_vendor(end.vendor))


def mismatches(endpoint: NetworkEndpoint, use: Use) -> list[Mismatch]:
    """Return what stands between the station and a foreign endpoint on the same topic."""
    found = []
    if endpoint.direction == use.peer:
        found = [*_of_type(endpoint, use)] or [*_of_quality(endpoint, use)]
    if endpoint.direction == use.own == "publisher":
        found.append(_rival(endpoint, use))
    return found


def _of_type(endpoint: NetworkEndpoint, use: Use) -> Iterator[Mismatch]:
    topic, does = use.topic, "graph.publishes" if endpoint.direction == "publisher" else "graph.subscribes"
    says = message(does, node=who(endpoint), topic=topic.name)
    if endpoint.type_name != topic.type_name:
        text = message("graph.type", says=says, theirs=endpoint.type_name, ours=topic.type_name)
        yield Mismatch("type", endpoint.node, topic.type_name, endpoint.type_name, text)
    elif endpoint.type_hash not in (None, use.type_hash):
        theirs = str(endpoint.type_hash)
        text = message("graph.definition", says=says, type=topic.type_name, theirs=theirs, ours=use.type_hash)
        yield Mismatch("definition", endpoint.node, use.type_hash, theirs, text)


def _of_quality(endpoint: NetworkEndpoint, use: Use) -> Iterator[Mismatch]:
    ours, theirs = use.topic.quality, endpoint.quality
    offered, wanted = (ours, theirs) if use.own == "publisher" else (theirs, ours)
    for said in disagreements(offered, wanted):
        policy = cast("Policy", said.partition(":")[0])
        text = message(
            "graph.quality-published" if use.own == "publisher" else "graph.quality-subscribed",
            topic=use.topic.name,
            node=who(endpoint),
            difference=said.capitalize(),
        )
        yield Mismatch("quality", endpoint.node, worded(ours, policy), worded(theirs, policy), text, policy)


def _rival(endpoint: NetworkEndpoint, use: Use) -> Mismatch:
    name = use.topic.name
    text = message("graph.rival", node=who(endpoint), topic=name)
    return Mismatch("rival", endpoint.node, use.topic.type_name, endpoint.type_name, text)


def who(endpoint: NetworkEndpoint) -> str:
    """Say whose endpoint it is."""
    return endpoint.node or message("graph.node")


def worded(quality: QualityOfService, policy: Policy) -> str:
    """Return what a quality says of a policy, in ROS 2's words."""
    if policy == "reliability":
        return "reliable" if quality.reliable else "best_effort"
    if policy == "durability":
        return "transient_local" if quality.transient_local else "volatile"
    seconds = quality.deadline if policy == "deadline" else quality.liveliness
    return "none" if seconds is None else f"{seconds:g} s"


# The network as a document, made of what a transport tells.

TOPICS_AT_ONCE = 20  # in a step
ACTION = "/_action/"  # within the names of an action's topics and services


def network_view(
    endpoints: Sequence[NetworkEndpoint], ends: Sequence[ServiceEnd] | None, uses: Mapping[str, Use]
) -> NetworkView:
    """The document. `ends` is None where the transport cannot tell services; `uses` are the station's topics."""
    steps = network_steps(endpoints, ends, uses)
    while True:
        try:
            next(steps)
        except StopIteration as done:
            view: NetworkView = done.value
            return view


def network_steps(
    endpoints: Sequence[NetworkEndpoint], ends: Sequence[ServiceEnd] | None, uses: Mapping[str, Use]
) -> Generator[None, None, NetworkView]:
    """The same in short steps, for who has other things to do as well."""
    by_topic: dict[str, list[NetworkEndpoint]] = {}
    for endpoint in endpoints:
        by_topic.setdefault(endpoint.topic, []).append(endpoint)
    for name in uses:
        by_topic.setdefault(name, [])
    yield
    services = _calls(end for end in ends or () if ACTION not in end.service)
    actions = _calls([*_of_actions(by_topic), *_actions_of(ends or ())])
    yield
    nodes = _nodes([*endpoints], ends or (), services, actions)
    topics: dict[str, GraphTopicView] = {}
    for number, (name, found) in enumerate(sorted(by_topic.items())):
        if number % TOPICS_AT_ONCE == 0:
            yield
        if ACTION not in name:
            topics[name] = _topic(found, uses.get(name))
    yield
    return NetworkView(nodes=nodes, topics=topics, services=services, actions=actions, services_known=ends is not None)


def _topic(found: Sequence[NetworkEndpoint], use: Use | None) -> GraphTopicView:
    return GraphTopicView(
        types=sorted({endpoint.type_name for endpoint in found} | ({use.topic.type_name} if use else set())),
        publishers=[_endpoint(each) for each in found if each.direction == "publisher"],
        subscribers=[_endpoint(each) for each in found if each.direction == "subscriber"],
        station=None if use is None else _use(found, use),
    )


def _endpoint(endpoint: NetworkEndpoint) -> EndpointView:
    return EndpointView(
        node=endpoint.node,
        own=endpoint.own,
        type=endpoint.type_name,
        type_hash=endpoint.type_hash,
        quality=_quality(endpoint.quality),
        vendor=endpoint.vendor,
    )


def _quality(quality: QualityOfService) -> QualityView:
    return QualityView(
        reliability="reliable" if quality.reliable else "best_effort",
        durability="transient_local" if quality.transient_local else "volatile",
        deadline=quality.deadline,
        liveliness=quality.liveliness,
    )


def _use(found: Iterable[NetworkEndpoint], use: Use) -> StationUseView:
    peers, wrong = 0, list[Mismatch]()
    for endpoint in found:
        if not endpoint.own:
            here = mismatches(endpoint, use)
            wrong += here
            peers += not here and endpoint.direction == use.peer
    return StationUseView(
        resource=use.topic.resource,
        direction="in" if use.own == "subscriber" else "out",
        type=use.topic.type_name,
        type_hash=use.type_hash,
        quality=_quality(use.topic.quality),
        peers=peers,
        mismatches=[
            MismatchView(
                kind=m.kind,
                policy=m.policy,
                node=m.node,
                ours=m.ours,
                theirs=m.theirs,
                text=m.text,
                text_message=m.text,
            )
            for m in wrong
        ],
    )


def _of_actions(by_topic: Mapping[str, Sequence[NetworkEndpoint]]) -> Iterable[ServiceEnd]:
    """The ends of actions that their topics show: who publishes the feedback carries the goals out."""
    for topic, found in by_topic.items():
        name, is_action, part = topic.partition(ACTION)
        if is_action and part == "feedback":
            for endpoint in found:
                type_name = endpoint.type_name.removesuffix("_FeedbackMessage")
                role: Role = "server" if endpoint.direction == "publisher" else "client"
                yield ServiceEnd(name, type_name, role, endpoint.own, endpoint.node, endpoint.vendor)


def _actions_of(ends: Iterable[ServiceEnd]) -> Iterable[ServiceEnd]:
    """The ends of actions that their services show."""
    for end in ends:
        name, is_action, part = end.service.partition(ACTION)
        if is_action and part == "send_goal":
            type_name = end.type_name.removesuffix("_SendGoal")
            yield ServiceEnd(name, type_name, end.role, end.own, end.node, end.vendor)


def _calls(ends: Iterable[ServiceEnd]) -> dict[str, CallView]:
    by_name: dict[str, list[ServiceEnd]] = {}
    for end in dict.fromkeys(ends):  # an action shows itself by its topics and by its services
        by_name.setdefault(end.service, []).append(end)
    return {
        name: CallView(
            types=sorted({end.type_name for end in found}),
            servers=_named(end for end in found if end.role == "server"),
            clients=_named(end for end in found if end.role == "client"),
        )
        for name, found in sorted(by_name.items())
    }


def _named(ends: Iterable[ServiceEnd]) -> list[str | None]:
    return sorted((end.node for end in ends), key=lambda name: (name is None, name or ""))


def _nodes(
    endpoints: Sequence[NetworkEndpoint],
    ends: Sequence[ServiceEnd],
    services: Mapping[str, CallView],
    actions: Mapping[str, CallView],
) -> dict[str, NodeView]:
    """The nodes that tell their names."""
    own: dict[str, bool] = {}
    vendors: dict[str, str | None] = {}
    told: list[NetworkEndpoint | ServiceEnd] = [*endpoints, *ends]
    for each in told:
        if each.node is not None:
            own[each.node] = own.get(each.node, False) or each.own
            vendors[each.node] = vendors.get(each.node) or each.vendor
    topics: dict[tuple[str, str], set[str]] = {}
    for endpoint in endpoints:
        if endpoint.node is not None and ACTION not in endpoint.topic:
            topics.setdefault((endpoint.node, endpoint.direction), set()).add(endpoint.topic)
    served = {name: _served(name, services) for name in own}
    return {
        name: NodeView(
            own=own[name],
            vendor=vendors[name],
            publishes=sorted(topics.get((name, "publisher"), ())),
            subscribes=sorted(topics.get((name, "subscriber"), ())),
            services=served[name],
            actions=_served(name, actions),
        )
        for name in sorted(own)
    }


def _served(node: str, calls: Mapping[str, CallView]) -> list[str]:
    return [name for name, call in calls.items() if node in call.servers]


# What the ROS graph says about the station's topics: peers, and peers that cannot be understood.


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
        self.seen: tuple[Sequence[NetworkEndpoint], Sequence[ServiceEnd] | None] = ((), None)
        self.changed = asyncio.Event()
        self.peers: dict[str, int] = dict.fromkeys(self.uses, 0)
        self.troubles: dict[str, Message] = {}
        self.rivals: dict[str, Message] = {}  # who else publishes a topic with which the station commands, in words

    def look(self, graph: Sequence[NetworkEndpoint], ends: Sequence[ServiceEnd] | None = None) -> frozenset[str]:
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

    def strangers(self, graph: Sequence[NetworkEndpoint], node: str) -> list[str]:
        """Return what speaks against the devices being those of `node` alone: topics it is missing on, and who else is
        there.

        A node that does not tell its name counts as somebody else; one that only listens to devices does not count.
        """
        there = {(e.topic, e.direction) for e in self._foreign(graph) if e.node == node}
        missing = [f"{node} is not yet on {t}" for t, use in self.uses.items() if (t, use.peer) not in there]
        return [*missing, *self.others(graph, node)]

    def others(self, graph: Sequence[NetworkEndpoint], node: str) -> list[str]:
        """Say who but `node` is there to be commanded, or reports as a device does."""
        return sorted({f"{e.node or 'another node'} is on {e.topic}" for e in self._foreign(graph) if e.node != node})

    def _foreign(self, graph: Sequence[NetworkEndpoint]) -> list[NetworkEndpoint]:
        return [
            e
            for e in graph
            if not e.own
            and (use := self.uses.get(e.topic)) is not None
            and (e.direction == "publisher" or use.own == "publisher")
        ]
