"""Pictures and videos of instructions, as they lie in the folder of the station."""

from __future__ import annotations

import hashlib
import os
import re
import stat
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Final
from xml.sax.saxutils import quoteattr

from fastapi.concurrency import run_in_threadpool
from starlette.responses import FileResponse, Response

from sequence_planner.controller.views.station import TaskView, VariableView
from sequence_planner.model.files import is_binary, largest
from sequence_planner.model.paths import INSTRUCTION, INSTRUCTIONS
from sequence_planner.server.errors import ProblemFound
from sequence_planner.server.settings import Settings
from sequence_planner.texts.message import message

_TYPES: Final = {
    "svg": "image/svg+xml",
    "png": "image/png",
    "jpg": "image/jpeg",
    "webp": "image/webp",
    "mp4": "video/mp4",
    "webm": "video/webm",
}
_INDEXED: Final = re.compile(r"(?:^|\.)(\w+)\[([^\],]+)\]$")
_WITH_ID: Final = re.compile(r"""<[A-Za-z][^<>]*?\sid=(["'])(?P<id>[^"'<>]*)\1""")
# Whoever opens one by itself sees it, and it runs nothing and loads nothing.
_SANDBOX: Final = "default-src 'none'; style-src 'unsafe-inline'; sandbox; frame-ancestors 'none'"
INSTRUCTION_ANSWERS: Final[dict[int | str, dict[str, Any]]] = {
    200: {
        "description": "The file, as its name says.",
        "content": {each: {"schema": {"type": "string", "format": "binary"}} for each in _TYPES.values()},
        "headers": {"ETag": {"description": "What it is now; see `If-None-Match`.", "schema": {"type": "string"}}},
    },
    206: {"description": "The part of it that was asked for."},
}


def names_of(tasks: Iterable[TaskView]) -> set[str]:
    """The names of the files that the instructions of tasks show."""
    paths = [path for task in tasks if (each := task.instruction) for path in (each.image, each.video) if path]
    return {path.partition("#")[0].removeprefix(f"{INSTRUCTIONS}/") for path in paths}


def with_state(svg: str, variables: Mapping[str, VariableView]) -> str:
    """Return the drawing with the value of each indexed variable at the element that has its index as `id`: of
    `bolts[pair_1]` the one with `id="pair_1"` has it in `data-bolts`. What is unknown is said of none.
    """
    values: dict[str, str] = {}
    for name, variable in variables.items():
        found = _INDEXED.search(name)
        if found is None or variable.value is None:
            continue
        value = str(variable.value).lower() if isinstance(variable.value, bool) else str(variable.value)
        values[found[2]] = f"{values.get(found[2], '')} data-{found[1]}={quoteattr(value)}"
    return _WITH_ID.sub(lambda element: element[0] + values.get(element["id"], ""), svg)


async def instruction_answer(
    settings: Settings, name: str, known: str | None, shown: Mapping[str, VariableView] | None = None
) -> Response:
    """Answer with the file of that name; with its tag alone where that is among those that are `known`. A drawing has
    the state of the variables that are `shown`.

    Raises `ProblemFound` where there is none.
    """
    found = None if settings.model is None else await run_in_threadpool(_find, settings.model, name)
    if found is None:
        raise ProblemFound(404, "no-such-instruction", message("refused.no-such-instruction.name", name=name))
    path, status = found
    drawn = None
    if shown is not None and path.suffix == ".svg":
        drawn = with_state(await run_in_threadpool(path.read_text, encoding="utf-8", errors="replace"), shown)
    of_state = "" if drawn is None else f"-{hashlib.sha256(drawn.encode()).hexdigest()[:16]}"
    tag = f'"{status.st_mtime_ns:x}-{status.st_size:x}{of_state}"'
    headers = {
        "ETag": tag,
        "Cache-Control": "private, no-cache",
        "Content-Security-Policy": _SANDBOX,
        # What is compressed already, or is asked for in parts, is not compressed on its way.
        **({"Content-Encoding": "identity"} if is_binary(f"{INSTRUCTIONS}/{name}") else {}),
    }
    if known is not None and tag in (each.strip().removeprefix("W/") for each in known.split(",")):
        return Response(status_code=304, headers=headers)
    if drawn is not None:
        return Response(drawn, media_type=_TYPES["svg"], headers=headers)
    return FileResponse(path, media_type=_TYPES[path.suffix[1:]], headers=headers, stat_result=status)


def _find(model: Path, name: str) -> tuple[Path, os.stat_result] | None:
    """The file of that name, of a size that is shown; None where there is none."""
    if not INSTRUCTION.fullmatch(name):
        return None
    path = model / INSTRUCTIONS / name
    try:
        status = path.stat()
        return (path, status) if stat.S_ISREG(status.st_mode) and status.st_size <= largest(name) else None
    except OSError:
        return None
