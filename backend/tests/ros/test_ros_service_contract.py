"""The contract of services on every transport."""

from __future__ import annotations

import asyncio
import importlib.util
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ros_networks import Network, play, standard
from structlog.testing import capture_logs

from sequence_planner.ros.call_header import CallHeader, split_header, with_header
from sequence_planner.ros.transport import NoAnswerError, NoServerError, Transport, TransportError
from sequence_planner.ros.types.errors import UnknownMessageTypeError
from sequence_planner.ros.types.messages import MessageRegistry
from support.examples import examples

NO_RCLPY = pytest.mark.skipif(
    importlib.util.find_spec("rclpy") is None,
    reason="rclpy is not importable here: run this suite where ROS 2 Jazzy is installed",
)
OF_ANY_TYPE = ["memory", "cyclonedds"]
KINDS = [*OF_ANY_TYPE, pytest.param("rclpy", marks=NO_RCLPY)]

ADD, EMPTY = "example_interfaces/srv/AddTwoInts", "std_srvs/srv/Empty"


async def add(request: bytes) -> bytes:
    """Answer a request for a sum, later for a larger one."""
    numbers = standard().decode(f"{ADD}_Request", request)
    total = int(str(numbers["a"])) + int(str(numbers["b"]))
    await asyncio.sleep(total / 1000)
    return standard().encode(f"{ADD}_Response", {"sum": total})


async def sum_of(transport: Transport, a: int, b: int, service: str = "/add") -> object:
    request = standard().encode(f"{ADD}_Request", {"a": a, "b": b})
    return standard().decode(f"{ADD}_Response", await transport.call(service, ADD, request, 10.0))["sum"]


@pytest.mark.parametrize("kind", KINDS)
def test_each_call_gets_its_own_answer(kind: str) -> None:
    async def scenario(network: Network) -> None:
        station, other, device = network.join("station"), network.join("other"), network.join("device")
        first = asyncio.ensure_future(sum_of(station, 1, 2))  # before there is a server
        await asyncio.sleep(0)
        device.serve("/add", ADD, add)
        assert await first == 3
        # Later calls are answered earlier, and two clients number their calls alike.
        calls = [sum_of(client, 30 - number, 0) for number in range(30) for client in (station, other)]
        assert await asyncio.gather(*calls) == [30 - number for number in range(30) for _ in range(2)]

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_empty_requests_pass(kind: str) -> None:
    async def scenario(network: Network) -> None:
        station, device = network.join("station"), network.join("device")
        heard: list[bytes] = []

        async def reset(request: bytes) -> bytes:
            heard.append(request)
            return standard().encode(f"{EMPTY}_Response", {})

        device.serve("/reset", EMPTY, reset)
        answer = await station.call("/reset", EMPTY, standard().encode(f"{EMPTY}_Request", {}), 10.0)
        assert standard().decode(f"{EMPTY}_Response", answer) == {}
        assert [standard().decode(f"{EMPTY}_Request", request) for request in heard] == [{}]

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_who_gets_no_answer_is_told_why(kind: str) -> None:
    async def scenario(network: Network) -> None:
        station, device = network.join("station"), network.join("device")

        async def fail(request: bytes) -> bytes:
            raise RuntimeError("the motor is hot")

        with pytest.raises(NoServerError, match="nobody serves /add"):
            await station.call("/add", ADD, standard().encode(f"{ADD}_Request", {}), 0.1)
        device.serve("/fails", ADD, fail)
        with capture_logs() as logs, pytest.raises(NoAnswerError, match="/fails gave no answer within 2 s"):
            await station.call("/fails", ADD, standard().encode(f"{ADD}_Request", {}), 2.0)
        assert [log["service"] for log in logs if log["event"] == "a request could not be answered"] == ["/fails"]
        device.serve("/add", ADD, add)  # A failure harms nobody else.
        assert await sum_of(station, 2, 2) == 4

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_a_server_that_restarts_is_found_again(kind: str) -> None:
    async def scenario(network: Network) -> None:
        station = network.join("station")
        for _ in range(2):
            device = network.join("device")
            device.serve("/add", ADD, add)
            assert await sum_of(station, 1, 1) == 2
            device.close()
        with pytest.raises(TransportError):
            await station.call("/add", ADD, standard().encode(f"{ADD}_Request", {}), 0.5)

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_misuse_of_services_is_refused_with_a_reason(kind: str) -> None:
    async def scenario(network: Network) -> None:
        station = network.join("station")
        station.serve("/add", ADD, add)
        with pytest.raises(TransportError, match="/add is already served"):
            station.serve("/add", ADD, add)
        with pytest.raises(UnknownMessageTypeError, match="did you mean example_interfaces/srv/AddTwoInts"):
            station.serve("/sum", "example_interfaces/srv/AddTwoInt", add)
        with pytest.raises(UnknownMessageTypeError, match="no service type"):
            await station.call("/sum", "std_msgs/msg/String", b"", 1.0)
        with pytest.raises(ValueError, match="is not a topic name"):
            station.serve("sum", ADD, add)
        station.close()
        with pytest.raises(TransportError, match="closed"):
            station.serve("/sum", ADD, add)
        with pytest.raises(TransportError, match="closed"):
            await station.call("/add", ADD, b"", 1.0)

    play(kind, scenario)


# rclpy would need the generated code of both definitions.
@pytest.mark.parametrize("kind", OF_ANY_TYPE)
def test_a_server_of_another_definition_is_not_called(kind: str, tmp_path: Path) -> None:
    def registry(folder: str, definition: str) -> MessageRegistry:
        path = tmp_path / folder / "cell_msgs" / "srv" / "Grip.srv"
        path.parent.mkdir(parents=True)
        path.write_text(definition)
        return MessageRegistry.from_folder(tmp_path / folder)

    async def scenario(network: Network) -> None:
        # The requests are alike, so that DDS itself finds nothing wrong with them.
        old, new = registry("old", "bool close\n---\n"), registry("new", "bool close\n---\nbool closed\n")
        device, station = network.join("device", old), network.join("station", new)
        heard: list[bytes] = []

        async def grip(request: bytes) -> bytes:
            heard.append(request)
            return old.encode("cell_msgs/srv/Grip_Response", {})

        device.serve("/grip", "cell_msgs/srv/Grip", grip)
        with pytest.raises(NoServerError, match="/grip is served with another definition of cell_msgs/srv/Grip"):
            await station.call("/grip", "cell_msgs/srv/Grip", new.encode("cell_msgs/srv/Grip_Request", {}), 5.0)
        assert heard == []

    play(kind, scenario)


@given(st.integers(0, 2**64 - 1), st.integers(-(2**63), 2**63 - 1), st.binary(max_size=40), st.booleans())
@examples(50)
def test_the_header_of_a_call_comes_back(client: int, number: int, body: bytes, little: bool) -> None:
    message = bytes([0, little, 0, 0]) + body
    sent = with_header(CallHeader(client, number), message)
    assert split_header(sent) == (CallHeader(client, number), message)
    assert split_header(sent[:19]) is None
