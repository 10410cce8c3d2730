"""A whole station with genuine ROS 2 on one side or on both, and what happens when either side is killed."""

from __future__ import annotations

import importlib.util
import os
import signal
from pathlib import Path

import pytest

from foreign.genuine import lacking
from foreign.test_genuine import OURS
from support.station import MODEL, process, station
from support.waiting import until

PACKAGE = "truck_engine_msgs"


@pytest.mark.parametrize(("ours", "theirs"), [("cyclonedds", "rclpy"), ("rclpy", "cyclonedds"), ("rclpy", "rclpy")])
def test_a_station_works_with_devices_over_genuine_ros(
    ours: str, theirs: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # A station of its own: the outputs of the one before are no concern of devices that begin anew.
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    why = lacking(OURS)
    if why is None and importlib.util.find_spec(PACKAGE) is None:
        why = f"{PACKAGE} is not built here: `sequence-planner messages {MODEL} --ament FOLDER`, then colcon build"
    if why is not None:
        pytest.skip(why)
    log = tmp_path / "devices.log"
    devices = ("emulate", str(MODEL), "--transport", theirs, "--speed", "5")
    with process(log, *devices) as emulated, station(tmp_path, "--transport", ours) as running:
        until(lambda: running.value("robot.pose") is not None)
        until(lambda: running.get("alarms") == {})
        answer = running.post("production/start", {})
        assert answer.status_code == 204, answer.text
        running.work_on(1)
        emulated.kill()
        emulated.wait()
        until(lambda: running.value("robot.pose") is None)
        with process(log, *devices):
            until(lambda: running.value("robot.pose") is not None)
            killed = running.child("controller")
            os.kill(killed, signal.SIGKILL)
            until(lambda: killed not in running.children("controller"))
            until(lambda: running.production() == "waiting")
            until(lambda: running.value("robot.pose") is not None)
    assert "Traceback" not in log.read_text() + running.log.read_text()
    assert "[WARN]" not in log.read_text() + running.log.read_text()
