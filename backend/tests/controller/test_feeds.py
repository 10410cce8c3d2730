"""What topics have said, and for how long it counts."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from pipelines.station_writing import station_with
from sequence_planner.controller.io.inputs import Inputs, one_per_topic
from sequence_planner.ros.transport import Sample
from support.cell import POSES, STATE, STATE_TYPE, cell

UNKNOWN = {"arm.pose": None, "arm.moving": None, "arm.last": None}


def feeds(deadline: float | None = 1.0) -> Inputs:
    station = cell()[0]
    incoming = {name: replace(p, deadline=deadline) for name, p in station.pipelines.incoming.items()}
    return Inputs(replace(station.pipelines, incoming=incoming), station.registry)


def says(pose: str, received: float) -> Sample:
    record = {"joints": POSES[pose], "moving": False}
    return Sample(STATE, cell()[0].registry.encode(STATE_TYPE, record), received)


def test_nothing_is_known_before_the_first_message_nor_after_the_deadline() -> None:
    topics = feeds()
    assert topics.measured(0.0) == UNKNOWN
    topics.take([says("home", 10.0)])
    assert topics.measured(11.0) == {"arm.pose": "home", "arm.moving": False, "arm.last": "home"}
    assert topics.measured(11.1) == UNKNOWN
    assert topics.awaited(11.1) == [STATE]


def test_what_a_topic_remembers_is_forgotten_when_it_falls_silent() -> None:
    topics = feeds()
    topics.take([says("home", 10.0)])
    topics.take([says("unknown", 10.9)])
    assert topics.measured(11.0)["arm.last"] == "home"
    # Nobody looked between the messages, as when the event loop was held up.
    topics.take([says("unknown", 15.0)])
    assert topics.measured(15.0)["arm.last"] is None


def test_a_topic_without_a_deadline_counts_until_its_publisher_goes() -> None:
    topics = feeds(deadline=None)
    topics.take([says("home", 10.0)])
    assert topics.measured(9999.0)["arm.pose"] == "home"
    topics.abandon(STATE)
    assert topics.measured(9999.0) == UNKNOWN
    topics.take([says("out", 10000.0)])
    assert topics.measured(10000.0)["arm.pose"] == "out"


def test_a_message_that_cannot_be_read_makes_its_variables_unknown_until_the_next() -> None:
    topics = feeds()
    topics.take([says("home", 10.0)])
    topics.take([Sample(STATE, b"\x00\x01\x00\x00", 10.1)])
    assert topics.measured(10.1) == UNKNOWN
    assert topics.topics[STATE].trouble
    assert topics.awaited(10.1) == [], "it speaks"
    topics.take([says("out", 10.2)])
    assert topics.measured(10.2)["arm.pose"] == "out"
    assert topics.topics[STATE].trouble is None


SAMPLES = st.lists(st.tuples(st.sampled_from("abc"), st.integers(0, 5)), max_size=20).map(
    lambda drawn: [Sample(topic, bytes([number]), float(at)) for number, (topic, at) in enumerate(drawn)]
)


@given(SAMPLES)
def test_a_batch_is_cut_without_loss_in_the_order_of_reception(samples: list[Sample]) -> None:
    parts = list(one_per_topic(samples))
    for part in parts:
        assert part
        assert len({sample.topic for sample in part}) == len(part), "each topic at most once"
    together = [sample for part in parts for sample in part]
    assert together == sorted(samples, key=lambda sample: sample.received)


def test_topics_delivered_one_after_the_other_are_not_shown_out_of_step() -> None:
    """The tool stops, then the arm moves: no tick may see the arm moving with the tool still turning."""
    turning, stopped = Sample("tool", b"turning", 1.0), Sample("tool", b"stopped", 2.0)
    still, moving = Sample("arm", b"still", 1.1), Sample("arm", b"moving", 2.1)
    assert list(one_per_topic([still, moving, turning, stopped])) == [[turning, still], [stopped, moving]]


def test_time_passes_in_the_stages_between_messages(tmp_path: Path) -> None:
    resource = """
topics:
  /switch:
    type: std_msgs/msg/Bool
    direction: in
    deadline: 5.0
    pipeline: [rename: {data: pressed}, debounce: {fields: [pressed], seconds: 0.1}]
measured: {pressed: {type: bool}}
"""
    station = station_with(tmp_path, resource, {})
    topics = Inputs(station.pipelines, station.registry)

    def press(pressed: bool, now: float) -> None:
        topics.take([Sample("/switch", station.registry.encode("std_msgs/msg/Bool", {"data": pressed}), now)])

    press(False, 1.0)
    press(True, 1.02)
    assert (topics.measured(1.05)["tank.pressed"], topics.due) == (False, 1.12)
    topics.wake(1.1)
    assert topics.measured(1.1)["tank.pressed"] is False
    topics.wake(1.12)
    assert (topics.measured(1.12)["tank.pressed"], topics.due) == (True, None)
    assert topics.measured(7.0)["tank.pressed"] is None, "it is silent beyond its deadline"


SAID = st.lists(
    st.tuples(st.sampled_from(["home", "out", "unknown", None]), st.floats(0.05, 1.5), st.booleans()), max_size=12
)


@given(SAID)
def test_a_message_that_says_the_same_need_not_be_looked_at(said: list[tuple[str | None, float, bool]]) -> None:
    """None stands for bytes that are no message; now and then the publisher goes."""
    quick, slow = feeds(), feeds()
    slow.running.repeats = dict.fromkeys(slow.running.repeats, False)
    now = 10.0
    for pose, seconds, goes in said:
        now += seconds
        for topics in (quick, slow):
            topics.take([Sample(STATE, b"\x00\x01\x00\x00", now) if pose is None else says(pose, now)])
            if goes:
                topics.abandon(STATE)
        assert quick.measured(now + 0.5) == slow.measured(now + 0.5)
        assert quick.topics[STATE].trouble == slow.topics[STATE].trouble
    assert quick.topics[STATE].messages == slow.topics[STATE].messages == len(said)
