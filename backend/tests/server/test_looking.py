"""The ROS graph and the pipelines, as programs and pages read them."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import replace
from typing import Any, ClassVar

import httpx
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection

from controller.test_network_watch import REPORTS
from sequence_planner.controller.commands.command import CommandRefused, Query
from sequence_planner.controller.commands.execution import ClearOverride, SetOverride
from sequence_planner.controller.commands.queries import AboutFlows, AboutPipelines
from sequence_planner.controller.io.network import network_view, uses
from sequence_planner.controller.io.pipeline_graph import pipelines_view
from sequence_planner.controller.ipc import ControllerLink
from sequence_planner.controller.views.details import NetworkView
from sequence_planner.controller.views.pipelines import EdgeFlowView, FlowsView, PipelineFlowView
from sequence_planner.core.data_models import DataModel
from sequence_planner.ros.transport import NetworkEndpoint
from sequence_planner.server.settings import Settings
from sequence_planner.texts.message import message
from support.cell import COMMAND, STATE, cell
from support.server import Controller, Loop, Server, listen
from support.waiting import patience, until

from .example_answers import example_answer
from .test_acting import problem
from .test_stream import hear, hear_kind, slow_client


def network(*endpoints: NetworkEndpoint) -> NetworkView:
    station = cell()[0]
    return network_view(endpoints, [], uses(station.pipelines, station.registry))


class Telling(Controller):
    """A controller that counts how often it was asked what passes."""

    asked = 0
    preparing = False
    among: ClassVar[list[frozenset[str] | None]] = []

    async def answer(self, ask: Query[Any]) -> DataModel:
        if self.preparing:
            raise CommandRefused("preparing", message("refused.preparing.again"), 503)
        if isinstance(ask, AboutPipelines):
            return pipelines_view(cell()[0].pipelines)
        if not isinstance(ask, AboutFlows):
            return example_answer(ask)
        self.asked += 1
        self.among.append(ask.among)
        edge = EdgeFlowView(to="arm.pose", records=self.asked, held=0, rate=2.0, last=None, troubles=[], at=None)
        pipelines = {name: PipelineFlowView(edges=[edge], repeated=0, rate=2.0) for name in (STATE, COMMAND)}
        chosen = {name: each for name, each in pipelines.items() if ask.among is None or name in ask.among}
        return FlowsView(time=float(self.asked), pipelines=chosen)

    def tell(self, shown: NetworkView) -> None:
        async def publish() -> None:
            self.link.publish_network(shown)

        self.loop.run(publish())


@pytest.fixture
def controller(loop: Loop, settings: Settings) -> Iterator[Telling]:
    controller = Telling(loop, settings.controller_socket)
    controller.link = ControllerLink(settings.controller_socket, controller.handle, controller.answer)
    controller.start()
    yield controller
    controller.stop()


def path(server: Server, name: str) -> str:
    return server.stream.replace("/stream", f"/{name}/stream")


@pytest.fixture
def graphs(server: Server) -> Iterator[ClientConnection]:
    with listen(server, path(server, "ros"), close_timeout=1) as stream:
        yield stream


def test_the_graph_is_told_once_the_controller_has_joined_the_network(
    client: httpx.Client, controller: Telling
) -> None:
    problem(client.get("/api/v1/ros/graph"), 503, "preparing")
    controller.tell(network(REPORTS))
    until(lambda: client.get("/api/v1/ros/graph").status_code == 200)
    found = client.get("/api/v1/ros/graph").json()
    assert found["topics"][STATE]["publishers"][0]["node"] == "/devices"
    assert found["topics"][COMMAND]["station"]["direction"] == "out"


def test_the_stream_has_a_snapshot_and_another_when_something_has_changed(
    graphs: ClientConnection, controller: Telling
) -> None:
    assert hear(graphs) == {"kind": "link", "controller": "heard"}
    controller.tell(network(REPORTS))
    assert "/devices" in hear(graphs)["network"]["nodes"]
    with pytest.raises(TimeoutError):
        graphs.recv(0.5)
    controller.tell(network())
    assert hear(graphs)["network"]["nodes"] == {}
    graphs.send('{"kind": "resync"}')
    assert hear(graphs)["network"]["nodes"] == {}
    graphs.send("what?")
    assert hear(graphs)["kind"] == "error"


def test_a_graph_is_not_shown_while_the_controller_is_silent(graphs: ClientConnection, controller: Telling) -> None:
    controller.tell(network(REPORTS))
    hear_kind(graphs, "network")
    controller.publishing = False
    assert hear(graphs) == {"kind": "link", "controller": "lost"}
    controller.publishing = True
    assert hear(graphs)["kind"] == "network"


def test_a_slow_client_of_the_graph_gets_the_newest_or_is_dropped_and_slows_nobody(
    server: Server, controller: Telling
) -> None:
    many = [replace(REPORTS, topic=f"/topic_{n}", node=f"/node_{n}") for n in range(500)]
    shown = network(*many)
    with slow_client(server, path(server, "ros")), listen(server, path(server, "ros"), max_size=None) as quick:
        for number in range(20):
            begun = time.monotonic()
            controller.tell(network(*many, REPORTS) if number % 2 else shown)
            while ("/devices" in hear_kind(quick, "network")["network"]["nodes"]) != bool(number % 2):
                pass
            assert time.monotonic() - begun < patience(2)


def test_the_pipelines_are_told_to_who_asks(client: httpx.Client, controller: Telling) -> None:
    found = client.get("/api/v1/pipelines").json()["pipelines"]
    state = found[STATE]
    assert [stage["kind"] for stage in state["stages"]] == ["discretise", "remember"]
    assert state["stages"][0]["summary"] == "joints → pose"
    assert state["edges"][0] == {"to": "1 discretise", "fields": {"joints": "real[2]", "moving": "bool"}}
    assert {end["becomes"] for end in state["ends"]} == {"arm.pose", "arm.last", "arm.moving"}
    edges = client.get("/api/v1/pipelines/edges").json()["pipelines"][STATE]["edges"]
    assert (edges[0]["to"], edges[0]["rate"]) == ("arm.pose", 2.0)
    controller.preparing = True
    problem(client.get("/api/v1/pipelines"), 503, "preparing")


def test_edges_are_asked_for_only_while_somebody_looks(server: Server, controller: Telling) -> None:
    with listen(server, path(server, "pipelines")) as one, listen(server, path(server, "pipelines")) as two:
        first = hear_kind(one, "flows")["flows"]["time"]
        assert hear_kind(one, "flows")["flows"]["time"] > first
        hear_kind(two, "flows")
        asked = controller.asked
        hear_kind(one, "flows")
        assert controller.asked <= asked + 2, "asked once for both"
    until(lambda: server_is_quiet(controller))


def test_who_looks_at_some_pipelines_is_told_of_these_and_no_others_are_asked_for(
    server: Server, controller: Telling, client: httpx.Client
) -> None:
    address = f"{path(server, 'pipelines')}?pipeline="
    with listen(server, address + STATE) as one:
        assert list(hear_kind(one, "flows")["flows"]["pipelines"]) == [STATE]
        assert controller.among[-1] == frozenset({STATE})
        with listen(server, address + COMMAND) as other:
            until(lambda: list(hear_kind(other, "flows")["flows"]["pipelines"]) == [COMMAND])
            assert controller.among[-1] == frozenset({STATE, COMMAND})
            assert list(hear_kind(one, "flows")["flows"]["pipelines"]) == [STATE]
            with listen(server, path(server, "pipelines")) as all_of_them:
                until(lambda: controller.among[-1] is None)
                assert len(hear_kind(all_of_them, "flows")["flows"]["pipelines"]) == 2
    found = client.get("/api/v1/pipelines/edges", params={"pipeline": COMMAND}).json()
    assert list(found["pipelines"]) == [COMMAND]


def server_is_quiet(controller: Telling) -> bool:
    """Whether nobody asks for longer than the server's interval."""
    before = controller.asked
    asyncio.run(asyncio.sleep(0.7))
    return controller.asked == before


