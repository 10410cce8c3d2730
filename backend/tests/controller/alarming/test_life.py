"""The life of alarms (ISA-18.2): after whatever comes, goes and is asked for, each stands where it should."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import (
    Bundle,
    RuleBasedStateMachine,
    consumes,
    initialize,
    invariant,
    precondition,
    rule,
)

from controller.alarming.causes import cause as plain_cause
from sequence_planner.controller.alarms.alarm import Alarm
from sequence_planner.controller.alarms.kinds import Cause
from sequence_planner.controller.alarms.registry import OFTEN, QUIET, AlarmRegistry
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.views.station import AlarmState, AlarmView, Priority
from sequence_planner.core.clock import Timestamp
from sequence_planner.texts.message import as_it_was

FAR = 1000.0  # seconds after which nothing counts as coming and going


def cause(key: str, priority: Priority = Priority.MEDIUM) -> Cause:
    plain = plain_cause(key, priority=priority)
    return replace(plain, parts=(as_it_was("x is"),), past_parts=(as_it_was("x was"),))


@dataclass
class Scene:
    """Alarms, and what is told of them; `seconds` is the time."""

    told: list[tuple[str, str]] = field(default_factory=list)
    seconds: float = 0.0

    def __post_init__(self) -> None:
        self.lives = AlarmRegistry(self._tell)

    def look(self, *causes: Cause, folded: tuple[str, ...] = (), after: float = FAR) -> dict[str, AlarmView]:
        """So many seconds later these causes are there."""
        self.seconds += after
        self.lives.observe({each.key: each for each in causes}, folded, self.now)
        return self.lives.view()

    @property
    def now(self) -> Timestamp:
        return Timestamp(5000.0 + self.seconds, self.seconds)

    def later(self, seconds: float) -> Timestamp:
        return Timestamp(self.now.epoch + seconds, self.now.monotonic + seconds)

    def _tell(self, key: str, life: Alarm, event: str) -> None:
        self.told.append((key, event))


def test_an_alarm_stays_until_its_cause_is_gone_and_a_person_knows_of_it() -> None:
    on = Scene()
    came = on.look(cause("a"))["a"]
    assert (came.state, came.ended) == (AlarmState.UNACKNOWLEDGED, None)
    returned = on.look()["a"]
    assert (returned.state, returned.since, returned.ended) == (AlarmState.RETURNED, came.since, on.now.epoch)
    assert (came.text, came.consequence, came.action, came.parts) == ("a is wrong", "nothing", "look", ["x is"])
    assert (returned.text, returned.consequence, returned.action) == ("a was wrong", "", ""), "it is over, and reads so"
    assert returned.parts == ["x was"]
    on.lives.acknowledge("a", came.since, "Eva")
    assert on.lives.view() == {}
    assert on.told == [("a", "came"), ("a", "returned"), ("a", "acknowledged")]


def test_where_the_text_becomes_another_its_time_is_told_anew() -> None:
    on = Scene()
    came = on.look(replace(cause("a"), phase="not begun"))["a"]
    assert on.look(replace(cause("a"), phase="not begun"))["a"].since == came.since
    other = on.look(replace(cause("a"), phase="not finished"))["a"]
    assert (other.since, other.state, other.count) == (on.now.epoch, came.state, 1)
    assert on.told == [("a", "came")], "it is the same alarm"


def test_an_alarm_that_is_known_goes_with_its_cause() -> None:
    on = Scene()
    on.lives.acknowledge("a", on.look(cause("a"))["a"].since, "Eva")
    known = on.look(cause("a"))["a"]
    assert (known.state, known.by, known.count) == (AlarmState.ACKNOWLEDGED, "Eva", 0)
    assert on.look() == {}


def test_nobody_acknowledges_an_alarm_that_came_after_the_one_that_was_seen() -> None:
    on = Scene()
    seen = on.look(cause("a"))["a"].since
    on.look()
    again = on.look(cause("a"))["a"]
    assert (again.state, again.count) == (AlarmState.UNACKNOWLEDGED, 2)
    with pytest.raises(CommandRefused, match="acknowledge this one") as refused:
        on.lives.acknowledge("a", seen, "Eva")
    assert refused.value.slug == "alarm-recurred"
    on.lives.acknowledge("a", again.since, "Eva")


def test_an_acknowledgement_that_is_repeated_changes_nothing() -> None:
    on = Scene()
    since = on.look(cause("a"))["a"].since
    on.lives.acknowledge("a", since, "Eva")
    on.lives.acknowledge("a", since, "Otto")
    assert on.lives.view()["a"].by == "Eva"


def test_of_a_notice_nobody_has_to_take_note() -> None:
    on = Scene()
    assert on.look(cause("a", Priority.LOW))["a"].state is AlarmState.ACKNOWLEDGED


def test_who_has_looked_at_a_notice_is_told_until_it_says_something_else() -> None:
    on = Scene()
    notice = cause("a", Priority.LOW)
    on.lives.acknowledge("a", on.look(notice)["a"].since, "Eva")
    seen = on.look(notice)["a"]
    assert (seen.state, seen.by) == (AlarmState.ACKNOWLEDGED, "Eva")
    assert on.told == [("a", "came"), ("a", "acknowledged")]
    assert on.look(replace(notice, text=as_it_was("a is wrong again")))["a"].by is None
    assert on.look() == {}


def test_a_shelved_alarm_is_told_again_when_its_time_is_over() -> None:
    on = Scene()
    on.look(cause("a"))
    on.lives.shelve("a", "Eva", "known", on.later(600))
    shelved = on.look(cause("a"), after=599)["a"]
    assert (shelved.state, shelved.by, shelved.why, shelved.until) == (
        AlarmState.SHELVED,
        "Eva",
        "known",
        on.now.epoch + 1,
    )
    assert on.look(cause("a"), after=1)["a"].state is AlarmState.UNACKNOWLEDGED


def test_a_shelved_alarm_whose_cause_has_gone_is_gone_afterwards() -> None:
    on = Scene()
    on.look(cause("a"))
    on.lives.shelve("a", "Eva", "known", on.later(600))
    assert on.look(after=300)["a"].state is AlarmState.SHELVED
    assert on.look(after=300) == {}


def test_a_clock_that_is_set_ends_no_shelving() -> None:
    on = Scene()
    on.look(cause("a"))
    on.lives.shelve("a", "Eva", "known", on.later(600))
    on.lives.observe({"a": cause("a")}, (), Timestamp(on.now.epoch + 86400, on.now.monotonic + 1))
    assert on.lives.view()["a"].state is AlarmState.SHELVED


def test_what_is_out_of_service_stays_so_and_in_sight_until_it_is_restored() -> None:
    on = Scene()
    on.look(cause("a"))
    on.lives.suppress("a", "Eva", "broken")
    on.look()
    assert on.look(cause("a"))["a"].state is AlarmState.OUT_OF_SERVICE
    with pytest.raises(CommandRefused):
        on.lives.shelve("a", "Otto", "known", on.later(60))
    on.lives.put_back("a")
    assert on.look(cause("a"))["a"].state is AlarmState.UNACKNOWLEDGED


def test_what_is_urgent_is_not_put_aside() -> None:
    on = Scene()
    on.look(cause("a", Priority.HIGH))
    acts: tuple[Callable[[], None], ...] = (
        lambda: on.lives.shelve("a", "Eva", "known", on.later(60)),
        lambda: on.lives.suppress("a", "Eva", "broken"),
    )
    for put_aside in acts:
        with pytest.raises(CommandRefused) as refused:
            put_aside()
        assert refused.value.slug == "alarm-too-urgent"
    assert on.lives.view()["a"].state is AlarmState.UNACKNOWLEDGED


def test_what_becomes_urgent_is_told_although_it_was_shelved() -> None:
    on = Scene()
    on.look(cause("a"))
    on.lives.shelve("a", "Eva", "known", on.later(3600))
    assert on.look(cause("a", Priority.HIGH), after=1)["a"].state is AlarmState.UNACKNOWLEDGED


def test_what_becomes_more_urgent_is_to_be_seen_again_and_not_when_it_only_was_before() -> None:
    on = Scene()
    on.lives.acknowledge("a", on.look(cause("a"))["a"].since, "Eva")
    worse = on.look(cause("a", Priority.HIGH))["a"]
    assert worse.state is AlarmState.UNACKNOWLEDGED
    on.lives.acknowledge("a", worse.since, "Eva")
    for priority in (Priority.MEDIUM, Priority.HIGH):
        assert on.look(cause("a", priority))["a"].state is AlarmState.ACKNOWLEDGED


def test_what_comes_and_goes_is_one_alarm_that_lasts() -> None:
    on = Scene()
    since = 0.0
    for _ in range(OFTEN):
        since = on.look(cause("a"), after=1)["a"].since
        on.look(after=1)
    for _ in range(20):
        assert on.look(cause("a"), after=1)["a"].since == since
        assert on.look(after=1)["a"].state is AlarmState.UNACKNOWLEDGED
    assert on.lives.view()["a"].count == OFTEN + 20
    assert on.told.count(("a", "returned")) == OFTEN - 1
    on.lives.acknowledge("a", since, "Eva")  # it can be: it is still the same
    assert on.look(after=QUIET - 2)["a"].state is AlarmState.ACKNOWLEDGED
    assert on.look(after=2) == {}


def test_a_part_of_another_is_afterwards_what_it_was() -> None:
    on = Scene()
    on.lives.acknowledge("a", on.look(cause("a"))["a"].since, "Eva")
    assert on.look(cause("root"), folded=("a",)).keys() == {"root"}
    both = on.look(cause("root"), cause("a"))
    assert both["a"].state is AlarmState.ACKNOWLEDGED


def test_a_part_that_is_gone_is_acknowledged_with_the_other() -> None:
    on = Scene()
    on.look(cause("a"))
    on.look(cause("root"), folded=("a",))
    assert on.look(cause("root")).keys() == {"root"}


KEYS = ("a", "b")
LASTING = st.sampled_from(KEYS)


@dataclass
class Expected:
    """Where an alarm should stand, said with tables of the standard's transitions."""

    state: AlarmState
    since: float
    there: bool = True
    until: float | None = None


