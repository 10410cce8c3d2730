"""Faults as they are written: in one line, and in a file with their time; what is wrong is said with its place."""

from __future__ import annotations

from pathlib import Path

import pytest

from sequence_planner.language.syntax import ExpressionError
from sequence_planner.model.source import ModelError
from sequence_planner.simulation.fault_script import Scripted, read_script
from sequence_planner.simulation.faults import Clear, Fault, FaultKind, FaultReader
from sequence_planner.station import ReadyStation, prepare_station
from support.places import BOLT_TIGHTENING, CELL

READY = prepare_station(CELL)
BOLTS = prepare_station(BOLT_TIGHTENING)


def reader(station: ReadyStation) -> FaultReader:
    return FaultReader(station.automaton, station.pipelines, lambda resource: True)


@pytest.mark.parametrize(
    "text",
    [
        "robot silent",
        "/ur10/state silent for 5 s",
        "robot.pose wrong home for 0.5 s",
        "nutrunner.tool_is_idle wrong false",
        "robot slow 3 for 10 s",
        "/ur10/command drop 0.25",
        "robot restarted for 2 s",
        "clear",
        "clear robot",
    ],
)
def test_what_is_read_is_written_in_the_same_words(text: str) -> None:
    assert str(reader(BOLTS).read(text)) == text


@pytest.mark.parametrize(
    ("text", "word", "message"),
    [
        ("", 0, "write a fault such as `robot silent for 5 s`"),
        ("robott silent", 0, "no emulated device has `robott`: name a resource, a topic or a variable; did you mean"),
        ("robot", 0, "say what is wrong with robot: silent, stuck, wrong, offline, restarted, slow, drop, garbage"),
        ("robot silnt", 6, "`silnt` is no fault: write one of silent, .*; did you mean `silent`"),
        ("robot wrong home", 6, "`wrong` is for a variable, and robot is a resource"),
        ("/ur10/command silent", 14, "is a topic on which the station speaks"),
        ("robot.pose wrong", 11, "`wrong` needs a value of robot.pose, which ranges over"),
        ("robot.pose wrong away", 17, "`away` is no value of robot.pose, which ranges over"),
        ("nutrunner.tool_is_idle wrong 1", 29, "`1` is no value of nutrunner.tool_is_idle, which ranges over bool"),
        ("robot slow", 6, "behind `slow` stands how many times as long everything takes, from 1 to"),
        ("robot slow 0.5", 11, "from 1 to"),
        ("robot drop nan", 11, "behind `drop` stands the share that is lost, from 0 to 1"),
        ("robot silent 5", 13, "`5` does not belong here: at the end may stand how long, as `for 5 s`"),
        ("robot silent for", 13, "behind `for` stands a number of seconds, as in `for 5 s`"),
        ("robot silent for 5", 17, "as in `for 5 s`"),
        ("robot silent for 5 min", 17, "as in `for 5 s`"),
        ("robot silent for -1 s", 17, "as in `for 5 s`"),
        ("robot silent for 5 s or so", 21, "`or` does not belong here"),
        ("clear all", 6, "no emulated device has `all`"),
    ],
)
def test_what_is_no_fault_says_which_word_does_not_fit(text: str, word: int, message: str) -> None:
    with pytest.raises(ExpressionError, match=message) as refused:
        reader(BOLTS).read(text)
    assert refused.value.span.start == word


def test_only_devices_that_are_emulated_can_have_faults() -> None:
    only_robot = FaultReader(BOLTS.automaton, BOLTS.pipelines, {"robot"}.__contains__)
    assert only_robot.read("robot.pose stuck") == Fault(FaultKind.STUCK, "robot.pose")
    with pytest.raises(ExpressionError, match="no emulated device has `nutrunner`"):
        only_robot.read("nutrunner silent")


def test_a_script_is_read_in_the_order_of_time(tmp_path: Path) -> None:
    script = tmp_path / "faults.yaml"
    script.write_text("faults:\n  - {at: 20.5, fault: clear}\n  - {at: 10, fault: arm silent for 5 s}\n")
    silent = Fault(FaultKind.SILENT, "arm", seconds=5.0)
    assert read_script(script, reader(READY)) == (Scripted(10, silent), Scripted(20.5, Clear()))


def test_all_that_is_wrong_in_a_script_is_said_with_its_place(tmp_path: Path) -> None:
    script = tmp_path / "faults.yaml"
    script.write_text(
        "faults:\n"
        "  - {at: 10, fault: arm sillent for 5 s}\n"
        "  - {at: -1, fault: clear}\n"
        "  - at: 3\n"
        "  - {at: .nan, fault: clear}\n"
        "  - {at: 1, fault: 5}\n"
    )
    with pytest.raises(ModelError) as refused:
        read_script(script, reader(READY))
    places = [(finding.place.line, finding.place.column) for finding in refused.value.findings]
    assert places == [(2, 25), (3, 10), (4, 5), (5, 10), (6, 20)]
    assert "did you mean `silent`" in str(refused.value)


@pytest.mark.parametrize("text", ["", "- a", "fault: []", "faults: 1", "faults: [", "faults: []\nmore: 1"])
def test_what_is_no_script_says_how_to_write_one(tmp_path: Path, text: str) -> None:
    script = tmp_path / "faults.yaml"
    script.write_text(text)
    with pytest.raises(ModelError, match=r"faults\.yaml:1:\d+: |faults\.yaml:2:1: "):
        read_script(script, reader(READY))
    with pytest.raises(ModelError, match="cannot be read"):
        read_script(tmp_path / "nowhere.yaml", reader(READY))
