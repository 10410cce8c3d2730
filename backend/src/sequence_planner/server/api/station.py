"""Reading the station: each part of the view at an address of its own.

Every answer carries the tick and the time of the view it was cut from, and none is ever older than two seconds: when
the controller is silent the answer is 503.
"""

from __future__ import annotations

from typing import Annotated

from fastapi import Header, Path, Query, Request, Response, WebSocket

from sequence_planner.analysis.report import AnalysisDocument
from sequence_planner.auth.roles import Role, Scope
from sequence_planner.controller.views.details import NetworkView
from sequence_planner.controller.views.part import ControlView
from sequence_planner.controller.views.station import (
    AbilityView,
    AlarmView,
    ApprovalView,
    BreakpointView,
    CycleStopView,
    DeploymentView,
    ForceView,
    LastCorrectionView,
    LastOperatorPlanView,
    OperationView,
    OperatorPlanView,
    OverrideView,
    PackML,
    PlanView,
    QuestionView,
    ResourceView,
    ServiceView,
    StandbyView,
    StationIdentity,
    StationStanding,
    TaskView,
    TopicView,
    UndecidedOutputView,
    VariableView,
    WhoCanView,
)
from sequence_planner.execution.vocabulary import Mode, Production
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import AnswerModel, Controller, Identity, LiveView
from sequence_planner.server.errors import ProblemFound, refused
from sequence_planner.server.interface import interface
from sequence_planner.server.services.figures import FiguresAnswer, figures_of
from sequence_planner.server.services.instructions import INSTRUCTION_ANSWERS, instruction_answer, names_of
from sequence_planner.server.stream.broadcast import FlowsFeed, NetworkFeed
from sequence_planner.server.stream.endpoints import own_tasks, serve
from sequence_planner.texts.message import message

router = interface(tags=["station"], dependencies=[allowed(Role.VIEWER, scope=Scope.READ)])


instructions_router = interface(tags=["station"], dependencies=[allowed(Role.VIEWER, scope=Scope.READ, watch=True)])


class Answer(AnswerModel):
    """The tick and the time (seconds since the epoch, the controller's clock) at which this was so."""

    tick: int
    time: float


class WallAnswer(AnswerModel):
    """The other stations of a wall: `https://HOST[:PORT]` or `http://HOST[:PORT]` of each."""

    beside: list[str]


class StationAnswer(Answer):
    """State of the running station, with requests of people to it and of it to people."""

    station: StationIdentity
    revision: int  # of the state: counts up with every change, and what was previewed holds for one
    mode: Mode
    packml: PackML
    standing: StationStanding
    silent: list[str]
    failing: list[str]
    stepping: bool
    breakpoints: dict[str, BreakpointView]
    cycle_stop: CycleStopView | None
    production: Production
    by_order: bool
    unconfirmed: bool
    undecided: dict[str, UndecidedOutputView]
    control: ControlView | None
    errand: OperatorPlanView | None
    last_errand: LastOperatorPlanView | None
    forces: dict[str, ForceView]
    out_of_service: list[ServiceView]
    questions: list[QuestionView]
    last_correction: LastCorrectionView | None
    standby: StandbyView | None
    deployment: DeploymentView | None
    approvals: dict[str, ApprovalView]
    who_can: WhoCanView | None


class StateAnswer(Answer):
    """Every variable."""

    variables: dict[str, VariableView]


class ResourcesAnswer(Answer):
    """Every resource."""

    resources: dict[str, ResourceView]


class OperationsAnswer(Answer):
    """Every operation."""

    operations: dict[str, OperationView]


class AbilitiesAnswer(Answer):
    """Every ability."""

    abilities: dict[str, AbilityView]


class PlanAnswer(Answer):
    """The live plan."""

    plan: PlanView


class TasksAnswer(Answer):
    """The tasks that wait for a person."""

    tasks: dict[str, TaskView]


class TopicsAnswer(Answer):
    """Every topic of the station."""

    topics: dict[str, TopicView]


class OverridesAnswer(Answer):
    """Variables that a person may force, and forces that are set."""

    overrides: dict[str, OverrideView]


class AnalysisAnswer(Answer):
    """Findings of the synthesis; null before there are any."""

    analysis: AnalysisDocument | None


class AlarmsAnswer(Answer):
    """The alarms that last."""

    alarms: dict[str, AlarmView]


@router.get("/station")
async def station(view: LiveView) -> StationAnswer:
    """The running station: its mode, whether production has been started, and requests of people."""
    return StationAnswer(**{name: getattr(view, name) for name in StationAnswer.model_fields})


@router.get("/state")
async def state(view: LiveView) -> StateAnswer:
    """Every variable; a null value is unknown, and `awaits` names the topic that would tell it."""
    return StateAnswer(tick=view.tick, time=view.time, variables=view.variables)


@router.get("/resources")
async def resources(view: LiveView) -> ResourcesAnswer:
    """Every resource, whether it is online, and which topics are awaited."""
    return ResourcesAnswer(tick=view.tick, time=view.time, resources=view.resources)


