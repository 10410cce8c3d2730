"""Revisions of the model: saved under a name, compared, taken back into the draft, and deployed once checked."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

from fastapi import Depends, Path, Query, Request, Response
from pydantic import Field

from sequence_planner.auth.roles import Role, Scope
from sequence_planner.core.actor import Actor as Acting
from sequence_planner.editor.processes import PATIENCE, worked
from sequence_planner.editor.schemas.diff import ComparisonView, TransferView
from sequence_planner.editor.schemas.draft import (
    FilesView,
    PlannedDeploymentView,
    RevisionsView,
    RevisionView,
)
from sequence_planner.editor.schemas.what_if import untransferred
from sequence_planner.journal.entry import LONGEST_REASON
from sequence_planner.model.paths import EditError
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import (
    JSON_ONLY,
    Actor,
    Body,
    LiveView,
    found,
)
from sequence_planner.server.errors import refused
from sequence_planner.server.http.middleware import while_waited_for
from sequence_planner.server.interface import interface
from sequence_planner.server.services.deployments import (
    AskedDeployment,
    DeploymentService,
    draft_after,
    revision_of,
    transfer_question,
)
from sequence_planner.server.services.drafts import DRAFT, HASH, RUNNING, TheWorkshop, refusal, version_files

VIEWER = allowed(Role.VIEWER, scope=Scope.READ)
ENGINEER = allowed(Role.ENGINEER)

router = interface("/model", tags=["model"], responses=refused(409, 503))
Id = Annotated[str, Path(pattern=f"^{HASH}$")]


async def deployments(request: Request, shop: TheWorkshop) -> DeploymentService:
    """Who deploys the draft of the station, of which there is one where there is a workshop."""
    desk: DeploymentService = request.app.state.deployments
    return desk


Desk = Annotated[DeploymentService, Depends(deployments)]
Version = Annotated[str, Query(pattern=f"^({DRAFT}|{RUNNING}|{HASH})$")]
Wait = Annotated[float, Query(ge=0, le=PATIENCE)]
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


@router.get("/revisions", dependencies=[VIEWER])
async def revisions(shop: TheWorkshop) -> RevisionsView:
    """All revisions, and which of them run and are edited."""
    return await shop.revised()


@router.post("/revisions", status_code=201, dependencies=[ENGINEER, JSON_ONLY], responses=refused(422))
async def save_revision(body: RevisionBody, shop: TheWorkshop, actor: Actor) -> RevisionView:
    """Save the draft as a revision; refused where somebody has changed it since (`stale-draft`)."""
    draft = await draft_after(shop, body.number)
    try:
        return await shop.save(draft, body.name, body.message, actor)
    except EditError as error:
        raise refusal(error) from error


@router.post(
    "/revisions/{id}/restore", dependencies=[ENGINEER, JSON_ONLY], response_model=FilesView, responses=refused(404)
)
async def restore_revision(id: Id, body: RestoreBody, shop: TheWorkshop, actor: Actor) -> Response:
    """Let the draft become a revision again, which can be undone; the files that are others now."""
    draft = await draft_after(shop, body.number)
    files = await version_files(shop, id)
    return found(await shop.restore(draft, files, (await revision_of(shop, id)).name, actor))


@router.get("/comparison", dependencies=[VIEWER], response_model=ComparisonView, responses=refused(404))
async def comparison(
    shop: TheWorkshop,
    request: Request,
    old: Version,
    new: Version = DRAFT,
    wait: Wait = PATIENCE,
    written_only: Annotated[bool, Query()] = False,
) -> Response:
    """Difference of two versions in text and in behaviour: revisions by their ids, the draft, or what runs.

    What is known after `wait` seconds is answered, with what is being compared in `doing`: ask again for more. It ends
    when nobody asks for it any more. With `written_only` what follows from what is written is not found out, and stays
    null.
    """
    compared = shop.compared(
        await version_files(shop, old), await version_files(shop, new), wait, written_only=written_only
    )
    text = await while_waited_for(request, compared)
    return Response(status_code=204) if text is None else found(text)  # that nobody reads the one


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
    return await _found("fitted", *await transfer_question(shop, view, reset=simulation is Simulation.RESET))


@router.post("/deployments", status_code=204, dependencies=[ENGINEER, JSON_ONLY], responses=refused(404, 422, 504))
async def deploy(body: DeploymentBody, desk: Desk, actor: Actor, view: LiveView) -> None:
    """Let the checked revision that the draft is take the place of the model that runs.

    The controller begins anew with it: what was believed comes back, nothing is published, and a person starts
    production. Where it cannot be started with it the model before comes back: `deployment` in `GET /station` says what
    has become of it. 409 `not-approved` where the model that runs asks for a second person's approval that is missing,
    `not-checked` while the check of the draft has not ended, `check-found-errors` with the first
    of the errors and its place, `no-supervisor` where nothing of it could be started.
    """
    await desk.deploy(_asked(body, actor), view)


@router.get("/deployments/planned", dependencies=[VIEWER])
async def planned_deployment(shop: TheWorkshop) -> PlannedDeploymentView | None:
    """What is deployed when the product in work is done, or why that was not done; null where nothing is planned."""
    return shop.planned


@router.put(
    "/deployments/planned", status_code=204, dependencies=[ENGINEER, JSON_ONLY], responses=refused(404, 422, 504)
)
async def plan_deployment(body: DeploymentBody, desk: Desk, actor: Actor, view: LiveView) -> None:
    """Let the checked revision that the draft is take the place of the model that runs, once the product that is in
    work is done.

    The station pauses then (`cycle_stop`); what cannot be deployed at that moment is not, and `planned` in the stream
    of the model says why. Refused as a deployment at once is, but for what the station is doing; 409 `not-automatic`
    where it does not work.
    """
    await desk.deploy_when_done(_asked(body, actor), view)


@router.delete("/deployments/planned", status_code=204, dependencies=[ENGINEER])
async def cancel_deployment(desk: Desk) -> None:
    """Deploy nothing when the product is done. The station pauses then unless `/mode/cycle-stop` takes that back."""
    desk.cancel()


def _asked(body: DeploymentBody, actor: Acting) -> AskedDeployment:
    return AskedDeployment(body.revision, body.number, body.reason, reset=body.simulation is Simulation.RESET, by=actor)


async def _found(name: str, *arguments: object) -> Response:
    """Return what a task of the workshop finds."""
    text = await worked("told", name, *arguments)
    assert isinstance(text, str)
    return found(text)
