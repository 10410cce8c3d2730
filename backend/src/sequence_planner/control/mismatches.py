"""Where the station and others on its topics do not understand one another, each with both sides."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, cast

from sequence_planner.pipelines.graph import StationPipelines, Topic
from sequence_planner.ros.actions import ActionNames
from sequence_planner.ros.derived import GOAL_STATUSES
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.quality import Direction, QualityOfService, disagreements
from sequence_planner.ros.service_graph import ServiceEnd
from sequence_planner.ros.transport import Endpoint
from sequence_planner.ros.vendors import worded as worded_vendor

Policy = Literal["reliability", "durability", "deadline", "liveliness"]


@dataclass(frozen=True)
class Mismatch:
    """What the station has and what an endpoint has; `policy` is of a quality of service, `text` for people."""

    kind: Literal["type", "definition", "quality", "rival"]
    node: str | None
    ours: str
    theirs: str
    text: str
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
    """What the station makes of a service or an action: `part` is the name of the pipeline that its answers come by."""

    part: str
    resource: str


def call_uses(pipelines: StationPipelines) -> dict[str, CallUse]:
    """The services that the station calls, by name; an action's is the one that takes its goals."""
    services = {name: use.response for name, use in pipelines.services.items()}
    goals = {ActionNames(name).send_goal: use.status for name, use in pipelines.actions.items()}
    return {name: CallUse(part.name, part.topic.resource) for name, part in (services | goals).items()}


def not_understood(end: ServiceEnd) -> str:
    """What to say of a server that puts the numbers of calls elsewhere than the station does."""
    name, is_action, _ = end.service.partition("/_action/")
    does = "carries out" if is_action else "serves"
    return (
        f"{end.node or 'another node'} {does} {name} on {worded_vendor(end.vendor)}, whose calls are written otherwise "
        "than this station's: nothing is asked of it"
    )


def mismatches(endpoint: Endpoint, use: Use) -> list[Mismatch]:
    """What stands between the station and a foreign endpoint on the same topic."""
    found = []
    if endpoint.direction == use.peer:
        found = [*_of_type(endpoint, use)] or [*_of_quality(endpoint, use)]
    if endpoint.direction == use.own == "publisher":
        found.append(_rival(endpoint, use))
    return found


def _of_type(endpoint: Endpoint, use: Use) -> Iterator[Mismatch]:
    topic, does = use.topic, "publishes" if endpoint.direction == "publisher" else "subscribes to"
    says = f"{who(endpoint)} {does} {topic.name}"
    if endpoint.type_name != topic.type_name:
        text = f"{says} as {endpoint.type_name}, and the station's model says {topic.type_name}"
        yield Mismatch("type", endpoint.node, topic.type_name, endpoint.type_name, text)
    elif endpoint.type_hash not in (None, use.type_hash):
        theirs = str(endpoint.type_hash)
        text = f"{says} with another definition of {topic.type_name}: theirs is {theirs}, ours is {use.type_hash}"
        yield Mismatch("definition", endpoint.node, use.type_hash, theirs, text)


def _of_quality(endpoint: Endpoint, use: Use) -> Iterator[Mismatch]:
    ours, theirs = use.topic.quality, endpoint.quality
    offered, wanted = (ours, theirs) if use.own == "publisher" else (theirs, ours)
    for said in disagreements(offered, wanted):
        policy = cast("Policy", said.partition(":")[0])
        sides = "we publish" if use.own == "publisher" else "we subscribe"
        text = (
            f"{use.topic.name}: nothing passes between {who(endpoint)} and the station ({sides}). {said.capitalize()}"
        )
        yield Mismatch("quality", endpoint.node, worded(ours, policy), worded(theirs, policy), text, policy)


def _rival(endpoint: Endpoint, use: Use) -> Mismatch:
    name = use.topic.name
    text = f"{who(endpoint)} also publishes {name}: two would command the same device"
    return Mismatch("rival", endpoint.node, use.topic.type_name, endpoint.type_name, text)


def who(endpoint: Endpoint) -> str:
    """Whose endpoint it is."""
    return endpoint.node or "another node"


def worded(quality: QualityOfService, policy: Policy) -> str:
    """What a quality says of a policy, in ROS 2's words."""
    if policy == "reliability":
        return "reliable" if quality.reliable else "best_effort"
    if policy == "durability":
        return "transient_local" if quality.transient_local else "volatile"
    seconds = quality.deadline if policy == "deadline" else quality.liveliness
    return "none" if seconds is None else f"{seconds:g} s"
