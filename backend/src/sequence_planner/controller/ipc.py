"""Local socket between controller and server: both ends, framing, message types and error replies."""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import json
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import Annotated, Any, Literal, TypeVar

import structlog
from pydantic import Field, JsonValue, TypeAdapter, ValidationError

from sequence_planner.controller.commands.command import Command, CommandRefused, Query, TextPlace
from sequence_planner.controller.commands.registry import AnyCommand, AnyQuery
from sequence_planner.controller.views.details import NetworkView
from sequence_planner.controller.views.station import StationView
from sequence_planner.core.data_models import DataModel
from sequence_planner.process.unix_socket import listen_on
from sequence_planner.texts.message import Message, message

# Lines from a byte stream, of bounded length.
#
# Both ends of the local socket speak newline-delimited JSON: one document per line. A peer that never ends its line
# must not fill the memory, and must not lose the connection either: the rest of an overlong line is skipped up to its
# end, its place is taken by `None`, and reading goes on with the next one.

CHUNK = 64 * 1024


async def read_lines(reader: asyncio.StreamReader, longest: int) -> AsyncIterator[bytes | None]:
    """Yield each line without its newline; `None` stands for one of more than `longest` bytes.

    Ends when the peer closes; an unfinished last line is dropped, because a document cut short means nothing.
    """
    buffer = bytearray()
    skipping = False
    while chunk := await reader.read(CHUNK):
        buffer += chunk
        while (end := buffer.find(b"\n")) >= 0:
            line = bytes(buffer[:end])
            del buffer[: end + 1]
            yield None if skipping or len(line) > longest else line
            skipping = False
        if len(buffer) > longest:
            skipping = True
            buffer.clear()


# What passes between the controller and the server: views one way, commands and wishes the other, with their replies.
#
# Each message is one line of JSON on a Unix domain socket. A command's `id` is chosen by the server and comes back in
# the reply; it is null in the reply to a line in which no id could be found.

LONGEST_COMMAND = 2 * 1024 * 1024  # bytes in a line from the server: that of the order between many jobs is the longest
LONGEST_VIEW = 16 * 1024 * 1024  # bytes in a line from the controller


class LinkMessage(DataModel):
    """Base of all messages: immutable, and nothing beside what is declared."""


class Refusal(LinkMessage):
    """`CommandRefused` on its way to the server."""

    slug: str
    title: Message
    detail: Message
    status: int
    place: TextPlace | None = None

    @classmethod
    def of(cls, refused: CommandRefused) -> Refusal:
        """Write down a refusal."""
        return cls(
            slug=refused.slug,
            title=refused.title,
            detail=refused.detail,
            status=refused.status,
            place=refused.place,
        )

    def error(self) -> CommandRefused:
        """Make the exception again that the controller raised."""
        return CommandRefused(self.slug, self.detail, self.status, title=self.title, place=self.place)


class ViewMessage(LinkMessage):
    """The whole document as it is now."""

    kind: Literal["view"] = "view"
    view: StationView


class AliveMessage(LinkMessage):
    """Nothing has happened since the document that came last: it is still so, at this time."""

    kind: Literal["alive"] = "alive"
    time: float


class NetworkMessage(LinkMessage):
    """The ROS graph as it is now; sent when it has changed."""

    kind: Literal["network"] = "network"
    network: NetworkView


class AnswerMessage(LinkMessage):
    """The answer to an ask: a document of its `answer_type`, to who asked for it."""

    kind: Literal["answer"] = "answer"
    id: int
    answer: dict[str, JsonValue]


class Reply(LinkMessage):
    """A message about what became of a command, or that an ask is refused; `problem` is there when `ok` is false.

    `recorded` is false as long as the journal does not have what was carried out. `made` is the document of what a
    command `makes`.
    """

    kind: Literal["reply"] = "reply"
    id: int | None
    ok: bool
    recorded: bool = True
    made: dict[str, JsonValue] | None = None
    problem: Refusal | None = None


class CommandMessage(LinkMessage):
    """A command and the number under which its reply is awaited.

    `expires` is when nobody waits for it any more, in seconds of `time.monotonic`, which all processes of a machine
    share: a controller that stood still must not start production long after the person who asked for it has left.
    `request` is the number under which the server's log has what the command came from.
    """

    kind: Literal["command"] = "command"
    id: int = Field(ge=0)
    command: AnyCommand
    expires: float | None = None
    request: str | None = Field(default=None, max_length=64)


