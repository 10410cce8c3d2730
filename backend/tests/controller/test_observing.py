"""What passes the pipelines, as it is shown: rates, and values of any size."""

from __future__ import annotations

import json

from hypothesis import given
from hypothesis import strategies as st

from controller.test_feeds import feeds, says
from sequence_planner.controller.io.monitor import Observing, shown
from sequence_planner.controller.views.pipelines import FlowsView
from sequence_planner.core.clock import Timestamp

VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=300) | st.binary(max_size=5),
    lambda inner: st.lists(inner, max_size=30) | st.dictionaries(st.text(max_size=3), inner, max_size=4),
    max_leaves=60,
)


def test_rates_are_over_the_last_seconds_in_which_somebody_looked() -> None:
    topics, observing = feeds(), Observing()

    def look(now: float) -> FlowsView:
        return observing.view(topics.observed(), Timestamp(1000.0 + now, now))

    assert look(10.0).pipelines["/arm/state"].edges[0].rate is None
    for number in range(30):
        topics.take([says("home" if number % 2 else "out", 10.0 + number / 10)])
    edges = look(13.0).pipelines["/arm/state"].edges
    assert [(edge.to, edge.records, edge.rate) for edge in edges[:2]] == [
        ("1 discretise", 30, 10.0),
        ("2 remember", 30, 10.0),
    ]
    assert edges[0].at == 1012.9
    assert edges[1].last == {"joints": [0.0, 0.0], "moving": False, "pose": "home"}
    topics.take([says("home", 13.01)])
    topics.take([says("home", 13.02)])
    state = look(13.5).pipelines["/arm/state"]
    assert (state.repeated, state.rate, state.edges[0].rate) == (2, 32 / 3.5, 30 / 3.5)
    assert look(13.6).pipelines["/arm/state"].edges[0].rate == 30 / 3.6
    assert look(14.5).pipelines["/arm/state"].edges[0].rate == 0.0
    assert look(99.0).pipelines["/arm/state"].edges[0].rate is None, "nobody has looked for long"


@given(VALUES)
def test_any_value_is_shown_as_json_of_bounded_size(value: object) -> None:
    assert len(json.dumps(shown(value), allow_nan=False)) < 300_000


def test_long_values_are_cut_short() -> None:
    assert shown(list(range(100))) == [*range(16), "and 84 more"]
    assert shown("x" * 1000) == "x" * 200 + "..."
    assert shown([float("nan"), float("inf"), 0.5]) == ["nan", "inf", 0.5]
