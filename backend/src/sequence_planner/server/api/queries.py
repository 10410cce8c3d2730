"""Routes of live queries: ability definitions, previews, recovery proposals, pipelines, ROS graph, explanations."""

from __future__ import annotations

from typing import Annotated

from fastapi import Path, Query, WebSocket
from pydantic import Field

from sequence_planner.auth.roles import Role, Scope
from sequence_planner.controller.commands.command import GivenValues
from sequence_planner.controller.commands.queries import (
    LONGEST_PREDICATE,
    AboutFlows,
    AboutPipelines,
    AskAdvice,
    AskCorrection,
    AskDefinition,
    AskGoal,
    AskReset,
    AskWhyNot,
)
from sequence_planner.controller.views.details import AbilityDefinitionView, CorrectionPreview, NetworkView, WhyNotView
from sequence_planner.controller.views.pipelines import FlowsView, PipelinesView
from sequence_planner.controller.views.proposals import AdviceView, OfferView
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import JSON_ONLY, Body, Controller, LiveView
from sequence_planner.server.errors import ProblemFound, refused
from sequence_planner.server.interface import interface
from sequence_planner.server.stream.broadcast import FlowsFeed, NetworkFeed
from sequence_planner.server.stream.endpoints import serve

# Abilities one by one: how one is defined, and what of that holds now.

LONGEST_ABILITY = 400  # characters
OPERATOR, ENGINEER = allowed(Role.OPERATOR), allowed(Role.ENGINEER)
abilities_router = interface(tags=["abilities"])


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


# What a correction would bring about, and plans that a person may take: what the advisor offers, a goal by hand, the
# reset of an operation.
#
# Asking changes nothing. What is offered belongs to the state it was made for, and is refused once the station has
# moved.

corrections_router = interface(
    tags=["corrections"], dependencies=[JSON_ONLY, OPERATOR], responses=refused(404, 409, 422, 504)
)
recovery_router = interface(tags=["recovery"], responses=refused(409, 504))
operator_plans_router = interface(
    "/operator-plans", tags=["recovery"], dependencies=[JSON_ONLY], responses=refused(409, 504)
)


class ValuesBody(Body):
    """Estimated variables, each with the value that it is to have."""

    values: GivenValues


class GoalBody(Body):
    """What shall hold, in the model's language."""

    predicate: Annotated[str, Field(min_length=1, max_length=LONGEST_PREDICATE)]


class ResetBody(Body):
    """The operation whose precondition shall hold again."""

    operation: Annotated[str, Field(min_length=1, max_length=200)]


@corrections_router.post("/corrections/preview")
async def preview_correction(body: ValuesBody, client: Controller) -> CorrectionPreview:
    """What a correction would bring about: what it would violate, which abilities could start, the plan that follows.

    Nothing is changed by asking, and it may be asked in every mode.
    """
    return await client.ask(AskCorrection(values=body.values))


@recovery_router.get("/recovery/proposals", dependencies=[OPERATOR])
async def recovery_proposals(client: Controller) -> AdviceView:
    """Proven ways on from the present state, the least effort first, each with its plan.

    409 `plan-running` while a plan is being carried out. With an offer in `obstacle` stands what to do first.
    """
    return await client.ask(AskAdvice())


@operator_plans_router.post("/goal-preview", dependencies=[ENGINEER])
async def preview_goal(body: GoalBody, client: Controller) -> OfferView:
    """A plan to whatever shall hold, to be looked at and perhaps taken.

    422 `bad-predicate` names the place; 409 `goal-holds` and `no-plan` say why there is nothing to take.
    """
    return await client.ask(AskGoal(predicate=body.predicate))


@operator_plans_router.post("/reset-preview", dependencies=[OPERATOR], responses=refused(404))
async def preview_reset(body: ResetBody, client: Controller) -> OfferView:
    """A plan to the precondition of an operation, from which it begins anew; 409 `no-plan` where there is none."""
    return await client.ask(AskReset(operation=body.operation))


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
