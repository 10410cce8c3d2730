"""The link between a station and its database, which can be cut."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

_SOCKET = ".s.PGSQL.5432"  # as PostgreSQL calls it


class Relay:
    """Hands on what passes between a socket of its own and that of a server; all of it on a thread of its own."""

    def __init__(self, server: Path, folder: Path) -> None:
        self._server, self._own = server / _SOCKET, folder / _SOCKET
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._listening: asyncio.Server | None = None
        self._open: set[asyncio.StreamWriter] = set()
        self._thread.start()

    def mend(self) -> None:
        """From now on there is a link."""
        asyncio.run_coroutine_threadsafe(self._mend(), self._loop).result()

    def cut(self) -> None:
        """From now on there is none: connections break, and no new one is made."""
        asyncio.run_coroutine_threadsafe(self._cut(), self._loop).result()

    def close(self) -> None:
        """End it."""
        self.cut()
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    async def _mend(self) -> None:
        self._listening = await asyncio.start_unix_server(self._meet, self._own)

    async def _cut(self) -> None:
        if self._listening is not None:
            self._listening.close()
            self._own.unlink(missing_ok=True)
            self._listening = None
        for writer in self._open:
            writer.transport.abort()

    async def _meet(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        there, back = await asyncio.open_unix_connection(self._server)
        self._open |= {writer, back}
        await asyncio.gather(_copy(reader, back), _copy(there, writer))
        self._open -= {writer, back}


async def _copy(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    with suppress(OSError):
        while part := await reader.read(1 << 16):
            writer.write(part)
            await writer.drain()
    writer.close()


@contextmanager
def relay(server: Path, folder: Path) -> Iterator[Relay]:
    """A link that holds unless it is cut."""
    made = Relay(server, folder)
    try:
        made.mend()
        yield made
    finally:
        made.close()
