"""The WebSocket `/api/v1/stream`: the station as it changes.

Two tasks serve a client: one sends what its subscriber holds, one reads what the client says. A client that takes no
message for too long is closed with code 1013 ("try again later"); it may come back and gets a snapshot.
"""

from __future__ import annotations

import asyncio
import contextlib
from contextlib import AbstractContextManager
from typing import Protocol

from fastapi import APIRouter, WebSocket, WebSocketDisconnect
from pydantic import ValidationError
from starlette.types import Message

from sequence_planner.web.broadcast import Broadcast, Subscriber
from sequence_planner.web.settings import StreamLimits
from sequence_planner.web.stream_messages import ClientMessage

TRY_AGAIN_LATER = 1013
LAST_WORDS = 30.0  # seconds in which a dropped client may still learn why

router = APIRouter()


class Source(Protocol):
    """What clients subscribe to."""

    limits: StreamLimits

    def subscription(self) -> AbstractContextManager[Subscriber | None]:
        """A subscriber for as long as the block lasts; None when there are too many already."""


@router.websocket("/stream")
async def stream(websocket: WebSocket) -> None:
    """Serve one client until it leaves or is dropped."""
    broadcast: Broadcast = websocket.app.state.broadcast
    await serve(websocket, broadcast)


async def serve(websocket: WebSocket, source: Source) -> None:
    """Serve one client of `source` until it leaves or is dropped."""
    await websocket.accept()
    with source.subscription() as subscriber:
        if subscriber is not None:
            dropped = await _converse(websocket, subscriber, source.limits)
        reason = "too many clients" if subscriber is None else "too slow"
    if subscriber is None or dropped:
        with contextlib.suppress(TimeoutError, WebSocketDisconnect, RuntimeError):
            async with asyncio.timeout(LAST_WORDS):
                await websocket.close(TRY_AGAIN_LATER, reason)


async def _converse(websocket: WebSocket, subscriber: Subscriber, limits: StreamLimits) -> bool:
    """Send and listen until one of them ends; true if the client is too slow."""
    sending = asyncio.create_task(_send(websocket, subscriber, limits))
    listening = asyncio.create_task(_listen(websocket, subscriber, limits))
    try:
        await asyncio.wait({sending, listening}, return_when=asyncio.FIRST_COMPLETED)
    finally:
        sending.cancel()
        listening.cancel()
        ended = await asyncio.gather(sending, listening, return_exceptions=True)
    for outcome in ended:
        if isinstance(outcome, Exception) and not isinstance(outcome, TimeoutError | WebSocketDisconnect):
            raise outcome
    return isinstance(ended[0], TimeoutError)


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
        ClientMessage.model_validate_json(text)
    except ValidationError as error:
        first = error.errors()[0]
        if first["type"] == "json_invalid":
            return "The frame is not JSON."
        place = ".".join(map(str, first["loc"])) or "the frame"
        return f'Only {{"kind": "resync"}} is understood. {place}: {first["msg"]}.'
    return None
