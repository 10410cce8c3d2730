"""What is noted of each request: a number by which it is found in the logs, how long it took and what came of it.

The number is in the answer's `X-Request-Id` and in all that is logged meanwhile, also by the controller where the
request is a command. A request may bring one of its own, as a proxy does.
"""

from __future__ import annotations

import re
import secrets
import time
from collections import Counter
from collections.abc import Callable

import structlog
from fastapi.routing import iter_route_contexts
from starlette.datastructures import Headers, MutableHeaders
from starlette.routing import BaseRoute
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from sequence_planner.distribution import Distribution
from sequence_planner.web.guard import READING
from sequence_planner.web.security_headers import STARTS

LOG = structlog.get_logger(__name__)
HEADER = "x-request-id"
FIT = re.compile(r"[A-Za-z0-9._-]{1,64}")
BOUNDS = (0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0)  # seconds
METHODS = ("GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS")
NO_ROUTE, NO_METHOD = "none", "other"  # files of the page and what is nowhere; what no route knows


class Noted:
    """What was noted since the server began: requests by method, route and status, and streams that are open."""

    def __init__(self) -> None:
        self.requests: Counter[tuple[str, str, int]] = Counter()
        self.took: dict[str, Distribution] = {}  # by route
        self.streams: Counter[str] = Counter()  # by route

    def request(self, method: str, route: str, status: int, seconds: float) -> None:
        """A request was answered."""
        self.requests[method if method in METHODS else NO_METHOD, route, status] += 1
        self.took.setdefault(route, Distribution(BOUNDS)).note(seconds)


class Noting:
    """Notes each request in `noted`; `routes` are those that are known, by what serves them."""

    def __init__(self, app: ASGIApp, noted: Noted, routes: Callable[[], dict[object, str]]) -> None:
        self.app = app
        self.noted = noted
        self.routes = routes

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request or stream."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        number = request_number(Headers(scope=scope))
        with structlog.contextvars.bound_contextvars(request=number):
            await self._serve(scope, receive, send, number)

    async def _serve(self, scope: Scope, receive: Receive, send: Send, number: str) -> None:
        began, status, route = time.perf_counter(), 0, ""

        async def noting(message: Message) -> None:
            nonlocal status, route
            if message["type"] in STARTS:
                status = message["status"]
                MutableHeaders(scope=message)[HEADER] = number
            elif message["type"] == "websocket.accept" and not route:
                route = self._route(scope)
                self.noted.streams[route] += 1
            await send(message)

        try:
            await self.app(scope, receive, noting)
        finally:
            if route:
                self.noted.streams[route] -= 1
            elif status:
                self._note(scope, status, time.perf_counter() - began)

    def _note(self, scope: Scope, status: int, seconds: float) -> None:
        method, route = scope.get("method", "GET"), self._route(scope)
        self.noted.request(method, route, status, seconds)
        if method not in READING or status == 500:
            # Not the path itself, in which anybody may write anything.
            LOG.info("answered", method=method, route=route, status=status, seconds=round(seconds, 4))

    def _route(self, scope: Scope) -> str:
        """The route that has served it, as it is written where it is defined."""
        return self.routes().get(scope.get("endpoint"), NO_ROUTE)


def request_number(headers: Headers) -> str:
    """What the request brings itself, if that is fit for it, or a new one."""
    brought = headers.get(HEADER, "")
    return brought if FIT.fullmatch(brought) else secrets.token_hex(8)


def known_routes(routes: list[BaseRoute]) -> dict[object, str]:
    """The path of each route, by the function that serves it."""
    found = {each.endpoint: each.path_format or each.path for each in iter_route_contexts(routes)}
    return {endpoint: path for endpoint, path in found.items() if endpoint is not None and path is not None}
