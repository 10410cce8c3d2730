"""Outputs go out when what has led to them is durable, in order; what a person holds does not wait for that."""

from __future__ import annotations

import pytest

from controller.test_conduct import Station
from sequence_planner.automaton.automaton import State
from sequence_planner.controller.io.output_gate import OutputGate
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.vocabulary import Mode

OUTPUTS = ("target", "drill")


class Sent:
    """What has been sent, and the numbers of the records; `clock` is in seconds."""

    def __init__(self, station: Station) -> None:
        self.recorded = 0
        self.all: list[tuple[object, ...]] = []
        self.clock = 0.0
        self.owed = False
        station.execution.listeners.append(self._record)
        recorded, owed, clock = (lambda: self.recorded), (lambda: self.owed), (lambda: self.clock)
        self.release = OutputGate(station.execution, recorded, self._send, owed, clock)

    def _record(self, _: object) -> None:
        self.recorded += 1

    def _send(self, state: State, everything: bool) -> None:
        self.all.append((everything, *(state[name] for name in OUTPUTS)))


@pytest.fixture
def station() -> Station:
    return Station()


@pytest.fixture
def sent(station: Station) -> Sent:
    made = Sent(station)
    station.begin()
    return made


def test_nothing_goes_out_before_it_is_durable_and_then_each_command_in_order(station: Station, sent: Sent) -> None:
    station.tick()
    station.tick(at="work")
    assert sent.all == []
    sent.release.durable(sent.recorded)
    assert sent.all == [(True, "home", False), (False, "work", False), (False, "work", True)]


def test_what_is_durable_goes_out_and_the_rest_waits(station: Station, sent: Sent) -> None:
    first = sent.recorded
    station.tick()
    sent.release.durable(first)
    assert sent.all == [(True, "home", False)]
    sent.release.durable(first)
    assert len(sent.all) == 1, "once"


def test_nothing_follows_what_is_owed(station: Station, sent: Sent) -> None:
    sent.release.durable(sent.recorded)
    sent.owed = True
    station.tick()
    sent.release.durable(sent.recorded)
    assert sent.all == [(True, "home", False)]
    sent.owed = False
    sent.release.go_on()
    assert sent.all[-1] == (False, "work", False)


def test_it_is_known_how_long_outputs_have_waited(station: Station, sent: Sent) -> None:
    sent.clock = 2.5
    assert sent.release.longest == 2.5
    sent.release.durable(sent.recorded)
    assert sent.release.longest == 0


def test_a_start_that_waits_for_its_record_is_never_sent_once_it_was_held(station: Station, sent: Sent) -> None:
    sent.release.durable(sent.recorded)
    station.tick()
    station.tick(at="work")
    assert station.execution.state["drill"] is True
    station.execution.change_mode(Mode.HOLD, "Eva", station.now)
    sent.release.durable(sent.recorded)
    assert all(sending == (True, "home", False) or sending[1:] == ("home", False) for sending in sent.all)
    station.tick()
    station.execution.change_mode(Mode.RESTART, "Eva", station.now)
    station.execution.change_mode(Mode.PAUSED, "Eva", station.now)
    sent.release.durable(sent.recorded)
    assert sent.all[-1][1:] == ("home", False), "nor does it leave when the database is there again"
    station.execution.change_mode(Mode.AUTOMATIC, "Eva", station.now)
    sent.release.durable(sent.recorded)
    assert sent.all[-1] == (False, "work", False), "when operations go on, it does"


def test_what_a_finish_has_withdrawn_goes_out_while_it_is_held(station: Station, sent: Sent) -> None:
    station.tick()
    station.tick(at="work")
    assert station.execution.state["drill"] is True
    sent.release.durable(sent.recorded)
    station.execution.change_mode(Mode.PAUSED, "Eva", station.now)
    station.tick(turns=True)
    station.tick(turns=True)
    assert station.execution.state["drill"] is False, "it has finished, and that is not durable"
    assert sent.all[-1] == (False, "work", True)
    station.execution.change_mode(Mode.HOLD, "Eva", station.now)
    sent.release.durable(sent.recorded)
    assert sent.all[-1] == (False, "work", False)


def test_what_was_kept_back_and_is_written_anew_goes_out_as_ever(station: Station, sent: Sent) -> None:
    sent.release.durable(sent.recorded)
    assert station.tick() == ("go",)
    station.execution.change_mode(Mode.HOLD, "Eva", station.now)
    sent.release.durable(sent.recorded)
    assert sent.all[-1][1:] == ("home", False), "called off, as it says how"
    station.execution.force("target", "aside", Timestamp(1010.0, 10.0), "Eva", "to have it out of the way")
    sent.release.durable(sent.recorded)
    assert sent.all[-1] == (False, "aside", False)
