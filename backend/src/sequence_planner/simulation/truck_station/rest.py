"""The REST interface of the AGV, as whoever asks it sees it.

`GET /api/v2.0.0/status` answers `{"position": .., "state_text": ..}`; `PUT /api/v2.0.0/goal` takes `{"goal": ..}`.
"""

from __future__ import annotations

import asyncio
import json

STATUS, GOAL = "/api/v2.0.0/status", "/api/v2.0.0/goal"


async def request(port: int, method: str, path: str, body: dict[str, object] | None = None) -> dict[str, object]:
    """Ask the AGV at `port` of the loopback. Raises OSError when it is not there or does not answer like HTTP."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    try:
        content = b"" if body is None else json.dumps(body).encode()
        head = f"{method} {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: {len(content)}\r\n\r\n"
        writer.write(head.encode() + content)
        answered, _, document = (await reader.read()).partition(b"\r\n\r\n")
        if not answered.startswith(b"HTTP/1.1 200 "):
            raise OSError(f"{method} {path}: {answered.splitlines()[:1]}")
        parsed = json.loads(document)
        if not isinstance(parsed, dict):
            raise OSError(f"{method} {path}: no JSON object")
        return parsed
    finally:
        writer.close()
