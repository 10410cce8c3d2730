"""What a request must be to be looked at: meant for this server, and not sent by somebody else's page.

Every page that a person opens in a browser can reach whatever that browser reaches. Three checks keep those pages out:
the Host header must name us (a foreign name that resolves to our address does not), an Origin, where the request can
change something or opens a stream, must be one of ours, and a browser that says the request crosses sites is believed.
Programs that send no Origin (curl, a MES) pass: they are not a page. So does, on this machine, the question how the
server is, by whatever name it is opened otherwise.
"""

from __future__ import annotations

import asyncio
import re
from urllib.parse import parse_qsl

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from sequence_planner.web.problems import FieldError, ProblemFound, problem_response
from sequence_planner.web.settings import LOOPBACK_NAMES, Endpoint, SettingsError, address_of, split_name

_NO_NAME = re.compile("[\x00-\x1f\x7f\ufffd]")  # the last is what uvicorn puts for what is no UTF-8
READING = ("GET", "HEAD", "OPTIONS")
LARGEST_BODY = 64 * 1024  # bytes
EDITS = 4 * 1024 * 1024  # bytes: files of a model, as they were and as they shall be
LARGER_BODIES = {"/api/v1/model/changes": EDITS, "/api/v1/model/pipelines/preview": EDITS}
BODY_SECONDS = 20.0  # in which a body must have come
ABOUT_ITSELF = ("/healthz", "/readyz", "/metrics")  # what a machine asks a server that runs on it


class Guard:
    """Refuses requests that do not mean `endpoint`, and bodies that are too large or too slow."""

    def __init__(self, app: ASGIApp, endpoint: Endpoint) -> None:
        self.app = app
        self.hosts = endpoint.hosts
        self.origins = endpoint.origins

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve or refuse one request or connection."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        largest = LARGER_BODIES.get(scope["path"], LARGEST_BODY)
        wrong = _framing(headers) or _address(scope) or self._host(scope, headers) or self._origin(scope, headers)
        refused = wrong or _length(headers, largest)
        if refused is None:
            await self.app(scope, _bounded(receive, largest), send)
            return
        response = problem_response(
            refused.status_code,
            refused.slug,
            refused.title,
            refused.detail,
            headers=refused.headers,
            errors=refused.errors,
        )
        # Starlette turns the answer to a handshake into the messages of the "websocket.http.response" extension.
        await response(scope, receive, send)

    def _host(self, scope: Scope, headers: Headers) -> ProblemFound | None:
        hosts = headers.getlist("host")
        if len(hosts) != 1:
            return ProblemFound(400, "no-host", "No single Host header", "Send one Host header.")
        if hosts[0].lower() in self.hosts or is_own_health_check(scope):
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


def _framing(headers: Headers) -> ProblemFound | None:
    """Refuse what a proxy may take for two requests and this server for one, or the other way round.

    The connection is closed, so that nothing that follows is read as a request (RFC 9112, 6.1).
    """
    if "content-length" not in headers or "transfer-encoding" not in headers:
        return None
    detail = "Send either Content-Length or Transfer-Encoding, not both."
    return ProblemFound(400, "two-lengths", "The length is said twice", detail, {"Connection": "close"})


def _address(scope: Scope) -> ProblemFound | None:
    """Refuse what nothing is called: control characters, and what is no UTF-8. Not every database can keep these."""
    if _NO_NAME.search(scope["path"]):
        return ProblemFound(
            404,
            "not-found",
            "Not Found",
            "Nothing has a control character, or no UTF-8, in its address. Leave that out.",
        )
    question = parse_qsl(scope["query_string"].decode("latin-1"), keep_blank_values=True)
    if odd := [name for name, value in question if "\x00" in name + value]:
        errors = [FieldError(field=f"query.{name}", expected="a text without the character 0") for name in odd]
        title, detail = "The request is not as expected", "No text has the character 0."
        return ProblemFound(422, "invalid-request", title, detail, errors=errors)
    return None


def _length(headers: Headers, largest: int) -> ProblemFound | None:
    announced = headers.get("content-length", "0")
    return _too_large(largest) if announced.isdecimal() and int(announced) > largest else None


def _too_large(largest: int) -> ProblemFound:
    detail = f"A body may have {largest} bytes at most: send less."
    return ProblemFound(413, "body-too-large", "The body is too large", detail)


def is_own_health_check(scope: Scope) -> bool:
    """Whether this machine itself asks by a name of the loopback how the server is, as containers and Prometheus do."""
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


def _bounded(receive: Receive, largest: int) -> Receive:
    """Count a body that did not say its length as it comes, and stop reading when it is too large or too slow."""
    size, complete = 0, False
    due = asyncio.get_running_loop().time() + BODY_SECONDS

    async def bounded() -> Message:
        nonlocal size, complete
        try:
            async with asyncio.timeout_at(None if complete else due):
                message = await receive()
        except TimeoutError:
            detail = f"A body must be there within {BODY_SECONDS:g} s. Send it again, all at once."
            raise ProblemFound(408, "body-too-slow", "The body did not come in time", detail) from None
        complete = not message.get("more_body", False)
        size += len(message.get("body", b""))
        if size > largest:
            raise _too_large(largest)
        return message

    return bounded
