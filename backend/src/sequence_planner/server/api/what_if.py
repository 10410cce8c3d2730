"""Routes that try the draft without touching the station: simulated for some seconds, step by step, with a clock of
its own, or all that it can come to.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Final

from fastapi import Depends, Path, Query, Request, Response
from pydantic import Field
from starlette.requests import ClientDisconnect

from sequence_planner.auth.roles import Role
from sequence_planner.editor.processes import worked
from sequence_planner.editor.schemas.draft import StepsView, StepView
from sequence_planner.editor.schemas.simulation import (
    Advance,
    NoSimulationError,
    ScenarioExpectation,
    ScenariosView,
    SimulationView,
    WrittenScenarioView,
)
from sequence_planner.editor.schemas.state_space import StateSpaceQuestion, StateSpaceView
from sequence_planner.editor.schemas.what_if import RecordedStateView, RecordedTrafficView, WhatIfView
from sequence_planner.language.types import Value
from sequence_planner.model.paths import EditError
from sequence_planner.server.api.history import looked_back
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import JSON_ONLY, Body, controller, found, live_view
from sequence_planner.server.errors import ProblemFound, refused
from sequence_planner.server.http.middleware import while_waited_for
from sequence_planner.server.interface import interface
from sequence_planner.server.services.drafts import (
    DRAFT,
    HASH,
    RUNNING,
    TheRecordings,
    TheWorkshop,
    recording_shelf,
    version_files,
)
from sequence_planner.texts.message import message

SIMULATING = 40.0  # seconds of work
SCENARIOS = 200.0  # seconds until all scenarios are known to have passed or not
ENGINEER = allowed(Role.ENGINEER)

OCTETS: Final = "application/octet-stream"
BODY: Final[dict[str, Any]] = {
    "requestBody": {"required": True, "content": {OCTETS: {"schema": {"type": "string", "format": "binary"}}}}
}

router = interface("/model", tags=["model"], responses=refused(409, 503))
recordings_router = interface("/model/recordings", tags=["model"], responses=refused(409, 503))
FileName = Annotated[str, Query(min_length=1, max_length=255, pattern=r"^[^\x00-\x1f\x7f]*$")]
RecordingId = Annotated[str, Path(pattern="^[0-9a-f]{1,64}$")]
Seconds = Annotated[float, Query(ge=0, le=1e10, allow_inf_nan=False)]
RecordNumber = Annotated[int | None, Field(ge=1, le=2**53 - 1, strict=True)]
ScenarioName = Annotated[str, Field(min_length=1, max_length=200)]
SimulationId = Annotated[str, Path(pattern="^[0-9a-f]{1,64}$")]


class RecordingPlace(Body):
    """A moment of a recording of ROS 2 traffic that was brought: its `id`, and `at` how many seconds after it began."""

    id: Annotated[str, Field(pattern="^[0-9a-f]{1,64}$")]
    at: Annotated[float, Field(ge=0, le=1e10, allow_inf_nan=False)]


class WhatIfBody(Body):
    """For how many seconds, with which version of the model, and from which values, record of the past or moment of a
    recording on; without them from the present. Where values are given beside a recording, they take the place of its.
    """

    seconds: Annotated[float, Field(gt=0, le=600.0, strict=True)]
    version: Annotated[str, Field(pattern=f"^({DRAFT}|{RUNNING}|{HASH})$")] = DRAFT
    number: RecordNumber = None
    recording: RecordingPlace | None = None
    present: dict[str, Value | None] | None = None


class StepsBody(Body):
    """The steps to take one after the other, from a record of the past or a moment of a recording, without either from
    the present. Values that are given beside a recording take the place of its.

    With `follow` plans are followed after them: one to its end, or one after the other until the condition `until`
    holds.
    """

    steps: Annotated[tuple[StepView, ...], Field(max_length=2000)] = ()
    number: RecordNumber = None
    recording: RecordingPlace | None = None
    present: dict[str, Value | None] | None = None
    follow: bool = False
    until: Annotated[str, Field(min_length=1, max_length=2000)] | None = None


@router.post("/what-if", dependencies=[ENGINEER, JSON_ONLY], response_model=WhatIfView, responses=refused(404, 422))
async def what_if(body: WhatIfBody, shop: TheWorkshop, request: Request) -> Response:
    """Simulate the station with the draft or another version, from its present state or from a past record; nothing of
    it reaches the station. It ends when who asked leaves.
    """
    files, present = await version_files(shop, body.version), await _beginning(request, body)
    simulated = worked("told", "simulated", files, shop.folder, present, body.seconds, SIMULATING)
    text = await while_waited_for(request, simulated)
    if text is None:
        return Response(status_code=204)  # that nobody reads
    assert isinstance(text, str)
    return found(text)


@router.post(
    "/what-if/steps", dependencies=[ENGINEER, JSON_ONLY], response_model=StepsView, responses=refused(404, 422)
)
async def what_if_steps(body: StepsBody, shop: TheWorkshop, request: Request) -> Response:
    """Lead the station through the draft step by step, from its present state, from values or from a past record.

    Each step is one tick: what is set, what devices do, and what starts. Nothing of it reaches the station.
    """
    present = await _beginning(request, body)
    try:
        stepped = shop.stepped(present, body.steps, follow=body.follow, until=body.until)
        text = await while_waited_for(request, stepped)
    except EditError as error:
        raise ProblemFound(422, "bad-predicate", message("step.so", so=error.why)) from None
    return Response(status_code=204) if text is None else found(text)  # that nobody reads the one


class StateSpaceBody(Body):
    """How the state space is to be folded, and which values are the present ones: those of a record of the past or
    of a moment of a recording, or without either of the station as it is.
    """

    question: StateSpaceQuestion = StateSpaceQuestion()
    number: RecordNumber = None
    recording: RecordingPlace | None = None
    present: dict[str, Value | None] | None = None


@router.post(
    "/what-if/state-space",
    dependencies=[ENGINEER, JSON_ONLY],
    response_model=StateSpaceView,
    responses=refused(404, 422),
)
async def what_if_state_space(body: StateSpaceBody, shop: TheWorkshop, request: Request) -> Response:
    """Tell which states the draft can come to, folded by chosen variables, with those that are forbidden or not safe.

    It is found beside the server; the station does not wait for it.
    """
    present = await _beginning(request, body)
    try:
        text = await while_waited_for(request, shop.space(present, body.question))
    except EditError as error:
        raise ProblemFound(422, "not-folded", message("step.so", so=error.why)) from None
    return Response(status_code=204) if text is None else found(text)  # that nobody reads the one


class SimulationBody(Body):
    """Where a simulation begins: from values, from a record of the past, from a moment of a recording, or `fresh`, as
    the model begins; without them from the present. A `scenario` of the draft is carried out to its end.
    """

    number: RecordNumber = None
    recording: RecordingPlace | None = None
    present: dict[str, Value | None] | None = None
    fresh: bool = False
    scenario: ScenarioName | None = None


@router.post(
    "/simulations",
    status_code=201,
    dependencies=[ENGINEER, JSON_ONLY],
    response_model=SimulationView,
    responses=refused(404, 422),
)
async def begin_simulation(body: SimulationBody, shop: TheWorkshop, request: Request) -> Response:
    """Begin to try the draft with emulated devices and a clock of its own; nothing of it reaches the station.

    It is kept for a quarter of an hour after it was asked for last, at most four at once.
    """
    if body.scenario is not None:
        try:
            begun = found(await shop.simulated(None, body.scenario, Advance()))
        except EditError as error:
            raise ProblemFound(422, "not-simulated", message("step.so", so=error.why)) from None
    else:
        present = {} if body.fresh else await _beginning(request, body)
        begun = found(await shop.simulated(None, present, Advance()))
    begun.status_code = 201
    return begun


@router.post(
    "/simulations/{id}/advance",
    dependencies=[ENGINEER, JSON_ONLY],
    response_model=SimulationView,
    responses=refused(404, 422),
)
async def advance_simulation(id: SimulationId, body: Advance, shop: TheWorkshop) -> Response:
    """Let a simulation go on, from its present or from a moment that it has been, and do something there.

    Where the draft is another one by now it goes on with that. 404 `no-simulation` where it is kept no more: begin it
    again with the values that it had.
    """
    try:
        return found(await shop.simulated(id, {}, body))
    except NoSimulationError as error:
        raise ProblemFound(404, "no-simulation", message("step.so", so=error.why)) from None
    except EditError as error:
        raise ProblemFound(422, "not-simulated", message("step.so", so=error.why)) from None


@router.post(
    "/simulations/{id}/scenario",
    dependencies=[ENGINEER, JSON_ONLY],
    response_model=WrittenScenarioView,
    responses=refused(404, 422),
)
async def scenario_of_simulation(id: SimulationId, body: ScenarioExpectation, shop: TheWorkshop) -> Response:
    """Return the scenario that a simulation becomes, as it would stand in a file of `tests`; nothing is written."""
    try:
        return found(await shop.scenario_of(id, body))
    except NoSimulationError as error:
        raise ProblemFound(404, "no-simulation", message("step.so", so=error.why)) from None
    except EditError as error:
        raise ProblemFound(422, "not-simulated", message("step.so", so=error.why)) from None


@router.get("/scenarios", dependencies=[ENGINEER], response_model=ScenariosView)
async def scenarios(shop: TheWorkshop, request: Request) -> Response:
    """Return the scenarios by which the draft is tested."""
    return await _found_scenarios(shop, request, None)


class ScenariosBody(Body):
    """Which scenarios are to be carried out; without names all."""

    names: Annotated[tuple[ScenarioName, ...], Field(max_length=1000)] = ()


@router.post("/scenarios/run", dependencies=[ENGINEER, JSON_ONLY], response_model=ScenariosView, responses=refused(422))
async def run_scenarios(body: ScenariosBody, shop: TheWorkshop, request: Request) -> Response:
    """Carry scenarios of the draft out in simulated time; nothing of it reaches the station. It ends when who asked
    leaves.
    """
    return await _found_scenarios(shop, request, body.names)


async def _found_scenarios(shop: TheWorkshop, request: Request, names: tuple[str, ...] | None) -> Response:
    draft = await shop.open()
    asked = draft.number, draft.files, shop.folder, names
    work = worked("simulating.scenarios:found_scenarios", *asked, patience=SCENARIOS)
    text = await while_waited_for(request, work)
    if text is None:
        return Response(status_code=204)  # that nobody reads
    if isinstance(text, EditError):
        raise ProblemFound(422, "not-simulated", message("step.so", so=text.why))
    assert isinstance(text, str)
    return found(text)


async def _beginning(
    request: Request, body: WhatIfBody | StepsBody | StateSpaceBody | SimulationBody
) -> Mapping[str, Value | None]:
    """Return the values to begin with: those that are given, of a moment of a recording, of a record of the past, or of
    the station as it is.
    """
    if body.recording is not None:
        recorded = await (await recording_shelf(request)).present(body.recording.id, body.recording.at)
        return {**recorded, **(body.present or {})}
    if body.present is not None:
        return body.present
    if body.number is not None:
        return (await looked_back(request, body.number)).past.values
    view = await live_view(await controller(request))
    return {name: variable.value for name, variable in view.variables.items()}


# Recordings of ROS 2 traffic, from which it can begin.


async def octets_only(request: Request) -> None:
    """A file is sent as such: no page of somebody else can do so without being asked first."""
    media, _, _ = request.headers.get("content-type", "").partition(";")
    if media.strip().lower() != OCTETS:
        raise ProblemFound(415, "not-octets", message("refused.not-octets.header"))


@recordings_router.post(
    "",
    status_code=201,
    dependencies=[ENGINEER, Depends(octets_only)],
    response_model=RecordedTrafficView,
    responses=refused(400, 408, 413, 415, 422, 507),
    openapi_extra=BODY,
)
async def bring_recording(name: FileName, shelf: TheRecordings, request: Request) -> Response:
    """Bring a recording of the station's topics, as `ros2 bag record` makes it: a file .mcap or .db3, or a zip of its
    folder. It is read with the pipelines of the draft.

    The last four are kept, each for an hour after it was used. One that cannot be used is not: 422 `recording-unread`
    says what is wrong with which file, and what to do.
    """
    try:
        answer = found(await shelf.bring(name, request.stream()))
    except ClientDisconnect:
        raise ProblemFound(400, "recording-incomplete", message("refused.recording-incomplete.again")) from None
    answer.status_code = 201
    return answer


@recordings_router.get(
    "/{id}", dependencies=[ENGINEER], response_model=RecordedTrafficView, responses=refused(404, 422)
)
async def read_recording(
    id: RecordingId, shelf: TheRecordings, request: Request, since: Seconds | None = None
) -> Response:
    """Return what a recording has for the draft as it is now, with at most 2000 moments, those after `since`."""
    text = await while_waited_for(request, shelf.overview(id, -1.0 if since is None else since))
    return Response(status_code=204) if text is None else found(text)  # that nobody reads the one


@recordings_router.get(
    "/{id}/state", dependencies=[ENGINEER], response_model=RecordedStateView, responses=refused(404, 422)
)
async def recorded_state(id: RecordingId, at: Seconds, shelf: TheRecordings, request: Request) -> Response:
    """Return the state of the draft that all messages give until so many seconds after the recording began.

    What no message gave is as the model begins, and said to be `not-recorded`.
    """
    text = await while_waited_for(request, shelf.state_then(id, at))
    return Response(status_code=204) if text is None else found(text)  # that nobody reads the one


@recordings_router.delete("/{id}", status_code=204, dependencies=[ENGINEER], responses=refused(404))
async def put_recording_away(id: RecordingId, shelf: TheRecordings) -> None:
    """Put a recording away before its time."""
    await shelf.put_away(id)
