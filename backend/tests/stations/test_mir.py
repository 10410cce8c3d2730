"""The AGV's own REST interface, over real HTTP on the loopback, and the bridge's way to it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import httpx
import pytest

from sequence_planner.simulation.truck_station.drivers import RestLink, WorldEndedError, WorldLink
from sequence_planner.simulation.truck_station.rest import GOAL, STATUS
from sequence_planner.simulation.truck_station.world import World
from sequence_planner.simulation.truck_station.world_server import MirServer, WorldServer


@asynccontextmanager
async def served(world: World) -> AsyncIterator[tuple[asyncio.Server, int, int]]:
    """A world and its AGV at ports of their own; the first is the AGV's server."""
    server = await asyncio.start_server(WorldServer(world).connected, "127.0.0.1", 0)
    async with server:
        port = server.sockets[0].getsockname()[1]
        link = await WorldLink.to("mir", port)
        mir = await asyncio.start_server(MirServer(link).connected, "127.0.0.1", 0)
        async with mir:
            yield mir, port, mir.sockets[0].getsockname()[1]
        link.close()


def test_the_agv_is_told_where_to_go_and_says_where_it_is() -> None:
    async def ask() -> None:
        world = World()
        async with served(world) as (_, _, port), httpx.AsyncClient(base_url=f"http://127.0.0.1:{port}") as client:
            assert (await client.get(STATUS)).json() == {"position": "kitting", "state_text": "Ready"}
            assert (await client.put(GOAL, json={"goal": "station"})).status_code == 200
            world.advance(0.01)
            assert (await client.get(STATUS)).json() == {"position": "moving", "state_text": "Executing"}

    asyncio.run(ask())


@pytest.mark.parametrize(
    ("method", "path", "body", "status"),
    [
        ("PUT", GOAL, b"nonsense", 400),
        ("PUT", GOAL, b'{"goal": "moon"}', 400),
        ("PUT", GOAL, b"[]", 400),
        ("GET", "/", b"", 404),
    ],
)
def test_what_makes_no_sense_is_refused_and_moves_nothing(method: str, path: str, body: bytes, status: int) -> None:
    async def ask() -> None:
        world = World()
        async with served(world) as (_, _, port), httpx.AsyncClient(base_url=f"http://127.0.0.1:{port}") as client:
            answer = await client.request(method, path, content=body)
            assert (answer.status_code, list(answer.json())) == (status, ["error"])
        assert world.agv.goal == "kitting"

    asyncio.run(ask())


def test_an_agv_that_is_switched_off_answers_nobody() -> None:
    async def ask() -> None:
        world = World()
        async with served(world) as (_, port, mir_port):
            world_link = await WorldLink.to("mircom", port)
            bridge = RestLink(world_link, mir_port)
            reader, writer = await asyncio.open_connection("127.0.0.1", port)
            writer.write(b'{"fault": {"node": "mir", "kind": "offline", "seconds": 60}}\n')
            assert await reader.readline() == b'{"done": true}\n'
            assert (await bridge.exchange({"goal": "station"})).fault == {"kind": "silent"}
            bridge.close()
            writer.close()

    asyncio.run(ask())


def test_the_bridge_reaches_the_agv_over_http_and_is_silent_without_it() -> None:
    async def bridge() -> None:
        world = World()
        async with served(world) as (mir, port, mir_port):
            link = RestLink(await WorldLink.to("mircom", port), mir_port)
            assert (await link.exchange({"goal": "station"})).read == {"position": "kitting"}
            assert world.agv.goal == "station"
            mir.close()
            await mir.wait_closed()
            assert (await link.exchange({"goal": None})).fault == {"kind": "silent"}
            link.close()

    asyncio.run(bridge())


def test_a_node_learns_that_the_world_has_ended() -> None:
    async def outlive() -> None:
        async def hang_up(_: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            writer.close()

        async with await asyncio.start_server(hang_up, "127.0.0.1", 0) as server:
            link = await WorldLink.to("ur10", server.sockets[0].getsockname()[1])
            with pytest.raises(WorldEndedError):
                await link.exchange({})
            link.close()

    asyncio.run(outlive())
