"""One cause, one alarm: the network of a station of eight nodes goes away and comes back, and other troubles."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

import pytest

from controller.alarming.scene import Scene, Told, acknowledge, shelve, suppress
from controller.carrying_out import carry_out
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.controller.alarms.alarm import aside_from
from sequence_planner.controller.io.inputs import Inputs
from sequence_planner.controller.io.network import NetworkWatch
from sequence_planner.controller.io.outputs import Outputs
from sequence_planner.controller.restore import RestoredState
from sequence_planner.controller.views.station import AlarmState, AlarmView, Priority
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import ServiceKind
from sequence_planner.planning.planner import Planner
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import NetworkEndpoint, Sample, TransportError
from sequence_planner.simulation.devices import EmulatedDevices
from sequence_planner.station import ReadyStation, prepare_station
from support.places import TRUCK_ENGINE_STATION

EVERYTHING_IS_SAFE = Supervisor(StateSet((), ()), {})
STEP = 0.1


@cache
def truck() -> tuple[ReadyStation, Planner]:
    station = prepare_station(TRUCK_ENGINE_STATION)
    return station, Planner(station.automaton, EVERYTHING_IS_SAFE)


class Network:
    """Eight nodes and what the station hears of them.

    `cut` are the topics of which nothing gets through; that their publishers are gone the graph may tell. What cannot
    be sent is `refused`, by the names of resources; everything is when all topics are cut.
    """

    def __init__(self) -> None:
        self.station, self.planner = truck()
        pipelines, registry = self.station.pipelines, self.station.registry
        self.execution = Executor(self.station.automaton, EVERYTHING_IS_SAFE)
        self.devices = EmulatedDevices(self.station.automaton, pipelines, seed=1)
        self.feeds = Inputs(pipelines, registry, self.station.automaton.initial_valuation)
        self.network = NetworkWatch(pipelines, registry)
        self.network.commands = True
        self.commander = Outputs(pipelines.outgoing, registry, self)
        self.told = Told()
        self.begin()
        self.cut: set[str] = set()
        self.refused: set[str] = set()
        self.tells = False
        self.now = 100.0
        self.most = 0  # alarms shown at once

    def begin(self, known: RestoredState | None = None) -> None:
        """A controller begins; `known` is what it knows from before."""
        self.scene = Scene(self.execution, self.station, self.told, known, self.feeds, self.network, self.commander)
        self.alarms = self.scene.alarms

    def advertise(self, topic: str, type_name: str, qos: QualityOfService) -> None:
        """Nothing is to be done."""

    def publish(self, topic: str, type_name: str, data: bytes) -> None:
        """To the devices, if it gets through."""
        resource = self.station.pipelines.outgoing[topic].topic.resource
        if self.cut == self.every or resource in self.refused:
            raise TransportError("the network is unreachable")
        self.devices.command(topic, self.station.registry.decode(type_name, data))

    @property
    def moment(self) -> Timestamp:
        return Timestamp(self.now + 1.7e9, self.now)

    @property
    def shown(self) -> dict[str, AlarmView]:
        return self.alarms.current(self.moment)

    @property
    def every(self) -> set[str]:
        return set(self.station.pipelines.incoming)

    def topics_of(self, *resources: str) -> set[str]:
        return {name for name in self.every if self.feeds.resource_of(name) in resources}

    def start(self) -> None:
        """Let the devices be heard, and production begin when the start is no excuse any more."""
        self.run(30)
        self.execution.start_production()
        self.commander.publish_all(self.execution.published, self.now)
        self.run(2)

    def run(self, seconds: float) -> None:
        end = self.now + seconds
        while self.now < end - STEP / 2:
            self.now += STEP
            self.devices.advance(self.now)
            self.feeds.take(self._samples())
            gone = self.network.look(self._graph() if self.tells else ())
            for topic in gone:
                self.feeds.abandon(topic)
            silent = self.feeds.offline(self.now)
            outcome = self.execution.tick(self.feeds.measured(self.now), self.moment, silent=silent)
            self.scene.note(outcome)
            self._plan()
            if self.execution.production == "started":
                self.commander.publish(self.execution.published, self.now)
                self.commander.repeat(self.now)
            self.most = max(self.most, len(self.shown))

    def _plan(self) -> None:
        if (request := self.execution.request(20)) is not None:
            self.execution.adopt(request, self.planner.answer(request))

    def _samples(self) -> list[Sample]:
        samples = []
        for name in self.every - self.cut:
            data = self.station.registry.encode(
                self.station.pipelines.incoming[name].topic.type_name, self.devices.report(name)
            )
            samples.append(Sample(name, data, self.now))
        return samples

    def _graph(self) -> Sequence[NetworkEndpoint]:
        return [
            NetworkEndpoint(
                topic=name,
                type_name=self.station.pipelines.incoming[name].topic.type_name,
                direction="publisher",
                own=False,
                type_hash=None,
                node="/devices",
                reliable=True,
                transient_local=False,
            )
            for name in sorted(self.every - self.cut)
        ]


@pytest.mark.parametrize("tells", [True, False], ids=["the graph tells", "messages are missing"])
def test_the_network_of_eight_nodes_goes_away_and_comes_back(tells: bool) -> None:
    on = Network()
    on.tells = tells
    assert len(on.every) == 8
    on.start()
    assert [key for key, alarm in on.shown.items() if alarm.priority is not Priority.LOW] == []

    on.most, on.told.notes = 0, []
    on.cut = on.every
    on.run(30)  # long enough for abilities to be late, and for commands to be due
    (alarm,) = on.shown.values()
    assert alarm.text == "No device is responding (8 of 8). Probable network failure"
    assert (alarm.priority, alarm.state) == (Priority.HIGH, AlarmState.UNACKNOWLEDGED)
    assert len([part for part in alarm.parts if part.startswith("No more messages on /")]) == 8
    assert on.most <= 4

    carry_out(on.alarms, acknowledge("many-silent", alarm.since), on.moment)
    for name in sorted(on.every):  # they come back one after the other
        on.cut = on.cut - {name}
        on.run(1)
        assert len(on.shown) <= 1
    on.run(20)
    late = {key for key in on.shown if key.startswith("overdue:")}  # it works without its supervisor
    assert on.shown.keys() == late
    came = [key for key, event in on.told.events if event in ("came", "came again") and key not in late]
    assert len(came) <= 5, came


def test_a_device_that_was_known_to_be_silent_is_known_also_after_the_network_was_away() -> None:
    on = Network()
    on.start()
    on.cut = on.topics_of("agv")
    on.run(5)
    since = on.shown["silent:agv"].since
    carry_out(on.alarms, acknowledge("silent:agv", since), on.moment)
    on.cut = on.every
    on.run(10)
    assert on.shown.keys() == {"many-silent"}
    on.cut = on.topics_of("agv")
    on.run(20)
    assert on.shown["silent:agv"].state is AlarmState.ACKNOWLEDGED
    assert on.shown["silent:agv"].since == since
    assert on.shown["many-silent"].state is AlarmState.RETURNED


def test_what_follows_from_a_silent_device_is_a_part_of_its_alarm() -> None:
    on = Network()
    on.start()
    (running, *_) = on.execution.plan.order.running
    resource = on.execution.automaton.abilities[running.ability].resource
    on.cut = on.topics_of(resource)
    on.run(40)
    shown = {key: alarm for key, alarm in on.shown.items() if alarm.priority is not Priority.LOW}
    assert shown.keys() == {f"silent:{resource}"}
    assert (
        "has not been sent its command" in " ".join(shown[f"silent:{resource}"].parts)
        or shown[f"silent:{resource}"].parts
    )


def test_devices_have_some_time_to_be_heard_first() -> None:
    on = Network()
    on.cut = on.every
    on.run(29)
    assert not on.shown
    on.run(2)
    (alarm,) = on.shown.values()
    assert alarm.priority is Priority.MEDIUM, "what was never heard may not have been started yet"
    assert alarm.text.startswith("Nothing has been heard of ")
    assert len(alarm.parts) == 8
    assert alarm.consequence == "Production is not started, so nothing waits for it."


def test_a_slow_start_of_a_healthy_station_is_no_alarm() -> None:
    """As on a machine that has much else to do: some devices appear late, others stumble, and production is started."""
    on = Network()
    on.execution.start_production()
    on.cut = on.every
    on.run(3)
    on.cut = on.topics_of("robot", "nutrunner")
    on.run(5)
    on.cut = on.every  # for much longer than their deadlines
    on.run(8)
    on.cut = on.topics_of("nutrunner")
    on.run(10)
    on.cut = set()
    on.run(20)
    came = [str(key) for key, event in on.told.events if event == "came"]
    assert [key for key in came if "silent" in key or "heard" in key] == []


def test_devices_that_die_early_are_told_soon_all_the_same() -> None:
    on = Network()
    on.run(1)
    on.execution.start_production()
    on.cut = on.every
    on.run(13)
    assert on.shown.keys() == {"many-silent"}


def test_that_devices_were_silent_is_told_as_it_was() -> None:
    on = Network()
    on.run(31)
    on.cut = on.every
    on.run(5)
    (alarm,) = on.shown.values()
    assert alarm.text.endswith("are not responding (7 of 8 devices). Probable network failure")
    assert alarm.consequence == "Production is not started, so nothing waits for it."
    on.execution.start_production()
    on.cut = set()
    on.run(15)
    over = on.shown["many-silent"]
    assert over.state is AlarmState.RETURNED
    assert over.text.endswith("were not responding (7 of 8 devices)")
    assert (over.consequence, over.action) == ("", ""), "what came of it is no more, and production is started by now"
    assert all("For some time no message came on /" in part for part in over.parts)


def test_a_device_that_a_person_has_switched_off_may_be_silent() -> None:
    on = Network()
    on.start()
    on.execution.set_service(ServiceKind.RESOURCE, "agv", False, "Eva", "is being charged", on.moment)
    on.cut = on.topics_of("agv")
    on.run(10)
    assert "silent:agv" not in on.shown


def test_several_rivals_are_one_alarm() -> None:
    on = Network()
    outgoing = [pipeline.topic for pipeline in on.station.pipelines.outgoing.values()]
    on.network.look(
        [
            NetworkEndpoint(
                topic=topic.name,
                type_name=topic.type_name,
                direction="publisher",
                own=False,
                type_hash=None,
                node="/other",
                reliable=True,
                transient_local=False,
            )
            for topic in outgoing
        ]
    )
    assert on.shown.keys() == {"rival"}
    assert len(on.shown["rival"].parts) == len(outgoing) > 1


def test_another_definition_explains_the_silence_of_its_node() -> None:
    on = Network()
    on.start()
    on.cut = on.topics_of("agv")
    (topic,) = on.cut
    built_otherwise = NetworkEndpoint(
        topic=topic,
        type_name=on.station.pipelines.incoming[topic].topic.type_name,
        direction="publisher",
        own=False,
        type_hash="RIHS01_0",
        node="/agv",
        reliable=True,
        transient_local=False,
    )
    on.run(5)
    on.network.look([built_otherwise])
    shown = on.shown
    assert shown.keys() == {"network:agv"}
    assert [part for part in shown["network:agv"].parts if part.startswith("No more messages on ")]


def test_nothing_hides_in_an_alarm_that_is_out_of_service() -> None:
    on = Network()
    on.start()
    on.cut = on.every
    on.run(10)
    (alarm,) = on.shown.values()
    assert alarm.priority is Priority.HIGH  # so it cannot be put aside, and those that follow are in sight with it
    on.cut = on.topics_of("agv")
    on.run(25)
    carry_out(on.alarms, suppress("silent:agv"), on.moment)
    on.cut = on.topics_of("agv", "dock")
    on.run(10)
    assert on.shown["silent:agv"].state is AlarmState.OUT_OF_SERVICE
    assert on.shown["silent:dock"].state is AlarmState.UNACKNOWLEDGED


def test_what_was_put_aside_is_so_after_the_controller_was_started_anew() -> None:
    before, after = Network(), Network()
    before.start()
    before.cut = before.topics_of("agv", "dock")
    before.run(10)
    carry_out(before.alarms, suppress("silent:agv"), before.moment)
    carry_out(before.alarms, shelve("silent:dock", 600), before.moment)
    kept = [content for kind, content in before.told.notes if kind == "alarms-aside"][-1]
    after.now = before.now + 100
    after.begin(RestoredState(aside=aside_from(kept)))
    after.cut = before.cut
    after.start()
    after.run(10)
    shown = after.shown
    assert (shown["silent:agv"].state, shown["silent:agv"].why) == (AlarmState.OUT_OF_SERVICE, "the sensor is broken")
    assert (shown["silent:dock"].state, shown["silent:dock"].until) == (
        AlarmState.SHELVED,
        before.shown["silent:dock"].until,
    )
    after.now += 590
    after.run(5)
    assert after.shown["silent:dock"].state is AlarmState.UNACKNOWLEDGED
