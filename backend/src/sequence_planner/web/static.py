"""The built page: files of one folder, at the addresses that SvelteKit's static adapter gives them.

Files below `_app/immutable/` carry a hash of their content in their names and may be kept for ever; everything else
is asked for again each time, so that a new build is seen at once. Without a build, a page says how to make one.
"""

from __future__ import annotations

from pathlib import Path

from starlette.exceptions import HTTPException
from starlette.responses import HTMLResponse, Response
from starlette.staticfiles import StaticFiles
from starlette.types import Receive, Scope, Send

from sequence_planner.web.security_headers import document_policy

IMMUTABLE = "_app/immutable/"
FOR_EVER = "public, max-age=31536000, immutable"
NOT_BUILT = """<!doctype html>
<html lang="en">
<head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>Sequence Planner</title></head>
<body><main><h1>The page is not built</h1>
<p>The server runs, but there is no page to show. <code>make run</code> builds it.</p></main></body>
</html>
"""


class PageFiles:
    """Answers with files of `folder` whatever no other route answers."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
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
            path += ".html"  # `/watch` is `watch.html`
        response = await self._files.get_response(path, scope)
        kept = path.startswith(IMMUTABLE) and response.status_code in (200, 206, 304)
        response.headers["Cache-Control"] = FOR_EVER if kept else "no-cache"
        if path.endswith(".html"):  # also when it has not changed: a browser then takes the new headers
            response.headers["Content-Security-Policy"] = document_policy(self.folder / path)
        return response


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # such as a name that is too long
        return False
