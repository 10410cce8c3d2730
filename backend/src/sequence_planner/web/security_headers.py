"""Headers on every answer that tell a browser what it may never do with it.

The built page holds a policy of its own in a meta element, with the hashes of the scripts written into it, which only
its build knows. As a browser keeps to every policy it is given, `document_policy` lets these hashes through in the
header too; all that is no document of the build gets the policy without them.
"""

from __future__ import annotations

import re
from pathlib import Path

from starlette.datastructures import MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

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
OF_THE_BUILD = ("script-src", "style-src-attr")  # what a built document may say for itself
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
                    headers["Cache-Control"] = "no-store"
            await send(message)

        await self.app(scope, receive, with_headers)


def document_policy(document: Path) -> str:
    """The policy for a built HTML document: ours, with the hashes that its own meta element allows."""
    found = META.search(document.read_text(encoding="utf-8"))
    stated = dict(each.strip().partition(" ")[::2] for each in found[1].split(";")) if found is not None else {}
    return _written({**POLICY, **{name: stated[name] for name in OF_THE_BUILD if name in stated}})


def _written(policy: dict[str, str]) -> str:
    return "; ".join(f"{name} {value}" for name, value in policy.items())
