"""HTTP/1.1 connections: strict request heads (RFC 9112), size limits and timeouts."""

from __future__ import annotations

import asyncio
import re
from http import HTTPStatus
from typing import Any, cast

import h11
from starlette.types import Receive, Scope, Send
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

from sequence_planner.server.errors import problem_response
from sequence_planner.server.http.middleware import (
    IN_SCOPE,
    ConnectionKind,
    ConnectionPlace,
    Crowd,
    Group,
    group_of_address,
)
from sequence_planner.server.settings import address_of

# Heads of requests as HTTP/1.1 has them (RFC 9112), no larger than is allowed.
#
# h11 looks at the size of a head only as long as it is not complete, and takes a line feed alone for the end of a
# line. A proxy that does not could take one request for two.

LARGEST_HEAD = 32 * 1024  # bytes
_END = re.compile(rb"\n\r?\n")
_BARE = re.compile(rb"(?<!\r)\n")


class StrictConnection(h11.Connection):
    """Refuses heads that are too large or whose lines do not end with CR LF; `refusal` is the status and the reason."""

    refusal = (400, "This is no request of HTTP/1.1.")

    def __init__(self) -> None:
        super().__init__(h11.SERVER, LARGEST_HEAD)

    def next_event(self) -> h11.Event | type[h11.NEED_DATA] | type[h11.PAUSED]:
        """Return what has come. Raises `h11.RemoteProtocolError`."""
        if self.their_state is h11.IDLE:
            self._look_at_head()
        return super().next_event()

    def _look_at_head(self) -> None:
        waiting = self.trailing_data[0]
        end = _END.search(waiting)
        head = waiting if end is None else waiting[: end.end()]
        if len(head) > LARGEST_HEAD:
            self._refuse(431, f"The head of a request has at most {LARGEST_HEAD} bytes.")
        if _BARE.search(head):
            self._refuse(400, "Lines of the head end with CR LF, and not with LF alone.")

    def _refuse(self, status: int, why: str) -> None:
        self.refusal = status, why
        raise h11.RemoteProtocolError(why, status)


# A connection that asks for something in good time, or is closed: nobody holds the server up by doing nothing.
#
# A client that connects and sends nothing, or a request's head byte by byte, costs a file descriptor, of which a
# process has so many only. uvicorn only closes connections that have been idle after an answer.

HEAD_SECONDS = 10.0  # in which the head of a request must have come, counted from the connection or the last answer
IDLE_SECONDS = 5  # in which the next request must have begun


class Placed:
    """The application, to which each request says whose place it takes among all connections."""

    def __init__(self, app: Any, place: ConnectionPlace) -> None:  # noqa: ANN401 - uvicorn's several kinds of applications
        self._app = app
        self._place = place

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request or connection."""
        self._place.asks()
        scope[IN_SCOPE] = self._place
        await self._app(scope, receive, send)


class PromptConnection(H11Protocol):
    """An HTTP connection that is closed when it lets the server wait; one of the `crowd`.

    What comes from one of the `proxies` belongs to whom these say.
    """

    _due: asyncio.TimerHandle | None = None

    def __init__(self, *, crowd: Crowd, proxies: tuple[str, ...], **more: Any) -> None:  # noqa: ANN401 - uvicorn's
        super().__init__(**more)
        self.conn = StrictConnection()
        self._crowd = crowd
        self._proxies = {address_of(each) for each in proxies}

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Begin to wait for the first request."""
        super().connection_made(transport)
        self.app = Placed(self.app, ConnectionPlace(self._crowd, transport, self._group()))
        self._await_head()

    def connection_lost(self, exc: Exception | None) -> None:
        """Wait no more."""
        self._wait_no_more()
        self._crowd.leave(self.transport)
        super().connection_lost(exc)

    def on_response_complete(self) -> None:
        """Begin to wait for the next request."""
        super().on_response_complete()
        if not self.transport.is_closing():
            self._await_head()

    def send_400_response(self, msg: str) -> None:
        """Say what is wrong with what has come, and hang up."""
        status, why = cast(StrictConnection, self.conn).refusal
        slug, title = ("head-too-large", "The head is too large") if status == 431 else ("bad-request", "Bad Request")
        answer = problem_response(status, slug, title, why, headers={"Connection": "close"})
        for event in (
            h11.Response(status_code=status, headers=answer.raw_headers, reason=HTTPStatus(status).phrase.encode()),
            h11.Data(data=bytes(answer.body)),
            h11.EndOfMessage(),
        ):
            self.transport.write(self.conn.send(event) or b"")
        self.transport.close()

    def _group(self) -> Group:
        """Return whose the connection is as long as nothing has come."""
        address = self.client[0] if self.client else ""
        return (ConnectionKind.PROXY, address) if address_of(address) in self._proxies else group_of_address(address)

    def _await_head(self) -> None:
        self._wait_no_more()
        self._due = self.loop.call_later(HEAD_SECONDS, self._give_up)

    def _wait_no_more(self) -> None:
        if self._due is not None:
            self._due.cancel()

    def _give_up(self) -> None:
        """Close it, unless a request is being answered (which is limited elsewhere) or it has become a stream."""
        answering = self.cycle is not None and not self.cycle.response_complete
        if not answering and not self.transport.is_closing() and self.transport.get_protocol() is self:
            self.transport.close()


class Stream(WebSocketsSansIOProtocol):
    """A stream that can be ended at any time, also while its client is about to close it.

    uvicorn 0.54 closes each stream at its shutdown, and stops short, with requests unfinished and the application not
    told, at one whose client has said that it closes but has not hung up yet.
    """

    def __init__(self, *, crowd: Crowd, **more: Any) -> None:  # noqa: ANN401 - uvicorn's
        super().__init__(**more)
        self._crowd = crowd

    def shutdown(self) -> None:
        """Say that the server goes, unless the client went first, and hang up."""
        if self.transport.is_closing():
            self.stop_keepalive()
        else:
            super().shutdown()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Go on where the HTTP connection was, with its place."""
        http = transport.get_protocol() if isinstance(transport, asyncio.Transport) else None
        super().connection_made(transport)
        if isinstance(http, PromptConnection):
            self.app = http.app

    def connection_lost(self, exc: Exception | None) -> None:
        """Give the place up."""
        self._crowd.leave(self.transport)
        super().connection_lost(exc)
