"""What a confirmed watch reads and does, and how it learns that it is none any more."""

from __future__ import annotations

import itertools
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from websockets.exceptions import InvalidStatus

from sequence_planner.controller.commands.command import Query
from sequence_planner.controller.commands.queries import AboutNames
from sequence_planner.controller.commands.tasks import AcknowledgeTask, ReportProblem, SolveProblem
from sequence_planner.controller.ipc import ControllerLink
from sequence_planner.controller.views.station import (
    AlarmMessages,
    JobStepState,
    JobStepView,
    PlanStepView,
    Priority,
    StationStanding,
    StepStatus,
)
from sequence_planner.core.actor import ActorKind
from sequence_planner.core.data_models import DataModel
from sequence_planner.execution.vocabulary import JobState
from sequence_planner.server.api.watches import WatchProgress
from sequence_planner.server.settings import Settings
from sequence_planner.server.stream.endpoints import awaits_order, doing_in, progress_of
from sequence_planner.texts.message import as_it_was
from support.example_view import example_job, step
from support.server import Controller, Loop, Server
from support.waiting import patience

from .example_answers import NO_NAMES, example_answer
from .test_acting import problem
from .test_people import closing_code
from .test_stream import hear
from .watching import DAY, FOREIGN, OWN, WATCHES, Device, active, later, station


def test_a_watch_that_is_revoked_learns_so_at_once(
    client: httpx.Client, device: Device, controller: Controller
) -> None:
    watch = active(client, device)
    with device.listen() as stream:
        hear(stream)
        assert client.delete(f"{WATCHES}/{watch}").status_code == 204
        problem(device.acknowledge(OWN), 401, "signed-out")
        assert closing_code(stream) == 4401
    assert device.state() == "signed-out"
    with pytest.raises(InvalidStatus) as refused:
        device.listen()
    assert refused.value.response.status_code == 401
    assert [each["state"] for each in client.get(WATCHES).json()["watches"]] == ["revoked"]
    assert controller.commands == []


def test_a_watch_expires_after_ninety_days(server: Server, client: httpx.Client, device: Device) -> None:
    active(client, device)
    with device.listen() as stream:
        hear(stream)
        later(server, 90 * DAY - 60)
        assert device.state() == "active"
        later(server, 90 * DAY)
        assert closing_code(stream) == 4401
    assert device.state() == "signed-out"


def test_a_watch_acknowledges_its_own_tasks_alone_and_by_its_own_name(
    client: httpx.Client, device: Device, controller: Controller
) -> None:
    watch = active(client, device)
    refused = device.acknowledge(FOREIGN)
    problem(refused, 403, "not-your-task")
    assert "nspector" not in refused.text
    problem(device.acknowledge("9"), 409, "task-gone")
    problem(device.acknowledge(OWN, revision=2), 409, "task-changed")
    problem(device.post(f"/api/v1/tasks/{OWN}/acknowledgement", json={}), 422, "invalid-request")
    assert controller.commands == []
    assert device.acknowledge(OWN).status_code == 204
    (command,) = controller.commands
    assert isinstance(command, AcknowledgeTask)
    assert (command.task, command.revision) == (OWN, 3)
    assert (command.actor.kind, command.actor.id, command.actor.name) == (ActorKind.WATCH, watch, "Watch 1")
    assert command.actor.address == "127.0.0.1"


@pytest.mark.parametrize("solved", [False, True])
def test_a_watch_tells_problems_of_its_own_tasks_alone_and_by_its_own_name(
    client: httpx.Client, device: Device, controller: Controller, solved: bool
) -> None:
    watch = active(client, device)
    problem(device.report(FOREIGN, solved=solved), 403, "not-your-task")
    problem(device.report("9", solved=solved), 409, "task-gone")
    problem(device.report(OWN, revision=2, solved=solved), 409, "task-changed")
    assert controller.commands == []
    assert device.report(OWN, solved=solved).status_code == 204
    (command,) = controller.commands
    assert isinstance(command, SolveProblem if solved else ReportProblem)
    assert (command.task, command.revision) == (OWN, 3)
    assert (command.actor.kind, command.actor.id, command.actor.name) == (ActorKind.WATCH, watch, "Watch 1")


