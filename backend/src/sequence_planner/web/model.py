"""The model while it is edited: the draft that all engineers of the station share, and what is found in it.

Nothing of the station that runs is touched by it.
"""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Path, Query, Response, WebSocket
from fastapi.requests import HTTPConnection
from pydantic import Field

from sequence_planner.control.definition_view import AutomatonView
from sequence_planner.identity.roles import Role, Scope
from sequence_planner.model.paths import EditError
from sequence_planner.web.access import allowed
from sequence_planner.web.body import Body, NothingBody
from sequence_planner.web.controller_client import ControllerClient
from sequence_planner.web.found import UnreadBody, found, takes
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import ProblemFound, refused
from sequence_planner.web.request_parts import JSON_ONLY, Actor
from sequence_planner.web.stream import serve
from sequence_planner.web.workshop import Workshop
from sequence_planner.workshop.check_view import CheckView
from sequence_planner.workshop.edits import ChangeBody, FilePath, PartChangedError
from sequence_planner.workshop.graph_view import GraphView
from sequence_planner.workshop.view import DraftView, FilesView, UsagesView

Finding = Annotated[int, Path(ge=0, le=2**31)]
AbilityName = Annotated[str, Query(min_length=1, max_length=400)]
PartId = Annotated[str, Field(min_length=3, max_length=500)]
VIEWER = allowed(Role.VIEWER, scope=Scope.READ)
ENGINEER = allowed(Role.ENGINEER)

router = interface("/model", tags=["model"], responses=refused(409, 503))


async def workshop(connection: HTTPConnection) -> Workshop:
    """The workshop of the station. Raises `ProblemFound` where the server does not know its model, or stands by.

    Who stands by has a folder of its own, which may be older than the draft that all share.
    """
    client: ControllerClient = connection.app.state.controller
    if client.stands_by:
        detail = "The model is edited at the station that commands. Open its page."
        raise ProblemFound(503, "stands-by", "This station stands by", detail)
    shop: Workshop | None = connection.app.state.workshop
    if shop is None:
        detail = "This server does not know where the station's model is. Start it with `sequence-planner run MODEL`."
        raise ProblemFound(409, "no-model", "The model is not known", detail)
    return shop


TheWorkshop = Annotated[Workshop, Depends(workshop)]


class RenameBody(Body):
    """A part of the model by its id, such as `variable:robot.pose`, and what it shall be called."""

    part: PartId
    name: Annotated[str, Field(min_length=1, max_length=200)]


@router.get("", dependencies=[VIEWER])
async def draft(shop: TheWorkshop, actor: Actor) -> DraftView:
    """The draft of the model: its files, and the last changes."""
    return await shop.view(actor)


@router.get("/files", dependencies=[VIEWER], response_model=FilesView)
async def draft_files(
    shop: TheWorkshop, path: Annotated[list[FilePath] | None, Query(max_length=500)] = None
) -> Response:
    """Files of the draft with what they hold; all of them where no `path` is named."""
    return found(await shop.files(path))


@router.get("/check", dependencies=[VIEWER])
async def check_model(shop: TheWorkshop) -> CheckView:
    """What is found in the draft, as far as that has come."""
    return await shop.checked()


@router.get("/check/findings/{finding}/run", dependencies=[VIEWER], responses=refused(404))
async def finding_run(
    shop: TheWorkshop, finding: Finding, ability: AbilityName, number: Annotated[int, Query(ge=0, le=2**53 - 1)]
) -> list[AutomatonView]:
    """How an ability goes through the run that shows a finding: its automaton in the initial state and after each step.

    The finding is named by its place in the check of the draft after change `number`.
    """
    try:
        return await shop.played(finding, ability, number)
    except EditError as error:
        raise ProblemFound(404, "no-run", "There is no such run", _sentence(error)) from error


@router.post(
    "/changes",
    dependencies=[ENGINEER],
    response_model=FilesView,
    responses=refused(422),
    openapi_extra=takes(ChangeBody),
)
async def change_draft(body: UnreadBody, shop: TheWorkshop, actor: Actor) -> Response:
    """Carry edits out; the files that are others now.

    An edit of a part that somebody else has changed meanwhile is refused with `part-changed`, and nothing is done.
    """
    try:
        return found(await shop.request(body, actor))
    except EditError as error:
        raise refusal(error) from error


@router.post("/rename", dependencies=[ENGINEER, JSON_ONLY], response_model=FilesView, responses=refused(422))
async def rename_part(body: RenameBody, shop: TheWorkshop, actor: Actor) -> Response:
    """Give a part of the model another name, which all that name it follow; the files that are others now."""
    try:
        return found(await shop.rename(body.part, body.name, actor))
    except EditError as error:
        raise refusal(error) from error


@router.get("/usages", dependencies=[VIEWER], response_model=UsagesView, responses=refused(422))
async def usages(shop: TheWorkshop, part: PartId) -> Response:
    """Where a part of the model, such as `variable:robot.pose`, is named, and what could not be without it."""
    try:
        return found(await shop.usages(part))
    except EditError as error:
        raise refusal(error) from error


@router.get("/graph", dependencies=[VIEWER], response_model=GraphView)
async def model_graph(shop: TheWorkshop) -> Response:
    """The model as a whole: all that has a name, on the layers of the station, and what is tied to what."""
    return found(await shop.tied())


@router.post("/undo", dependencies=[ENGINEER, JSON_ONLY], response_model=FilesView, responses=refused(422))
async def undo_change(body: NothingBody, shop: TheWorkshop, actor: Actor) -> Response:
    """Take back your last change that is not taken back yet; the files that are others now."""
    try:
        return found(await shop.undo(actor))
    except EditError as error:
        raise refusal(error) from error


@router.post("/redo", dependencies=[ENGINEER, JSON_ONLY], response_model=FilesView, responses=refused(422))
async def redo_change(body: NothingBody, shop: TheWorkshop, actor: Actor) -> Response:
    """Do again what you took back last; the files that are others now."""
    try:
        return found(await shop.redo(actor))
    except EditError as error:
        raise refusal(error) from error


@router.websocket("/stream", dependencies=[VIEWER])
async def stream(websocket: WebSocket) -> None:
    """Serve one client: the draft and its check, whenever they change."""
    shop = await workshop(websocket)
    await shop.open()
    await serve(websocket, shop.latest)


def refusal(error: EditError) -> ProblemFound:
    """The problem that says why an edit is not made."""
    text = _sentence(error)
    if isinstance(error, PartChangedError):
        detail = f"{text} Nothing was changed: look at what it is now, and repeat yours if it is still wanted."
        return ProblemFound(409, "part-changed", "It was changed meanwhile", detail)
    return ProblemFound(422, "edit-refused", "It cannot be changed so", text)


def _sentence(error: Exception) -> str:
    return f"{str(error)[:1].upper()}{str(error)[1:]}."
