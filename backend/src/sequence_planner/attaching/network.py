"""A topic as it is found on the network: who has it, of which type, in which direction and quality."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from sequence_planner.attaching.errors import AttachError
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.ros.errors import UnknownMessageTypeError
from sequence_planner.ros.found_types import TypeNotFoundError, find_type
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.quality import QualityOfService
from sequence_planner.ros.transport import Endpoint, Transport

LOOK_EVERY = 0.1  # seconds
TYPE_WITHIN = 3.0  # seconds in which a node answers what its type is

_MESSAGE = re.compile(r"[a-z][a-z0-9_]*/msg/[A-Za-z][A-Za-z0-9]*")

InOut = Literal["in", "out"]


@dataclass(frozen=True)
class FoundTopic:
    """A topic, and how the station would use it. `source` is who has it; `found_types` are no file's."""

    name: str
    type_name: str
    direction: InOut
    quality: QualityOfService
    source: str
    found_types: tuple[str, ...] = ()


async def find_topic(
    transport: Transport, *, registry: MessageRegistry, name: str, direction: InOut | None, within: float
) -> FoundTopic:
    """Look for a topic for so many seconds, and find out its type, which is entered into `registry`.

    Without a `direction` a topic that others publish comes in, and one that they only subscribe to goes out. Raises
    `AttachError` for a topic that is not there, or of which the type cannot be known.
    """
    ends = await _ends(transport, name, within)
    if direction is None:
        direction = "in" if any(each.direction == "publisher" for each in ends) else "out"
    wanted = "publisher" if direction == "in" else "subscriber"
    others = [each for each in ends if each.direction == wanted] or ends
    types = sorted({each.type_name for each in others})
    if len(types) > 1:
        raise AttachError("several-types", f"{name} is used with several types: {', '.join(types)}")
    if not _MESSAGE.fullmatch(types[0]):
        raise AttachError("no-message", f"{name} has the type {types[0]}, which is no message of ROS 2")
    before = set(registry.found())
    await _know_type(transport, registry, others)
    new = tuple(sorted(set(registry.found()) - before))
    source = next((each.node for each in others if each.node), "a program that does not tell its node")
    return FoundTopic(name, types[0], direction, _quality(others, direction), source, new)


async def _ends(transport: Transport, name: str, within: float) -> list[Endpoint]:
    """The endpoints of others on a topic, once there are any that all tell their node, or time is up."""
    until = asyncio.get_running_loop().time() + within
    while True:
        graph = [each for each in transport.graph() if not each.own]
        found = [each for each in graph if each.topic == name]
        is_late = asyncio.get_running_loop().time() >= until
        if found and (is_late or all(each.node is not None for each in found)):
            return found
        if is_late:
            known = sorted({each.topic for each in graph})
            near = suggestion(name, known) or f"; there are {', '.join(known) or 'none'}"
            raise AttachError("no-topic", f"nobody has a topic {name} on this network{near}")
        await asyncio.sleep(LOOK_EVERY)


async def _know_type(transport: Transport, registry: MessageRegistry, others: Sequence[Endpoint]) -> None:
    """Find out the type of an endpoint unless it is known; of several that have it, one that tells is enough."""
    endpoint = others[0]
    try:
        ours = registry.type_hash(endpoint.type_name)
    except UnknownMessageTypeError:
        ours = None
    if ours is not None:
        theirs = next((each.type_hash for each in others if each.type_hash not in (None, ours)), None)
        if theirs is not None:
            said = f"{endpoint.topic} has another definition of {endpoint.type_name}"
            raise AttachError("other-definition", f"{said}: theirs is {theirs}, ours is {ours}")
        return
    failed = ""
    for each in others:
        try:
            await find_type(transport, registry, each, TYPE_WITHIN)
        except TypeNotFoundError as error:
            failed = str(error)
        else:
            return
    raise AttachError("no-type", failed)


def _quality(others: Sequence[Endpoint], direction: InOut) -> QualityOfService:
    """A quality with which the station meets all of them."""
    if direction == "in":
        return QualityOfService(
            reliable=all(each.reliable for each in others),
            transient_local=all(each.transient_local for each in others),
            depth=_depth(all(each.reliable for each in others), all(each.transient_local for each in others)),
        )
    wishes = [each.deadline for each in others if each.deadline is not None]
    lasting = any(each.transient_local for each in others)
    return QualityOfService(transient_local=lasting, depth=_depth(True, lasting), deadline=min(wishes, default=None))


def _depth(reliable: bool, transient_local: bool) -> int:
    """As the names for qualities have it."""
    if not reliable:
        return QualityOfService.SENSOR_DATA.depth
    return QualityOfService.LATCHED.depth if transient_local else QualityOfService.RELIABLE.depth
