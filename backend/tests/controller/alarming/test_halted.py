"""A Hold calls off what is late and mends nothing: it stays told until the station goes on, with what a person does."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from controller.alarming.test_cause_first import Watched
from sequence_planner.controller.views.execution import failing
from sequence_planner.controller.views.station import AlarmState
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.simulation.faults import Clear, Fault, FaultKind
from support.simulated import ready

LATE = "overdue:nutrunner.run_nut"


@pytest.fixture(autouse=True)
def _planner_of_its_own() -> Iterator[None]:
    """What is planned for here is remembered by the planner, which others of this process share."""
    ready.cache_clear()
    yield
    ready.cache_clear()


def stuck_and_held() -> Watched:
    """A nutrunner that does not start, and a Hold when it was late for some time."""
    rig = Watched()
    rig.faulty.start(Fault(FaultKind.STUCK, "nutrunner"), rig.now)
    rig.start_production()
    assert rig.run(120, until=lambda: LATE in rig.shown)
    rig.execution.change_mode(Mode.HOLD, "Eva", Timestamp(rig.now, rig.now))
    rig.run(2)
    assert "nutrunner.run_nut" not in rig.execution.running()
    return rig


def test_it_stays_told_with_what_a_person_does() -> None:
    rig = stuck_and_held()
    alarm = rig.shown[LATE]
    assert (alarm.state, alarm.ended) == (AlarmState.UNACKNOWLEDGED, None)
    assert alarm.text == "Nutrunner: “Run the nutrunner” did not begin within 5 s, until it was called off"
    assert alarm.action.startswith("Get the nutrunner to turn.")
    assert failing(rig.station.automaton, rig.shown, rig.execution.running()) == [], "it stands still, as it should"
    assert alarm.consequence == "It can come again as soon as the station goes on."


def test_what_never_began_is_told_so_however_long_it_was_waited_for() -> None:
    """What a person does then is for its beginning, and not in place of what is begun once more."""
    rig = Watched()
    rig.faulty.start(Fault(FaultKind.STUCK, "nutrunner"), rig.now)
    rig.start_production()
    assert rig.run(120, until=lambda: LATE in rig.shown)
    rig.run(40)
    assert "has not finished within 30 s" in rig.shown[LATE].text
    rig.execution.change_mode(Mode.HOLD, "Eva", Timestamp(rig.now, rig.now))
    rig.run(2)
    alarm = rig.shown[LATE]
    assert alarm.text == "Nutrunner: “Run the nutrunner” did not begin within 30 s, until it was called off"
    assert alarm.action.startswith("Get the nutrunner to turn.")


def test_it_is_told_in_restart_mode_and_goes_when_the_station_goes_on() -> None:
    rig = stuck_and_held()
    since = rig.shown[LATE].since
    rig.execution.change_mode(Mode.RESTART, "Eva", Timestamp(rig.now, rig.now))
    rig.run(2)
    assert (rig.shown[LATE].ended, rig.shown[LATE].since) == (None, since)
    rig.faulty.clear(Clear())
    rig.execution.change_mode(Mode.AUTOMATIC, "Eva", Timestamp(rig.now, rig.now))
    rig.run(1)
    assert rig.shown[LATE].ended is not None


def test_where_nothing_is_mended_it_goes_on_as_the_same_alarm() -> None:
    rig = stuck_and_held()
    rig.execution.change_mode(Mode.AUTOMATIC, "Eva", Timestamp(rig.now, rig.now))
    assert rig.run(30, until=lambda: LATE in rig.shown and rig.shown[LATE].ended is None)
    assert rig.shown[LATE].text.startswith("The nutrunner does not start.")
