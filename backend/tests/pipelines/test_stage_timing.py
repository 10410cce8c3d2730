"""Stages that remember or wait: what goes on at which time, against what the table of stages says in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.choices import Choices, made_by
from pipelines.stage_texts import outgoing, stage, take
from sequence_planner.language.records.record import Record
from sequence_planner.model.stages.base import Overriding, StageInstance
from support.examples import examples


@dataclass(frozen=True)
class Event:
    """At a time a record comes with a value, which may be unknown."""

    time: float
    value: int | None


def _events(choose: Choices) -> list[Event]:
    """Up to twenty records, some at the same time, some long apart."""
    time, events = 0.0, []
    for _ in range(choose.number(0, 20)):
        time += choose.pick([1.0, 0.0, 0.5, 0.25, 3.0, 7.0])
        events.append(Event(time, choose.pick([0, 1, 2, None])))
    return events


EVENTS = made_by(_events)
END = 100.0


def run(course: StageInstance, events: Sequence[Event], end: float = END) -> list[tuple[float, object]]:
    """What goes on, with the times, when the course is woken whenever it wants to be."""
    out: list[tuple[float, object]] = []

    def note(time: float, record: Record | None) -> None:
        if record is not None:
            out.append((time, record.values.get("count")))

    def pass_to(time: float) -> None:
        while (due := course.due) is not None and due <= time:
            note(due, course.wake(due))
            assert course.due is None or course.due > due

    for event in events:
        pass_to(event.time)
        note(event.time, course.take(Record({"count": event.value}), event.time))
    pass_to(end)
    return out


def at(out: Sequence[tuple[float, object]], time: float) -> object:
    """What was last said by `time`."""
    return next((value for when, value in reversed(out) if when <= time), None)


# debounce


@given(EVENTS)
@examples(300)
def test_in_the_end_the_last_value_counts(events: list[Event]) -> None:
    out = run(stage("debounce: {fields: [count], seconds: 2}").begin(), events)
    assert at(out, END) == (events[-1].value if events else None)


@given(EVENTS)
@examples(300)
def test_debouncing_is_what_a_history_says(events: list[Event]) -> None:
    """Against the definition: the newest value that stayed for two seconds, the first one, or unknown at once."""
    out = run(stage("debounce: {fields: [count], seconds: 2}").begin(), events)
    counting: int | None = None
    since = 0.0
    current: int | None = None
    for index, event in enumerate(events):
        if index == 0:
            counting = event.value
        elif current != counting and event.time - since >= 2:
            counting = current
        if index == 0 or event.value != current:
            current, since = event.value, event.time
        if event.value is None:
            counting = None
        if event.time not in {following.time for following in events[index + 1 :]}:
            assert at(out, event.time) == counting


def test_a_short_touch_does_not_count() -> None:
    course = stage("debounce: {fields: [door], seconds: 0.05}").begin()
    assert take(course, 0.0, door=False) == {"door": False}
    assert take(course, 0.02, door=True) == {"door": False}
    assert take(course, 0.04, door=False) == {"door": False}
    assert course.due is None
    assert take(course, 1.0, door=True) == {"door": False}
    assert course.due == 1.05
    assert course.wake(1.04) is None
    woken = course.wake(1.05)
    assert woken is not None
    assert woken.values == {"door": True}


def test_fields_that_are_debounced_together_change_together() -> None:
    course = stage("debounce: {fields: [door, count], seconds: 1}").begin()
    take(course, 0.0, door=False, count=0)
    take(course, 1.0, door=True, count=0)
    assert take(course, 1.5, door=True, count=1) == {"door": False, "count": 0}
    assert take(course, 2.2, door=True, count=1) == {"door": False, "count": 0}
    assert take(course, 2.5, door=True, count=1) == {"door": True, "count": 1}


# limit


@given(EVENTS)
@examples(300)
def test_a_limit_keeps_its_distance_and_never_loses_the_last(events: list[Event]) -> None:
    out = run(stage("limit: {every: 2}").begin(), events)
    times = [time for time, _ in out]
    assert all(b - a >= 2 for a, b in pairwise(times))
    if events:
        assert out[0] == (events[0].time, events[0].value)
        assert out[-1][1] == events[-1].value
        assert out[-1][0] <= events[-1].time + 2
    for time, value in out:  # never an older one than the last that came before
        before = [event.value for event in events if event.time < time]
        assert value in [*before[-1:], *(event.value for event in events if event.time == time)]


def test_what_made_no_sense_in_a_record_that_is_lost_is_said_with_the_next() -> None:
    course = stage("limit: {every: 1}").begin()
    course.take(Record({}), 0.0)
    assert course.take(Record({"count": 1}, ["count is odd"]), 0.1) is None
    assert course.take(Record({"count": 2}), 0.2) is None
    assert course.wake(1.0) == Record({"count": 2}, ["count is odd"])


# tick


@given(EVENTS)
@examples(200)
def test_a_ticker_repeats_the_last_record_and_nothing_is_late(events: list[Event]) -> None:
    out = run(stage("tick: {every: 2}").begin(), events, END)
    comings = [(event.time, event.value) for event in events]
    assert [each for each in comings if each not in out] == []
    repeated = list(out)
    for each in comings:
        repeated.remove(each)
    for time, value in repeated:
        assert value == [event.value for event in events if event.time <= time][-1]
    times = [time for time, _ in out]
    assert all(b - a <= 2 for a, b in pairwise(times))
    assert not events or times[-1] > END - 2


def test_what_is_repeated_is_what_came_and_not_what_became_of_it() -> None:
    course = outgoing("tick: {every: 1}").begin()
    passed = course.take(Record({"count": 1}, ["count is odd"]), 0.0)
    assert passed is not None
    passed.values["count"] = 2  # as a later stage may
    assert course.wake(1.0) == Record({"count": 1})
    assert course.due == 2.0


# timeout


@given(EVENTS)
@examples(200)
def test_after_a_silence_fields_are_unknown(events: list[Event]) -> None:
    out = run(stage("timeout: {fields: [count], seconds: 2}").begin(), events)
    for event, following in zip(events, [*(event.time for event in events[1:]), END], strict=False):
        newest = [other.value for other in events if other.time == event.time][-1]
        assert at(out, event.time) == newest
        if following - event.time >= 2:
            assert (event.time + 2, None) in out
            assert at([each for each in out if each[0] < following or following == END], following) is None


def test_other_fields_stay_and_it_is_said_once() -> None:
    course = stage("timeout: {fields: [count, pose.position.x], seconds: 1}").begin()
    pose = {"position": {"x": 1.0}}
    assert take(course, 0.0, count=1, door=True, pose=pose) == {
        "count": 1,
        "door": True,
        "pose": pose,
        "pose.position.x": 1.0,
    }
    woken = course.wake(1.0)
    assert woken is not None
    assert woken.values == {"count": None, "door": True, "pose": pose, "pose.position.x": None}
    assert course.due is None
    assert course.wake(2.0) is None


# remember and fold


def test_a_memory_keeps_the_last_value_that_counts() -> None:
    course = stage("remember: {variable: last, of: state, except: [automatic]}", wanted={}).begin()
    seen = ("automatic", "manual", "automatic", None, "manual")
    assert [(take(course, state=value) or {})["last"] for value in seen] == [None, *["manual"] * 4]


def test_a_numbers_memory_ignores_numbers() -> None:
    course = stage("remember: {variable: last, of: count, except: ['0', '255']}", wanted={}).begin()
    assert [(take(course, count=value) or {})["last"] for value in (0, 7, 255, 8)] == [None, 7, 7, 8]


@given(st.lists(st.dictionaries(st.sampled_from(["count", "door"]), st.none() | st.integers(0, 3)), max_size=10))
@examples(100)
def test_folding_keeps_the_last_known_value(records: list[dict[str, object]]) -> None:
    some, every = stage("fold: [count]").begin(), stage("fold: []").begin()
    known: dict[str, object] = {}
    for values in records:
        known |= {name: value for name, value in values.items() if value is not None}
        folded = take(some, **values)
        assert folded == values | {"count": known.get("count")}
        whole = take(every, **values) or {}
        assert {name: value for name, value in whole.items() if value is not None} == known


# override

OVERRIDE = """
override:
  name: test
  fields: {force: {between: [0.05, 0.5]}, state: {in: [manual]}, door: {in: [true]}}
  expires: 10
