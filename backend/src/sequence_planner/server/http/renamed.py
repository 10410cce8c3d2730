"""Addresses of version 0.2 that have other names: requests are sent on to these, until the next minor version.

Whoever asks is told the new address, signed in or not, and for names that there are as for names that there are not:
who may do what is decided there.
"""

from __future__ import annotations

import re
from typing import Final

from starlette.responses import Response
from starlette.types import ASGIApp, Receive, Scope, Send

# Old and new, part by part; what stands in braces is kept, and so is all that follows.
ROUTES: Final = {
    "/advice": "/recovery/proposals",
    "/approvals/outputs": "/approvals/restored-outputs",
    "/control": "/control-lock",
    "/errands": "/operator-plans",
    "/first-administrator": "/setup",
    "/keys": "/api-keys",
    "/model/pipelines/fits": "/model/pipelines/suggestions",
    "/model/pipelines/trials": "/model/pipelines/test-runs",
    "/order-of-work": "/schedule",
    "/outputs": "/restored-outputs",
    "/people": "/users",
    "/service": "/availability",
    "/trials": "/test-runs",
    "/watches": "/wearables",
    "/webhooks/{webhook}/dead-letters/again": "/webhooks/{webhook}/dead-letters/retry",
    "/why-not/ability/{name}": "/abilities/{name}/blockers",
    "/why-not/goal": "/goals/blockers",
    "/why-not/operation/{name}": "/operations/{name}/blockers",
    "/work-by-order": "/settings/job-mode",
}
# Of the page. `/watch` is a file of the build: what a browser has kept for a watch can follow no redirection.
PAGES: Final = {
    "/ability": "/abilities",
    "/first-start": "/setup",
    "/keys": "/api-keys",
    "/people": "/users",
    "/watches": "/wearables",
}
_PREFIX: Final = "/api/v1"
_OLD: Final = [
    (re.compile(re.sub(r"\{(\w+)\}", r"(?P<\1>[^/]+)", _PREFIX + old) + "(?P<rest>/.*)?"), _PREFIX + new + "{rest}")
    for old, new in ROUTES.items()
]


def new_address(path: str) -> str | None:
    """Return the address that has taken the place of `path`, which is as it was sent; None where it is no old one."""
    for old, new in _OLD:
        if (found := old.fullmatch(path)) is not None:
            return new.format_map(found.groupdict(default=""))
    return PAGES.get(path)


class Renamed:
    """Sends requests to old addresses on; streams are served by `routes` as at the new one, `rest` has all others."""

    def __init__(self, routes: ASGIApp, rest: ASGIApp) -> None:
        self.routes = routes
        self.rest = rest

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request or stream that no route knows."""
        sent: bytes = scope.get("raw_path") or scope["path"].encode()
        address = new_address(sent.decode("latin-1"))
        if address is None:
            await self.rest(scope, receive, send)
        elif scope["type"] == "websocket":  # few clients of these follow a redirection
            scope.update(path=address, raw_path=address.encode("latin-1"))
            await self.routes(scope, receive, send)
        else:
            question = scope["query_string"].decode("latin-1")
            location = f"{address}?{question}" if question else address
            await Response(status_code=308, headers={"Location": location})(scope, receive, send)
