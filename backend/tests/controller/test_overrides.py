"""What a person sets while a station runs, as the controller carries it out and shows it."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from pathlib import Path

import pytest

from pipelines.station_writing import station_with
from sequence_planner.controller.build import build_controller
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.execution import ClearOverride, SetOverride, StartProduction, TakeControl
from sequence_planner.controller.commands.queries import AboutFlows, AboutPipelines
from sequence_planner.controller.controller import Controller
from sequence_planner.controller.io.clients import Clients
from sequence_planner.controller.io.inputs import Inputs
from sequence_planner.controller.io.outputs import Outputs
from sequence_planner.controller.io.overrides import Overrides
from sequence_planner.controller.views.pipelines import FlowsView, PipelinesView
from sequence_planner.controller.views.station import FieldValue
from sequence_planner.core.actor import SYSTEM
from sequence_planner.core.clock import Timestamp
from sequence_planner.db.database import Database
from sequence_planner.model.source import ModelError
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import Sample
from sequence_planner.ros.transports.memory import MemoryNetwork
from sequence_planner.station import ReadyStation
from sequence_planner.synthesis.supervisor import synthesise
from support.cell import IDENTITY
from support.databases import journal
from support.people import EVA
from support.waiting import until_async

TANK = """
topics:
  /tank/state:
    type: tank_msgs/msg/State
    direction: in
    pipeline:
      - override: {name: door, fields: {door: {in: [true]}}, expires: 30}
  /tank/order:
    type: tank_msgs/msg/Order
    direction: out
    pipeline:
      - constant: {speed: 0.5}
      - override: {name: speed, fields: {speed: {between: [0.05, 0.5]}}, expires: 60}
"""
FIELDS = {"State": "bool door\n", "Order": "bool fill\nfloat64 speed\n"}
SPEED = {"speed": 0.1}


class Quiet:
    """A publisher that remembers what it was given."""

    def __init__(self) -> None:
        self.sent: list[bytes] = []

    def advertise(self, topic: str, type_name: str, qos: QualityOfService) -> None:
        """Nobody is told."""

    def publish(self, topic: str, type_name: str, data: bytes) -> None:
        """Remember it."""
        if topic == "/tank/order":
            self.sent.append(data)


class Desk:
    """The overrides of the tank's station, in time that a test tells."""

    def __init__(self, folder: Path) -> None:
        self.station = station_with(folder, TANK, FIELDS)
        self.publisher = Quiet()
        pipelines, registry = self.station.pipelines, self.station.registry
        self.feeds = Inputs(pipelines, registry)
        self.commander = Outputs(pipelines.outgoing, registry, self.publisher)
        loop = asyncio.new_event_loop()
        loop.close()  # the station asks nobody for anything
        transport = MemoryNetwork().join(registry, "sequence_planner", loop)
        clients = Clients(pipelines, registry, transport, self.feeds, lambda samples: None)
        self.overrides = Overrides(pipelines, self.feeds, self.commander, clients)

    def set(self, name: str, fields: Mapping[str, FieldValue], now: float) -> None:
        self.overrides.set(SetOverride(actor=EVA, name=name, fields=dict(fields)), Timestamp(1000.0, now))

    def clear(self, name: str, now: float) -> None:
        self.overrides.clear(ClearOverride(actor=EVA, name=name), Timestamp(1000.0, now))

    def speeds(self) -> list[object]:
        """What has been ordered so far."""
        return [self.station.registry.decode("tank_msgs/msg/Order", data)["speed"] for data in self.publisher.sent]


def test_an_override_is_shown_with_its_bounds_and_when_it_expires(tmp_path: Path) -> None:
    desk = Desk(tmp_path)
    view = desk.overrides.view(Timestamp(1000.0, 50.0))
    assert set(view) == {"tank.door", "tank.speed"}
    speed = view["tank.speed"]
    assert (speed.pipeline, speed.resource, speed.expires, speed.actor) == ("/tank/order", "tank", 60.0, None)
    assert (speed.fields["speed"].between, speed.fields["speed"].value) == ((0.05, 0.5), None)
    assert view["tank.door"].fields["door"].among == [True]
    desk.set("tank.speed", SPEED, 50.0)
    shown = desk.overrides.view(Timestamp(1001.0, 51.0))["tank.speed"]
    assert (shown.actor, shown.until, shown.fields["speed"].value) == ("Eva", 1060.0, 0.1)
    assert desk.overrides.view(Timestamp(1002.0001, 52.0))["tank.speed"] == shown, "it is told the same each time"
    gone = desk.overrides.view(Timestamp(1060.0, 110.0))["tank.speed"]
    assert (gone.actor, gone.until, gone.fields["speed"].value) == (None, None, None)