"""


def test_a_person_sets_a_field_for_a_while() -> None:
    course = stage(OVERRIDE).begin()
    assert isinstance(course, Overriding)
    values = {"force": 0.9, "state": "automatic", "door": False, "count": 1}
    assert course.set_override({"force": 0.1}, 0.0, "eva") is None  # no record has come yet
    assert take(course, 1.0, **values) == values | {"force": 0.1}
    changed = course.set_override({"state": "manual", "door": True}, 2.0, "eva")
    assert changed == Record(values | {"state": "manual", "door": True})
    assert course.due == 12.0
    assert course.wake(11.9) is None
    assert course.wake(12.0) == Record(values)
    assert course.override is None
    assert course.due is None


def test_what_a_person_set_can_be_taken_back() -> None:
    course = stage(OVERRIDE).begin()
    assert isinstance(course, Overriding)
    take(course, 0.0, force=0.9)
    course.set_override({"force": 0.1}, 1.0, "eva")
    assert course.override is not None
    assert (course.override.actor, course.override.until, course.name) == ("eva", 11.0, "test")
    back = course.clear_override(2.0)
    assert back is not None
    assert back.values["force"] == 0.9
    assert course.clear_override(3.0) is None


def test_what_has_expired_counts_no_more_even_if_nobody_woke() -> None:
    course = stage(OVERRIDE).begin()
    assert isinstance(course, Overriding)
    course.set_override({"force": 0.1}, 0.0, "eva")
    assert (take(course, 10.0, force=0.9) or {})["force"] == 0.9


def test_after_a_new_beginning_what_was_set_goes_on() -> None:
    course, fresh = stage(OVERRIDE).begin(), stage(OVERRIDE).begin()
    assert isinstance(course, Overriding)
    assert isinstance(fresh, Overriding)
    course.set_override({"force": 0.1}, 0.0, "eva")
    assert course.override is not None
    fresh.restore(course.override)
    assert (take(fresh, 9.0, force=0.9) or {})["force"] == 0.1


@pytest.mark.parametrize(
    ("fields", "why"),
    [
        ({"force": 0.51}, "`force` cannot be 0.51: it is a number from 0.05 to 0.5"),
        ({"force": float("nan")}, "`force` cannot be nan: it is a number from 0.05 to 0.5"),
        ({"force": True}, "`force` cannot be True: it is a number from 0.05 to 0.5"),
        ({"force": "0.1"}, "`force` cannot be '0.1': it is a number from 0.05 to 0.5"),
        ({"force": 0.1, "state": "automatic"}, "`state` cannot be 'automatic': it is one of manual"),
        ({"door": 1}, "`door` cannot be 1: it is one of true"),
        ({"forse": 0.1}, "`test` has no field `forse`; did you mean `force`?"),
        ({}, "nothing is set: `test` has the fields force, state, door"),
    ],
)
def test_beyond_the_bounds_nothing_is_set(fields: dict[str, object], why: str) -> None:
    course = stage(OVERRIDE).begin()
    assert isinstance(course, Overriding)
    course.set_override({"force": 0.2}, 0.0, "eva")
    before = course.override
    with pytest.raises(ValueError, match=r"`") as refused:
        course.set_override(fields, 1.0, "bob")
    assert str(refused.value) == why
    assert course.override == before


@pytest.mark.parametrize(("value", "allowed"), [(0, True), (2, True), (True, False), (1.5, False), (3, False)])
def test_an_integer_is_overridden_by_integers_only(value: object, allowed: bool) -> None:
    course = stage("override: {name: x, fields: {count: {between: [0, 2]}}, expires: 1}").begin()
    assert isinstance(course, Overriding)
    if allowed:
        course.set_override({"count": value}, 0.0, "eva")
    else:
        with pytest.raises(ValueError, match="it is an integer from 0 to 2"):
            course.set_override({"count": value}, 0.0, "eva")


# filter


@pytest.mark.parametrize(("text", "passes"), [("count > 1", [2, 3]), ("true", [None, 1, 2, 3]), ("false", [])])
def test_only_what_holds_goes_on(text: str, passes: list[object]) -> None:
    course = stage(f"filter: {text}").begin()
    out = [course.take(Record({"count": count}), 0.0) for count in (None, 1, 2, 3)]
    assert [record.values["count"] for record in out if record is not None] == passes


def test_a_record_for_which_a_filter_cannot_be_computed_says_why() -> None:
    record = Record({"count": 0})
    assert stage("filter: 1 / count > 1").begin().take(record, 0.0) is None
    assert record.troubles == ["1 / count divides by zero"]


@pytest.mark.parametrize(
    "text",
    ["debounce: {fields: [count], seconds: 1}", "limit: {every: 1}", "tick: {every: 1}", OVERRIDE, "fold: []"],
)
def test_read_backwards_nothing_is_added(text: str) -> None:
    values: dict[str, object] = {"count": 1}
    stage(text).backwards(values)
    assert values == {"count": 1}
