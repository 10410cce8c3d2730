"""Work for somebody who leaves is called off, and is done for somebody who waits."""

from __future__ import annotations

import asyncio

from starlette.requests import Request
from starlette.types import Message

from sequence_planner.server.http.middleware import while_waited_for


def asked_by(leaves: bool) -> Request:
    """A request of somebody who has left already, or waits for ever."""

    async def receive() -> Message:
        if not leaves:
            await asyncio.Event().wait()
        return {"type": "http.disconnect"}

    return Request({"type": "http", "method": "POST", "path": "/", "headers": []}, receive)


def test_work_is_done_for_who_waits() -> None:
    async def work() -> str:
        await asyncio.sleep(0.6)
        return "done"

    assert asyncio.run(while_waited_for(asked_by(leaves=False), work())) == "done"


def test_work_for_who_has_left_is_called_off() -> None:
    ended: list[str] = []

    async def work() -> str:
        try:
            await asyncio.Event().wait()
        except asyncio.CancelledError:
            ended.append("called off")
            raise
        return "done"

    assert asyncio.run(while_waited_for(asked_by(leaves=True), work())) is None
    assert ended == ["called off"]
