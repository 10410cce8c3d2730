"""The policy of SROS 2 for a station: which node may publish, subscribe, call and serve what, and nothing else.

Written in the policy language of sros2 (version 0.2.0), which `ros2 security create_permission` turns into the signed
permissions of DDS Security. Devices have an enclave for each resource, in which they may do what the emulated ones do.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from typing import Final
from xml.etree import ElementTree

from sequence_planner.pipelines.graph import StationPipelines
from sequence_planner.ros.actions import ActionNames
from sequence_planner.ros.environment import CONTROLLER, DEVICES, EMULATED, TOOLS
from sequence_planner.simulation.manual_interface import BY_HAND_TOPIC, FAULTS_TOPIC, SAID_TOPIC

VERSION: Final = "0.2.0"
# What rclpy opens for every node whatever it is for.
_OF_EVERY_NODE: Final = "/parameter_events"
_SERVED_BY_EVERY_NODE: Final = "~/get_type_description"
_SERVED_BY_TOOLS: Final = "/*/get_type_description"  # they have the number of their process in their names


@dataclass
class Rights:
    """The things that a node may do, each a set of names. Whatever is not named it may not."""

    publish: set[str] = field(default_factory=set)
    subscribe: set[str] = field(default_factory=set)
    request: set[str] = field(default_factory=set)  # services that it calls
    reply: set[str] = field(default_factory=set)  # services that it serves
    call: set[str] = field(default_factory=set)  # actions that it gives goals
    execute: set[str] = field(default_factory=set)  # actions that it serves

    def mirrored(self) -> Rights:
        """Return what somebody may do who is all that these rights need to meet."""
        return Rights(
            publish=set(self.subscribe),
            subscribe=set(self.publish),
            request=set(self.reply),
            reply=set(self.request),
            call=set(self.execute),
            execute=set(self.call),
        )


def rights_by_resource(pipelines: StationPipelines, ros_1: Collection[str] = ()) -> dict[str, Rights]:
    """Return what the controller may do with the devices of each resource; topics of ROS 1 are none of ROS 2's."""
    found: dict[str, Rights] = {}
    for incoming in pipelines.incoming.values():
        if incoming.topic.name not in ros_1:
            found.setdefault(incoming.topic.resource, Rights()).subscribe.add(incoming.topic.name)
    for outgoing in pipelines.outgoing.values():
        if outgoing.topic.name not in ros_1:
            found.setdefault(outgoing.topic.resource, Rights()).publish.add(outgoing.topic.name)
    for service in pipelines.services.values():
        found.setdefault(service.request.topic.resource, Rights()).request.add(service.name)
    for action in pipelines.actions.values():
        found.setdefault(action.goal.topic.resource, Rights()).call.add(action.name)
    return found


def enclaves(pipelines: StationPipelines, ros_1: Collection[str] = ()) -> dict[str, dict[str, Rights]]:
    """The enclaves by path, each with its nodes by name."""
    by_resource = rights_by_resource(pipelines, ros_1)
    controller = _together(by_resource.values())
    emulated = controller.mirrored()
    # Before one of these begins it listens whether somebody else publishes what it is going to.
    alone, alone_emulated = Rights(subscribe=set(controller.publish)), Rights(subscribe=set(emulated.publish))
    alone_emulated.subscribe |= {ActionNames(name).status for name in emulated.execute}
    emulated.subscribe |= {BY_HAND_TOPIC, FAULTS_TOPIC}
    emulated.publish.add(SAID_TOPIC)
    tools = Rights(publish={BY_HAND_TOPIC, FAULTS_TOPIC}, subscribe={SAID_TOPIC}, reply={_SERVED_BY_TOOLS})
    return {
        CONTROLLER: {"sequence_planner": controller, "sequence_planner_check": alone},
        EMULATED: {"emulated_devices": emulated, "emulated_devices_check": alone_emulated},
        TOOLS: {"by_hand": tools},
        **{f"{DEVICES}/{name}": {name: rights.mirrored()} for name, rights in sorted(by_resource.items())},
    }


def policy(pipelines: StationPipelines, ros_1: Collection[str] = ()) -> str:
    """The policy as XML."""
    root = ElementTree.Element("policy", version=VERSION)
    listed = ElementTree.SubElement(root, "enclaves")
    for path, nodes in enclaves(pipelines, ros_1).items():
        enclave = ElementTree.SubElement(listed, "enclave", path=path)
        profiles = ElementTree.SubElement(enclave, "profiles")
        for node, rights in nodes.items():
            profile = ElementTree.SubElement(profiles, "profile", ns="/", node=node)
            for kind, member, qualifier, names in _rules(rights):
                rule = ElementTree.SubElement(profile, kind, {qualifier: "ALLOW"})
                for name in sorted(names):
                    ElementTree.SubElement(rule, member).text = name
    ElementTree.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{ElementTree.tostring(root, encoding="unicode")}\n'


def _rules(rights: Rights) -> Iterator[tuple[str, str, str, set[str]]]:
    """Yield what is allowed: the element and its members, the qualifier, and the names; only where there are any."""
    rules = (
        ("topics", "topic", "publish", rights.publish | {_OF_EVERY_NODE}),
        ("topics", "topic", "subscribe", rights.subscribe),
        ("services", "service", "request", rights.request),
        ("services", "service", "reply", rights.reply | {_SERVED_BY_EVERY_NODE}),
        ("actions", "action", "call", rights.call),
        ("actions", "action", "execute", rights.execute),
    )
    return (rule for rule in rules if rule[3])


def _together(each: Collection[Rights]) -> Rights:
    found = Rights()
    for rights in each:
        for name, names in vars(rights).items():
            getattr(found, name).update(names)
    return found
