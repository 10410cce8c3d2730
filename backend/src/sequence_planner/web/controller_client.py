"""The server's end of the local socket to the controller.

The server holds no state of the station: it knows the last view it was sent, and when. As soon as the controller has
been silent for two seconds that view is old, and nobody is shown it any more. The client connects for ever, so either
process may be started, killed and started again in any order.
"""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import structlog
from pydantic import ValidationError

from sequence_planner.control.asks import AskBase
from sequence_planner.control.commands import Command, CommandRefused
from sequence_planner.control.lines import read_lines
from sequence_planner.control.link_messages import (
    FROM_CONTROLLER,
    LONGEST_VIEW,
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
from sequence_planner.control.network_view import NetworkView
from sequence_planner.control.view import StationView
from sequence_planner.control.view_part import View

Heard = Reply | AnswerMessage
Told = TypeVar("Told", bound=View)

LOG = structlog.get_logger(__name__)
SILENCE = 2.0  # seconds without a view after which the controller counts as lost
FIRST_WAIT, LONGEST_WAIT = 0.05, 1.0  # seconds between attempts to connect
REPLY_DEADLINE = 5.0  # seconds
_A_LITTLE = 0.01  # seconds, so that it is over when it is looked at
ON_THE_WAY = 0.5  # seconds that an answer may need back to us, beyond the patience of who asks


class ControllerClient:
    """What is known of the controller, and the way to command it; `run` keeps it connected."""

    def __init__(self, path: Path, *, reply_deadline: float = REPLY_DEADLINE) -> None:
        self.path = path
        self.view: StationView | None = None
        self.last_heard: float | None = None  # on the clock of `time.monotonic`
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
        """Whether there is a connection; a controller that hangs keeps its own."""
        return self._writer is not None

    @property
    def stands_by(self) -> bool:
        """Whether another station commands, with which this one shares its database."""
        standby = None if self.view is None else self.view.standby
        return standby is not None and not standby.active

    @property
    def heard(self) -> bool:
        """Whether a view came within the last two seconds."""
        return self.last_heard is not None and time.monotonic() - self.last_heard <= SILENCE

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
        sent, `controller-no-answer` (504) when it is not known what became of it.
        """
        expires = time.monotonic() + self._reply_deadline
        request: str | None = structlog.contextvars.get_contextvars().get("request")
        unknown = "It is not known whether the command was carried out: look at the station before trying again."
        reply = await self._exchange(
            lambda number: CommandMessage(id=number, command=command, expires=expires, request=request),
            self._reply_deadline,
            unknown,
        )
        return not isinstance(reply, Reply) or reply.recorded

    async def ask(self, ask: AskBase[Told]) -> Told:
        """What answers `ask`. Raises `CommandRefused` as `send` does; asking has changed nothing then."""
        patience = self._reply_deadline if ask.patience is None else ask.patience
        expires = time.monotonic() + patience
        answer = await self._exchange(
            lambda number: AskMessage.model_validate({"id": number, "ask": ask, "expires": expires}),
            patience + ON_THE_WAY,
            "Nothing was changed by asking; try again.",
        )
        assert isinstance(answer, AnswerMessage)
        return ask.answer_type().model_validate(answer.answer)

    async def _exchange(self, message: Callable[[int], LinkMessage], deadline: float, silence: str) -> Heard:
        """Send a message and wait for what comes back under its number. Raises `CommandRefused`.

        `silence` says what to make of it when nothing comes back within `deadline` seconds.
        """
        writer = self._writer
        if writer is None:
            raise CommandRefused(
                "controller-unavailable",
                "The controller is not there",
                "Nothing was sent. Start the controller, then try again.",
                503,
            )
        number = next(self._numbers)
        awaited: asyncio.Future[Heard] = asyncio.get_running_loop().create_future()
        self._awaited[number] = awaited
        try:
            async with asyncio.timeout(deadline):
                writer.write(encode(message(number)))
                await writer.drain()
                answer = await awaited
        except (TimeoutError, ConnectionError) as error:
            raise CommandRefused(
                "controller-no-answer",
                "The controller did not answer",
                silence,
                504,
            ) from error
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
        self.view, self.last_heard = view, time.monotonic()
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