def test_a_watch_acknowledges_nothing_while_it_is_not_known_whose_task_it_is(
    client: httpx.Client, device: Device, controller: Controller
) -> None:
    active(client, device)
    with device.listen() as stream:
        hear(stream)
        controller.publishing = False
        while hear(stream)["kind"] != "link":
            pass
    problem(device.acknowledge(OWN), 503, "controller-unavailable")
    assert controller.commands == []


def test_two_watches_serve_one_resource_and_a_third_another(
    client: httpx.Client, device: Device, another: Device, server: Server
) -> None:
    active(client, device)
    second = active(client, another, "Watch 2")
    with Device(server) as third:
        active(client, third, "Watch 3", "inspector")
        with device.listen() as one, another.listen() as two, third.listen() as other:
            assert hear(one)["tasks"].keys() == hear(two)["tasks"].keys() == {OWN}
            assert hear(other)["tasks"].keys() == {FOREIGN}
            client.delete(f"{WATCHES}/{second}")
            assert closing_code(two) == 4401
            assert hear(one)["kind"] == "watch"
        assert third.acknowledge(FOREIGN).status_code == 204
    assert [each["name"] for each in client.get(WATCHES).json()["watches"]] == ["Watch 3", "Watch 2", "Watch 1"]


NAMES = NO_NAMES.model_copy(
    update={
        "station": {"sv": "Cellen"},
        "resources": {name: {"sv": name.title()} for name in ("operator", "inspector", "robot")},
        "abilities": {name: {"sv": "x"} for name in ("operator.place", "inspector.look", "robot.move")},
        "tasks": {name: {"sv": "x"} for name in ("operator.place", "inspector.look")},
        "operations": {"inspect": {"sv": "Inspector"}},
    }
)


class NamingController(Controller):
    """A controller that is asked what its parts are called."""

    def __init__(self, loop: Loop, path: Path) -> None:
        super().__init__(loop, path)
        self.link = ControllerLink(path, self.handle, self.answer)

    async def answer(self, ask: Query[Any]) -> DataModel:
        return NAMES if isinstance(ask, AboutNames) else example_answer(ask)


@pytest.fixture
def controller(loop: Loop, settings: Settings) -> Iterator[Controller]:
    controller = NamingController(loop, settings.controller_socket)
    controller.start()
    yield controller
    controller.stop()


def texts(document: object) -> Iterator[str]:
    """All that is written in a document."""
    if isinstance(document, dict):
        for key, value in document.items():
            yield str(key)
            yield from texts(value)
    elif isinstance(document, list):
        for value in document:
            yield from texts(value)
    elif isinstance(document, str):
        yield document


def test_a_watch_reads_nothing_but_its_own_tasks(client: httpx.Client, device: Device) -> None:
    active(client, device)
    described = client.get("/api/v1/openapi.json").json()
    readable = {}
    for path, verbs in described["paths"].items():
        # On this machine everybody reads the figures, and whether it is ready, which it is not here. Which pictures a
        # watch reads is a test of these.
        if "get" in verbs and path not in ("/readyz", "/metrics", "/api/v1/instructions/{name}"):
            answer = device.get(path)
            if answer.status_code == 200:
                readable[path] = answer
            else:
                problem(answer, 401, "signed-out")
    assert readable.keys() == {"/healthz", "/api/v1/session", f"{WATCHES}/self", f"{WATCHES}/names"}
    names = readable[f"{WATCHES}/names"].json()
    assert (names["station"], names["resources"].keys()) == ({"sv": "Cellen"}, {"operator", "robot"})
    assert (names["abilities"].keys(), names["tasks"].keys()) == ({"operator.place", "robot.move"}, {"operator.place"})
    problem(device.get("/api/v1/openapi.json"), 401, "signed-out")
    for place in ("/api/v1/stream", "/api/v1/ros/stream", "/api/v1/pipelines/stream"):
        with pytest.raises(InvalidStatus) as refused:
            device.listen(place)
        assert refused.value.response.status_code == 401
    with device.listen() as stream:
        messages = [hear(stream)]
        for frame in ('{"kind": "resync"}', '{"kind": "resync", "resource": "inspector"}', "what?"):
            stream.send(frame)
            messages.append(hear(stream))
    read = [answer.json() for answer in readable.values()] + messages
    told = {text for document in read for text in texts(document)}
    foreign = station().tasks[FOREIGN]
    for hidden in (FOREIGN, foreign.title, foreign.text, "inspector", "Inspector", "robot.pose", "/robot/state"):
        assert not any(hidden == text or (len(hidden) > 3 and hidden in text) for text in told), hidden


