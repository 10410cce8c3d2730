"""Who asks, when a reverse proxy stands between: exactly one hop is believed, and only from a proxy that is named.

The proxy connects by itself, so every request would seem to come from it. It appends the address that it saw to
X-Forwarded-For and says in X-Forwarded-Proto how it was asked. Whatever its client wrote into these headers stands
before that, and is not looked at. Without named proxies this layer is not there, and nobody's headers are believed.
"""

from __future__ import annotations

from ipaddress import ip_address

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Receive, Scope, Send

from sequence_planner.web.crowd import belongs_to, group_of_address
from sequence_planner.web.guard import is_own_health_check
from sequence_planner.web.problems import ProblemFound, problem_response
from sequence_planner.web.settings import address_of

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
            response = problem_response(refused.status_code, refused.slug, refused.title, refused.detail)
            await response(scope, receive, send)
            return
        belongs_to(scope, group_of_address(client))
        scope.update(client=(client, 0), scheme=ENCRYPTED[scope["type"]])  # in place: outer layers learn of the route
        await self.app(scope, receive, send)

    def _client(self, scope: Scope) -> str:
        """The address that the proxy was asked from. Raises `ProblemFound` when there is no knowing."""
        client = scope.get("client")
        if client is None or address_of(client[0]) not in self.proxies:
            detail = "This server is reached through its proxy only; open its public address."
            raise ProblemFound(403, "not-the-proxy", "Not sent by the proxy", detail)
        headers = Headers(scope=scope)
        if headers.getlist("x-forwarded-proto") not in (["https"], ["wss"]):
            detail = "Open it by https. (The proxy must say so with one header, X-Forwarded-Proto: https.)"
            raise ProblemFound(403, "not-encrypted", "Not sent over HTTPS", detail)
        last = ",".join(headers.getlist("x-forwarded-for")).rpartition(",")[2].strip()
        try:
            return str(ip_address(last))
        except ValueError:
            detail = "The proxy must append its client's address to the header X-Forwarded-For."
            raise ProblemFound(400, "no-client-address", "The proxy does not say who asks", detail) from None
