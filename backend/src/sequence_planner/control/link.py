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
    FROM_SERVER,
    LONGEST_COMMAND,
    About,
    AskMessage,
    FlowsAnswer,
    LinkMessage,
    NetworkMessage,
    PipelinesAnswer,
    Refusal,
    Reply,
    ViewMessage,
    encode,
)
from sequence_planner.control.network_view import NetworkView
from sequence_planner.control.pipeline_view import FlowsView, PipelinesView
from sequence_planner.control.unix_socket import listen_on
from sequence_planner.control.view import StationView

LOG = structlog.get_logger(__name__)
SHORTEST_INTERVAL = 0.05  # seconds between two views to the same peer
MOST_PEERS = 8
MOST_COMMANDS = 32  # of one peer, being carried out at the same time

Handle = Callable[[Command], Awaitable[None]]
Answer = Callable[[About], PipelinesView | FlowsView]


@dataclass(eq=False)
class _Peer:
    """A connection: what it was shown last of each kind, and how many more commands it may give."""

    reader: asyncio.StreamReader
    writer: asyncio.StreamWriter
    shown: dict[str, bytes] = field(default_factory=dict)
    fresh: asyncio.Event = field(default_factory=asyncio.Event)
    slots: asyncio.Semaphore = field(default_factory=lambda: asyncio.Semaphore(MOST_COMMANDS))


def _nothing_to_tell(about: About) -> PipelinesView | FlowsView:
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
        self._publish("view", ViewMessage(view=view))

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
            writer.transport.abort()

    async def _show(self, peer: _Peer) -> None:
        """Send the newest of each kind whenever there is one and the peer takes it."""
        with contextlib.suppress(ConnectionError):
            while True:
                await peer.fresh.wait()
                peer.fresh.clear()
                for kind in list(self._newest):
                    line = self._encoded(kind)
                    if line is not peer.shown.get(kind):
                        peer.shown[kind] = line
                        peer.writer.write(line)
                        await peer.writer.drain()
                await asyncio.sleep(SHORTEST_INTERVAL)

    def _encoded(self, kind: str) -> bytes:
        line = self._lines.get(kind)
        if line is None:
            line = self._lines[kind] = encode(self._newest[kind])
        return line

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

    async def _carry_out(self, line: bytes | None) -> LinkMessage:
        if line is None:
            return _refused(None, _malformed(f"The line is longer than {LONGEST_COMMAND} bytes."))
        try:
            message = FROM_SERVER.validate_json(line)
        except ValidationError as error:
            places = ", ".join(".".join(map(str, each["loc"])) or "the line" for each in error.errors()[:5])
            return _refused(_id_in(line), _malformed(f"Not a command of this controller: see {places}."))
        if isinstance(message, AskMessage):
            return self._told(message)
        if message.expires is not None and time.monotonic() > message.expires:
            detail = "It came too late and was not carried out. Look at the station, then try again."
            return _refused(message.id, CommandRefused("command-expired", "The command came too late", detail))
        try:
            await self._handle(message.command)
        except CommandRefused as refused:
            return _refused(message.id, refused)
        except Exception:
            LOG.exception("a command failed", command=message.command.kind)
            return _refused(message.id, _failed("The command failed"))
        return Reply(id=message.id, ok=True)

    def _told(self, message: AskMessage) -> LinkMessage:
        try:
            view = self._answer_to(message.about)
        except CommandRefused as refused:
            return _refused(message.id, refused)
        except Exception:
            LOG.exception("a question failed", about=message.about)
            return _refused(message.id, _failed("The question could not be answered"))
        if isinstance(view, PipelinesView):
            return PipelinesAnswer(id=message.id, view=view)
        return FlowsAnswer(id=message.id, view=view)


def _failed(title: str) -> CommandRefused:
    detail = "The controller met an error of its own; it is written in the controller's log."
    return CommandRefused("controller-error", title, detail, 500)


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
