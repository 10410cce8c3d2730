"""Routes of recordings of ROS 2 traffic, from which What-if can begin."""

from __future__ import annotations

from typing import Annotated, Any, Final

from fastapi import Depends, Path, Query, Request, Response
from starlette.requests import ClientDisconnect

from sequence_planner.auth.roles import Role
from sequence_planner.editor.recordings.schemas import RecordedStateView, RecordingView
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import found
from sequence_planner.server.errors import ProblemFound, refused
from sequence_planner.server.http.middleware import while_waited_for
from sequence_planner.server.interface import interface
from sequence_planner.server.services.drafts import TheRecordings
from sequence_planner.texts.message import message

ENGINEER = allowed(Role.ENGINEER)
OCTETS: Final = "application/octet-stream"
BODY: Final[dict[str, Any]] = {
    "requestBody": {"required": True, "content": {OCTETS: {"schema": {"type": "string", "format": "binary"}}}}
}

router = interface("/model/recordings", tags=["model"], responses=refused(409, 503))
FileName = Annotated[str, Query(min_length=1, max_length=255, pattern=r"^[^\x00-\x1f\x7f]*$")]
RecordingId = Annotated[str, Path(pattern="^[0-9a-f]{1,64}$")]
Seconds = Annotated[float, Query(ge=0, le=1e10, allow_inf_nan=False)]


async def octets_only(request: Request) -> None:
    """A file is sent as such: no page of somebody else can do so without being asked first."""
    media, _, _ = request.headers.get("content-type", "").partition(";")
    if media.strip().lower() != OCTETS:
        raise ProblemFound(415, "not-octets", message("refused.not-octets.header"))


@router.post(
    "",
    status_code=201,
    dependencies=[ENGINEER, Depends(octets_only)],
    response_model=RecordingView,
    responses=refused(400, 408, 413, 415, 422, 507),
    openapi_extra=BODY,
)
async def bring_recording(name: FileName, shelf: TheRecordings, request: Request) -> Response:
    """Bring a recording of the station's topics, as `ros2 bag record` makes it: a file .mcap or .db3, or a zip of its
    folder. It is read with the pipelines of the draft.

    The last four are kept, each for an hour after it was used. One that cannot be used is not: 422 `recording-unread`
    says what is wrong with which file, and what to do.
    """
    try:
        answer = found(await shelf.take(name, request.stream()))
    except ClientDisconnect:
        raise ProblemFound(400, "recording-incomplete", message("refused.recording-incomplete.again")) from None
    answer.status_code = 201
    return answer


@router.get("/{id}", dependencies=[ENGINEER], response_model=RecordingView, responses=refused(404, 422))
async def read_recording(
    id: RecordingId, shelf: TheRecordings, request: Request, since: Seconds | None = None
) -> Response:
    """Return what a recording has for the draft as it is now, with at most 2000 moments, those after `since`."""
    text = await while_waited_for(request, shelf.overview(id, -1.0 if since is None else since))
    return Response(status_code=204) if text is None else found(text)  # that nobody reads the one


@router.get("/{id}/state", dependencies=[ENGINEER], response_model=RecordedStateView, responses=refused(404, 422))
async def recorded_state(id: RecordingId, at: Seconds, shelf: TheRecordings, request: Request) -> Response:
    """Return the state of the draft that all messages give until so many seconds after the recording began.

    What no message gave is as the model begins, and said to be `not-recorded`.
    """
    text = await while_waited_for(request, shelf.state(id, at))
    return Response(status_code=204) if text is None else found(text)  # that nobody reads the one


@router.delete("/{id}", status_code=204, dependencies=[ENGINEER], responses=refused(404))
async def put_recording_away(id: RecordingId, shelf: TheRecordings) -> None:
    """Put a recording away before its time."""
    await shelf.put_away(id)
