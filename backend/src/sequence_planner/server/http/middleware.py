"""HTTP middleware: request guard, proxies, connection limits, security headers, log, long requests."""

from __future__ import annotations

import asyncio
import contextlib
import re
import secrets
import time
from asyncio import Transport
from collections import Counter
from collections.abc import Callable, Coroutine, Sequence
from enum import Enum
from ipaddress import IPv6Address, IPv6Network, ip_address
from pathlib import Path
from typing import Any, Final, Literal, TypeVar
from urllib.parse import parse_qsl

import structlog
from fastapi import Response
from fastapi.responses import JSONResponse
from fastapi.routing import iter_route_contexts
from pydantic import BaseModel, ConfigDict
from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import Request
from starlette.routing import BaseRoute
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from sequence_planner.core.distribution import Distribution
from sequence_planner.server.errors import FieldError, ProblemFound, refusal_response
from sequence_planner.server.settings import (
    LARGEST_RECORDING,
    LOOPBACK_NAMES,
    Endpoint,
    SettingsError,
    address_of,
    split_name,
)
from sequence_planner.texts.message import message

# The answer to what stops a station: it was carried out, and whether the journal has it.


class NotRecorded(BaseModel):
    """It was carried out, and the journal does not have it yet.

    The station keeps it on its own machine until then: a controller that begins anew begins at rest, and none goes on
    by itself.
    """

    model_config = ConfigDict(frozen=True)
    recorded: Literal[False] = False
    detail: str = (
        "It was carried out. The journal does not have it yet, so it is kept on this machine until it does; nothing "
        "goes on by itself meanwhile."
    )


CARRIED_OUT: Final[dict[int | str, dict[str, Any]]] = {
    200: {"model": NotRecorded, "description": "It was carried out, and is not in the journal yet"},
    204: {"description": "It was carried out, and is in the journal"},
}


def carried_out(recorded: bool) -> Response:
    """204, or 200 with a body where the journal does not have it."""
    return Response(status_code=204) if recorded else JSONResponse(NotRecorded().model_dump())


# Who has connections open, and whose is closed when there are too many.
#
# Nobody is known before the head of a request has come. Those who are not known have places of their own, so however
# many they are, whoever is signed in finds one. A connection too many closes the oldest of those who have most, so
# that a newcomer need not wait until somebody who asks for nothing has been given up.

# Connections that are accepted in one go: fewer than one address may have, so that none of them is closed by the others
# before what it asks for was looked at.
ACCEPTED_AT_ONCE = 128
IN_SCOPE = "sequence_planner.place"


class ConnectionKind(Enum):
    """Whom connections belong to."""

    ADDRESS = "address"  # somebody who has not shown who they are
    PROXY = "proxy"  # whoever a proxy will say
    BEARER = "bearer"  # a session, a watch or a key


MOST_UNKNOWN, MOST_KNOWN = 600, 300  # connections at once, streams included
MOST_OF_ONE = {ConnectionKind.ADDRESS: 200, ConnectionKind.PROXY: MOST_UNKNOWN, ConnectionKind.BEARER: 60}

Group = tuple[ConnectionKind, str]


class Crowd:
    """All connections of a server, by whom they belong to; the one that asked last stands last."""

    def __init__(self) -> None:
        self._groups: dict[Transport, Group] = {}
        self._sizes: Counter[Group] = Counter()

    def put(self, transport: Transport, group: Group) -> None:
        """Let a connection belong to a group from now on, at the cost of an older one where there are too many."""
        self.leave(transport)
        self._groups[transport] = group
        self._sizes[group] += 1
        if self._sizes[group] > MOST_OF_ONE[group[0]]:
            self._close_oldest(group)
            return
        is_known = group[0] is ConnectionKind.BEARER
        sizes = {each: size for each, size in self._sizes.items() if (each[0] is ConnectionKind.BEARER) == is_known}
        if sum(sizes.values()) > (MOST_KNOWN if is_known else MOST_UNKNOWN):
            self._close_oldest(max(sizes, key=sizes.__getitem__))

    def leave(self, transport: Transport) -> None:
        """Count a connection no more."""
        group = self._groups.pop(transport, None)
        if group is not None:
            self._sizes[group] -= 1
            if not self._sizes[group]:
                del self._sizes[group]

    def _close_oldest(self, group: Group) -> None:
        oldest = next(transport for transport, each in self._groups.items() if each == group)
        self.leave(oldest)
        oldest.abort()  # whoever takes no answer would not take the rest of it either


