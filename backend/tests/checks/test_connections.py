"""Variables without an origin or a use."""

from __future__ import annotations

from pathlib import Path

from checks.small import DEVICE, device, found, station
from sequence_planner.analysis.checks.connections import Connections

CONNECTED = Connections(frozenset({"device.on"}), frozenset({"device.command"}))
SMALL = "name: small\nestimated: {part: {type: bool}}"


def test_a_connected_device(tmp_path: Path) -> None:
    assert found(device(tmp_path, station=SMALL), CONNECTED) == []


def test_what_no_topic_has_to_do_with(tmp_path: Path) -> None:
    assert found(device(tmp_path, station=SMALL), Connections(frozenset(), frozenset())) == [
        "device.yaml:2:12: no topic feeds `device.on`, and it is no acknowledgement: it stays unknown, and what "
        "depends on it never happens. Give it a field of an incoming topic, or make it an estimate if no message "
        "says it [nothing-feeds]",
        "device.yaml:3:10: no topic carries `device.command`: no device ever hears of it. Give it a field of an "
        "outgoing topic, or make it an estimate if it is not for a device [carried-nowhere]",
    ]


def test_what_nothing_writes_or_reads(tmp_path: Path) -> None:
    text = "name: small\nestimated: {part: {type: bool}, size: {type: 0..3, initial: 2}, idle: {type: bool}}"
    automaton = device(tmp_path, ("enabled: not command and not on", "enabled: not on and size > 1"), station=text)
    assert found(automaton, CONNECTED) == [
        "station.yaml:2:33: no ability writes `size`: it stays `2`. Write the action that is missing, or leave it out "
        "[never-written]",
        "station.yaml:2:65: nothing reads `idle`: leave it out, and list its field under `ignore` if a message has it "
        "[never-read]",
    ]


def test_a_person_answers_on_the_watch_page(tmp_path: Path) -> None:
    text = DEVICE.replace("  go:\n", "  go:\n    human: {task: Go there., acknowledgement: on}\n")
    automaton = station(tmp_path, {"device": text}, station=SMALL)
    assert found(automaton, Connections(frozenset(), frozenset())) == []