def test_what_is_set_is_sent_and_taken_back_and_nothing_before_production(tmp_path: Path) -> None:
    desk = Desk(tmp_path)
    desk.set("tank.speed", SPEED, 50.0)
    assert desk.speeds() == []
    desk.commander.publish_all(desk.station.automaton.initial_valuation, 51.0)
    desk.set("tank.speed", {"speed": 0.2}, 52.0)
    desk.clear("tank.speed", 53.0)
    desk.set("tank.speed", SPEED, 54.0)
    desk.commander.repeat(114.0)
    assert desk.speeds() == [0.1, 0.2, 0.5, 0.1, 0.5]


def test_an_incoming_value_is_overridden_until_it_is_taken_back(tmp_path: Path) -> None:
    desk = Desk(tmp_path)
    data = desk.station.registry.encode("tank_msgs/msg/State", {"door": False})
    desk.feeds.take([Sample("/tank/state", data, 50.0)])
    desk.set("tank.door", {"door": True}, 51.0)
    assert desk.feeds.measured(51.0)["tank.door"] is True
    desk.clear("tank.door", 52.0)
    assert desk.feeds.measured(52.0)["tank.door"] is False


@pytest.mark.parametrize(
    ("name", "fields", "slug", "said"),
    [
        ("tank.speed", {"speed": 0.6}, "out-of-bounds", "`speed` cannot be 0.6: it is a number from 0.05 to 0.5"),
        ("tank.speed", {"speed": "fast"}, "out-of-bounds", "`speed` cannot be 'fast'"),
        ("tank.speed", {"sped": 0.1}, "out-of-bounds", "did you mean `speed`"),
        ("tank.door", {"door": False}, "out-of-bounds", "`door` cannot be False: it is one of true"),
        ("tank.sped", SPEED, "no-override", "did you mean `tank.speed`"),
    ],
)
def test_what_the_model_does_not_allow_is_refused_and_changes_nothing(
    tmp_path: Path, name: str, fields: dict[str, FieldValue], slug: str, said: str
) -> None:
    desk = Desk(tmp_path)
    with pytest.raises(CommandRefused, match=said.replace("?", ".")) as refused:
        desk.set(name, fields, 50.0)
    assert refused.value.slug == slug
    assert refused.value.status == (404 if slug == "no-override" else 422)
    assert all(each.actor is None for each in desk.overrides.view(Timestamp(1000.0, 50.0)).values())


def test_a_resource_has_each_name_once(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="`door` is the name of another override of this resource"):
        station_with(tmp_path, TANK.replace("name: speed", "name: door"), FIELDS)


def test_the_controller_sets_shows_and_tells_what_passes(tmp_path: Path) -> None:
    station = station_with(tmp_path, TANK, FIELDS)
    supervisor = synthesise(station.automaton)

    async def scenario(database: Database) -> None:
        network = MemoryNetwork()
        loop = asyncio.get_running_loop()
        transport = network.join(station.registry, "sequence_planner", loop)
        tank = network.join(station.registry, "tank", loop)
        orders: list[object] = []
        tank.subscribe("/tank/order", "tank_msgs/msg/Order", QualityOfService.RELIABLE, orders.extend)
        controller = build_controller(IDENTITY, station, supervisor, transport, database)
        controller.take_command()
        running = asyncio.create_task(controller.run())
        await asyncio.sleep(0)
        await controller.command(StartProduction(actor=SYSTEM))
        await until_async(lambda: len(orders) == 1)
        await controller.command(TakeControl(actor=EVA))
        await controller.command(SetOverride(actor=EVA, name="tank.speed", fields={"speed": 0.1}))
        await until_async(lambda: len(orders) == 2)
        assert controller.view().overrides["tank.speed"].actor == "Eva"
        with pytest.raises(CommandRefused):
            await controller.command(SetOverride(actor=EVA, name="tank.speed", fields={"speed": 9}))
        await controller.command(ClearOverride(actor=EVA, name="tank.speed"))
        await until_async(lambda: len(orders) == 3)
        await check_told(controller, station)
        running.cancel()
        await asyncio.gather(running, return_exceptions=True)

    with journal() as database:
        asyncio.run(scenario(database))


async def check_told(controller: Controller, station: ReadyStation) -> None:
    graph, flows = await controller.answer(AboutPipelines()), await controller.answer(AboutFlows())
    assert isinstance(graph, PipelinesView)
    assert isinstance(flows, FlowsView)
    assert set(graph.pipelines) == set(flows.pipelines) == {*station.pipelines.incoming, *station.pipelines.outgoing}
    for name, pipeline in graph.pipelines.items():
        assert [edge.to for edge in pipeline.edges] == [edge.to for edge in flows.pipelines[name].edges]
    order = flows.pipelines["/tank/order"].edges
    assert [edge.records for edge in order] == [1, 1, 3]
    assert order[-1].last == {"door": None, "fill": False, "speed": 0.5}
    stages = graph.pipelines["/tank/order"].stages
    assert [(stage.kind, stage.summary) for stage in stages] == [("constant", "speed"), ("override", "speed")]
    assert graph.pipelines["/tank/order"].edges[1].fields["speed"] == "real"
