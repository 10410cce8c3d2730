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
import json
import time
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType

import structlog
from pydantic import ValidationError

from sequence_planner.control.commands import Command, CommandRefused
from sequence_planner.control.lines import read_lines
from sequence_planner.control.link_messages import (
    LONGEST_COMMAND,
    CommandMessage,
    Refusal,
    Reply,
    ViewMessage,
    encode,
)
from sequence_planner.control.unix_socket import listen_on
from sequence_planner.control.view import StationView

LOG = structlog.get_logger(__name__)
SHORTEST_INTERVAL = 0.05  # seconds between two views to the same peer
MOST_PEERS = 8
MOST_COMMANDS = 32  # of one peer, being carried out at the same time

Handle = Callable[[Command], Awaitable[None]]


@dataclass(eq=False)
class _Peer:
    """A connection: what it still has to be shown, and how many more commands it may give."""

    reader: asyncio.StreamReader
    writer: asyncio.StreamWriter
    fresh: asyncio.Event = field(default_factory=asyncio.Event)
    slots: asyncio.Semaphore = field(default_factory=lambda: asyncio.Semaphore(MOST_COMMANDS))


class ControllerLink:
    """Shows views to every peer and passes their commands to `handle`, which raises `CommandRefused` to refuse.

    Used from one event loop, as `async with ControllerLink(path, handle) as link`.
    """

    def __init__(self, path: Path, handle: Handle) -> None:
        self.path = path
        self._handle = handle
        self._view: StationView | None = None
        self._line: bytes | None = None  # the view, encoded once for all peers
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
        self._view, self._line = view, None
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
        if self._view is not None:
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
            writer.transport.abort()

    async def _show(self, peer: _Peer) -> None:
        """Send the newest view whenever there is one and the peer takes it."""
        with contextlib.suppress(ConnectionError):
            while True:
                await peer.fresh.wait()
                peer.fresh.clear()
                peer.writer.write(self._encoded())
                await peer.writer.drain()
                await asyncio.sleep(SHORTEST_INTERVAL)

    def _encoded(self) -> bytes:
        if self._line is None:
            if self._view is None:
                raise RuntimeError("a peer was told of a view before there was one")
            self._line = encode(ViewMessage(view=self._view))
        return self._line

    async def _listen(self, peer: _Peer) -> None:
        """Start a task for each command; when the peer has too many under way, it is not read further."""
        async for line in read_lines(peer.reader, LONGEST_COMMAND):
            await peer.slots.acquire()
            # Not a child of the connection: a command that was begun is carried out even if the peer leaves.
            task = asyncio.create_task(self._answer(peer, line))
            self._commands.add(task)
            task.add_done_callback(self._commands.discard)

    async def _answer(self, peer: _Peer, line: bytes | None) -> None:
        try:
            reply = await self._carry_out(line)
            peer.writer.write(encode(reply))
            with contextlib.suppress(ConnectionError):
                await peer.writer.drain()
        finally:
            peer.slots.release()

    async def _carry_out(self, line: bytes | None) -> Reply:
        if line is None:
            return _refused(None, _malformed(f"The line is longer than {LONGEST_COMMAND} bytes."))
        try:
            message = CommandMessage.model_validate_json(line)
        except ValidationError as error:
            places = ", ".join(".".join(map(str, each["loc"])) or "the line" for each in error.errors()[:5])
            return _refused(_id_in(line), _malformed(f"Not a command of this controller: see {places}."))
        if message.expires is not None and time.monotonic() > message.expires:
            detail = "It came too late and was not carried out. Look at the station, then try again."
            return _refused(message.id, CommandRefused("command-expired", "The command came too late", detail))
        try:
            await self._handle(message.command)
        except CommandRefused as refused:
            return _refused(message.id, refused)
        except Exception:
            LOG.exception("a command failed", command=message.command.kind)
            detail = "The controller met an error of its own; it is written in the controller's log."
            return _refused(message.id, CommandRefused("controller-error", "The command failed", detail, 500))
        return Reply(id=message.id, ok=True)


def _malformed(detail: str) -> CommandRefused:
    return CommandRefused("malformed-command", "The command cannot be read", detail, 422)


def _refused(command: int | None, refused: CommandRefused) -> Reply:
    return Reply(id=command, ok=False, problem=Refusal.of(refused))


def _id_in(line: bytes) -> int | None:
    """The id in a message that is otherwise wrong, so that whoever waits for its reply gets it."""
    try:
        found = json.loads(line)
    except (ValueError, RecursionError):
        return None
    number = found.get("id") if isinstance(found, dict) else None
    return number if isinstance(number, int) and not isinstance(number, bool) else None
