"""`topics`: who and what is on the ROS network."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator, Sequence
from functools import partial

import typer

from sequence_planner.cli.options import AsJson, print_json, refuse
from sequence_planner.cli.part_options import TransportOption
from sequence_planner.cli.station.controller import Domain, Seconds, look
from sequence_planner.controller.io.network import network_view
from sequence_planner.controller.views.details import CallView, EndpointView, NetworkView
from sequence_planner.ros.transport import TellsServices, Transport, TransportError
from sequence_planner.ros.types.messages import MessageRegistry

UNASKED = ("/rosout", "/parameter_events")  # topics that every node of ROS 2 has


def topics(
    transport: TransportOption = "auto",
    domain: Domain = None,
    seconds: Seconds = 2.0,
    everything: bool = typer.Option(False, "--all", help="Also the topics that every node of ROS 2 has."),
    json: AsJson = False,
) -> None:
    """Show who and what is on the ROS network: topics with their types, who publishes and subscribes, and services.

    It looks for some seconds, as peers need time to be found, and publishes nothing. With --json the document of
    `GET /api/v1/ros/graph`.
    """
    try:
        found = look(partial(_seen, seconds=seconds), MessageRegistry.from_folder(None), transport, domain)
    except TransportError as error:
        refuse(str(error))
    if json:
        print_json(found.model_dump(mode="json"))
        return
    typer.echo("\n".join(_lines(found, everything)))


async def _seen(transport: Transport, seconds: float) -> NetworkView:
    """Return what is there after so many seconds, without this node itself."""
    await asyncio.sleep(seconds)
    endpoints = [each for each in transport.graph() if not each.own]
    ends = [each for each in transport.services() if not each.own] if isinstance(transport, TellsServices) else None
    return network_view(endpoints, ends, {})


def _lines(found: NetworkView, everything: bool) -> Iterator[str]:
    topics = {name: topic for name, topic in found.topics.items() if everything or name not in UNASKED}
    if not topics and not found.services and not found.actions:
        yield "nobody is there: see ROS_DOMAIN_ID and ROS_AUTOMATIC_DISCOVERY_RANGE (docs/ros.md)"
        return
    for name, topic in topics.items():
        yield f"{name}  {', '.join(topic.types)}"
        yield from _ends("published by", topic.publishers)
        yield from _ends("read by", topic.subscribers)
    yield from _calls("service", found.services)
    yield from _calls("action", found.actions)


def _ends(does: str, ends: Sequence[EndpointView]) -> Iterator[str]:
    for end in ends:
        quality = end.quality
        words: list[str] = [quality.reliability, quality.durability]
        words += [f"{key} {value:g} s" for key, value in _promises(end)]
        vendor = f", {end.vendor}" if end.vendor else ""
        yield f"  {does:12}  {_name(end.node)}  ({', '.join(words)}{vendor})"


def _promises(end: EndpointView) -> Iterator[tuple[str, float]]:
    for key, value in (("deadline", end.quality.deadline), ("liveliness", end.quality.liveliness)):
        if value is not None:
            yield key, value


def _calls(kind: str, calls: dict[str, CallView]) -> Iterator[str]:
    for name, call in calls.items():
        yield f"{name}  {', '.join(call.types)}  ({kind})"
        if call.servers:
            yield f"  {'served by':12}  {', '.join(map(_name, call.servers))}"
        if call.clients:
            yield f"  {'called by':12}  {', '.join(map(_name, call.clients))}"


def _name(node: str | None) -> str:
    return node or "a node that does not tell its name"
