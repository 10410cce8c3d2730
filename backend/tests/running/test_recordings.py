"""A recording of what a running station and its devices say, from which What-if begins."""

from __future__ import annotations

import time
from pathlib import Path

from sequence_planner.automaton.automaton import Kind
from sequence_planner.station import prepare_station
from support.places import BOLT_TIGHTENING
from support.recordings import STORAGES, recording
from support.station import RunningStation, station
from support.waiting import until

QUIET = 0.4  # seconds before and after a moment at which nothing changes: a busy machine's clocks agree within it
MOMENTS = 5
OCTETS = {"Content-Type": "application/octet-stream"}


def test_at_each_moment_a_recording_tells_what_the_journal_of_the_station_tells(tmp_path: Path) -> None:
    """Both have heard the same messages: measured variables are the same at any moment at which nothing changes."""
    ready = prepare_station(BOLT_TIGHTENING)
    measured = [name for name in ready.automaton.names(Kind.MEASURED) if name in ready.pipelines.feeds]
    outputs = sorted(ready.automaton.outputs)
    with station(tmp_path, "--emulator", "--start", "--emulator-speed", "1") as running:
        # Who listens to commands before is taken for a device that is no emulated one.
        until(lambda: running.get("production", "station") == "started")
        with recording(ready) as recorder:
            _work(running)
            time.sleep(2 * QUIET)
        for storage in STORAGES:
            file = recorder.write(tmp_path / storage, storage)
            params = {"name": file.name}
            answer = running.browser.post(
                "model/recordings", params=params, content=file.read_bytes(), headers=OCTETS, timeout=120
            )
            assert answer.status_code == 201, answer.text
            read = answer.json()
            assert (read["missing"], read["otherwise"], read["troubles"]) == ([], [], [])
            assert read["messages"] <= len(recorder.messages)
            ats = [each["at"] for each in read["moments"]]
            quiet = [
                one + QUIET
                for one, other in zip(ats, [*ats[1:], read["until"]], strict=True)
                if other - one > 2 * QUIET
            ]
            assert len(quiet) >= MOMENTS
            poses = set()
            for at in quiet:
                state = running.get("values", f"model/recordings/{read['id']}/state?at={at}")
                place = running.browser.get("history/at", params={"time": read["began"] + at}).json()
                past = running.get("past", f"history/{place['number']}")["values"]
                assert {name: state[name] for name in measured} == {name: past[name] for name in measured}, at
                # What was commanded is known by the recorded commands, too.
                assert {name: state[name] for name in outputs} == {name: past[name] for name in outputs}, at
                begun = running.browser.post(
                    "model/what-if/steps", json={"recording": {"id": read["id"], "at": at}}, timeout=120
                )
                assert begun.json()["before"] == state
                poses.add(state["robot.pose"])
            assert len(poses) > 1  # it has worked


def _work(running: RunningStation) -> None:
    """Let a person do what they are asked, until two bolt pairs are tightened."""

    def is_tight() -> bool:
        for id, task in running.get("tasks").items():
            running.browser.post(f"tasks/{id}/acknowledgement", json={"revision": task["revision"]})
        bolts = running.get("variables", "state")
        tight = [name for name, each in bolts.items() if name.startswith("bolts[") and each["value"] == "tightened"]
        return len(tight) > 1

    until(is_tight, seconds=90)
