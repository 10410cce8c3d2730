"""How a station starts: nothing moves without a person, and what cannot start says why."""

from __future__ import annotations

import asyncio
import os
import shutil
import signal
from pathlib import Path

import pytest

from sequence_planner.ros.qos import QualityOfService
from support.network import free_port
from support.places import REPOSITORY
from support.station import MODEL, RunningStation, finished, foreign_node, process, station
from support.waiting import until


def test_nothing_is_published_until_a_person_starts_production(tmp_path: Path) -> None:
    heard: list[str] = []

    async def listen() -> None:
        async with foreign_node() as (transport, _):
            commands = {
                "/ur10/command": "truck_engine_msgs/msg/RobotCommand",
                "/operator/task": "truck_engine_msgs/msg/OperatorTask",
            }
            for topic, type_name in commands.items():
                transport.subscribe(
                    topic, type_name, QualityOfService.RELIABLE, lambda batch: heard.extend(s.topic for s in batch)
                )
            await asyncio.to_thread(until, lambda: running.get("topics")["/ur10/command"]["peers"] >= 2)
            await asyncio.sleep(3)
            assert heard == []
            assert running.get("tasks") == {}
            assert running.post("production/start", {}).status_code == 204
            await asyncio.to_thread(until, lambda: set(heard) == set(commands))

    with station(tmp_path, "--emulator", "--emulator-speed", "5") as running:
        assert running.get("production", "station") == "waiting"
        asyncio.run(asyncio.wait_for(listen(), 60))
        again = running.post("production/start", {})
        assert again.status_code == 409
        assert again.json()["detail"] == "Production has been started already."
        running.work_on(1)

        # A controller that had to be started again knows nothing of what it did: a person starts production.
        killed = running.child("controller")
        os.kill(killed, signal.SIGKILL)
        until(lambda: killed not in running.children("controller"))
        until(lambda: running.production() == "waiting")


DEMONSTRATION = ("run", str(MODEL), "--emulator", "--demonstration")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("run", str(MODEL), "--start"), "--start is for emulated devices"),
        (("run", str(MODEL), "--host", "0.0.0.0"), "cannot serve on 0.0.0.0 without HTTPS"),
        (("run", str(MODEL), "--port", "70000"), "70000 is not a port"),
        (("run", str(MODEL), "--database", "oracle://station"), "a database of the kind `oracle` is not supported"),
        (("run", str(MODEL), "--demonstration"), "--demonstration is for emulated devices"),
        ((*DEMONSTRATION, "--host", "192.0.2.7"), "cannot serve on 192.0.2.7 without HTTPS"),
        ((*DEMONSTRATION, "--proxy", "127.0.0.1", "--name", "a.example"), "--demonstration is for this machine alone"),
        ((*DEMONSTRATION, "--name", "a.example"), "--demonstration is for this machine alone"),
        ((*DEMONSTRATION, "--database", "sqlite:////folder/kept"), "--demonstration has a database of its own"),
        (("run", "models"), "a station is a folder with a station.yaml"),
        (("run", str(MODEL), "--transport", "rclpy"), "source the setup file of a ROS 2 installation"),
        (("by-hand", "robot.pose := home"), "no emulated devices are running"),
    ],
)
def test_what_cannot_be_run_says_what_to_do(arguments: tuple[str, ...], said: str) -> None:
    refused = finished(*arguments)
    assert refused.returncode == 2
    assert said in refused.stderr
    assert "Traceback" not in refused.stderr


def test_specifications_that_cannot_be_met_are_shown_with_a_run_and_nothing_is_started(tmp_path: Path) -> None:
    model = tmp_path / "station"
    shutil.copytree(REPOSITORY / MODEL, model)
    station = model / "station.yaml"
    text = station.read_text(encoding="utf-8")
    idle = "nutrunner.set_tool_idle and"
    assert idle in text
    station.write_text(text.replace(idle, f"{idle} nutrunner.run_tool_forward and"), encoding="utf-8")
    port = free_port()
    log = tmp_path / "station.log"
    with process(log, "run", str(model), "--emulator", "--start", "--port", str(port)) as running:
        shown = RunningStation(running, port, log)
        until(lambda: shown.analysed() is not None)
        analysis = shown.analysed()
        assert analysis is not None
        assert (analysis["supervised"], analysis["guards"]) == (False, None)
        [finding] = analysis["findings"]
        assert "no state described by `rest` in station.yaml can be reached" in finding["message"]
        assert (finding["kind"], finding["file"]) == ("specification-cannot-be-met", str(station))
        assert finding["trace"]["initial"]["robot.pose"] == "home"
        assert list(shown.get("alarms")) == ["no-supervisor"]
        refused = shown.post("production/start", {})
        assert (refused.status_code, refused.json()["type"]) == (409, "/problems/no-supervisor")
        assert "`rest`" in refused.json()["detail"]


BROKEN = {
    "a library is missing": ("raise ImportError('librcl.so: cannot open shared object file')", "librcl.so"),
    "it is of another Python": ("from rclpy.impl import nothing", "No module named 'rclpy.impl'"),
    "it crashes": ("import os\nos.abort()", "it ends with code -6"),
}


@pytest.fixture
def broken_rclpy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: str) -> str:
    """An rclpy first on the path that cannot be imported; what is said of it."""
    package = tmp_path / "jazzy" / "rclpy" / "__init__.py"
    package.parent.mkdir(parents=True)
    package.write_text(BROKEN[kind][0])
    monkeypatch.setenv("PYTHONPATH", str(package.parents[1]))
    return BROKEN[kind][1]


@pytest.mark.parametrize("kind", BROKEN)
def test_a_broken_rclpy_that_is_asked_for_is_refused_with_one_line(broken_rclpy: str) -> None:
    refused = finished("run", str(MODEL), "--emulator", "--transport", "rclpy")
    assert refused.returncode == 2
    [line] = refused.stderr.splitlines()
    assert broken_rclpy in line
    assert line.endswith("mend that installation of ROS 2, or choose cyclonedds")


@pytest.mark.parametrize("kind", ["a library is missing", "it crashes"])
def test_a_station_that_may_choose_does_without_a_broken_rclpy_and_says_so_once(
    broken_rclpy: str, tmp_path: Path
) -> None:
    with station(tmp_path, "--emulator") as running:
        assert running.get("production", "station") == "waiting"
    lines = running.log.read_text().splitlines()
    [line] = [line for line in lines if "rclpy" in line]
    assert line.startswith("cyclonedds is used instead of the rclpy at ")
    assert broken_rclpy in line
    assert not [line for line in lines if "started again" in line]


def test_a_part_alone_does_without_a_broken_rclpy_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "rclpy" / "__init__.py"
    package.parent.mkdir()
    package.write_text("raise OSError('wrong ELF class')")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    looked = finished("topics")
    assert (looked.returncode, "Traceback" in looked.stderr) == (0, False)
    assert "cyclonedds is used instead of the rclpy at " in looked.stderr
    refused = finished("topics", "--transport", "rclpy")
    assert refused.returncode == 2
    [line] = refused.stderr.splitlines()
    assert "wrong ELF class" in line


@pytest.mark.parametrize("kind", ["a library is missing"])
def test_emulated_devices_that_do_without_a_broken_rclpy_say_so_once(broken_rclpy: str, tmp_path: Path) -> None:
    log = tmp_path / "devices.log"
    with process(log, "emulate", str(MODEL)):
        until(lambda: "emulated devices are up" in log.read_text())
    [line] = [line for line in log.read_text().splitlines() if "rclpy" in line]
    assert "cyclonedds is used instead of the rclpy at " in line
    assert broken_rclpy in line