class ConnectionPlace:
    """One connection's place among all."""

    def __init__(self, crowd: Crowd, transport: Transport, group: Group) -> None:
        self._crowd = crowd
        self._transport = transport
        self._group = group
        crowd.put(transport, group)

    def asks(self) -> None:
        """Count it as the newest."""
        self._crowd.put(self._transport, self._group)

    def belongs_to(self, group: Group) -> None:
        """Say whose it is."""
        self._group = group
        if not self._transport.is_closing():
            self._crowd.put(self._transport, group)


def group_of_address(address: str) -> Group:
    """An address; of IPv6 the 64-bit network that one host has for itself (RFC 4291, 2.5.4)."""
    found = address_of(address.partition("%")[0])
    if isinstance(found, IPv6Address) and not found.is_loopback:
        return ConnectionKind.ADDRESS, str(IPv6Network((found, 64), strict=False))
    return ConnectionKind.ADDRESS, str(found or address)


def belongs_to(scope: Scope, group: Group) -> None:
    """Say whose the connection of a request is, where there is one."""
    place: ConnectionPlace | None = scope.get(IN_SCOPE)
    if place is not None:
        place.belongs_to(group)


# What a request must be to be looked at: meant for this server, and not sent by somebody else's page.
#
# Every page that a person opens in a browser can reach whatever that browser reaches. Three checks keep those pages
# out: the Host header must name us (a foreign name that resolves to our address does not), an Origin, where the
# request can change something or opens a stream, must be one of ours, and a browser that says the request crosses
# sites is believed. Programs that send no Origin (curl, a MES) pass: they are not a page. So does, on this machine, the
# question how the server is, by whatever name it is opened otherwise.

_NO_NAME = re.compile("[\x00-\x1f\x7f\ufffd]")  # the last is what uvicorn puts for what is no UTF-8
READING = ("GET", "HEAD", "OPTIONS")
LARGEST_BODY = 64 * 1024  # bytes
EDITS = 4 * 1024 * 1024  # bytes: files of a model, as they were and as they shall be
LARGER_BODIES = {"/api/v1/model/changes": EDITS, "/api/v1/model/pipelines/preview": EDITS}
BODY_SECONDS = 20.0  # in which a body must have come
RECORDINGS = "/api/v1/model/recordings"
RECORDING_SECONDS = 900.0  # in which a recording must have come
MB = 1_000_000
ABOUT_ITSELF = ("/healthz", "/readyz", "/metrics")  # what a machine asks a server that runs on it


