"""What another process has found, and bodies for it: both pass through the server as they are.

To read a large document, or to write one, would keep everybody waiting who asks for something else, a stop for one.
"""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from typing import Annotated, Any

from fastapi import Depends, Request, Response
from fastapi.responses import StreamingResponse
from pydantic import BaseModel

from sequence_planner.web.request_parts import json_only

JSON = "application/json"
PIECE = 64 * 1024  # bytes that are written, and compressed, in one go


def found(text: str) -> Response:
    """The answer that consists of this JSON."""
    content = text.encode()
    if len(content) <= PIECE:
        return Response(content, media_type=JSON)
    return StreamingResponse(_pieces(content), media_type=JSON)


async def _pieces(content: bytes) -> AsyncIterator[bytes]:
    for start in range(0, len(content), PIECE):
        yield content[start : start + PIECE]
        await asyncio.sleep(0)  # others come between


async def _unread_body(request: Request) -> bytes:
    await json_only(request)
    return await request.body()


UnreadBody = Annotated[bytes, Depends(_unread_body)]


def takes(model: type[BaseModel]) -> dict[str, Any]:
    """What `openapi_extra` of a route says whose `UnreadBody` is a `model`, which `openapi_document` must know."""
    schema = {"$ref": f"#/components/schemas/{model.__name__}"}
    return {"requestBody": {"required": True, "content": {JSON: {"schema": schema}}}}
