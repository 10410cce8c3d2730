"""Work for somebody who may leave before it is done."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Coroutine
from typing import Any, Final, TypeVar

from starlette.requests import Request

Result = TypeVar("Result")

LOOKED_EVERY: Final = 0.5  # seconds between two looks whether somebody still waits


async def while_waited_for(request: Request, work: Coroutine[Any, Any, Result]) -> Result | None:
    """What the work comes to; None where it was called off, as who asked has left."""
    task = asyncio.ensure_future(work)
    try:
        while not (await asyncio.wait((task,), timeout=LOOKED_EVERY))[0]:
            if await request.is_disconnected():
                task.cancel()
                with contextlib.suppress(asyncio.CancelledError):
                    await task
                return None
        return task.result()
    finally:
        task.cancel()