class AskMessage(LinkMessage):
    """A wish to be told what is not shown unasked, and the number under which the answer is awaited.

    `expires` is when nobody waits for it any more; see `CommandMessage`.
    """

    kind: Literal["ask"] = "ask"
    id: int = Field(ge=0)
    ask: AnyQuery
    expires: float


FromController = ViewMessage | AliveMessage | NetworkMessage | Reply | AnswerMessage
FROM_CONTROLLER: TypeAdapter[FromController] = TypeAdapter(Annotated[FromController, Field(discriminator="kind")])
FromServer = CommandMessage | AskMessage
FROM_SERVER: TypeAdapter[FromServer] = TypeAdapter(Annotated[FromServer, Field(discriminator="kind")])


def encode(message: LinkMessage) -> bytes:
    """One line of JSON. Null members of the message itself stay: a view's nulls mean "unknown"."""
    return message.model_dump_json().encode() + b"\n"


# What the controller replies to lines that it cannot read, and to what it does not carry out.

MOST_ASKS = 16  # of one peer, waiting for their answers at the same time


def read(line: bytes | None) -> FromServer | Reply:
    """Return what the server says, or the reply to what cannot be read."""
    if line is None:
        return refusal(None, malformed(message("refused.malformed-command.too-long", longest=LONGEST_COMMAND)))
    try:
        return FROM_SERVER.validate_json(line)
    except ValidationError as error:
        places = ", ".join(".".join(map(str, each["loc"])) or "the line" for each in error.errors()[:5])
        return refusal(_id_in(line), malformed(message("refused.malformed-command.places", places=places)))


def too_many() -> CommandRefused:
    """Somebody asks too much at once."""
    return CommandRefused("controller-busy", message("refused.controller-busy.most", most=MOST_ASKS), 503)


def late() -> CommandRefused:
    """Nobody waits for the answer any more."""
    return CommandRefused("answer-timeout", message("refused.answer-timeout.again"), 504)


def failed() -> CommandRefused:
    """The controller has met an error of its own."""
    return CommandRefused("controller-error", message("refused.controller-error.log"), 500)


def malformed(detail: Message) -> CommandRefused:
    """Return the refusal of something that came and is no message."""
    return CommandRefused("malformed-command", detail, 422)


def expired() -> CommandRefused:
    """Nobody waited any more for a command when it came."""
    return CommandRefused("command-expired", message("refused.command-expired.look"))


def refusal(command: int | None, refused: CommandRefused) -> Reply:
    """The reply that refuses what came under this number."""
    return Reply(id=command, ok=False, problem=Refusal.of(refused))


def _id_in(line: bytes) -> int | None:
    """The id in a message that is otherwise wrong, so that whoever waits for its reply gets it."""
    try:
        found = json.loads(line)
    except (ValueError, RecursionError):
        return None
    number = found.get("id") if isinstance(found, dict) else None
    return number if isinstance(number, int) and not isinstance(number, bool) else None


# The controller's end of the local socket to the server.
#
# The controller must never wait for whoever looks at it. `publish` only remembers the newest view; each peer has a task
# that sends the newest view there is whenever the peer is ready for one, so a slow peer sees fewer views and never an
# old one. Commands come back over the same connection and are handed to the controller one by one.
#
# The link repeats nothing by itself: a view that is sent again would make a controller that hangs look alive. The
# controller therefore calls `publish` at each change and at least every half second; a server that hears nothing for
# two seconds calls the station's values old.

LOG = structlog.get_logger(__name__)
SHORTEST_INTERVAL = 0.05  # seconds between two views to the same peer
MOST_PEERS = 8
MOST_COMMANDS = 32  # of one peer, being carried out at the same time


@dataclass(frozen=True)
class CarriedOut:
    """A command was, and perhaps `made` something; whether the journal has it."""

    recorded: bool = True
    made: DataModel | None = None


Handle = Callable[[Command], Awaitable[CarriedOut | None]]
Answer = Callable[[Query[Any]], Awaitable[DataModel]]


@dataclass(eq=False)
class _Peer:
    """A connection: what it was shown last of each kind, how many more commands it may give, and what it asks."""

    reader: asyncio.StreamReader
    writer: asyncio.StreamWriter
    shown: dict[str, bytes] = field(default_factory=dict)
    fresh: asyncio.Event = field(default_factory=asyncio.Event)
    slots: asyncio.Semaphore = field(default_factory=lambda: asyncio.Semaphore(MOST_COMMANDS))
    asks: set[asyncio.Task[None]] = field(default_factory=set)


