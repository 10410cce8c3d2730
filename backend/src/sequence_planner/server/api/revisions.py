"""Revisions of the model: saved under a name, compared, taken back into the draft, and deployed once checked."""

from __future__ import annotations

import secrets
import shutil
from enum import StrEnum
from pathlib import Path as Folder
from typing import Annotated

from fastapi import Path, Query, Request, Response
from pydantic import Field
from starlette.concurrency import run_in_threadpool

from sequence_planner.auth.roles import Role, Scope
from sequence_planner.controller.commands.execution import Deploy
from sequence_planner.controller.views.station import StationView
from sequence_planner.editor.draft import Draft
from sequence_planner.editor.processes import worked
from sequence_planner.editor.schemas.diff import ComparisonView, TransferView
from sequence_planner.editor.schemas.draft import FilesView, RevisionsView, RevisionView
from sequence_planner.editor.schemas.what_if import WhatIfView, untransferred
from sequence_planner.journal.entry import LONGEST_REASON
from sequence_planner.language.types import Value
from sequence_planner.model.files import Files, write_files
from sequence_planner.model.paths import EditError
from sequence_planner.server.api.history import looked_back
from sequence_planner.server.api.model import TheWorkshop, refusal
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import (
    JSON_ONLY,
    Actor,
    Body,
    Controller,
    LiveView,
    controller,
    found,
    live_view,
)
from sequence_planner.server.errors import ProblemFound, refused
from sequence_planner.server.http.middleware import while_waited_for
from sequence_planner.server.interface import interface
from sequence_planner.server.services.editor import Workshop
from sequence_planner.texts.message import Message, joined, message

DRAFT, RUNNING = "draft", "running"
SIMULATING = 40.0  # seconds of work
VIEWER = allowed(Role.VIEWER, scope=Scope.READ)
ENGINEER = allowed(Role.ENGINEER)
HASH = "[0-9a-f]{40}"

router = interface("/model", tags=["model"], responses=refused(409, 503))
Id = Annotated[str, Path(pattern=f"^{HASH}$")]
Version = Annotated[str, Query(pattern=f"^({DRAFT}|{RUNNING}|{HASH})$")]
Number = Annotated[int, Field(ge=0, le=2**53 - 1, strict=True)]


class RevisionBody(Body):
    """The draft after its change `number` is saved under a name."""

    number: Number
    name: Annotated[str, Field(min_length=1, max_length=200)]
    message: Annotated[str, Field(max_length=5000)] = ""


class RestoreBody(Body):
    """The draft, after its change `number`, becomes the revision."""

    number: Number


class Simulation(StrEnum):
    """Treatment of emulated devices: they go on as they stand, or they and the station begin as the model says."""

    KEEP = "keep"
    RESET = "reset"


class DeploymentBody(Body):
    """The revision that the draft is, after its change `number`, takes the place of the model that runs.

    A `simulation` can be reset only where the devices are emulated.
    """

    revision: Annotated[str, Field(pattern=f"^{HASH}$")]
    number: Number
    reason: Annotated[str, Field(min_length=1, max_length=LONGEST_REASON)]
    simulation: Simulation = Simulation.KEEP


class WhatIfBody(Body):
    """For how many seconds, and from which record of the past on; without one from the present."""

    seconds: Annotated[float, Field(gt=0, le=600.0, strict=True)]
    number: Annotated[int, Field(ge=1, le=2**53 - 1, strict=True)] | None = None


@router.get("/revisions", dependencies=[VIEWER])
async def revisions(shop: TheWorkshop) -> RevisionsView:
    """All revisions, and which of them run and are edited."""
    return await shop.revised()


@router.post("/revisions", status_code=201, dependencies=[ENGINEER, JSON_ONLY], responses=refused(422))
async def save_revision(body: RevisionBody, shop: TheWorkshop, actor: Actor) -> RevisionView:
    """Save the draft as a revision; refused where somebody has changed it since (`stale-draft`)."""
    draft = await _at(shop, body.number)
    try:
        return await shop.save(draft, body.name, body.message, actor)
    except EditError as error:
        raise refusal(error) from error


@router.post(
    "/revisions/{id}/restore", dependencies=[ENGINEER, JSON_ONLY], response_model=FilesView, responses=refused(404)
)
async def restore_revision(id: Id, body: RestoreBody, shop: TheWorkshop, actor: Actor) -> Response:
    """Let the draft become a revision again, which can be undone; the files that are others now."""
    draft = await _at(shop, body.number)
    files = await _files(shop, id)
    return found(await shop.restore(draft, files, (await _known(shop, id)).name, actor))


@router.get("/comparison", dependencies=[VIEWER], response_model=ComparisonView, responses=refused(404))
async def comparison(shop: TheWorkshop, old: Version, new: Version = DRAFT) -> Response:
    """Difference of two versions in text and in behaviour: revisions by their ids, the draft, or what runs."""
    files = await _files(shop, old), await _files(shop, new)
    return await _found("compared", *files, shop.folder)


