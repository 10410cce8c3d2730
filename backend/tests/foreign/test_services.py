"""Services with implementations that do not say in which mapping they speak.

Fast DDS has a mapping of its own. ros2-client has both, but its DDS, RustDDS, sends no user data, so that neither its
servers nor its clients tell which. The station, for which a wrong guess would be a server that executes garbage, has
nothing to do with any of them. That what it writes and reads is right all the same is tried with that rule put aside,
against peers that were told to speak the station's mapping.
"""

from __future__ import annotations

import asyncio
import importlib.util
import os
import time
from collections.abc import Awaitable, Callable

import pytest
from structlog.testing import capture_logs

from foreign.genuine import CYCLONE
from foreign.peers import FAST_DDS, ROS2_CLIENT, Peer, built, running
from sequence_planner.ros import names
from sequence_planner.ros.transport import NoAnswerError, NoServerError, ServiceEnd, TellsServices, Transport
from sequence_planner.ros.transports.choice import TransportChoice, open_transport
from sequence_planner.ros.transports.cyclonedds_network import loopback_configuration
from sequence_planner.ros.types.messages import MessageRegistry
from support.network import DOMAIN
from support.waiting import PATIENCE, until_async

Role = tuple[str, ...]
ASKS_AS_WE_DO, SERVES_AS_WE_DO = (ROS2_CLIENT, "call", "cyclone"), (ROS2_CLIENT, "serve", "cyclone")
VENDORS = {FAST_DDS: "eProsima Fast DDS", ROS2_CLIENT: "RustDDS"}
LOOKING = "asked 0 + 0"
SERVICE, TYPE = "/add_two_ints", "example_interfaces/srv/AddTwoInts"


@pytest.fixture(scope="module")
def registry() -> MessageRegistry:
    return MessageRegistry.from_folder(None)


