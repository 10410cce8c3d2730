"""Commands: sent when a variable changes on which they depend, again in their time, and within what a person allows."""

from __future__ import annotations

from pathlib import Path

import pytest

from pipelines.station_writing import station_with
from sequence_planner.controller.io.outputs import Outputs
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import TransportError
from sequence_planner.station import ReadyStation

FIELDS = {"Order": "float64 speed\nbool careful\nuint8 place\n"}
RESOURCE = """
topics:
  /order:
    type: tank_msgs/msg/Order
    direction: out
    every: 1.0
    pipeline:
      - constant: {speed: 0.5}
      - expression: {careful: is_open or place > 3}
      - override: {name: speed, fields: {speed: {between: [0.1, 0.5]}}, expires: 10}
  /slow:
    type: tank_msgs/msg/Order
    direction: out
    ignore: [careful]
    pipeline: [limit: {every: 0.5}]
  /door: {type: std_msgs/msg/Bool, direction: in, pipeline: [rename: {data: is_open}]}
output: {place: {type: 0..9}}
"""


class Wire:
    """Keeps what is sent, until it breaks."""

    def __init__(self) -> None:
        self.sent: list[tuple[str, bytes]] = []
        self.is_broken = False

    def advertise(self, topic: str, type_name: str, qos: QualityOfService) -> None:
        """Nothing to do."""

    def publish(self, topic: str, type_name: str, data: bytes) -> None:
        """Keep it."""
        if self.is_broken:
            raise TransportError("the cable is out")
        self.sent.append((topic, data))


class Bench:
    """A commander with its station and the variables, in time that a test tells."""

    def __init__(self, station: ReadyStation) -> None:
        self.station = station
        self.wire = Wire()
        self.commander = Outputs(station.pipelines.outgoing, station.registry, self.wire)
        self.state = dict(station.automaton.initial_valuation)

    def sent(self, topic: str = "/order") -> list[dict[str, object]]:
        """The messages sent on a topic since the last look."""
        sent, self.wire.sent = self.wire.sent, [each for each in self.wire.sent if each[0] != topic]
        return [self.station.registry.decode("tank_msgs/msg/Order", data) for name, data in sent if name == topic]


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    made = Bench(station_with(tmp_path, RESOURCE, FIELDS))
    made.commander.publish_all(made.state, 0.0)
    assert made.sent() == [{"speed": 0.5, "careful": False, "place": 0}]
    return made


def test_a_message_is_sent_when_what_it_depends_on_changes(bench: Bench) -> None:
    bench.commander.publish(bench.state, 0.1)
    assert bench.sent() == []
    bench.state["tank.is_open"] = True  # measured, and the message depends on it
    bench.commander.publish(bench.state, 0.2)
    assert bench.sent() == [{"speed": 0.5, "careful": True, "place": 0}]
    bench.commander.publish({**bench.state, "arm.goto": "out"}, 0.3)
    assert bench.sent() == []


def test_it_is_repeated_and_what_could_not_be_sent_is_owed(bench: Bench) -> None:
    bench.commander.repeat(0.9)
    assert bench.sent() == []
    bench.commander.repeat(1.0)
    assert len(bench.sent()) == 1
    bench.wire.is_broken = True
    bench.state["tank.place"] = 5
    bench.commander.publish(bench.state, 1.1)
    assert bench.commander.owed["/order"] == "the cable is out"
    bench.wire.is_broken = False
    bench.commander.repeat(1.2)
    assert bench.sent() == [{"speed": 0.5, "careful": True, "place": 5}]
    assert not bench.commander.owed


def test_the_last_of_what_is_held_back_goes_out_when_its_time_comes(bench: Bench) -> None:
    bench.sent("/slow")
    for number in (1, 2, 3):
        bench.commander.publish({**bench.state, "tank.place": number}, number / 10)
    assert bench.sent("/slow") == []
    assert bench.commander.due == 0.5
    bench.commander.repeat(0.5)
    assert [message["place"] for message in bench.sent("/slow")] == [3]


def test_a_person_slows_it_down_within_bounds_and_for_a_while(bench: Bench) -> None:
    bench.commander.set_override("/order", "speed", {"speed": 0.2}, 1.0, "eva")
    assert [message["speed"] for message in bench.sent()] == [0.2]
    with pytest.raises(ValueError, match="speed"):
        bench.commander.set_override("/order", "speed", {"speed": 0.6}, 2.0, "eva")
    bench.commander.publish({**bench.state, "tank.place": 1}, 3.0)
    assert [message["speed"] for message in bench.sent()] == [0.2]
    bench.commander.repeat(11.0)
    assert bench.sent()[0]["speed"] == 0.5
    bench.commander.set_override("/order", "speed", {"speed": 0.2}, 12.0, "eva")
    bench.commander.clear_override("/order", "speed", 13.0)
    assert [message["speed"] for message in bench.sent()] == [0.2, 0.5]


def test_what_has_passed_can_be_seen(bench: Bench) -> None:
    bench.commander.publish({**bench.state, "tank.place": 5}, 0.1)
    bench.commander.set_override("/order", "speed", {"speed": 0.2}, 0.2, "eva")
    view = bench.commander.observed()["/order"]
    assert [(edge.to, edge.records) for edge in view.edges] == [
        ("1 constant", 2),
        ("2 expression", 2),
        ("3 override", 2),
        ("/order", 3),
    ]
    assert view.edges[-1].last is not None
    assert (view.edges[-1].last["careful"], view.edges[-1].last["speed"]) == (True, 0.2)
    assert view.overrides["speed"] is not None


def test_what_makes_no_sense_in_a_command_is_reported_until_it_does(tmp_path: Path) -> None:
    resource = """
topics:
  /order:
    type: tank_msgs/msg/Order
    direction: out
    pipeline: [expression: {speed: 1 / place}]
output: {place: {type: 0..9, initial: 2}}
"""
    bench = Bench(station_with(tmp_path, resource, {"Order": "float64 speed 0.25\nuint8 place\n"}))
    bench.commander.publish_all(bench.state, 0.0)
    assert list(bench.commander.reports.current(0.0)) == []
    bench.commander.publish({**bench.state, "tank.place": 0}, 0.1)
    assert [message["speed"] for message in bench.sent()] == [0.5, 0.25]
    [(place, _, report)] = bench.commander.reports.current(60.0)
    assert place == "/order"
    assert report.text == "1 / place divides by zero"
    bench.commander.publish({**bench.state, "tank.place": 4}, 60.0)
    assert list(bench.commander.reports.current(75.0)) == []