class RequestGuard:
    """Refuses requests that do not mean `endpoint`, and bodies that are too large or too slow."""

    def __init__(self, app: ASGIApp, endpoint: Endpoint, largest_recording: int = LARGEST_RECORDING) -> None:
        self.app = app
        self.largest = {**LARGER_BODIES, RECORDINGS: largest_recording * MB}
        self.hosts = endpoint.hosts
        self.origins = endpoint.origins

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve or refuse one request or connection."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        largest = self.largest.get(scope["path"], LARGEST_BODY)
        too_large = _recording_too_large if scope["path"] == RECORDINGS else _too_large
        seconds = RECORDING_SECONDS if scope["path"] == RECORDINGS else BODY_SECONDS
        wrong = _framing(headers) or _address(scope) or self._host(scope, headers) or self._origin(scope, headers)
        refused = wrong or (too_large(largest) if _announced(headers) > largest else None)
        if refused is None:
            await self.app(scope, _bounded(receive, largest, seconds, too_large), send)
            return
        response = refusal_response(refused)
        # Starlette turns the answer to a handshake into the messages of the "websocket.http.response" extension.
        await response(scope, receive, send)

    def _host(self, scope: Scope, headers: Headers) -> ProblemFound | None:
        hosts = headers.getlist("host")
        if len(hosts) != 1:
            return ProblemFound(400, "no-host", message("refused.no-host.one"))
        if hosts[0].lower() in self.hosts or is_own_health_check(scope):
            return None
        return ProblemFound(421, "wrong-host", message("refused.wrong-host.hosts", hosts=", ".join(sorted(self.hosts))))

    def _origin(self, scope: Scope, headers: Headers) -> ProblemFound | None:
        if scope["type"] == "http" and scope["method"] in READING:
            return None
        origins = headers.getlist("origin")
        foreign = any(origin.lower() not in self.origins for origin in origins)
        if foreign or "cross-site" in headers.getlist("sec-fetch-site"):
            return ProblemFound(403, "foreign-origin", message("refused.foreign-origin.open"))
        return None


def _framing(headers: Headers) -> ProblemFound | None:
    """Refuse what a proxy may take for two requests and this server for one, or the other way round.

    The connection is closed, so that nothing that follows is read as a request (RFC 9112, 6.1).
    """
    if "content-length" not in headers or "transfer-encoding" not in headers:
        return None
    return ProblemFound(
        400, "conflicting-lengths", message("refused.conflicting-lengths.either"), {"Connection": "close"}
    )


def _address(scope: Scope) -> ProblemFound | None:
    """Refuse what nothing is called: control characters, and what is no UTF-8. Not every database can keep these."""
    if _NO_NAME.search(scope["path"]):
        return ProblemFound(404, "not-found", message("refused.not-found.character"))
    question = parse_qsl(scope["query_string"].decode("latin-1"), keep_blank_values=True)
    if odd := [name for name, value in question if "\x00" in name + value]:
        errors = [FieldError(field=f"query.{name}", expected="a text without the character 0") for name in odd]
        return ProblemFound(422, "invalid-request", message("refused.invalid-request.character"), errors=errors)
    return None


def _announced(headers: Headers) -> int:
    announced = headers.get("content-length", "0")
    return int(announced) if announced.isdecimal() else 0


def _recording_too_large(largest: int) -> ProblemFound:
    return ProblemFound(
        413, "recording-too-large", message("refused.recording-too-large.most", most=f"{largest // MB}")
    )


def _too_large(largest: int) -> ProblemFound:
    return ProblemFound(413, "body-too-large", message("refused.body-too-large.most", largest=largest))


def is_own_health_check(scope: Scope) -> bool:
    """Return whether this machine itself asks by a name of the loopback how the server is, as containers and Prometheus
    do.
    """
    if scope["type"] != "http" or scope["method"] not in ("GET", "HEAD") or scope["path"] not in ABOUT_ITSELF:
        return False
    client = address_of(scope["client"][0]) if scope.get("client") else None
    hosts = Headers(scope=scope).getlist("host")
    return client is not None and client.is_loopback and len(hosts) == 1 and _means_loopback(hosts[0])


def _means_loopback(host: str) -> bool:
    try:
        return split_name(host)[0] in LOOPBACK_NAMES
    except SettingsError:
        return False


def _bounded(receive: Receive, largest: int, seconds: float, too_large: Callable[[int], ProblemFound]) -> Receive:
    """Count a body that did not say its length as it comes, and stop reading when it is too large or too slow."""
    size, complete = 0, False
    due = asyncio.get_running_loop().time() + seconds

    async def bounded() -> Message:
        nonlocal size, complete
        try:
            async with asyncio.timeout_at(None if complete else due):
                event = await receive()
        except TimeoutError:
            raise ProblemFound(
                408, "body-too-slow", message("refused.body-too-slow.seconds", seconds=seconds)
            ) from None
        complete = not event.get("more_body", False)
        size += len(event.get("body", b""))
        if size > largest:
            raise too_large(largest)
        return event

    return bounded