@router.get("/operations")
async def operations(view: LiveView) -> OperationsAnswer:
    """Every operation, whether it is active, and how often it was completed."""
    return OperationsAnswer(tick=view.tick, time=view.time, operations=view.operations)


@router.get("/abilities")
async def abilities(view: LiveView) -> AbilitiesAnswer:
    """Every ability: enabled, executing, finished."""
    return AbilitiesAnswer(tick=view.tick, time=view.time, abilities=view.abilities)


@router.get("/plan")
async def plan(view: LiveView) -> PlanAnswer:
    """The live plan: what is done, what runs, what comes next and what that waits for."""
    return PlanAnswer(tick=view.tick, time=view.time, plan=view.plan)


@router.get("/tasks")
async def tasks(view: LiveView) -> TasksAnswer:
    """The tasks that wait for a person, by id."""
    return TasksAnswer(tick=view.tick, time=view.time, tasks=view.tasks)


@instructions_router.get("/instructions/{name}", response_class=Response, responses=INSTRUCTION_ANSWERS | refused(404))
async def read_instruction(
    request: Request,
    client: Controller,
    name: Annotated[str, Path(max_length=200)],
    if_none_match: Annotated[str | None, Header()] = None,
    state: Annotated[str | None, Query(max_length=40)] = None,
) -> Response:
    """A picture or a video of an instruction, by the name of its file; a watch reads those of its own tasks.

    With a `state`, whatever it is, an SVG has the values of indexed variables: of `bolts[pair_1]` the element with
    `id="pair_1"` has it in `data-bolts`. Who shows it asks with another one when they have changed.
    """
    watch = getattr(request.state, "watch", None)
    if watch is not None and (
        client.view is None or name not in names_of(own_tasks(client.view, watch.resource).values())
    ):
        raise ProblemFound(404, "no-such-instruction", message("refused.no-such-instruction.name", name=name))
    shown = client.view.variables if state is not None and client.view is not None else None
    return await instruction_answer(request.app.state.settings, name, if_none_match, shown)


@router.get("/topics")
async def topics(view: LiveView) -> TopicsAnswer:
    """Every ROS 2 topic of the station, and whether it speaks."""
    return TopicsAnswer(tick=view.tick, time=view.time, topics=view.topics)


@router.get("/overrides")
async def overrides(view: LiveView) -> OverridesAnswer:
    """Variables that a person may force within which bounds, forces that are set, and when they expire."""
    return OverridesAnswer(tick=view.tick, time=view.time, overrides=view.overrides)


@router.get("/analysis")
async def analysis(view: LiveView) -> AnalysisAnswer:
    """The guards that the supervisor adds, how many states can be reached, and findings with runs that show them."""
    return AnalysisAnswer(tick=view.tick, time=view.time, analysis=view.analysis)


@router.get("/alarms")
async def alarms(view: LiveView) -> AlarmsAnswer:
    """Alarms that want a person's attention now."""
    return AlarmsAnswer(tick=view.tick, time=view.time, alarms=view.alarms)


@router.get("/figures")
async def figures(request: Request, office: Identity, view: LiveView) -> FiguresAnswer:
    """The figures of the day and of the shift that is on, in the time zone of the station: what is in work, what was
    made, how long that takes, and how long the station worked.
    """
    return await figures_of(request.app.state.order_desk, office, view)


@router.get("/wall")
async def wall(request: Request) -> WallAnswer:
    """The stations whose walls this station's page shows side by side with its own: the addresses of their servers."""
    return WallAnswer(beside=list(request.app.state.settings.beside))


# The ROS graph, read once or as it changes.

ros_router = interface("/ros", tags=["ros"], dependencies=[allowed(Role.VIEWER, scope=Scope.READ)])


@ros_router.get("/graph")
async def ros_graph(view: LiveView, client: Controller) -> NetworkView:
    """All nodes, topics, services and actions that the station's transport knows, and how the station meets them.

    503 until the station is prepared and has joined the network.
    """
    if client.network is None:
        raise ProblemFound(503, "preparing", message("refused.preparing.network"))
    return client.network


@ros_router.websocket("/stream")
async def ros_stream(websocket: WebSocket) -> None:
    """Serve one client: the graph, and again whenever it has changed."""
    show: NetworkFeed = websocket.app.state.network_show
    await serve(websocket, show.latest)


# What passes the pipelines, as it goes on.

# Pipelines by name, repeated as in `?pipeline=/robot/state&pipeline=robot.holding`.
Names = Annotated[list[Annotated[str, Query(max_length=500)]] | None, Query(max_length=200)]


@router.websocket("/pipelines/stream")
async def pipelines_stream(websocket: WebSocket, pipeline: Names = None) -> None:
    """Serve one client: what has passed each edge of the pipelines that are named, or of all, twice a second."""
    show: FlowsFeed = websocket.app.state.flows_show
    await serve(websocket, show.of(None if pipeline is None else frozenset(pipeline)))
