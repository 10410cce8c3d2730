"""How much is kept and how it grows, for how long it is, and the archive; and to have what is old cut now."""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Request

from sequence_planner.identity.roles import Role
from sequence_planner.web.access import allowed
from sequence_planner.web.body import NothingBody
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import ProblemFound, refused
from sequence_planner.web.request_parts import JSON_ONLY, Actor
from sequence_planner.web.retention_desk import RetentionDesk
from sequence_planner.web.storage_answer import StorageAnswer, StorageBusyAnswer, storage_answer

ADMINISTRATOR = allowed(Role.ADMINISTRATOR)
bodiless = interface("/storage", tags=["storage"], dependencies=[ADMINISTRATOR], responses=refused(409))
router = interface("/storage", tags=["storage"], dependencies=[ADMINISTRATOR, JSON_ONLY], responses=refused(409))


async def _desk(request: Request) -> RetentionDesk:
    """Who looks after it. Raises `ProblemFound` where nobody does."""
    found: RetentionDesk | None = request.app.state.retention
    if found is None:
        if request.app.state.settings.demonstration:
            detail = "What a demonstration keeps is forgotten at its end, so nothing is archived."
            raise ProblemFound(409, "demonstration", "A demonstration keeps nothing", detail)
        detail = "This server does not know where the station's model is. Start it with `sequence-planner run MODEL`."
        raise ProblemFound(409, "no-model", "The model is not known", detail)
    return found


Desk = Annotated[RetentionDesk, Depends(_desk)]


@bodiless.get("")
async def storage(desk: Desk) -> StorageAnswer:
    """How much there is of what, how it grows, since when what is kept, and what is in the way."""
    return storage_answer(desk, await desk.look())


@router.post("/archive", status_code=202)
async def archive_now(body: NothingBody, desk: Desk, actor: Actor) -> StorageBusyAnswer:
    """Cut what is older than the settings say now, in the background. Whoever asks while it is done gets that."""
    desk.ask(actor)
    return StorageBusyAnswer(by=actor.name if desk.busy is None else desk.busy.name)