@pytest.fixture
def vouched(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whoever serves or asks is taken to speak the station's mapping."""
    monkeypatch.setattr(names, "server_of", lambda data: b"vouched")
    monkeypatch.setattr(names, "client_of", lambda data: b"vouched")


def servers(station: Transport) -> list[ServiceEnd]:
    station.graph()
    assert isinstance(station, TellsServices)
    return [end for end in station.services() if end.role == "server"]


def play(
    registry: MessageRegistry,
    role: Role,
    scenario: Callable[[Transport, Peer], Awaitable[None]],
    choice: TransportChoice = "cyclonedds",
) -> None:
    """Run `scenario` beside a peer: its program, and what it does."""
    program = built(role[0])

    async def live() -> None:
        transport = open_transport(choice, registry, "station", asyncio.get_running_loop(), DOMAIN)
        try:
            async with running(program, DOMAIN, *role[1:]) as peer:
                await scenario(transport, peer)
        finally:
            transport.close()

    asyncio.run(live())


@pytest.mark.parametrize("role", [SERVES_AS_WE_DO, (ROS2_CLIENT, "serve", "enhanced"), (FAST_DDS, "serve")])
def test_a_server_that_does_not_tell_its_mapping_is_not_called(registry: MessageRegistry, role: Role) -> None:
    """In another mapping the server would take the header of our request for its content, and carry it out."""

    async def scenario(station: Transport, peer: Peer) -> None:
        request = registry.encode(f"{TYPE}_Request", {"a": 2, "b": 3})
        with pytest.raises(NoServerError, match="it would execute garbage, so nothing was sent"):
            await station.call(SERVICE, TYPE, request, PATIENCE)
        assert peer.lines == []
        await until_async(lambda: servers(station), "the server is seen")
        [server] = servers(station)
        assert (server.service, server.vendor, server.understood) == (SERVICE, VENDORS[role[0]], False)

    play(registry, role, scenario)


@pytest.mark.skipif(
    importlib.util.find_spec("rclpy") is None,
    reason="rclpy is not importable here: run this suite where ROS 2 Jazzy is installed",
)
@pytest.mark.skipif(os.environ.get("RMW_IMPLEMENTATION") != CYCLONE, reason="rclpy is not on rmw_cyclonedds_cpp here")
def test_a_server_on_another_dds_is_not_called_over_rclpy_either(
    registry: MessageRegistry, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The peer is on the loopback interface alone, which rclpy takes for one of many.
    monkeypatch.setenv("CYCLONEDDS_URI", loopback_configuration())

    async def scenario(station: Transport, peer: Peer) -> None:
        request = registry.encode(f"{TYPE}_Request", {"a": 2, "b": 3})
        with pytest.raises(NoServerError, match=r"on eProsima Fast DDS \(rmw_fastrtps_cpp\), .* so nothing was sent"):
            await station.call(SERVICE, TYPE, request, PATIENCE)
        assert peer.lines == []

    play(registry, (FAST_DDS, "serve"), scenario, "rclpy")


@pytest.mark.parametrize("role", [ASKS_AS_WE_DO, (ROS2_CLIENT, "call", "enhanced")])
def test_a_client_that_does_not_tell_its_mapping_is_not_answered(registry: MessageRegistry, role: Role) -> None:
    """What the enhanced mapping sends, cyclonedds itself drops already."""

    async def scenario(station: Transport, peer: Peer) -> None:
        asked: list[bytes] = []

        async def add(request: bytes) -> bytes:
            asked.append(request)
            return request

        with capture_logs() as log:
            station.serve(SERVICE, TYPE, add)
            if role == ASKS_AS_WE_DO:
                await until_async(lambda: log, "the request is noticed")
            await asyncio.sleep(2)  # in which the client asks some ten times
        assert (asked, peer.lines) == ([], [])
        dropped = [event for event in log if "(no clientid)" in event["event"]]
        assert len(dropped) == (role == ASKS_AS_WE_DO)

    play(registry, role, scenario)


def test_a_client_on_fast_dds_is_named_once_and_does_not_fill_the_log(
    registry: MessageRegistry, capfd: pytest.CaptureFixture[str]
) -> None:
    """What it sends has no header, and Cyclone writes a line for each request that it cannot read."""

    async def scenario(station: Transport, peer: Peer) -> None:
        async def add(request: bytes) -> bytes:
            raise AssertionError(request)

        with capture_logs() as log:
            station.serve(SERVICE, TYPE, add)
            await until_async(lambda: log, "the client is noticed")
            capfd.readouterr()
            await asyncio.sleep(3)  # in which it asks some thirty times
        [told] = log
        assert "neither asked nor answered: run both with the same RMW_IMPLEMENTATION" in told["event"]
        assert (told["service"], told["role"]) == (SERVICE, "client")
        assert (told["peer"], told["middleware"]) == ("not named", "eProsima Fast DDS (rmw_fastrtps_cpp)")
        assert capfd.readouterr().err == ""
        assert peer.lines == []

    play(registry, (FAST_DDS, "ask"), scenario)


@pytest.mark.usefixtures("vouched")
def test_a_server_of_the_same_mapping_understands_each_call(registry: MessageRegistry) -> None:
    async def scenario(station: Transport, peer: Peer) -> None:
        async def added(a: int, b: int, within: float = PATIENCE) -> object:
            request = registry.encode(f"{TYPE}_Request", {"a": a, "b": b})
            return registry.decode(f"{TYPE}_Response", await station.call(SERVICE, TYPE, request, within))["sum"]

        async def found() -> None:
            """Call until the peer has found the station: what it answers before that, its DDS sends to nobody."""
            deadline = time.monotonic() + PATIENCE
            while True:
                try:
                    await added(0, 0, within=2)
                    return
                except NoAnswerError:
                    assert time.monotonic() < deadline, "never found"

        await found()
        assert await added(-(2**62), 2**62 - 1) == -1
        # As many at a time as the peer keeps.
        assert await asyncio.gather(*(added(number, 1) for number in range(10))) == list(range(1, 11))
        expected = [f"asked {-(2**62)} + {2**62 - 1}", *(f"asked {number} + 1" for number in range(10))]
        await until_async(lambda: len(peer.lines) >= len(expected) + peer.lines.count(LOOKING), "each call is heard")
        assert sorted(line for line in peer.lines if line != LOOKING) == sorted(expected)

    play(registry, SERVES_AS_WE_DO, scenario)


@pytest.mark.usefixtures("vouched")
def test_a_client_of_the_same_mapping_gets_its_answers(registry: MessageRegistry) -> None:
    async def scenario(station: Transport, peer: Peer) -> None:
        async def add(request: bytes) -> bytes:
            assert registry.decode(f"{TYPE}_Request", request) == {"a": 2, "b": 3}
            return registry.encode(f"{TYPE}_Response", {"sum": 5})

        station.serve(SERVICE, TYPE, add)
        await until_async(lambda: len(peer.lines) >= 3, "the client has its answers")
        assert set(peer.lines) == {"answered 5"}

    play(registry, ASKS_AS_WE_DO, scenario)
