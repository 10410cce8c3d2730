"""The pipelines: their typed graph, and what passes it, read once or as it goes on."""

from __future__ import annotations

from typing import Annotated

from fastapi import Query, WebSocket

from sequence_planner.control.asks import AboutFlows, AboutPipelines
from sequence_planner.control.pipeline_view import FlowsView, PipelinesView
from sequence_planner.identity.roles import Role, Scope
from sequence_planner.web.access import allowed
from sequence_planner.web.interface import interface
from sequence_planner.web.looking import FlowsShow
from sequence_planner.web.problems import refused
from sequence_planner.web.request_parts import Controller
from sequence_planner.web.stream import serve

# Pipelines by name, repeated as in `?pipeline=/robot/state&pipeline=robot.holding`.
Names = Annotated[list[Annotated[str, Query(max_length=500)]] | None, Query(max_length=200)]

router = interface(
    "/pipelines",
    tags=["pipelines"],
    dependencies=[allowed(Role.VIEWER, scope=Scope.READ)],
    responses=refused(504),
)


@router.get("")
async def pipelines(client: Controller) -> PipelinesView:
    """The typed graph: topics and flows with their stages, the fields on each edge, and what they become."""
    return await client.ask(AboutPipelines())


@router.get("/edges")
async def pipeline_edges(client: Controller, pipeline: Names = None) -> FlowsView:
    """What has passed each edge of the pipelines that are named, or of all: counts, rates, drops and the last record.
    Rates come with the second look.
    """
    return await client.ask(AboutFlows(among=None if pipeline is None else frozenset(pipeline)))


@router.websocket("/stream")
async def stream(websocket: WebSocket, pipeline: Names = None) -> None:
    """Serve one client: what has passed each edge of the pipelines that are named, or of all, twice a second."""
    show: FlowsShow = websocket.app.state.flows_show
    await serve(websocket, show.of(None if pipeline is None else frozenset(pipeline)))
