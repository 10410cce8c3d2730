"""The controller's end of the local socket to the server.

The controller must never wait for whoever looks at it. `publish` only remembers the newest view; each peer has a task
that sends the newest view there is whenever the peer is ready for one, so a slow peer sees fewer views and never an
old one. Commands come back over the same connection and are handed to the controller one by one.

The link repeats nothing by itself: a view that is sent again would make a controller that hangs look alive. The
controller therefore calls `publish` at each change and at least every half second; a server that hears nothing for
two seconds calls the station's values old.
"""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType

import structlog

from sequence_planner.control.asks import Ask
from sequence_planner.control.commands import Command, CommandRefused
from sequence_planner.control.lines import read_lines
from sequence_planner.control.link_messages import (
    LONGEST_COMMAND,
    AliveMessage,
    AnswerMessage,
    AskMessage,
    CommandMessage,
    LinkMessage,
    NetworkMessage,
    Reply,
    ViewMessage,
    encode,
)
from sequence_planner.control.link_replies import MOST_ASKS, failed, late, read, refusal, too_many
from sequence_planner.control.network_view import NetworkView
from sequence_planner.control.unix_socket import listen_on
from sequence_planner.control.view import StationView
from sequence_planner.control.view_part import View

LOG = structlog.get_logger(__name__)
SHORTEST_INTERVAL = 0.05  # seconds between two views to the same peer
MOST_PEERS = 8
MOST_COMMANDS = 32  # of one peer, being carried out at the same time

# Carries a command out; false where the journal does not have it yet.
Handle = Callable[[Command], Awaitable[bool | None]]
Answer = Callable[[Ask], Awaitable[View]]


@dataclass(eq=False)
class _Peer:
    """A connection: what it was shown last of each kind, how many more commands it may give, and what it asks."""

    reader: asyncio.StreamReader
    writer: asyncio.StreamWriter
    shown: dict[str, bytes] = field(default_factory=dict)
    fresh: asyncio.Event = field(default_factory=asyncio.Event)
    slots: asyncio.Semaphore = field(default_factory=lambda: asyncio.Semaphore(MOST_COMMANDS))
    asks: set[asyncio.Task[None]] = field(default_factory=set)


async def _nothing_to_tell(ask: Ask) -> View:
    raise CommandRefused("preparing", "The station is being prepared", "Try again in a moment.", 503)


