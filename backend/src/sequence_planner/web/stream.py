"""The WebSocket `/api/v1/stream`: the station as it changes.

Three tasks serve a client: one sends what its subscriber holds, one reads what the client says, and one sees whether
it still may listen. A client that takes no message for too long is closed with code 1013 ("try again later"); it may
come back and gets a snapshot. One whose session, key or watch has ended is closed with code 4401.
"""

from __future__ import annotations

import asyncio
import contextlib
from collections import Counter
from collections.abc import Iterator
from contextlib import AbstractContextManager, nullcontext
from typing import NamedTuple, Protocol

from fastapi import WebSocket, WebSocketDisconnect
from pydantic import ValidationError
from starlette.types import Message

from sequence_planner.actor import Actor
from sequence_planner.complaints import complained
from sequence_planner.identity.roles import Role, Scope
from sequence_planner.storage.error import StorageError
from sequence_planner.web.access import Access, allowed
from sequence_planner.web.broadcast import Broadcast, Subscriber
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import ProblemFound
from sequence_planner.web.settings import StreamLimits
from sequence_planner.web.stream_messages import Resync

LOOK_EVERY = 1.0  # seconds between looks at whether a client still may listen
LAST_WORDS = 30.0  # seconds in which a dropped client may still learn why

router = interface()


class Ending(NamedTuple):
    """Why the server closes a stream; `code` is that of RFC 6455, or of ours from 4000 on."""

    code: int
    reason: str


TOO_MANY, TOO_SLOW = Ending(1013, "too many clients"), Ending(1013, "too slow")
NO_DATABASE = Ending(1013, "the database is not available")
SIGNED_OUT = Ending(4401, "signed out")


class Source(Protocol):
    """What clients subscribe to."""

    limits: StreamLimits

    def subscription(self) -> AbstractContextManager[Subscriber | None]:
        """A subscriber for as long as the block lasts; None when there are too many already."""


@router.websocket("/stream", dependencies=[allowed(Role.VIEWER, scope=Scope.READ)])
async def stream(websocket: WebSocket) -> None:
    """Serve one client until it leaves or is dropped."""
    broadcast: Broadcast = websocket.app.state.broadcast
    await serve(websocket, broadcast)


async def serve(websocket: WebSocket, source: Source) -> None:
    """Serve one client of `source` until it leaves, is dropped, or may no longer listen."""
    await websocket.accept()
    with _counted(websocket, source.limits) as fits, source.subscription() if fits else nullcontext() as subscriber:
        ending = TOO_MANY if subscriber is None else await _converse(websocket, subscriber, source.limits)
    if ending is not None:
        with contextlib.suppress(TimeoutError, WebSocketDisconnect, RuntimeError):
            async with asyncio.timeout(LAST_WORDS):
                await websocket.close(ending.code, ending.reason)


@contextlib.contextmanager
def _counted(websocket: WebSocket, limits: StreamLimits) -> Iterator[bool]:
    """Count the stream; whether it is not one too many for who listens."""
    streams: Counter[str] = websocket.app.state.streams
    actor: Actor = websocket.state.actor
    streams[actor.id] += 1
    try:
        yield streams[actor.id] <= limits.of_one
    finally:
        streams[actor.id] -= 1
        if not streams[actor.id]:
            del streams[actor.id]


async def _converse(websocket: WebSocket, subscriber: Subscriber, limits: StreamLimits) -> Ending | None:
    """Serve until one of the tasks ends; why the server ends it, None if the client has left."""
    sending = asyncio.create_task(_send(websocket, subscriber, limits))
    listening = asyncio.create_task(_listen(websocket, subscriber, limits))
    watching = asyncio.create_task(_watch_over(websocket))
    tasks = (sending, listening, watching)
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        sent, listened, watched = await asyncio.gather(*tasks, return_exceptions=True)
    for outcome in (sent, listened, watched):
        if isinstance(outcome, Exception) and not isinstance(outcome, TimeoutError | WebSocketDisconnect):
            raise outcome
    if isinstance(watched, Ending):
        return watched
    return TOO_SLOW if isinstance(sent, TimeoutError) else None


async def _watch_over(websocket: WebSocket) -> Ending:
    """Look whether the client still may listen; why not, as soon as it may not."""
    access: Access = websocket.state.access
    while True:
        await asyncio.sleep(LOOK_EVERY)
        try:
            await access.admit(websocket)
        except ProblemFound:
            return SIGNED_OUT
        except StorageError:
            return NO_DATABASE


async def _send(websocket: WebSocket, subscriber: Subscriber, limits: StreamLimits) -> None:
    while True:
        message = await subscriber.next()
        async with asyncio.timeout(limits.send_seconds):
            await websocket.send_text(message)


async def _listen(websocket: WebSocket, subscriber: Subscriber, limits: StreamLimits) -> None:
    while True:
        frame = await websocket.receive()
        if frame["type"] == "websocket.disconnect":
            return
        if (wrong := _fault(frame, limits.frame)) is not None:
            subscriber.complain(wrong)
        else:
            subscriber.resync()  # the only thing that a client can ask for


def _fault(frame: Message, longest: int) -> str | None:
    """What is wrong with a frame; None when it is a message of ours."""
    text = frame.get("text")
    if text is None:
        return "Binary frames are not understood; send JSON text."
    if len(text) > longest:
        return f"The frame is longer than {longest} characters."
    try:
        Resync.model_validate_json(text)
    except ValidationError as error:
        first = error.errors()[0]
        if first["type"] == "json_invalid":
            return "The frame is not JSON."
        place = ".".join(map(str, first["loc"])) or "the frame"
        return f'Only {{"kind": "resync"}} is understood. {place}: {complained(first)}.'
    return None
