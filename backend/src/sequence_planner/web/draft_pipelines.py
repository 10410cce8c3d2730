"""The pipelines of the draft: their graph, what could be put where, and runs of them. What is edited is edited as the
rest of the model is, with `POST /model/changes`.
"""

from __future__ import annotations

from typing import Annotated

from fastapi import Response
from pydantic import Field

from sequence_planner.control.asks import AskRecord
from sequence_planner.identity.roles import Role, Scope
from sequence_planner.model.paths import EditError
from sequence_planner.web.access import allowed
from sequence_planner.web.body import Body
from sequence_planner.web.found import UnreadBody, found, takes
from sequence_planner.web.interface import interface
from sequence_planner.web.model import TheWorkshop, refusal
from sequence_planner.web.problems import refused
from sequence_planner.web.request_parts import JSON_ONLY, Actor, Controller
from sequence_planner.web.workshop import Workshop
from sequence_planner.workshop.pipelines.questions import (
    Everything,
    Examples,
    Fitting,
    PipelineId,
    PipelineQuestion,
    Preview,
    Trial,
)
from sequence_planner.workshop.pipelines.view import (
    DraftPipelinesView,
    FitsView,
    PreviewView,
    RecordedView,
    RunsView,
)

router = interface("/model/pipelines", tags=["model"], responses=refused(409, 503))
VIEWER = allowed(Role.VIEWER, scope=Scope.READ)


class RecordBody(Body):
    """What the station has heard or said last of a pipeline becomes an example of this name in the draft."""

    pipeline: PipelineId
    name: Annotated[str, Field(min_length=1, max_length=200)]


@router.get("", dependencies=[VIEWER], response_model=DraftPipelinesView)
async def draft_pipelines(shop: TheWorkshop) -> Response:
    """The typed graph of the draft as far as it is sound, and what is wrong with it, where it is wrong."""
    return await _found(shop, Everything())


@router.post("/fits", dependencies=[VIEWER, JSON_ONLY], response_model=FitsView, responses=refused(422))
async def find_fits(body: Fitting, shop: TheWorkshop) -> Response:
    """What could be put at an edge: kinds of stages, what its fields could become, and further sources of a flow."""
    return await _found(shop, body)


@router.post("/preview", dependencies=[VIEWER], response_model=PreviewView, openapi_extra=takes(Preview))
async def preview_pipelines(body: UnreadBody, shop: TheWorkshop) -> Response:
    """What edits would bring about; nothing is changed."""
    return await _found(shop, body)


@router.post("/examples", dependencies=[VIEWER, JSON_ONLY], response_model=RunsView, responses=refused(422))
async def run_examples(body: Examples, shop: TheWorkshop) -> Response:
    """How the examples of a pipeline end, with the record at every edge."""
    return await _found(shop, body)


@router.post("/trials", dependencies=[VIEWER, JSON_ONLY], response_model=RunsView, responses=refused(422))
async def try_pipeline(body: Trial, shop: TheWorkshop) -> Response:
    """What comes of a message, or of several in time that is told, with the record at every edge."""
    return await _found(shop, body)


@router.post(
    "/recordings", dependencies=[allowed(Role.ENGINEER), JSON_ONLY], status_code=201, responses=refused(422, 504)
)
async def record_example(body: RecordBody, shop: TheWorkshop, client: Controller, actor: Actor) -> RecordedView:
    """Make an example of what the station has heard or said last; it is added to the draft."""
    heard = await client.ask(AskRecord(pipeline=body.pipeline))
    try:
        return await shop.record(body.pipeline, body.name, heard, actor)
    except EditError as error:
        raise refusal(error) from error


async def _found(shop: Workshop, question: PipelineQuestion | bytes) -> Response:
    try:
        return found(await shop.ask_pipelines(question))
    except EditError as error:
        raise refusal(error) from error