def test_edges_of_a_station_that_is_being_prepared_come_later(server: Server, controller: Telling) -> None:
    controller.preparing = True
    with listen(server, path(server, "pipelines")) as stream:
        assert hear(stream) == {"kind": "link", "controller": "heard"}
        controller.preparing = False
        assert hear(stream)["kind"] == "flows"


def test_too_many_clients_of_the_graph_are_told_to_come_later(server: Server) -> None:
    with ExitStack() as streams:
        for _ in range(server.settings.stream.clients):
            streams.enter_context(listen(server, path(server, "ros")))
        with listen(server, path(server, "ros")) as late, pytest.raises(ConnectionClosed):
            late.recv(patience(2))


def test_an_override_is_a_command_with_its_actor(client: httpx.Client, controller: Telling) -> None:
    assert client.put("/api/v1/overrides/robot.speed", json={"fields": {"speed": 0.2}}).status_code == 204
    assert client.delete("/api/v1/overrides/robot.speed").status_code == 204
    put, deleted = controller.commands
    assert put == SetOverride(actor=put.actor, name="robot.speed", fields={"speed": 0.2})
    assert deleted == ClearOverride(actor=put.actor, name="robot.speed")
    assert put.actor.name.startswith("Operator")
    bodies: list[dict[str, object]] = [{}, {"fields": {}}, {"fields": {"speed": [1]}}, {"fields": {"speed": None}}]
    for body in bodies:
        problem(client.put("/api/v1/overrides/robot.speed", json=body), 422, "invalid-request")
    headers = {"Content-Type": "application/json"}
    nan = client.put("/api/v1/overrides/robot.speed", content=b'{"fields": {"speed": NaN}}', headers=headers)
    problem(nan, 422, "invalid-request")
    assert len(controller.commands) == 2


def test_nothing_is_attached_where_the_model_is_not_known(administrator: httpx.Client) -> None:
    body = {"topic": "/arm/state", "resource": "arm"}
    problem(administrator.post("/api/v1/ros/attachments", json=body), 409, "no-model")
    for wrong in ({"topic": "--help"}, {"resource": "../arm"}, {"direction": "up"}):
        problem(administrator.post("/api/v1/ros/attachments", json=body | wrong), 422, "invalid-request")
