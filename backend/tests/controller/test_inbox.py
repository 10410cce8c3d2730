"""What is heard waits in the order in which it came, and only what is news is looked at before the next look."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.controller.io.inputs import AGAIN, Inbox, InputErrors
from sequence_planner.ros.transport import Sample
from support.examples import examples

HEARD = st.lists(st.tuples(st.sampled_from("ab"), st.sampled_from([b"on", b"off"]), st.integers(0, 30)), max_size=20)


@given(HEARD)
@examples(200)
def test_what_is_said_again_is_no_news_and_not_lost(heard: list[tuple[str, bytes, int]]) -> None:
    inbox, now = Inbox(InputErrors()), 0.0
    last: dict[str, tuple[bytes, float]] = {}
    put: list[Sample] = []
    for topic, data, tenths in heard:
        now += tenths / 10
        sample = Sample(topic, data, now)
        said, when = last.get(topic, (None, 0.0))
        assert inbox.put([sample]) == (said != data or now - when > AGAIN)
        last[topic] = data, now
        put.append(sample)
    parts = list(inbox.parts())
    assert all(len({sample.topic for sample in part}) == len(part) for part in parts)
    for topic in "ab":
        taken = [sample for part in parts for sample in part if sample.topic == topic]
        assert taken == [sample for sample in put if sample.topic == topic]
    assert not inbox
