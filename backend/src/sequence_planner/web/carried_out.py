"""The answer to what stops a station: it was carried out, and whether the journal has it."""

from __future__ import annotations

from typing import Any, Final, Literal

from fastapi import Response
from fastapi.responses import JSONResponse
from pydantic import BaseModel, ConfigDict


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
