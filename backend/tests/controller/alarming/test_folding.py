"""What is a part of what: nothing is lost, nothing is made less urgent, and nothing hides for long."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from controller.alarming.causes import cause
from sequence_planner.controller.alarms.alarm import urgency
from sequence_planner.controller.alarms.registry import LINGERS, Folding
from sequence_planner.controller.views.station import Priority
from sequence_planner.texts.message import as_it_was
from support.examples import examples

KEYS = ("a", "b", "c", "d", "e")
LINKS = st.fixed_dictionaries({key: st.lists(st.sampled_from(KEYS), max_size=2, unique=True) for key in KEYS})
LOOKS = st.lists(
    st.tuples(st.sets(st.sampled_from(KEYS)), st.sets(st.sampled_from(KEYS), max_size=1), st.floats(0.1, 8)), max_size=8
)


@examples(300)
@given(LINKS, st.fixed_dictionaries({key: st.sampled_from(Priority) for key in KEYS}), LOOKS)
def test_whatever_is_there_is_told_once_as_urgently_as_it_is(
    links: dict[str, list[str]], priorities: dict[str, Priority], looks: list[tuple[set[str], set[str], float]]
) -> None:
    folding, now = Folding(), 0.0
    last_there = dict.fromkeys(KEYS, float("-inf"))
    for there, alone, seconds in looks:
        now += seconds
        causes = [cause(key, *links[key], priority=priorities[key]) for key in sorted(there)]
        told = folding.fold(causes, alone, now)
        last_there |= dict.fromkeys(there, now)
        assert told.folded.isdisjoint(told.alarms)
        assert there == told.folded | (told.alarms.keys() & there)
        for each in causes:
            tellers = [alarm for key, alarm in told.alarms.items() if key == each.key or each.text in alarm.parts]
            assert len(tellers) == 1
            assert urgency(tellers[0].priority) >= urgency(each.priority)
            if each.key in told.folded:
                assert links[each.key]
        for key, alarm in told.alarms.items():
            if key not in there:  # it is over, and what followed is not
                assert alarm.parts
                assert now - last_there[key] <= LINGERS + 8
            if key in alone:
                assert not alarm.parts


def test_what_follows_from_what_follows_is_a_part_too() -> None:
    told = Folding().fold([cause("a"), cause("b", "a"), cause("c", "b")], (), 0)
    assert [str(part) for part in told.alarms["a"].parts] == ["b is wrong", "c is wrong"]
    assert [str(part) for part in told.alarms["a"].past_parts] == ["b was wrong", "c was wrong"]
    assert told.folded == {"b", "c"}


def test_what_outlasts_its_cause_for_long_is_an_alarm_of_its_own() -> None:
    folding = Folding()
    part = replace(
        cause("b", "a", priority=Priority.LOW), consequence=as_it_was("it waits"), action=as_it_was("look at b")
    )
    folding.fold([cause("a", priority=Priority.HIGH), part], (), 0)
    over = folding.fold([part], (), 5).alarms["a"]
    assert str(over.text) == "a was wrong. That is over, but something that came of it lasts"
    assert (str(over.consequence), str(over.action)) == ("it waits", "look at b"), "of what is left"
    assert over.priority is Priority.LOW
    assert folding.fold([cause("b", "a")], (), 5 + LINGERS).alarms.keys() == {"b"}


def test_an_alarm_without_parts_ends_with_its_cause() -> None:
    folding = Folding()
    folding.fold([cause("a")], (), 0)
    assert not folding.fold([], (), 1).alarms
    assert folding.fold([cause("b", "a")], (), 2).alarms.keys() == {"b"}


def test_what_consists_of_parts_is_told_in_its_parts() -> None:
    several = replace(cause("b", "a"), parts=(as_it_was("one"), as_it_was("other")))
    parts = Folding().fold([cause("a"), several], (), 0).alarms["a"].parts
    assert [str(part) for part in parts] == ["one", "other"]