def test_a_watch_names_an_alarm_while_help_is_needed(
    client: httpx.Client, device: Device, controller: Controller
) -> None:
    active(client, device)
    change = {
        "text": "The robot stands still",
        "action": "Look at the robot",
        "messages": AlarmMessages(
            as_it_was("The robot stands still", ""), None, as_it_was("Look at the robot", ""), ()
        ),
        "priority": Priority.MEDIUM,
    }
    slow = station().alarms["slow"]
    every = {"slow": slow, "still:robot": slow.model_copy(update=change)}
    with device.listen() as stream:

        def told(name: str | None, **changes: object) -> object:
            controller.show(station(time=next(times), alarms=every, named_alarm=name, **changes))
            while (message := hear(stream))["time"] != controller.view.time:
                pass
            return message["alarm"]

        times = itertools.count(2000.0)
        said = {
            "text": "The robot stands still",
            "action": "Look at the robot",
            "message": as_it_was("The robot stands still", "").sent(),
            "action_message": as_it_was("Look at the robot", "").sent(),
            "priority": "medium",
            "state": slow.state.value,
            "since": slow.since,
        }
        assert told("still:robot") is None, "nobody is needed"
        assert told("still:robot", silent=["Robot"]) is None, "which device it is says enough"
        assert told("still:robot", failing=["Robot"]) == said
        assert told("still:robot", standing=StationStanding.STOPPED) == said
        assert told(None, failing=["Robot"]) is None


def test_a_watch_is_told_what_its_own_person_does_next_while_the_station_goes_on(
    client: httpx.Client, device: Device, controller: Controller
) -> None:
    active(client, device)
    plan = station().plan
    steps = [
        *plan.steps,
        step("look", "inspector", StepStatus.NEXT, 3),
        step("place", "operator", StepStatus.PLANNED, 4).model_copy(update={"expected_start": 1008.0}),
        step("place", "operator", StepStatus.PLANNED, 6),
    ]
    with device.listen() as stream:

        def told(standing: StationStanding, steps: list[PlanStepView]) -> object:
            controller.show(station(time=next(times), standing=standing, plan=plan.model_copy(update={"steps": steps})))
            while (message := hear(stream))["time"] != controller.view.time:
                pass
            return message["next"]

        times = itertools.count(2000.0)
        assert told(StationStanding.WORKING, steps) == {"ability": "operator.place", "title": "place", "at": 1008.0}
        assert told(StationStanding.WORKING, steps[:3]) is None, "what somebody else does"
        for standing in (StationStanding.HELD, StationStanding.PAUSED, StationStanding.STOPPED):
            assert told(standing, steps) is None


def test_a_watch_is_told_that_the_station_waits_for_an_order() -> None:
    ended, waiting = example_job(state=JobState.ENDED), example_job(state=JobState.WAITING)
    assert awaits_order(station(by_order=True, jobs={}))
    assert awaits_order(station(by_order=True, jobs={"4710": ended}))
    assert not awaits_order(station(by_order=True, jobs={"4710": ended, "4711": waiting}))
    assert not awaits_order(station(by_order=True, jobs={}, standing=StationStanding.PAUSED))
    assert not awaits_order(station(by_order=False, jobs={}))


