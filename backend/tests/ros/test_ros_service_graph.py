"""Who serves and who calls, and whose middleware it is, as transports tell it."""

from __future__ import annotations

import asyncio
from uuid import UUID

from sequence_planner.ros.environment import vendor_of
from sequence_planner.ros.names import ros_service
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import NetworkEndpoint, ServiceEnd, TellsServices, Transport
from sequence_planner.ros.transports.choice import open_transport
from sequence_planner.ros.transports.memory import MemoryNetwork
from sequence_planner.ros.types.messages import MessageRegistry
from support.network import DOMAIN
from support.waiting import until_async

TRIGGER = "std_srvs/srv/Trigger"


async def stop(request: bytes) -> bytes:
    """Nobody calls it."""
    return request


async def told(transport: Transport, service: str) -> ServiceEnd:
    """The server of a service, once it has told its node."""
    assert isinstance(transport, TellsServices)
    async with asyncio.timeout(10):
        while True:
            transport.graph()
            for end in transport.services():
                if end.service == service and end.role == "server" and end.node is not None:
                    return end
            await asyncio.sleep(0.02)


def test_a_server_is_told_with_its_node() -> None:
    async def scenario(one: Transport, other: Transport) -> tuple[ServiceEnd, ServiceEnd]:
        other.serve("/press/stop", TRIGGER, stop)
        ends = await told(one, "/press/stop"), await told(other, "/press/stop")
        one.close()
        other.close()
        return ends

    async def in_memory() -> tuple[ServiceEnd, ServiceEnd]:
        network, registry, loop = MemoryNetwork(), MessageRegistry.from_folder(None), asyncio.get_running_loop()
        return await scenario(network.join(registry, "one", loop), network.join(registry, "press", loop))

    async def on_dds() -> tuple[ServiceEnd, ServiceEnd]:
        registry, loop = MessageRegistry.from_folder(None), asyncio.get_running_loop()
        ends = [open_transport("cyclonedds", registry, name, loop, DOMAIN) for name in ("one", "press")]
        return await scenario(*ends)

    for life, vendor in ((in_memory, None), (on_dds, "Eclipse Cyclone DDS")):
        theirs, ours = asyncio.run(life())
        assert theirs == ServiceEnd("/press/stop", TRIGGER, "server", False, "/press", vendor)
        assert ours == ServiceEnd("/press/stop", TRIGGER, "server", True, "/press", vendor)


def test_an_endpoint_is_told_anew_when_its_node_is_known_and_gone_with_it() -> None:
    async def scenario() -> None:
        registry, loop = MessageRegistry.from_folder(None), asyncio.get_running_loop()
        one, other = (open_transport("cyclonedds", registry, name, loop, DOMAIN) for name in ("one", "press"))

        def seen() -> list[NetworkEndpoint]:
            return [each for each in one.graph() if each.topic == "/press/seen"]

        other.advertise("/press/seen", "std_msgs/msg/Bool", QualityOfService.LATCHED)
        await until_async(lambda: [(each.node, each.vendor) for each in seen()] == [("/press", "Eclipse Cyclone DDS")])
        other.close()
        await until_async(lambda: not seen())
        one.close()

    asyncio.run(scenario())


def test_names_of_services_and_vendors() -> None:
    assert ros_service("rq/arm/stopRequest", "std_srvs::srv::dds_::Trigger_Request_") == ("/arm/stop", TRIGGER)
    assert ros_service("rr/arm/stopReply", "std_srvs::srv::dds_::Trigger_Response_") is None
    assert ros_service("rt/arm/state", "std_msgs::msg::dds_::Bool_") is None
    assert vendor_of(UUID(bytes=b"\x01\x0f" + bytes(14))) == "eProsima Fast DDS"
    assert vendor_of(UUID(bytes=bytes(16))) is None
