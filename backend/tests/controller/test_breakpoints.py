"""Breakpoints: the station pauses after the tick in which a condition becomes true, and no tick waits for anybody."""

from __future__ import annotations

import pytest

from controller.carrying_out import carry_out
from controller.test_conduct import Station
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.execution import RemoveBreakpoint, SetBreakpoint
from sequence_planner.controller.features.commissioning.breakpoints import MOST_BREAKPOINTS, Breakpoints
from sequence_planner.controller.views.station import BreakpointView, MadeBreakpointView
from sequence_planner.execution.vocabulary import Mode
from support.people import EVA


class Watched:
    """A cart that is commissioned."""

    def __init__(self) -> None:
        self.station = Station()
        self.station.begin()
        self.points = Breakpoints(self.station.execution)

    def tick(self, ticks: int = 1, **measured: bool | str | None) -> tuple[str, ...]:
        """What the first of some ticks starts; then is looked whether to pause, as the controller does."""
        station = self.station
        station.measured |= measured
        outcome = station.execution.tick(station.measured, station.now)
        self.points.take_note(outcome, station.now)
        for _ in range(ticks - 1):
            self.points.take_note(station.execution.tick(station.measured, station.now), station.now)
        self.points.pause(station.now)
        station.plan()
        return outcome.started

    def set(self, condition: str) -> str:
        """Pause when that becomes true; the number of the breakpoint."""
        made = carry_out(self.points, SetBreakpoint(actor=EVA, condition=condition), self.station.now)
        assert isinstance(made, MadeBreakpointView)
        assert made.model_dump(exclude={"id"}) == self.shown[made.id].model_dump()
        return made.id

    @property
    def shown(self) -> dict[str, BreakpointView]:
        """All of them, as people see them."""
        shown = self.points.view_part(self.station.now)["breakpoints"]
        assert isinstance(shown, dict)
        return shown

    def mode(self) -> Mode:
        return self.station.execution.mode


@pytest.fixture
def on() -> Watched:
    return Watched()


def test_the_station_pauses_after_the_tick_in_which_it_becomes_true(on: Watched) -> None:
    number = on.set("at == work")
    assert on.tick() == ("go",)
    assert on.mode() is Mode.AUTOMATIC
    assert on.tick(at="work") == ("drill",), "the tick itself is taken as ever"
    assert on.mode() is Mode.PAUSED
    shown = on.shown[number]
    assert (shown.hits, shown.stopped, shown.by, shown.condition) == (1, True, EVA.name, "at == work")
    assert on.tick(turns=True) == (), "what runs may finish, and nothing starts"


def test_it_pauses_also_where_the_next_tick_comes_at_once(on: Watched) -> None:
    number = on.set("at == work")
    on.tick()
    on.tick(3, at="work")
    assert (on.mode(), on.shown[number].stopped) == (Mode.PAUSED, True)


def test_it_goes_on_though_the_condition_is_still_true_and_pauses_when_it_is_once_more(on: Watched) -> None:
    number = on.set("target == work")
    on.tick()
    assert on.mode() is Mode.PAUSED
    on.station.execution.change_mode(Mode.AUTOMATIC, "Eva", on.station.now)
    on.tick(at="work")
    assert on.mode() is Mode.AUTOMATIC
    assert not on.shown[number].stopped
    on.station.execution.state = {**on.station.execution.state, "target": "home"}
    on.tick(at="home")
    on.station.execution.state = {**on.station.execution.state, "target": "work"}
    on.tick()
    assert (on.mode(), on.shown[number].hits) == (Mode.PAUSED, 2)


def test_what_is_not_known_is_not_true_and_what_is_true_already_has_to_become_so_again(on: Watched) -> None:
    on.set("at == home")
    on.tick()
    assert on.mode() is Mode.AUTOMATIC, "it was so before"
    on.tick(at=None)
    assert on.mode() is Mode.AUTOMATIC
    on.tick(at="home")
    assert on.mode() is Mode.PAUSED


def test_in_another_mode_it_is_counted_and_changes_nothing(on: Watched) -> None:
    number = on.set("at == work")
    on.station.execution.change_mode(Mode.RESTART, "Eva", on.station.now)
    on.tick(at="work")
    assert (on.mode(), on.shown[number].hits, on.shown[number].stopped) == (Mode.RESTART, 1, False)


def test_one_that_is_removed_does_nothing_and_bad_ones_are_refused(on: Watched) -> None:
    number = on.set("at == work")
    carry_out(on.points, RemoveBreakpoint(actor=EVA, id=number), on.station.now)
    on.tick(at="work")
    assert on.mode() is Mode.AUTOMATIC
    with pytest.raises(CommandRefused) as gone:
        carry_out(on.points, RemoveBreakpoint(actor=EVA, id=number), on.station.now)
    assert (gone.value.slug, gone.value.status) == ("no-breakpoint", 404)
    with pytest.raises(CommandRefused) as unread:
        on.set("at == wrok")
    assert (unread.value.slug, unread.value.place is not None) == ("bad-predicate", True)
    with pytest.raises(CommandRefused) as constant:
        on.set("true")
    assert (constant.value.slug, constant.value.status) == ("bad-predicate", 422)
    for _ in range(MOST_BREAKPOINTS):
        on.set("at == work")
    with pytest.raises(CommandRefused) as many:
        on.set("at == home")
    assert many.value.slug == "too-many-breakpoints"