def test_a_watch_is_told_what_devices_do_and_not_what_they_may_do() -> None:
    view = station()
    running = [each.model_copy(update={"status": StepStatus.RUNNING}) for each in view.plan.steps]
    view = view.model_copy(update={"plan": view.plan.model_copy(update={"steps": running}), "failing": []})
    devices = [each.ability for each in running if not view.abilities[each.ability].human]
    assert [each.ability for each in doing_in(view)] == devices
    assert doing_in(view.model_copy(update={"failing": ["Robot UR10"]})) == []
    assert doing_in(view.model_copy(update={"standing": StationStanding.SILENT})) == []


def test_a_watch_is_told_how_far_the_order_in_work_is_or_else_the_operations_of_the_round() -> None:
    def steps(*states: JobStepState) -> dict[str, JobStepView]:
        return {
            str(place): JobStepView(state=state, waits_for=[], started=None, ended=None)
            for place, state in enumerate(states)
        }

    state = JobStepState
    running = example_job(steps=steps(state.COMPLETED, state.SKIPPED, state.ACTIVE))
    view = station(jobs={"4710": example_job(state=JobState.ENDED, steps=steps(state.ACTIVE)), "4711": running})
    assert progress_of(view) == WatchProgress(done=1, all=2)

    first = next(iter(station().operations.values())).model_copy(
        update={"active": False, "began": 990.0, "ended": 992.0}
    )
    before = first.model_copy(update={"began": 980.0, "ended": 985.0})
    again = first.model_copy(update={"active": True, "active_since": 993.0})
    freely = station(jobs={}, by_order=False, operations={"first": first, "before": before, "again": again})
    assert progress_of(freely) == WatchProgress(done=1, all=3)
    assert progress_of(freely.model_copy(update={"by_order": True})) is None
    assert progress_of(freely.model_copy(update={"operations": {}})) is None


def test_the_tasks_are_told_when_they_change_and_the_time_twice_a_second(
    client: httpx.Client, device: Device, controller: Controller
) -> None:
    active(client, device)
    with device.listen() as stream:
        hear(stream)
        times = []
        for _ in range(4):
            times.append(time.monotonic())
            assert hear(stream)["tasks"].keys() == {OWN}
        assert max(after - before for before, after in itertools.pairwise(times)) < patience(1.0)
        begun = time.monotonic()
        for revision in range(4, 9):
            task = station().tasks[OWN].model_copy(update={"revision": revision})
            controller.show(station(tasks={OWN: task, FOREIGN: task.model_copy(update={"resource": "inspector"})}))
            while hear(stream)["tasks"][OWN]["revision"] != revision:
                pass
        assert time.monotonic() - begun < patience(1.5), "nobody waits for the next time that is due"
        controller.show(station(tasks={}))
        while hear(stream)["tasks"]:
            pass
        controller.publishing = False
        while (message := hear(stream))["kind"] == "watch":
            pass
        assert message == {"kind": "link", "controller": "lost"}
        controller.publishing = True
        assert hear(stream)["kind"] == "watch"


def test_without_a_controller_a_watch_can_be_revoked_but_none_offered(
    client: httpx.Client, device: Device, controller: Controller
) -> None:
    watch = active(client, device)
    with device.listen() as stream:
        controller.stop()
        while hear(stream)["kind"] != "link":
            pass
        assert client.get(WATCHES).json()["resources"] == []
        body = {"name": "Watch 2", "resource": "operator"}
        problem(client.post(f"{WATCHES}/offers", json=body), 503, "controller-unavailable")
        assert client.delete(f"{WATCHES}/{watch}").status_code == 204
        assert closing_code(stream) == 4401
    controller.start()


def test_an_operator_at_a_device_that_is_also_a_watch_acts_as_the_operator(
    client: httpx.Client, device: Device, controller: Controller
) -> None:
    active(client, device)
    device.cookies.update(client.cookies)
    assert device.acknowledge(FOREIGN).status_code == 204
    assert controller.commands[0].actor.kind is ActorKind.PERSON
    assert device.get("/api/v1/session").json()["watch"]["name"] == "Watch 1"
