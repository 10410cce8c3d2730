"""The one alarm that is named where help is needed and one alone has room."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.controller.alarms.manager import named_alarm
from sequence_planner.controller.views.station import AlarmGroup, AlarmState, AlarmView, Priority
from support.example_view import example_view

SLOW = example_view().alarms["slow"]


def alarm(
    priority: Priority = Priority.MEDIUM,
    state: AlarmState = AlarmState.UNACKNOWLEDGED,
    group: AlarmGroup = AlarmGroup.DEVICE,
    since: float = 1.0,
) -> AlarmView:
    return SLOW.model_copy(update={"priority": priority, "state": state, "group": group, "since": since})


NOT_NAMED = {
    "a problem of somebody": alarm(Priority.HIGH, group=AlarmGroup.PEOPLE),
    "nothing on a topic": alarm(Priority.HIGH, group=AlarmGroup.COMMUNICATION),
    "over": alarm(Priority.HIGH, AlarmState.RETURNED),
    "shelved": alarm(Priority.HIGH, AlarmState.SHELVED),
    "out of service": alarm(Priority.HIGH, AlarmState.OUT_OF_SERVICE),
    "a reminder": alarm(Priority.LOW),
}


def test_what_is_over_set_aside_low_or_between_others_is_not_named() -> None:
    assert named_alarm({}) is None
    assert named_alarm(NOT_NAMED) is None


def test_the_most_urgent_is_named_of_equals_what_nobody_has_seen_and_then_the_newest() -> None:
    seen = alarm(state=AlarmState.ACKNOWLEDGED, since=9.0)
    every = NOT_NAMED | {"seen": seen, "first": alarm()}
    assert named_alarm(every) == "first"
    every["newer"] = alarm(since=2.0)
    assert named_alarm(every) == "newer"
    every["high, seen"] = alarm(Priority.HIGH, AlarmState.ACKNOWLEDGED)
    assert named_alarm(every) == "high, seen"


ALARMS = st.builds(
    alarm,
    st.sampled_from(Priority),
    st.sampled_from(AlarmState),
    st.sampled_from(AlarmGroup),
    st.sampled_from((1.0, 2.0, 3.0)),
)


@given(st.dictionaries(st.sampled_from("abcdef"), ALARMS))
def test_nothing_that_would_be_named_by_itself_is_more_urgent_than_what_is_named(alarms: dict[str, AlarmView]) -> None:
    key = named_alarm(alarms)
    alone = {name for name, each in alarms.items() if named_alarm({name: each}) is not None}
    assert (key is None) == (not alone)
    if key is not None:
        assert key in alone
        urgency = list(Priority)
        assert all(urgency.index(alarms[key].priority) <= urgency.index(alarms[each].priority) for each in alone)