# Who asks, when a reverse proxy stands between: exactly one hop is believed, and only from a proxy that is named.
#
# The proxy connects by itself, so every request would seem to come from it. It appends the address that it saw to
# X-Forwarded-For and says in X-Forwarded-Proto how it was asked. Whatever its client wrote into these headers stands
# before that, and is not looked at. Without named proxies this layer is not there, and nobody's headers are believed.

ENCRYPTED = {"http": "https", "websocket": "wss"}  # the scheme of each kind of connection


class Forwarded:
    """Serves `proxies` (addresses) only, and puts the address of their client in the place of theirs."""

    def __init__(self, app: ASGIApp, proxies: tuple[str, ...]) -> None:
        self.app = app
        self.proxies = {address_of(proxy) for proxy in proxies}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve or refuse one request or connection."""
        if scope["type"] not in ENCRYPTED or is_own_health_check(scope):
            await self.app(scope, receive, send)
            return
        try:
            client = self._client(scope)
        except ProblemFound as refused:
            response = refusal_response(refused)
            await response(scope, receive, send)
            return
        belongs_to(scope, group_of_address(client))
        scope.update(client=(client, 0), scheme=ENCRYPTED[scope["type"]])  # in place: outer layers learn of the route
        await self.app(scope, receive, send)

    def _client(self, scope: Scope) -> str:
        """The address that the proxy was asked from. Raises `ProblemFound` when there is no knowing."""
        client = scope.get("client")
        if client is None or address_of(client[0]) not in self.proxies:
            raise ProblemFound(403, "not-the-proxy", message("refused.not-the-proxy.open"))
        headers = Headers(scope=scope)
        if headers.getlist("x-forwarded-proto") not in (["https"], ["wss"]):
            raise ProblemFound(403, "not-encrypted", message("refused.not-encrypted.https"))
        last = ",".join(headers.getlist("x-forwarded-for")).rpartition(",")[2].strip()
        try:
            return str(ip_address(last))
        except ValueError:
            raise ProblemFound(400, "no-client-address", message("refused.no-client-address.header")) from None


# Work for somebody who may leave before it is done.

Result = TypeVar("Result")

LOOKED_EVERY: Final = 0.5  # seconds between two looks whether somebody still waits


async def while_waited_for(request: Request, work: Coroutine[Any, Any, Result]) -> Result | None:
    """Return what the work comes to; None where it was called off, as who asked has left."""
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


# Headers on every answer that tell a browser what it may never do with it.
#
# The built page holds a policy of its own in a meta element, with the hashes of the scripts and styles written into it,
# which only its build knows. As a browser keeps to every policy it is given, `document_policy` lets these hashes
# through in the header too; all that is no document of the build gets the policy without them.

POLICY = {
    "default-src": "'self'",
    "script-src": "'self'",
    "connect-src": "'self'",  # also over ws: and wss: (Content Security Policy 3, section 6.7.2.8)
    "img-src": "'self' data:",
    "frame-src": "'none'",
    "object-src": "'none'",
    "base-uri": "'self'",
    "form-action": "'self'",
    "frame-ancestors": "'none'",
}
OF_THE_BUILD = ("script-src", "style-src", "style-src-attr")  # what a built document may say for itself
META = re.compile(r'<meta http-equiv="content-security-policy" content="([^"]*)">')
# The watch keeps its screen on and vibrates; nothing here sees, hears or locates anybody.
DENIED = (
    "camera",
    "microphone",
    "geolocation",
    "display-capture",
    "usb",
    "serial",
    "hid",
    "midi",
    "payment",
    "accelerometer",
    "gyroscope",
    "magnetometer",
)
HEADERS = {
    "Permissions-Policy": ", ".join([*(f"{feature}=()" for feature in DENIED), "screen-wake-lock=(self)"]),
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
}
ONLY_HTTPS = {"Strict-Transport-Security": "max-age=31536000"}  # seconds; other hosts below this name are not ours
LIVE = ("/api/", "/healthz", "/readyz", "/metrics")  # what is so now is not so later: no browser or proxy keeps it
STARTS = ("http.response.start", "websocket.http.response.start")


class SecurityHeaders:
    """Adds the headers to whatever is answered; with `https` browsers keep to HTTPS for a year."""

    def __init__(self, app: ASGIApp, https: bool) -> None:
        self.app = app
        self.headers = {**HEADERS, **(ONLY_HTTPS if https else {})}
        self.policy = _written(POLICY)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request."""

        async def with_headers(message: Message) -> None:
            if message["type"] in STARTS:
                headers = MutableHeaders(scope=message)
                headers.setdefault("Content-Security-Policy", self.policy)
                for name, value in self.headers.items():
                    headers[name] = value
                if scope["path"].startswith(LIVE):
                    headers.setdefault("Cache-Control", "no-store")
            await send(message)

        await self.app(scope, receive, with_headers)


