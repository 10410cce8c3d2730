"""Routes of live queries: ability definitions and trials, pipelines, ROS graph, explanations."""

from __future__ import annotations

from typing import Annotated

from fastapi import Path, Query, WebSocket
from pydantic import Field, StrictBool

from sequence_planner.auth.roles import Role, Scope
from sequence_planner.controller.commands.commands import TryAbility
from sequence_planner.controller.commands.queries import AboutFlows, AboutPipelines, AskDefinition, AskWhyNot
from sequence_planner.controller.views.details import AbilityDefinitionView, NetworkView, WhyNotView
from sequence_planner.controller.views.pipelines import FlowsView, PipelinesView
from sequence_planner.server.api.commands import ENGINEER, GoalBody
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import JSON_ONLY, Actor, Body, Controller, LiveView, Reason
from sequence_planner.server.errors import ProblemFound, refused
from sequence_planner.server.interface import interface
from sequence_planner.server.stream.broadcast import FlowsFeed, NetworkFeed
from sequence_planner.server.stream.endpoints import serve

# Abilities one by one: how one is defined, what of that holds now, and a trial of it alone.

LONGEST_ABILITY = 400  # characters
abilities_router = interface(tags=["abilities"])


class TrialBody(Body):
    """`real_devices` confirms that devices may move which are not emulated ones."""

    ability: Annotated[str, Field(min_length=1, max_length=LONGEST_ABILITY)]
    real_devices: StrictBool = False
    reason: Reason = None


@abilities_router.get(
    "/abilities/{name}/definition",
    dependencies=[allowed(Role.VIEWER, scope=Scope.READ)],
    responses=refused(404, 504),
)
async def ability_definition(
    name: Annotated[str, Path(max_length=LONGEST_ABILITY)], client: Controller
) -> AbilityDefinitionView:
    """Its guards, actions and expected reactions as they are written, what of them holds now, and its last trial."""
    return await client.ask(AskDefinition(ability=name))


@abilities_router.post(
    "/test-runs",
    status_code=204,
    dependencies=[JSON_ONLY, allowed(Role.ENGINEER)],
    responses=refused(404, 409, 422, 504),
)
async def start_test_run(body: TrialBody, client: Controller, actor: Actor) -> None:
    """Start the ability alone, at once; `POST /operator-plans/stop` ends that. It takes control, and the paused mode.

    409 `not-startable` says what its guards or the supervisor lack; `real-devices`: they have not been confirmed.
    """
    await client.send(TryAbility(actor=actor, ability=body.ability, real_devices=body.real_devices, reason=body.reason))


# The pipelines: their typed graph, and what passes it, read once or as it goes on.

# Pipelines by name, repeated as in `?pipeline=/robot/state&pipeline=robot.holding`.
Names = Annotated[list[Annotated[str, Query(max_length=500)]] | None, Query(max_length=200)]

pipelines_router = interface(
    "/pipelines",
    tags=["pipelines"],
    dependencies=[allowed(Role.VIEWER, scope=Scope.READ)],
    responses=refused(504),
)


@pipelines_router.get("")
async def pipelines(client: Controller) -> PipelinesView:
    """The typed graph: topics and flows with their stages, the fields on each edge, and what they become."""
    return await client.ask(AboutPipelines())


@pipelines_router.get("/edges")
async def pipeline_edges(client: Controller, pipeline: Names = None) -> FlowsView:
    """What has passed each edge of the pipelines that are named, or of all: counts, rates, drops and the last record.
    Rates come with the second look.
    """
    return await client.ask(AboutFlows(among=None if pipeline is None else frozenset(pipeline)))


@pipelines_router.websocket("/stream")
async def pipelines_stream(websocket: WebSocket, pipeline: Names = None) -> None:
    """Serve one client: what has passed each edge of the pipelines that are named, or of all, twice a second."""
    show: FlowsFeed = websocket.app.state.flows_show
    await serve(websocket, show.of(None if pipeline is None else frozenset(pipeline)))


# The ROS graph, read once or as it changes.

ros_router = interface("/ros", tags=["ros"], dependencies=[allowed(Role.VIEWER, scope=Scope.READ)])


@ros_router.get("/graph")
async def ros_graph(view: LiveView, client: Controller) -> NetworkView:
    """All nodes, topics, services and actions that the station's transport knows, and how the station meets them.

    503 until the station is prepared and has joined the network.
    """
    if client.network is None:
        detail = "The station is being prepared and has not joined the network. Try again in a moment."
        raise ProblemFound(503, "preparing", "The station is being prepared", detail)
    return client.network


@ros_router.websocket("/stream")
async def ros_stream(websocket: WebSocket) -> None:
    """Serve one client: the graph, and again whenever it has changed."""
    show: NetworkFeed = websocket.app.state.network_show
    await serve(websocket, show.latest)


# What keeps an ability from starting, an operation from being active or done, or a goal from holding.

blockers_router = interface(tags=["station"], responses=refused(504))
LOOKED_AT = allowed(Role.VIEWER, scope=Scope.READ)
Blocked = Annotated[str, Path(max_length=400)]


@blockers_router.get("/abilities/{name}/blockers", dependencies=[LOOKED_AT], responses=refused(404))
async def ability_blockers(name: Blocked, client: Controller) -> WhyNotView:
    """What keeps an ability from starting, and who could change it."""
    return await client.ask(AskWhyNot(of="ability", name=name))


@blockers_router.get("/operations/{name}/blockers", dependencies=[LOOKED_AT], responses=refused(404))
async def operation_blockers(name: Blocked, client: Controller) -> WhyNotView:
    """What keeps an operation from being active or completed, and who could change it."""
    return await client.ask(AskWhyNot(of="operation", name=name))


@blockers_router.post("/goals/blockers", dependencies=[ENGINEER, JSON_ONLY])
async def goal_blockers(body: GoalBody, client: Controller) -> WhyNotView:
    """What keeps a predicate from being true, and whether the station could reach it; 422 `bad-predicate`."""
    return await client.ask(AskWhyNot(of="goal", name=body.predicate))
