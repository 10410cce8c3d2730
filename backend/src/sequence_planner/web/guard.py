"""What a request must be to be looked at: meant for this server, and not sent by somebody else's page.

The server listens on this machine only, but every page that a person opens in a browser here can reach it too. Three
checks keep those pages out: the Host header must name us (a foreign name that resolves to 127.0.0.1 does not), an
Origin, where the request can change something or opens the stream, must be one of ours, and a browser that says the
request crosses sites is believed. Programs that send no Origin (curl, a MES) pass: they are not a page.
"""

from __future__ import annotations

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from sequence_planner.web.problems import ProblemFound, problem_response

NAMES = ("127.0.0.1", "localhost", "[::1]")
READING = ("GET", "HEAD", "OPTIONS")
LARGEST_BODY = 64 * 1024  # bytes


class Guard:
    """Refuses requests from elsewhere and bodies that are too large; `port` is the one that is served."""

    def __init__(self, app: ASGIApp, port: int) -> None:
        self.app = app
        self.hosts = {f"{name}:{port}" for name in NAMES} | (set(NAMES) if port == 80 else set())
        self.origins = {f"http://{host}" for host in self.hosts}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve or refuse one request or connection."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        refused = self._host(headers) or self._origin(scope, headers) or _announced_length(headers)
        if refused is None:
            await self.app(scope, _bounded(receive), send)
            return
        response = problem_response(refused.status_code, refused.slug, refused.title, refused.detail)
        # Starlette turns the answer to a handshake into the messages of the "websocket.http.response" extension.
        await response(scope, receive, send)

    def _host(self, headers: Headers) -> ProblemFound | None:
        hosts = headers.getlist("host")
        if len(hosts) != 1:
            return ProblemFound(400, "no-host", "No single Host header", "Send one Host header.")
        if hosts[0].lower() in self.hosts:
            return None
        detail = f"This server answers to {', '.join(sorted(self.hosts))} only."
        return ProblemFound(421, "wrong-host", "Another host was meant", detail)

    def _origin(self, scope: Scope, headers: Headers) -> ProblemFound | None:
        if scope["type"] == "http" and scope["method"] in READING:
            return None
        origins = headers.getlist("origin")
        foreign = any(origin.lower() not in self.origins for origin in origins)
        if foreign or "cross-site" in headers.getlist("sec-fetch-site"):
            detail = "The request comes from a page of another site; open this server's own page."
            return ProblemFound(403, "foreign-origin", "Sent by a foreign page", detail)
        return None


def _announced_length(headers: Headers) -> ProblemFound | None:
    announced = headers.get("content-length", "0")
    return _too_large() if announced.isdecimal() and int(announced) > LARGEST_BODY else None


def _too_large() -> ProblemFound:
    detail = f"A body may have {LARGEST_BODY} bytes at most."
    return ProblemFound(413, "body-too-large", "The body is too large", detail)


def _bounded(receive: Receive) -> Receive:
    """Count a body that did not say its length as it comes, and stop reading when it is too large."""
    size = 0

    async def counted() -> Message:
        nonlocal size
        message = await receive()
        if message["type"] == "http.request":
            size += len(message.get("body", b""))
            if size > LARGEST_BODY:
                raise _too_large()
        return message

    return counted
