"""The network as a document, made of what a transport tells."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Mapping, Sequence

from sequence_planner.control.mismatches import Mismatch, Use, mismatches
from sequence_planner.control.network_view import (
    CallView,
    EndpointView,
    GraphTopicView,
    MismatchView,
    NetworkView,
    NodeView,
    QualityView,
    StationUseView,
)
from sequence_planner.ros.quality import QualityOfService
from sequence_planner.ros.service_graph import Role, ServiceEnd
from sequence_planner.ros.transport import Endpoint

TOPICS_AT_ONCE = 20  # in a step
ACTION = "/_action/"  # within the names of an action's topics and services


def network_view(
    endpoints: Sequence[Endpoint], ends: Sequence[ServiceEnd] | None, uses: Mapping[str, Use]
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
    endpoints: Sequence[Endpoint], ends: Sequence[ServiceEnd] | None, uses: Mapping[str, Use]
) -> Generator[None, None, NetworkView]:
    """The same in short steps, for who has other things to do as well."""
    by_topic: dict[str, list[Endpoint]] = {}
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


def _topic(found: Sequence[Endpoint], use: Use | None) -> GraphTopicView:
    return GraphTopicView(
        types=sorted({endpoint.type_name for endpoint in found} | ({use.topic.type_name} if use else set())),
        publishers=[_endpoint(each) for each in found if each.direction == "publisher"],
        subscribers=[_endpoint(each) for each in found if each.direction == "subscriber"],
        station=None if use is None else _use(found, use),
    )


def _endpoint(endpoint: Endpoint) -> EndpointView:
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


def _use(found: Iterable[Endpoint], use: Use) -> StationUseView:
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
            MismatchView(kind=m.kind, policy=m.policy, node=m.node, ours=m.ours, theirs=m.theirs, text=m.text)
            for m in wrong
        ],
    )


def _of_actions(by_topic: Mapping[str, Sequence[Endpoint]]) -> Iterable[ServiceEnd]:
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
    endpoints: Sequence[Endpoint],
    ends: Sequence[ServiceEnd],
    services: Mapping[str, CallView],
    actions: Mapping[str, CallView],
) -> dict[str, NodeView]:
    """The nodes that tell their names."""
    own: dict[str, bool] = {}
    vendors: dict[str, str | None] = {}
    told: list[Endpoint | ServiceEnd] = [*endpoints, *ends]
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