class Living(RuleBasedStateMachine):
    """Any life of two alarms, beside the transitions of ISA-18.2, figure 4.2, written down plainly.

    Time goes in steps that are too long for coming and going.
    """

    seen = Bundle("seen")  # alarms as somebody saw them: key and since

    @initialize(priorities=st.tuples(*(st.sampled_from(Priority) for _ in KEYS)))
    def begin(self, priorities: tuple[Priority, ...]) -> None:
        self.on = Scene()
        self.causes = {key: cause(key, each) for key, each in zip(KEYS, priorities, strict=True)}
        self.expected: dict[str, Expected] = {}
        self.there: set[str] = set()

    def rises(self, key: str) -> AlarmState:
        low = self.causes[key].priority is Priority.LOW
        return AlarmState.ACKNOWLEDGED if low else AlarmState.UNACKNOWLEDGED

    @rule(there=st.sets(LASTING))
    def pass_time(self, there: set[str]) -> None:
        shown = self.on.look(*(self.causes[key] for key in sorted(there)))
        now = self.on.now.epoch
        for key in KEYS:
            was = self.expected.get(key)
            if was is None and key in there:
                self.expected[key] = Expected(self.rises(key), now)
            elif was is not None:
                self._age(key, was, key in there, now)
        self.there = there
        assert shown.keys() == self.expected.keys()

    def _age(self, key: str, was: Expected, there: bool, now: float) -> None:
        if there and not was.there:
            was.since = now
        came, went, was.there = there and not was.there, was.there and not there, there
        if was.state is AlarmState.SHELVED and was.until is not None and now >= was.until:
            was.state, was.until = (self.rises(key) if there else AlarmState.ACKNOWLEDGED), None
        elif came and was.state is AlarmState.RETURNED:
            was.state = AlarmState.UNACKNOWLEDGED
        elif went and was.state is AlarmState.UNACKNOWLEDGED:
            was.state = AlarmState.RETURNED
        if was.state is AlarmState.ACKNOWLEDGED and not there:
            del self.expected[key]

    @rule(target=seen, key=LASTING)
    def see(self, key: str) -> tuple[str, float]:
        view = self.on.lives.view().get(key)
        return key, view.since if view is not None else -1.0

    @rule(saw=consumes(seen))
    def acknowledge(self, saw: tuple[str, float]) -> None:
        key, since = saw
        was = self.expected.get(key)
        aside = was is not None and was.state in (AlarmState.SHELVED, AlarmState.OUT_OF_SERVICE)
        may = was is not None and was.since == since and not aside
        self.asked(may, lambda: self.on.lives.acknowledge(key, since, "Eva"))
        if may and was is not None:
            was.state = AlarmState.ACKNOWLEDGED
            if not was.there:
                del self.expected[key]

    @rule(key=LASTING, seconds=st.sampled_from((FAR / 2, FAR, FAR * 3)))
    def shelve(self, key: str, seconds: float) -> None:
        was = self.expected.get(key)
        urgent = self.causes[key].priority is Priority.HIGH
        may = was is not None and not urgent and was.state is not AlarmState.OUT_OF_SERVICE
        until = self.on.later(seconds)
        self.asked(may, lambda: self.on.lives.shelve(key, "Eva", "known", until))
        if may and was is not None:
            was.state, was.until = AlarmState.SHELVED, until.epoch

    @rule(key=LASTING)
    def suppress(self, key: str) -> None:
        was = self.expected.get(key)
        may = was is not None and self.causes[key].priority is not Priority.HIGH
        self.asked(may, lambda: self.on.lives.suppress(key, "Eva", "broken"))
        if may and was is not None:
            was.state, was.until = AlarmState.OUT_OF_SERVICE, None

    @rule(key=LASTING, restoring=st.booleans())
    def take_back(self, key: str, restoring: bool) -> None:
        was = self.expected.get(key)
        may = was is not None and was.state is (AlarmState.OUT_OF_SERVICE if restoring else AlarmState.SHELVED)
        self.asked(may, lambda: self.on.lives.put_back(key) if restoring else self.on.lives.unshelve(key))
        if may and was is not None:
            was.state, was.until = self.rises(key), None
            if not was.there:
                del self.expected[key]

    def asked(self, may: bool, act: Callable[[], None]) -> None:
        """What may not be done is refused, and changes nothing."""
        before = self.on.lives.view()
        if may:
            act()
        else:
            with pytest.raises(CommandRefused):
                act()
            assert self.on.lives.view() == before

    @precondition(lambda self: hasattr(self, "expected"))
    @invariant()
    def stands(self) -> None:
        shown = self.on.lives.view()
        assert {key: (each.state, each.since) for key, each in shown.items()} == {
            key: (each.state, each.since) for key, each in self.expected.items()
        }
        for key, each in shown.items():
            assert (each.ended is None) == self.expected[key].there
            assert (each.until is not None) == (each.state is AlarmState.SHELVED)

    @precondition(lambda self: hasattr(self, "expected"))
    @invariant()
    def nothing_is_lost(self) -> None:
        """Whatever is there has an alarm; whatever has ended unseen is still to be seen."""
        assert self.there <= self.on.lives.view().keys()


Living.TestCase.settings = settings(max_examples=150, stateful_step_count=30, deadline=None, derandomize=True)
test_any_life = Living.TestCase
