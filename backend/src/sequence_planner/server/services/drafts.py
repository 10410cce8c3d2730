"""The workshop as routes depend on it: the draft of the station, its versions, and what edits are refused with."""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends
from fastapi.requests import HTTPConnection

from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.editor.draft import PartChangedError
from sequence_planner.model.files import Files
from sequence_planner.model.paths import EditError
from sequence_planner.server.errors import ProblemFound
from sequence_planner.server.services.deployments import revision_of
from sequence_planner.server.services.editor import Workshop
from sequence_planner.texts.message import message

DRAFT, RUNNING = "draft", "running"
HASH = "[0-9a-f]{40}"


async def workshop(connection: HTTPConnection) -> Workshop:
    """The workshop of the station. Raises `ProblemFound` where the server does not know its model, or stands by.

    Who stands by has a folder of its own, which may be older than the draft that all share.
    """
    client: ControllerClient = connection.app.state.controller
    if client.stands_by:
        raise ProblemFound(503, "on-standby", message("refused.on-standby.model"))
    shop: Workshop | None = connection.app.state.workshop
    if shop is None:
        raise ProblemFound(409, "no-model", message("refused.no-model.start"))
    return shop


TheWorkshop = Annotated[Workshop, Depends(workshop)]


async def version_files(shop: Workshop, version: str) -> Files:
    """Return the files of the draft, of what runs, or of a revision by its id. Raises `Refused`."""
    if version == DRAFT:
        return (await shop.open()).files
    if version == RUNNING:
        return (await shop.open()).base
    await revision_of(shop, version)
    return await shop.files_of(version)


def refusal(error: EditError) -> ProblemFound:
    """The problem that says why an edit is not made."""
    if isinstance(error, PartChangedError):
        return ProblemFound(409, "part-changed", message("refused.part-changed.why", why=error.why))
    return ProblemFound(422, "edit-refused", message("refused.edit-refused.why", why=error.why))