async def _nothing_to_tell(ask: Query[Any]) -> DataModel:
    raise CommandRefused("preparing", message("refused.preparing.again"), 503)


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
            return refusal(message.id, expired())
        try:
            with structlog.contextvars.bound_contextvars(**_named(message.request)):
                done = await self._handle(message.command) or CarriedOut()
        except CommandRefused as refused:
            return refusal(message.id, refused)
        except Exception:
            LOG.exception("a command failed", command=message.command.kind)
            return refusal(message.id, failed())
        made = None if done.made is None else done.made.model_dump(mode="json")
        return Reply(id=message.id, ok=True, recorded=done.recorded, made=made)

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
            return refusal(message.id, failed())
        return AnswerMessage(id=message.id, answer=view.model_dump(mode="json"))


def _named(request: str | None) -> dict[str, str]:
    """Return what all that is logged meanwhile is to be found by."""
    return {} if request is None else {"request": request}


async def _say(peer: _Peer, message: LinkMessage) -> None:
    peer.writer.write(encode(message))
    with contextlib.suppress(ConnectionError):
        await peer.writer.drain()


# The server's end of the local socket to the controller.
#
# The server holds no state of the station: it knows the last view it was sent, and when. As soon as the controller has
# been silent for two seconds that view is old, and nobody is shown it any more. The client connects for ever, so either
# process may be started, killed and started again in any order.

Heard = Reply | AnswerMessage
Told = TypeVar("Told", bound=DataModel)

SILENCE = 2.0  # seconds without a view after which the controller counts as lost
FIRST_WAIT, LONGEST_WAIT = 0.05, 1.0  # seconds between attempts to connect
REPLY_DEADLINE = 5.0  # seconds
_A_LITTLE = 0.01  # seconds, so that it is over when it is looked at
ON_THE_WAY = 0.5  # seconds that an answer may need back to us, beyond the patience of who asks


