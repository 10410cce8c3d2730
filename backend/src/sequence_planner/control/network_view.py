"""What is on the ROS network, as one document: nodes, topics, services, actions, and how the station stands to them."""

from __future__ import annotations

from typing import Literal

from sequence_planner.control.view_part import View


class QualityView(View):
    """What an endpoint offers or wants, in ROS 2's words; `deadline` and `liveliness` are seconds, or null for none."""

    reliability: Literal["reliable", "best_effort"]
    durability: Literal["volatile", "transient_local"]
    deadline: float | None
    liveliness: float | None


class EndpointView(View):
    """A publisher or subscriber. `node`, `type_hash` and `vendor` (of its middleware) are null where it does not tell.

    `own` is true of this station's controller.
    """

    node: str | None
    own: bool
    type: str
    type_hash: str | None
    quality: QualityView
    vendor: str | None


class MismatchView(View):
    """Why the station and an endpoint do not understand one another, or would fight.

    `type`: it uses another type under this name. `definition`: another definition of the type (`ours` and `theirs` are
    hashes). `quality`: `policy` is not agreed on, and nothing passes between the two. `rival`: it publishes what the
    station commands. `text` says it in words.
    """

    kind: Literal["type", "definition", "quality", "rival"]
    policy: Literal["reliability", "durability", "deadline", "liveliness"] | None
    node: str | None
    ours: str
    theirs: str
    text: str


class StationUseView(View):
    """A topic of the station's model, and how many endpoints there are with which it is understood."""

    resource: str
    direction: Literal["in", "out"]
    type: str
    type_hash: str
    quality: QualityView
    peers: int
    mismatches: list[MismatchView]


class GraphTopicView(View):
    """A topic; `station` is null where the model does not use it."""

    types: list[str]
    publishers: list[EndpointView]
    subscribers: list[EndpointView]
    station: StationUseView | None


class CallView(View):
    """A service or an action: who answers it and who asks, by node; null stands for one that does not tell its name."""

    types: list[str]
    servers: list[str | None]
    clients: list[str | None]


class NodeView(View):
    """A node, and the names of what it uses and serves."""

    own: bool
    vendor: str | None
    publishes: list[str]
    subscribes: list[str]
    services: list[str]
    actions: list[str]


class NetworkView(View):
    """The whole graph. Where `services_known` is false, the transport cannot tell services, and they are left out."""

    nodes: dict[str, NodeView]
    topics: dict[str, GraphTopicView]
    services: dict[str, CallView]
    actions: dict[str, CallView]
    services_known: bool
