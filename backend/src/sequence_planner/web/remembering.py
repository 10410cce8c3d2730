"""Whose the connection of a request is, before anybody is looked up."""

from __future__ import annotations

from starlette.requests import HTTPConnection
from starlette.types import ASGIApp, Receive, Scope, Send

from sequence_planner.web.bearer_memory import Bearer
from sequence_planner.web.cookies import credentials
from sequence_planner.web.crowd import Kind, belongs_to
from sequence_planner.web.identity import IdentityOffice


class Remembering:
    """Gives the connection of a request to whom it belongs, where that was found out lately.

    It takes no time, and so nobody who asks for nothing can take their place until they are looked up.
    """

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request or connection."""
        if scope["type"] in ("http", "websocket"):
            connection = HTTPConnection(scope)
            office: IdentityOffice = connection.app.state.identity
            bearer = office.remembered(credentials(connection))
            if bearer is not None and (found := _id_of(bearer)) is not None:
                belongs_to(scope, (Kind.BEARER, found))
        await self.app(scope, receive, send)


def _id_of(bearer: Bearer) -> str | None:
    if bearer.signed_in is not None:
        return bearer.signed_in.session
    found = bearer.watch or bearer.key
    return None if found is None else found.id
