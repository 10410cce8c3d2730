"""The local socket between controller and server, as each end meets it."""

from __future__ import annotations

import asyncio
import json
import stat
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any, cast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.controller.commands.command import Command, CommandRefused
from sequence_planner.controller.commands.execution import SetMode
from sequence_planner.controller.ipc import LONGEST_COMMAND, ControllerClient, ControllerLink, read_lines
from sequence_planner.controller.views.station import StationView
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.process.unix_socket import SocketTakenError, listen_on
from sequence_planner.texts.message import message
from support.example_view import example_view
from support.examples import TIMED


def named(name: str) -> Actor:
    return Actor(kind=ActorKind.PERSON, id=name, name=name, session="1")


ACTOR = named("Ada")
COMMAND = {"kind": "set-mode", "actor": ACTOR.model_dump(mode="json"), "mode": "paused"}


class Peer:
    """A peer that speaks the socket's language byte by byte."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.reader = reader
        self.writer = writer

    async def hear(self, kind: str) -> dict[str, Any]:
        while True:
            message: dict[str, Any] = json.loads(await asyncio.wait_for(self.reader.readline(), 5))
            if message["kind"] == kind:
                return message

    async def ask(self, line: bytes) -> dict[str, Any]:
        self.writer.write(line + b"\n")
        return await self.hear("reply")


@asynccontextmanager
async def peer_of(path: Path) -> AsyncIterator[Peer]:
    reader, writer = await asyncio.open_unix_connection(str(path), limit=16 * 1024 * 1024)
    yield Peer(reader, writer)
    writer.close()


async def connected(client: ControllerClient) -> asyncio.Task[None]:
    """Run `client` until it has heard its first view, and go on running it."""
    heard = asyncio.Event()
    client.listen(lambda view: heard.set())
    running = asyncio.create_task(client.run())
    await asyncio.wait_for(heard.wait(), 5)
    return running


async def accept(command: Command) -> None:
    """A controller that carries out everything."""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "controller.sock"


def test_only_the_owner_may_open_the_socket(path: Path) -> None:
    def mode() -> int:
        return stat.S_IMODE(path.stat().st_mode)

    async def scenario() -> None:
        async with ControllerLink(path, accept):
            assert mode() == 0o600

    asyncio.run(scenario())
    assert not path.exists()


def test_a_socket_left_behind_is_replaced_and_a_live_one_is_not(path: Path) -> None:
    listen_on(path).close()
    assert path.is_socket()
    with listen_on(path), pytest.raises(SocketTakenError, match="another controller"):
        listen_on(path)


def test_a_path_too_long_for_the_system_is_said(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="longer than 107 bytes"):
        listen_on(tmp_path / ("x" * 107))


def test_who_connects_late_gets_the_newest_view(path: Path) -> None:
    async def scenario() -> None:
        async with ControllerLink(path, accept) as link:
            link.publish(example_view(tick=1))
            link.publish(example_view(tick=2))
            async with peer_of(path) as peer:
                assert (await peer.hear("view"))["view"] == example_view(tick=2).model_dump(mode="json")

    asyncio.run(scenario())


def test_that_nothing_has_happened_is_heard_and_is_not_said_of_a_later_view(path: Path) -> None:
    async def scenario() -> None:
        async with ControllerLink(path, accept) as link:
            link.publish(example_view(tick=1, time=100.0))
            client = ControllerClient(path)
            running = await connected(client)
            before, again = client.last_heard, asyncio.Event()
            client.listen(lambda view: again.set())
            link.publish_alive(100.5)
            await asyncio.wait_for(again.wait(), 5)
            assert client.view is not None
            assert (client.view.tick, client.view.time) == (1, 100.5)
            assert before is not None
            assert client.last_heard is not None
            assert client.last_heard > before
            link.publish(example_view(tick=2, time=101.0))
            late = ControllerClient(path)
            also = await connected(late)
            await asyncio.sleep(0.1)
            assert late.view is not None
            assert (late.view.tick, late.view.time) == (2, 101.0)
            for each in (running, also):
                each.cancel()

    asyncio.run(scenario())


def test_a_peer_gets_at_most_twenty_views_a_second_and_always_the_last(path: Path) -> None:
    async def scenario() -> None:
        async with ControllerLink(path, accept) as link, peer_of(path) as peer:
            begun = time.monotonic()
            for tick in range(100):
                link.publish(example_view(tick=tick))
                await asyncio.sleep(0.005)
            ticks = []
            while 99 not in ticks:
                ticks.append((await peer.hear("view"))["view"]["tick"])
            assert len(ticks) <= 20 * (time.monotonic() - begun) + 1
            assert ticks == sorted(set(ticks))

    asyncio.run(scenario())


def test_what_a_command_has_done_is_shown_before_it_is_answered(path: Path) -> None:
    async def scenario() -> None:
        async def handle(command: Command) -> None:
            link.publish(example_view(tick=command_tick))

        async with ControllerLink(path, handle) as link, peer_of(path) as peer:
            for command_tick in range(10, 15):  # sooner after each other than views are shown
                peer.writer.write(json.dumps({"kind": "command", "id": 1, "command": COMMAND}).encode() + b"\n")
                seen: list[int] = []
                while (message := json.loads(await peer.reader.readline()))["kind"] != "reply":
                    seen.append(message["view"]["tick"])
                assert seen[-1:] == [command_tick]

    asyncio.run(scenario())


def test_a_peer_that_does_not_read_blocks_nobody(path: Path) -> None:
    large = example_view().plan.model_copy(update={"reason": "x" * 500_000})

    async def scenario() -> None:
        async with ControllerLink(path, accept) as link, peer_of(path) as stuck, peer_of(path) as peer:
            transport = cast(asyncio.Transport, stuck.writer.transport)  # a socket's is for both ways
            transport.pause_reading()
            for tick in range(40):
                begun = time.monotonic()
                link.publish(example_view(tick=tick, plan=large))
                assert not TIMED or time.monotonic() - begun < 0.05
                while (await peer.hear("view"))["view"]["tick"] != tick:
                    pass
            transport.resume_reading()
            seen = []
            while 39 not in seen:
                seen.append((await stuck.hear("view"))["view"]["tick"])
            assert len(seen) < 10

    asyncio.run(scenario())


@pytest.mark.parametrize(
    ("line", "number"),
    [
        (b"", None),
        (b"nonsense", None),
        (b"\xff\xfe", None),
        (b"[" * 5000, None),
        (b'{"kind": "command", "id": true, "command": {}}', None),
        (b'{"kind": "command", "id": 5, "command": {"kind": "dance"}}', 5),
        (b'{"kind": "command", "id": 6, "command": {"kind": "set-mode", "mode": "paused"}}', 6),
        (b"x" * (LONGEST_COMMAND + 1), None),
        (b"x" * (5 * LONGEST_COMMAND), None),
    ],
)
def test_a_line_that_is_no_command_is_answered_and_the_connection_goes_on(
    path: Path, line: bytes, number: int | None
) -> None:
    heard: list[Command] = []

    async def handle(command: Command) -> None:
        heard.append(command)

    async def scenario() -> None:
        async with ControllerLink(path, handle), peer_of(path) as peer:
            reply = await peer.ask(line)
            assert (reply["ok"], reply["id"]) == (False, number)
            assert reply["problem"]["slug"] == "malformed-command"
            good = json.dumps({"kind": "command", "id": 17, "command": COMMAND}).encode()
            reply = await peer.ask(good)
            assert (reply["ok"], reply["id"]) == (True, 17)

    asyncio.run(scenario())
    assert heard == [SetMode(actor=ACTOR, mode=Mode.PAUSED)]


def test_a_command_that_was_begun_is_carried_out_though_its_sender_leaves(path: Path) -> None:
    done = asyncio.Event()
    begun = asyncio.Event()

    async def handle(command: Command) -> None:
        begun.set()
        await asyncio.sleep(0.1)
        done.set()

    async def scenario() -> None:
        async with ControllerLink(path, handle):
            async with peer_of(path) as peer:
                peer.writer.write(json.dumps({"kind": "command", "id": 1, "command": COMMAND}).encode() + b"\n")
                await begun.wait()
            await asyncio.wait_for(done.wait(), 2)

    asyncio.run(scenario())


def test_replies_find_their_commands_whatever_their_order(path: Path) -> None:
    async def handle(command: Command) -> None:
        if command.actor.name == "slow":
            await asyncio.sleep(0.1)
            raise CommandRefused("control-needed", message("refused.control-needed.holder", holder="Eva"))

    async def scenario() -> None:
        async with ControllerLink(path, handle) as link:
            link.publish(example_view())
            client = ControllerClient(path)
            running = await connected(client)
            slow = asyncio.create_task(client.send(SetMode(actor=named("slow"), mode=Mode.PAUSED)))
            await asyncio.sleep(0)
            await client.send(SetMode(actor=named("quick"), mode=Mode.PAUSED))
            assert not slow.done()
            with pytest.raises(CommandRefused, match="Eva is in control") as refused:
                await slow
            assert (refused.value.slug, refused.value.status) == ("control-needed", 409)
            assert refused.value.title.id == "refused.control-needed"
            assert refused.value.detail.arguments == {"holder": "Eva"}
            running.cancel()

    asyncio.run(scenario())


def test_a_controller_that_never_answers_is_given_up(path: Path) -> None:
    async def handle(command: Command) -> None:
        await asyncio.sleep(60)

    async def scenario() -> None:
        async with ControllerLink(path, handle) as link:
            link.publish(example_view())
            client = ControllerClient(path, reply_deadline=0.2)
            running = await connected(client)
            with pytest.raises(CommandRefused, match="not known") as refused:
                await client.send(SetMode(actor=ACTOR, mode=Mode.PAUSED))
            assert (refused.value.slug, refused.value.status) == ("controller-timeout", 504)
            running.cancel()

    asyncio.run(scenario())


def test_a_command_that_nobody_waits_for_any_more_is_not_carried_out(path: Path) -> None:
    """The controller stood still; whoever asked was told that nothing is known, and may have left."""
    heard: list[Command] = []

    async def handle(command: Command) -> None:
        heard.append(command)

    async def scenario() -> None:
        async with ControllerLink(path, handle), peer_of(path) as peer:
            late = {"kind": "command", "id": 1, "command": COMMAND, "expires": time.monotonic() - 0.1}
            assert (await peer.ask(json.dumps(late).encode()))["problem"]["slug"] == "command-expired"
            in_time = {**late, "id": 2, "expires": time.monotonic() + 5}
            assert (await peer.ask(json.dumps(in_time).encode()))["ok"]

    asyncio.run(scenario())
    assert heard == [SetMode(actor=ACTOR, mode=Mode.PAUSED)]


def test_a_view_that_cannot_be_dealt_with_does_not_deafen_the_server(path: Path) -> None:
    async def scenario() -> None:
        heard = {tick: asyncio.Event() for tick in (1, 2)}

        def stumble(view: StationView) -> None:
            heard[view.tick].set()
            if view.tick == 1:
                raise RuntimeError("a fault of the server")

        async with ControllerLink(path, accept) as link:
            client = ControllerClient(path)
            client.listen(stumble)
            link.publish(example_view(tick=1))
            running = asyncio.create_task(client.run())
            await asyncio.wait_for(heard[1].wait(), 5)
            link.publish(example_view(tick=2))
            await asyncio.wait_for(heard[2].wait(), 5)
            running.cancel()

    asyncio.run(scenario())


@given(st.lists(st.binary(max_size=12).map(lambda line: line.replace(b"\n", b"")), max_size=8), st.data())
def test_lines_do_not_depend_on_how_their_bytes_arrive(lines: list[bytes], data: st.DataObject) -> None:
    stream = b"".join(line + b"\n" for line in lines)

    async def read() -> list[bytes | None]:
        reader = asyncio.StreamReader()
        found: list[bytes | None] = []

        async def collect() -> None:
            found.extend([line async for line in read_lines(reader, longest=6)])

        collecting = asyncio.create_task(collect())
        rest = stream
        while rest:
            size = data.draw(st.integers(1, len(rest)))
            reader.feed_data(rest[:size])
            rest = rest[size:]
            await asyncio.sleep(0)
        reader.feed_eof()
        await collecting
        return found

    assert asyncio.run(read()) == [line if len(line) <= 6 else None for line in lines]
