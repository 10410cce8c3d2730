"""A connection that asks for something in good time, or is closed: nobody holds the server up by doing nothing.

A client that connects and sends nothing, or a request's head byte by byte, costs a file descriptor, of which a process
has so many only. uvicorn only closes connections that have been idle after an answer.
"""

from __future__ import annotations

import asyncio
from ipaddress import IPv4Address, IPv6Address

from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

from sequence_planner.web.settings import address_of

MOST_CONNECTIONS = 400  # at once, streams included
MOST_OF_ONE_ADDRESS = 100  # of these, except from this machine and through a proxy
HEAD_SECONDS = 10.0  # in which the head of a request must have come, counted from the connection or the last answer
LARGEST_HEAD = 32 * 1024  # bytes
IDLE_SECONDS = 5  # in which the next request must have begun


class PromptConnection(H11Protocol):
    """An HTTP connection that is closed when it lets the server wait, or is one too many."""

    of_one_address = MOST_OF_ONE_ADDRESS
    _due: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Begin to wait for the first request."""
        super().connection_made(transport)
        if len(self.connections) > MOST_CONNECTIONS or self._from_one_address() > self.of_one_address:
            transport.close()
        else:
            self._await_head()

    def connection_lost(self, exc: Exception | None) -> None:
        """Wait no more."""
        self._wait_no_more()
        super().connection_lost(exc)

    def on_response_complete(self) -> None:
        """Begin to wait for the next request."""
        super().on_response_complete()
        if not self.transport.is_closing():
            self._await_head()

    def _from_one_address(self) -> int:
        """How many connections there are from where this one comes from; 0 for this machine itself."""
        here = _address(self)
        if here is None or _from_here(here):
            return 0
        return sum(_address(each) == here for each in self.connections)

    def _await_head(self) -> None:
        self._wait_no_more()
        self._due = self.loop.call_later(HEAD_SECONDS, self._give_up)

    def _wait_no_more(self) -> None:
        if self._due is not None:
            self._due.cancel()

    def _give_up(self) -> None:
        """Close it, unless a request is being answered (which is limited elsewhere) or it has become a stream."""
        answering = self.cycle is not None and not self.cycle.response_complete
        if not answering and self.transport.get_protocol() is self:
            self.transport.close()


def _address(connection: object) -> IPv4Address | IPv6Address | None:
    """Where a connection of uvicorn's, of whatever kind, comes from."""
    client = getattr(connection, "client", None)
    return address_of(client[0]) if client else None


def _from_here(address: IPv4Address | IPv6Address) -> bool:
    return address.is_loopback


class ProxiedConnection(PromptConnection):
    """A connection of a server that stands behind proxies, which alone connect to it, for everybody."""

    of_one_address = MOST_CONNECTIONS


class Stream(WebSocketsSansIOProtocol):
    """A stream that can be ended at any time, also while its client is about to close it.

    uvicorn 0.54 closes each stream at its shutdown, and stops short, with requests unfinished and the application not
    told, at one whose client has said that it closes but has not hung up yet.
    """

    def shutdown(self) -> None:
        """Say that the server goes, unless the client went first, and hang up."""
        if self.transport.is_closing():
            self.stop_keepalive()
        else:
            super().shutdown()
