"""The streams to an editor: messages in the frames of the Language Server Protocol, and nothing else.

Whatever in this process or one that it starts prints something prints it to standard error.
"""

from __future__ import annotations

import asyncio
import json
import os
import re
import sys
import threading
import traceback
from typing import BinaryIO

from lsprotocol import types
from pygls.exceptions import JsonRpcException, JsonRpcInvalidRequest, JsonRpcParseError
from pygls.protocol import LanguageServerProtocol

from sequence_planner.core.late_log import LateLog

LOG = LateLog(__name__)
_LENGTH = re.compile(rb"content-length:[ \t]*(\d{1,18})[ \t]*", re.IGNORECASE)
_LONGEST_HEADER = 4_096  # bytes of one line
_LONGEST_MESSAGE = 200_000_000  # bytes
_CHUNK = 1 << 16


class ClientStreams:
    """Standard input and output, taken over from the rest of the process."""

    def __init__(self) -> None:
        self._input = os.dup(sys.stdin.fileno())
        self._output: BinaryIO = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
        nothing = os.open(os.devnull, os.O_RDONLY)
        os.dup2(nothing, sys.stdin.fileno())
        os.close(nothing)
        sys.stdout.flush()
        os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
        self._arriving = asyncio.StreamReader(limit=_CHUNK)

    def start_reading(self) -> None:
        """Read what arrives, from within the event loop, in a thread that keeps nothing from ending."""
        loop = asyncio.get_running_loop()
        self._arriving = asyncio.StreamReader(limit=_CHUNK, loop=loop)
        threading.Thread(target=self._read, args=(loop, self._arriving), daemon=True, name="input").start()

    def _read(self, loop: asyncio.AbstractEventLoop, arriving: asyncio.StreamReader) -> None:
        def feed(chunk: bytes) -> None:
            if chunk:
                arriving.feed_data(chunk)
            else:
                arriving.feed_eof()

        while True:
            try:
                chunk = os.read(self._input, _CHUNK)
            except OSError:
                chunk = b""
            try:
                loop.call_soon_threadsafe(feed, chunk)
            except RuntimeError:  # the loop has ended
                return
            if not chunk:
                return

    async def next_message(self) -> bytes | None:
        """The body of the next message; None where no more come."""
        length: int | None = None
        while True:
            line = await self._line()
            if line is None:
                return None
            if line:
                if found := _LENGTH.fullmatch(line):
                    length = int(found[1])
                continue
            if length is None:
                continue
            if length > _LONGEST_MESSAGE:
                LOG.error("a message is too long: the connection is given up", bytes=length)
                return None
            try:
                return await self._arriving.readexactly(length)
            except asyncio.IncompleteReadError:
                return None

    async def _line(self) -> bytes | None:
        """A line of a header without its end; what is longer than any counts as an unknown one."""
        try:
            line = await self._arriving.readuntil(b"\n")
        except asyncio.IncompleteReadError:
            return None
        except asyncio.LimitOverrunError as error:
            await self._arriving.readexactly(error.consumed)
            while await self._skips():
                pass
            return b"?"
        return line.rstrip(b"\r\n") if len(line) <= _LONGEST_HEADER else b"?"

    async def _skips(self) -> bool:
        """Leave out what is left of a line that is too long, piece by piece."""
        try:
            await self._arriving.readuntil(b"\n")
        except asyncio.LimitOverrunError as error:
            await self._arriving.readexactly(error.consumed)
            return True
        except asyncio.IncompleteReadError:
            pass
        return False

    def send(self, data: bytes) -> None:
        """Send that. What nobody reads any more is lost: then nothing more comes either."""
        try:
            self._output.write(data)
            self._output.flush()
        except (BrokenPipeError, ValueError):
            LOG.info("the editor reads nothing any more")

    write = send  # as `pygls` calls it

    def close(self) -> None:
        """Send nothing more."""


async def talk(protocol: LanguageServerProtocol, streams: ClientStreams) -> int:
    """Have messages handled until there are no more; returns the exit code: 0 after a `shutdown`, else 1."""
    protocol.set_writer(streams)
    streams.start_reading()
    is_shut_down = False
    while (body := await streams.next_message()) is not None:
        try:
            plain = json.loads(body)
        except (ValueError, RecursionError) as error:
            LOG.warning("a message is no JSON", because=str(error))
            _refuse(streams, None, JsonRpcParseError(f"this is not JSON: {error}"))
            continue
        if not isinstance(plain, dict) or plain.get("jsonrpc") != "2.0":
            _refuse(streams, _id_in(plain), JsonRpcInvalidRequest("this is no message of JSON-RPC 2.0"))
            continue
        method = plain.get("method")
        if method == types.EXIT:
            break
        if is_shut_down:
            if method is not None and "id" in plain:
                _refuse(streams, _id_in(plain), JsonRpcInvalidRequest("the server has been shut down"))
            continue
        is_shut_down = method == types.SHUTDOWN
        try:
            protocol.handle_message(protocol.structure_message(plain))
        except JsonRpcException as error:
            if "method" in plain:
                _refuse(streams, _id_in(plain), error)
        except Exception as error:  # a message must not end the server, whatever it is
            LOG.error("a message could not be handled", because="".join(traceback.format_exception(error)))
            _refuse(streams, _id_in(plain), JsonRpcException(str(error)))
        await asyncio.sleep(0)  # what is asked begins in the order of its messages
    return 0 if is_shut_down else 1


def _id_in(plain: object) -> int | str | None:
    found = plain.get("id") if isinstance(plain, dict) else None
    return found if isinstance(found, int | str) else None


def _refuse(streams: ClientStreams, id: int | str | None, error: JsonRpcException) -> None:
    """Answer that it cannot be done. A notification has no answer, but what is no message at all has one."""
    if id is None and not isinstance(error, JsonRpcParseError | JsonRpcInvalidRequest):
        return
    answer = {"jsonrpc": "2.0", "id": id, "error": {"code": error.code, "message": error.message}}
    body = json.dumps(answer).encode()
    streams.send(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
