"""Lines from a byte stream, of bounded length.

Both ends of the local socket speak newline-delimited JSON: one document per line. A peer that never ends its line
must not fill the memory, and must not lose the connection either: the rest of an overlong line is skipped up to its
end, its place is taken by `None`, and reading goes on with the next one.
"""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator

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