def document_policy(document: Path, beside: Sequence[str] = ()) -> str:
    """The policy for a built HTML document: ours, with the hashes that its own meta element allows.

    `beside` are the origins with which it may stand in one page, each within the other. Browsers go by that rather than
    by `X-Frame-Options` (Content Security Policy 3, section 6.4.2).
    """
    found = META.search(document.read_text(encoding="utf-8"))
    stated = dict(each.strip().partition(" ")[::2] for each in found[1].split(";")) if found is not None else {}
    policy = {**POLICY, **{name: stated[name] for name in OF_THE_BUILD if name in stated}}
    if beside:
        policy |= dict.fromkeys(("frame-src", "frame-ancestors"), " ".join(("'self'", *beside)))
    return _written(policy)


def _written(policy: dict[str, str]) -> str:
    return "; ".join(f"{name} {value}" for name, value in policy.items())


# What is noted of each request: a number by which it is found in the logs, how long it took and what came of it.
#
# The number is in the answer's `X-Request-Id` and in all that is logged meanwhile, also by the controller where the
# request is a command. A request may bring one of its own, as a proxy does.

LOG = structlog.get_logger(__name__)
HEADER = "x-request-id"
FIT = re.compile(r"[A-Za-z0-9._-]{1,64}")
BOUNDS = (0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0)  # seconds
METHODS = ("GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS")
NO_ROUTE, NO_METHOD = "none", "other"  # files of the page and what is nowhere; what no route knows


class RequestMetrics:
    """The figures noted since the server began: requests by method, route and status, and streams that are open."""

    def __init__(self) -> None:
        self.requests: Counter[tuple[str, str, int]] = Counter()
        self.took: dict[str, Distribution] = {}  # by route
        self.streams: Counter[str] = Counter()  # by route

    def request(self, method: str, route: str, status: int, seconds: float) -> None:
        """A request was answered."""
        self.requests[method if method in METHODS else NO_METHOD, route, status] += 1
        self.took.setdefault(route, Distribution(BOUNDS)).note(seconds)


class RequestLog:
    """Notes each request in `noted`; `routes` are those that are known, by what serves them."""

    def __init__(self, app: ASGIApp, noted: RequestMetrics, routes: Callable[[], dict[object, str]]) -> None:
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
    """Return what the request brings itself, if that is fit for it, or a new one."""
    brought = headers.get(HEADER, "")
    return brought if FIT.fullmatch(brought) else secrets.token_hex(8)


def known_routes(routes: list[BaseRoute]) -> dict[object, str]:
    """The path of each route, by the function that serves it."""
    found = {each.endpoint: each.path_format or each.path for each in iter_route_contexts(routes)}
    return {endpoint: path for endpoint, path in found.items() if endpoint is not None and path is not None}