class ControllerLink:
    """Shows views to every peer and passes their commands to `handle`, what they ask to `answer`.

    Both raise `CommandRefused` to refuse. Used from one event loop, as `async with ControllerLink(...) as link`.
    """

    def __init__(self, path: Path, handle: Handle, answer: Answer = _nothing_to_tell) -> None:
        self.path = path
        self._handle = handle
        self._answer_to = answer
        self._newest: dict[str, LinkMessage] = {}  # by kind
        self._lines: dict[str, bytes] = {}  # the same, encoded once for all peers
        self._peers: set[_Peer] = set()
        self._connections: set[asyncio.Task[None]] = set()
        self._commands: set[asyncio.Task[None]] = set()
        self._server: asyncio.Server | None = None

    async def __aenter__(self) -> ControllerLink:
        """Listen; raises what `listen_on` raises."""
        listener = listen_on(self.path)
        self._server = await asyncio.start_unix_server(self._serve, sock=listener)
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close all connections and remove the socket file."""
        if self._server is not None:
            self._server.close()
        self.path.unlink(missing_ok=True)
        ending = [*self._connections, *self._commands]
        for task in ending:
            task.cancel()
        await asyncio.gather(*ending, return_exceptions=True)

    def publish(self, view: StationView) -> None:
        """Make `view` the one that is shown. Never blocks, whatever the peers do."""
        self._newest.pop("alive", None)  # that is of the view before
        self._lines.pop("alive", None)
        self._publish("view", ViewMessage(view=view))

    def publish_alive(self, time: float) -> None:
        """Nothing has happened since `publish`; see there."""
        self._publish("alive", AliveMessage(time=time))

    def publish_network(self, network: NetworkView) -> None:
        """Make `network` the one that is shown; see `publish`."""
        self._publish("network", NetworkMessage(network=network))

    def _publish(self, kind: str, message: LinkMessage) -> None:
        self._newest[kind] = message
        self._lines.pop(kind, None)
        for peer in self._peers:
            peer.fresh.set()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Live with one peer until it leaves."""
        task = asyncio.current_task()
        if task is None or len(self._peers) >= MOST_PEERS:
            writer.close()
            return
        peer = _Peer(reader, writer)
        # With no room in the transport, `drain` returns when the peer's kernel has it all: only then the next view.
        writer.transport.set_write_buffer_limits(high=0)
        self._peers.add(peer)
        self._connections.add(task)
        if self._newest:
            peer.fresh.set()
        showing = asyncio.create_task(self._show(peer))
        try:
            await self._listen(peer)
        except ConnectionError:
            pass
        except asyncio.CancelledError:
            pass  # the link is being closed, and this task ends here
        finally:
            self._peers.discard(peer)
            self._connections.discard(task)
            showing.cancel()
            for asking in peer.asks:
                asking.cancel()  # nobody waits for the answer any more
            writer.transport.abort()

    async def _show(self, peer: _Peer) -> None:
        """Send the newest of each kind whenever there is one and the peer takes it."""
        with contextlib.suppress(ConnectionError):
            while True:
                await peer.fresh.wait()
                await self._show_newest(peer)
                await asyncio.sleep(SHORTEST_INTERVAL)

    async def _show_newest(self, peer: _Peer) -> None:
        peer.fresh.clear()
        for kind in list(self._newest):
            line = self._encoded(kind) if kind in self._newest else None  # it may have been taken back meanwhile
            if line is not None and line is not peer.shown.get(kind):
                peer.shown[kind] = line
                peer.writer.write(line)
                await peer.writer.drain()

    def _encoded(self, kind: str) -> bytes:
        line = self._lines.get(kind)
        if line is None:
            line = self._lines[kind] = encode(self._newest[kind])
        return line

    async def _listen(self, peer: _Peer) -> None:
        """Start a task for each command; when the peer has too many under way, it is not read further.

        Asks have tasks of their own, so that no command ever waits for an answer that takes long.
        """
        async for line in read_lines(peer.reader, LONGEST_COMMAND):
            message = read(line)
            if isinstance(message, AskMessage):
                self._hear_ask(peer, message)
                continue
            await peer.slots.acquire()
            # Not a child of the connection: a command that was begun is carried out even if the peer leaves.
            task = asyncio.create_task(self._answer(peer, message))
            self._commands.add(task)
            task.add_done_callback(self._commands.discard)

    def _hear_ask(self, peer: _Peer, message: AskMessage) -> None:
        if len(peer.asks) >= MOST_ASKS:
            peer.writer.write(encode(refusal(message.id, too_many())))
            return
        task = asyncio.create_task(self._tell(peer, message))
        peer.asks.add(task)
        task.add_done_callback(peer.asks.discard)

    async def _tell(self, peer: _Peer, message: AskMessage) -> None:
        await _say(peer, await self._told(message))

    async def _answer(self, peer: _Peer, message: CommandMessage | Reply) -> None:
        try:
            if isinstance(message, CommandMessage):
                message = await self._carry_out(message)
                # Whoever asks for the station after the reply sees what the command has done.
                with contextlib.suppress(ConnectionError):
                    await self._show_newest(peer)
            await _say(peer, message)
        finally:
            peer.slots.release()

    async def _carry_out(self, message: CommandMessage) -> Reply:
        if message.expires is not None and time.monotonic() > message.expires:
            detail = "It came too late and was not carried out. Look at the station, then try again."
            return refusal(message.id, CommandRefused("command-expired", "The command came too late", detail))
        try:
            with structlog.contextvars.bound_contextvars(**_named(message.request)):
                recorded = await self._handle(message.command)
        except CommandRefused as refused:
            return refusal(message.id, refused)
        except Exception:
            LOG.exception("a command failed", command=message.command.kind)
            return refusal(message.id, failed("The command failed"))
        return Reply(id=message.id, ok=True, recorded=recorded is not False)

    async def _told(self, message: AskMessage) -> LinkMessage:
        try:
            async with asyncio.timeout(message.expires - time.monotonic()):
                view = await self._answer_to(message.ask)
        except TimeoutError:
            return refusal(message.id, late())
        except CommandRefused as refused:
            return refusal(message.id, refused)
        except Exception:
            LOG.exception("a question failed", about=message.ask.kind)
            return refusal(message.id, failed("The question could not be answered"))
        return AnswerMessage(id=message.id, answer=view.model_dump(mode="json"))


def _named(request: str | None) -> dict[str, str]:
    """What all that is logged meanwhile is to be found by."""
    return {} if request is None else {"request": request}


async def _say(peer: _Peer, message: LinkMessage) -> None:
    peer.writer.write(encode(message))
    with contextlib.suppress(ConnectionError):
        await peer.writer.drain()
