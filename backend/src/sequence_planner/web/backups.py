"""Backups: which there are, making one, and reading one as a whole. They stay on the server, and so does restoring.

A backup holds password hashes and who did what. Whoever gets hold of an administrator's browser for a minute must not
be able to carry all of that away, so none can be downloaded: who may read the folder may copy it from there.
"""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Request

from sequence_planner.backup.trouble import trouble_in
from sequence_planner.identity.roles import Role
from sequence_planner.web.access import allowed
from sequence_planner.web.backup_desk import BackupDesk, Busy, CannotBeginError, FolderSilentError, OtherBusyError
from sequence_planner.web.backups_answer import BackupBusyAnswer, BackupsAnswer, backups_answer, busy_answer
from sequence_planner.web.body import Identifier, NothingBody
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import ProblemFound, refused
from sequence_planner.web.request_parts import JSON_ONLY, Actor

ADMINISTRATOR = allowed(Role.ADMINISTRATOR)
bodiless = interface("/backups", tags=["backups"], dependencies=[ADMINISTRATOR], responses=refused(409))
router = interface("/backups", tags=["backups"], dependencies=[ADMINISTRATOR, JSON_ONLY], responses=refused(409))


async def _desk(request: Request) -> BackupDesk:
    """Who looks after backups. Raises `ProblemFound` where there are none."""
    found: BackupDesk | None = request.app.state.backups
    if found is None:
        if request.app.state.settings.demonstration:
            detail = "What a demonstration keeps is forgotten at its end, so there is nothing to back up."
            raise ProblemFound(409, "demonstration", "A demonstration has no backups", detail)
        detail = "This server does not know where the station's model is. Start it with `sequence-planner run MODEL`."
        raise ProblemFound(409, "no-model", "The model is not known", detail)
    return found


Desk = Annotated[BackupDesk, Depends(_desk)]


@bodiless.get("")
async def all_backups(desk: Desk) -> BackupsAnswer:
    """Which backups there are, what is being done, and what would be in the way of another."""
    try:
        looked, recorded = await desk.look(), await desk.recorded()
    except FolderSilentError as error:
        raise _silent(error) from None
    return backups_answer(desk.shelf, looked, recorded, desk.busy)


@router.post("", status_code=202)
async def make(body: NothingBody, desk: Desk, actor: Actor) -> BackupBusyAnswer:
    """Make a backup in the background. Whoever asks while one is being made gets that one."""
    try:
        return busy_answer(await desk.make(actor))
    except CannotBeginError as error:
        slug, why = f"backup-{trouble_in(error.trouble)}", str(error)
        raise ProblemFound(409, slug, "A backup cannot be made", f"{why[:1].upper()}{why[1:]}.") from None
    except OtherBusyError as other:
        raise _other(other.busy) from None
    except FolderSilentError as error:
        raise _silent(error) from None


@router.post("/{file}/check", status_code=202, responses=refused(404))
async def check(file: Identifier, body: NothingBody, desk: Desk, actor: Actor) -> BackupBusyAnswer:
    """Read a backup as a whole in the background, as if it were to be restored, but put nothing in place."""
    try:
        busy = await desk.check(file, actor)
    except OtherBusyError as other:
        raise _other(other.busy) from None
    except FolderSilentError as error:
        raise _silent(error) from None
    if busy is None:
        detail = f"There is no backup of this name in {desk.shelf.folder}. Look at the list again."
        raise ProblemFound(404, "no-backup", "The backup is not there", detail)
    return busy_answer(busy)


def _other(busy: Busy) -> ProblemFound:
    detail = (
        f"{busy.file} is being worked on for {busy.by.name}, and one backup is made or checked at a time. Try again."
    )
    return ProblemFound(409, "backup-busy", "Another backup is worked on", detail)


def _silent(error: FolderSilentError) -> ProblemFound:
    detail = f"{error} does not answer. If it is on another machine, see whether that can be reached; then try again."
    return ProblemFound(503, "backup-folder-silent", "The folder of the backups does not answer", detail)