@router.get("/transfer", dependencies=[VIEWER], response_model=TransferView, responses=refused())
async def transfer(
    shop: TheWorkshop, view: LiveView, simulation: Annotated[Simulation, Query()] = Simulation.KEEP
) -> Response:
    """Check if the station could take the draft as it is now, or with the simulation reset.

    Where no station may run the draft, as its check has not ended or has found errors, `obstacle` says what a
    deployment would be refused with.
    """
    if (hindrance := (await shop.checked()).hindrance((await shop.open()).number)) is not None:
        return found(untransferred(hindrance.why).model_dump_json())
    return await _found("fitted", *await _to_fit(shop, view, simulation))


@router.post("/what-if", dependencies=[ENGINEER, JSON_ONLY], response_model=WhatIfView, responses=refused(404))
async def what_if(body: WhatIfBody, shop: TheWorkshop, request: Request) -> Response:
    """Simulate the station with the draft, from its present state or from a past record; nothing of it reaches
    the station. It ends when who asked leaves.
    """
    draft = await shop.open()
    present = await _present(request) if body.number is None else await _past(request, body.number)
    simulated = _found("simulated", draft.files, shop.folder, present, body.seconds, SIMULATING)
    return await while_waited_for(request, simulated) or Response(status_code=204)  # which nobody reads


@router.post("/deployments", status_code=204, dependencies=[ENGINEER, JSON_ONLY], responses=refused(404, 422, 504))
async def deploy(body: DeploymentBody, shop: TheWorkshop, actor: Actor, client: Controller, view: LiveView) -> None:
    """Let the checked revision that the draft is take the place of the model that runs.

    The controller begins anew with it: what was believed comes back, nothing is published, and a person starts
    production. Where it cannot be started with it the model before comes back: `deployment` in `GET /station` says what
    has become of it. 409 `not-checked` while the check of the draft has not ended, `check-found-errors` with the first
    of the errors and its place, `no-supervisor` where nothing of it could be started.
    """
    draft = await _at(shop, body.number)
    known = await _known(shop, body.revision)
    if not known.draft:
        raise ProblemFound(409, "not-the-draft", message("refused.not-the-draft.take-back"))
    if (hindrance := (await shop.checked()).hindrance(draft.number)) is not None:
        raise ProblemFound(409, hindrance.slug, f"{hindrance.why}.", title=hindrance.title)
    fits = await worked("fitted", *await _to_fit(shop, view, body.simulation))
    assert isinstance(fits, TransferView)
    if not fits.legal:
        raise ProblemFound(409, "not-legal", _why_not(fits))
    reset = body.simulation is Simulation.RESET
    if reset and not view.station.emulated:
        raise ProblemFound(409, "not-emulated", message("refused.not-emulated.reset"))
    shop.note_deployment(draft)
    staged = client.path.parent / f"deploy-{secrets.token_hex(8)}"
    await run_in_threadpool(_stage, draft.files, staged)
    try:
        await client.send(
            Deploy(actor=actor, reason=body.reason, revision=known.id, name=known.name, staged=staged.name, reset=reset)
        )
    finally:
        await run_in_threadpool(shutil.rmtree, staged, True)


async def _at(shop: Workshop, number: int) -> Draft:
    draft = await shop.open()
    if draft.number != number:
        raise ProblemFound(409, "stale-draft", message("refused.stale-draft.look"))
    return draft


async def _known(shop: Workshop, id: str) -> RevisionView:
    found = next((each for each in (await shop.revised()).revisions if each.id == id), None)
    if found is None:
        raise ProblemFound(404, "no-revision", message("refused.no-revision.look"))
    return found


async def _files(shop: Workshop, version: str) -> Files:
    if version == DRAFT:
        return (await shop.open()).files
    if version == RUNNING:
        return (await shop.open()).base
    await _known(shop, version)
    return await shop.files_of(version)


async def _to_fit(shop: Workshop, view: StationView, simulation: Simulation) -> tuple[object, ...]:
    """Return what `tasks.fitted` is asked about."""
    draft = await shop.open()
    present = {name: variable.value for name, variable in view.variables.items()}
    running = [name for name, ability in view.abilities.items() if ability.running_since is not None]
    return draft.base, draft.files, shop.folder, present, running, simulation is Simulation.RESET


async def _present(request: Request) -> dict[str, Value | None]:
    view = await live_view(await controller(request))
    return {name: variable.value for name, variable in view.variables.items()}


async def _past(request: Request, number: int) -> dict[str, Value | None]:
    moment = await looked_back(request, number)
    return dict(moment.past.values)


async def _found(name: str, *arguments: object) -> Response:
    """Return what a task of the workshop finds."""
    text = await worked("told", name, *arguments)
    assert isinstance(text, str)
    return found(text)


def _why_not(fits: TransferView) -> Message:
    if fits.obstacle is not None:
        return message("refused.not-legal.obstacle", why=fits.obstacle)
    if fits.under_way:
        return message("refused.not-legal.under-way", abilities=", ".join(fits.under_way))
    if fits.violated:
        return message("refused.not-legal.violates", specifications=joined(fits.violated))
    return message("refused.not-legal.no-rest")


def _stage(files: Files, folder: Folder) -> None:
    folder.mkdir(mode=0o700)
    write_files(files, folder)