class ControllerClient:
    """A client with what is known of the controller, and the way to command it; `run` keeps it connected."""

    def __init__(self, path: Path, *, reply_deadline: float = REPLY_DEADLINE) -> None:
        self.path = path
        self.view: StationView | None = None
        self.last_heard: float | None = None  # on the clock of `time.monotonic`
        self._moved: float | None = None  # when the time of the view was another one than before, on that clock
        self._reply_deadline = reply_deadline
        self.network: NetworkView | None = None
        self._listeners: list[Callable[[StationView], None]] = []
        self._network_listeners: list[Callable[[NetworkView], None]] = []
        self._silence_listeners: list[Callable[[], None]] = []
        self._looking: asyncio.TimerHandle | None = None  # for silence, while it is heard
        self._writer: asyncio.StreamWriter | None = None
        self._numbers = itertools.count(1)
        self._awaited: dict[int, asyncio.Future[Heard]] = {}

    @property
    def connected(self) -> bool:
        """True if there is a connection; a controller that hangs keeps its own."""
        return self._writer is not None

    @property
    def stands_by(self) -> bool:
        """True if another station commands, with which this one shares its database."""
        standby = None if self.view is None else self.view.standby
        return standby is not None and not standby.active

    @property
    def heard(self) -> bool:
        """True if a view came within the last two seconds."""
        return self.last_heard is not None and time.monotonic() - self.last_heard <= SILENCE

    @property
    def age(self) -> float | None:
        """Seconds since the controller's time was seen to move; None where it never was."""
        return None if self._moved is None else time.monotonic() - self._moved

    def listen(self, listener: Callable[[StationView], None]) -> None:
        """Call `listener` with each view as it arrives; it must not block."""
        self._listeners.append(listener)

    def listen_to_network(self, listener: Callable[[NetworkView], None]) -> None:
        """Call `listener` with the ROS graph whenever it has changed; it must not block."""
        self._network_listeners.append(listener)

    def listen_to_silence(self, listener: Callable[[], None]) -> None:
        """Call `listener` when the controller is heard no more, or its ROS graph is not; it must not block."""
        self._silence_listeners.append(listener)

    async def run(self) -> None:
        """Stay connected until cancelled."""
        wait = FIRST_WAIT
        while True:
            try:
                reader, self._writer = await asyncio.open_unix_connection(str(self.path))
                await self._receive(reader)
                wait = FIRST_WAIT
            except OSError:
                pass  # not there yet, or gone: nothing to do but to try again
            except Exception:  # else nobody would ever hear the controller again
                LOG.exception("a message of the controller cannot be dealt with")
            finally:
                self._forget_connection()
                self._tell_silence()
            await asyncio.sleep(wait)
            wait = min(2 * wait, LONGEST_WAIT)

    async def send(self, command: Command) -> bool:
        """Have `command` carried out; returns when it was, and whether the journal has it.

        Raises `CommandRefused`: with the controller's own words, `controller-unavailable` (503) when it was never
        sent, `controller-timeout` (504) when it is not known what became of it.
        """
        return (await self._send(command)).recorded

    async def produce(self, command: Command) -> DataModel:
        """Have `command` carried out, and return what it made. Raises `CommandRefused` as `send` does."""
        assert command.makes is not None
        return command.makes.model_validate((await self._send(command)).made)

    async def _send(self, command: Command) -> Reply:
        expires = time.monotonic() + self._reply_deadline
        request: str | None = structlog.contextvars.get_contextvars().get("request")
        unknown = message("refused.controller-timeout.command")
        reply = await self._exchange(
            lambda number: CommandMessage(id=number, command=command, expires=expires, request=request),
            self._reply_deadline,
            unknown,
        )
        assert isinstance(reply, Reply)
        return reply

    async def ask(self, ask: Query[Told]) -> Told:
        """Return what answers `ask`. Raises `CommandRefused` as `send` does; asking has changed nothing then."""
        patience = self._reply_deadline if ask.patience is None else ask.patience
        expires = time.monotonic() + patience
        answer = await self._exchange(
            lambda number: AskMessage(id=number, ask=ask, expires=expires),
            patience + ON_THE_WAY,
            message("refused.controller-timeout.question"),
        )
        assert isinstance(answer, AnswerMessage)
        return ask.answer_type().model_validate(answer.answer)

    async def _exchange(self, numbered: Callable[[int], LinkMessage], deadline: float, silence: Message) -> Heard:
        """Send a message and wait for what comes back under its number. Raises `CommandRefused`.

        `silence` says what to make of it when nothing comes back within `deadline` seconds.
        """
        writer = self._writer
        if writer is None:
            raise CommandRefused("controller-unavailable", message("refused.controller-unavailable.not-sent"), 503)
        number = next(self._numbers)
        awaited: asyncio.Future[Heard] = asyncio.get_running_loop().create_future()
        self._awaited[number] = awaited
        try:
            async with asyncio.timeout(deadline):
                writer.write(encode(numbered(number)))
                await writer.drain()
                answer = await awaited
        except (TimeoutError, ConnectionError) as error:
            raise CommandRefused("controller-timeout", silence, 504) from error
        finally:
            self._awaited.pop(number, None)
        if isinstance(answer, Reply) and not answer.ok and answer.problem is not None:
            raise answer.problem.error()
        return answer

    async def _receive(self, reader: asyncio.StreamReader) -> None:
        async for line in read_lines(reader, LONGEST_VIEW):
            try:
                message = FROM_CONTROLLER.validate_json(line or b"")
            except ValidationError as error:
                LOG.warning("a line of the controller cannot be read", errors=error.error_count())
                continue
            if isinstance(message, ViewMessage):
                self._hear(message.view)
            elif isinstance(message, AliveMessage):
                if self.view is not None:
                    self._hear(self.view.model_copy(update={"time": message.time}))
            elif isinstance(message, NetworkMessage):
                self.network = message.network
                for each in self._network_listeners:
                    each(message.network)
            else:
                self._answered(message)

    def _hear(self, view: StationView) -> None:
        now = time.monotonic()
        if self.view is not None and self.view.time != view.time:
            self._moved = now
        self.view, self.last_heard = view, now
        if self._looking is None:
            self._look_for_silence()
        for listener in self._listeners:
            listener(view)

    def _look_for_silence(self) -> None:
        """Look again when it would have fallen silent by then."""
        self._looking = None
        if self.last_heard is not None and self.heard:
            left = self.last_heard + SILENCE - time.monotonic()
            self._looking = asyncio.get_running_loop().call_later(left + _A_LITTLE, self._look_for_silence)
        else:
            self._tell_silence()

    def _tell_silence(self) -> None:
        for each in self._silence_listeners:
            each()

    def _answered(self, answer: Heard) -> None:
        awaited = None if answer.id is None else self._awaited.get(answer.id)
        if awaited is not None and not awaited.done():
            awaited.set_result(answer)

    def _forget_connection(self) -> None:
        if self._writer is not None:
            with contextlib.suppress(OSError):
                self._writer.close()
        self._writer = None
        self.network = None  # that of another controller may be another one
        for answer in self._awaited.values():
            if not answer.done():
                answer.set_exception(ConnectionResetError("the controller went away"))
