"""The built page: files of one folder, at the addresses that SvelteKit's static adapter gives them.

Files below `_app/immutable/` carry a hash of their content in their names and may be kept for ever; everything else
is asked for again each time, so that a new build is seen at once. The build has compressed its files beforehand; who
takes them so gets them so. Without a build, a page says how to make one.
"""

from __future__ import annotations

from collections.abc import Sequence
from http import HTTPStatus
from pathlib import Path

from starlette.datastructures import Headers
from starlette.exceptions import HTTPException
from starlette.responses import HTMLResponse, Response
from starlette.staticfiles import StaticFiles
from starlette.types import Receive, Scope, Send

from sequence_planner.server.http.middleware import document_policy

IMMUTABLE = "_app/immutable/"
WALL = "wall.html"
NOWHERE = "404.html"
FOR_EVER = "public, max-age=31536000, immutable"
COMPRESSED = {"br": ".br", "gzip": ".gz"}  # how the build names what it has compressed so, the smallest first
NOT_BUILT = """<!doctype html>
<html lang="en">
<head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>Sequence Planner</title></head>
<body><main><h1>The page is not built</h1>
<p>The server runs, but there is no page to show. <code>make run</code> builds it.</p></main></body>
</html>
"""


class PageFiles:
    """Answers with files of `folder` whatever no other route answers; the wall stands with those of the origins
    `beside`.
    """

    def __init__(self, folder: Path, beside: Sequence[str] = ()) -> None:
        self.folder = folder
        self.beside = beside
        self._files = StaticFiles(directory=folder, check_dir=False)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request for a file."""
        if scope["type"] != "http" or scope["path"].startswith("/api/"):
            raise HTTPException(404)
        if scope["method"] not in ("GET", "HEAD"):
            raise HTTPException(405, headers={"Allow": "GET, HEAD"})
        response = await self._find(scope)
        await response(scope, receive, send)

    async def _find(self, scope: Scope) -> Response:
        if not _is_file(self.folder / "index.html"):
            return HTMLResponse(NOT_BUILT, status_code=503, headers={"Cache-Control": "no-store"})
        path = self._files.get_path(scope)
        if path == ".":
            path = "index.html"
        elif not _is_file(self.folder / path):
            path += ".html"  # `/operator` is `operator.html`
        headers = Headers(scope=scope)
        is_missing = not _is_file(self.folder / path)
        if is_missing and "text/html" in headers.get("accept", "") and _is_file(self.folder / NOWHERE):
            path = NOWHERE  # somebody has typed the address; a program that asks is told by an exception
        coding, suffix = self._compressed(path, headers.get("accept-encoding", ""))
        response = await self._files.get_response(path + suffix, scope)
        if path == NOWHERE and response.status_code == HTTPStatus.OK:
            response.status_code = HTTPStatus.NOT_FOUND
        if suffix:
            response.headers["Content-Encoding"] = coding
        response.headers["Vary"] = "Accept-Encoding"
        kept = path.startswith(IMMUTABLE) and response.status_code in (200, 206, 304)
        response.headers["Cache-Control"] = FOR_EVER if kept else "no-cache"
        if path.endswith(".html"):  # also when it has not changed: a browser then takes the new headers
            response.headers["Content-Security-Policy"] = document_policy(
                self.folder / path, self.beside if path == WALL else ()
            )
        return response

    def _compressed(self, path: str, accepted: str) -> tuple[str, str]:
        """Return which coding of a file to send, and what its name ends in; nothing where it is sent as it is."""
        for coding, suffix in COMPRESSED.items():
            if _takes(accepted, coding) and _is_file(self.folder / (path + suffix)):
                return coding, suffix
        return "", ""


def _takes(accepted: str, coding: str) -> bool:
    """Return whether `Accept-Encoding` names it, and does not say that it is not taken (RFC 9110, section 12.5.3)."""
    for each in accepted.split(","):
        name, _, weight = each.partition(";")
        if name.strip().lower() == coding:
            return weight.replace(" ", "").rstrip("0.").lower() != "q="
    return False


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # such as a name that is too long
        return False
