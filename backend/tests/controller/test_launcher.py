"""The launcher: what dies is started again, what cannot run says so, and nothing outlives it."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from sequence_planner.core.secrets import CLIENT_SECRET, PASSWORD
from sequence_planner.core.secrets import environment as with_secrets
from sequence_planner.core.storage_error import DATABASE
from sequence_planner.process.parent_watch import DEPLOYED
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.startup import station_process as parts
from sequence_planner.startup.station_process import UNUSABLE, Executed, StationProcess
from support.network import free_port
from support.places import REPOSITORY
from support.station import MODEL, RunningStation, command, descendants, environment, finished, foreign_node, station
from support.waiting import patience, until


def part(program: str) -> StationProcess:
    return StationProcess("part", Executed([sys.executable, "-c", program]))


def children(pid: int) -> list[int]:
    listed = subprocess.run(["ps", "--ppid", str(pid), "-o", "pid="], capture_output=True, text=True, check=False)
    return [int(line) for line in listed.stdout.split()]


def are_gone(pids: list[int]) -> bool:
    listed = subprocess.run(
        ["ps", "-o", "pid=", "-p", ",".join(map(str, pids))], capture_output=True, text=True, check=False
    )
    return not listed.stdout.split()


@pytest.fixture
def _no_nohup() -> Iterator[None]:
    """What is started hangs up when asked to: under nohup it would inherit, and rightly respect, that it must not."""
    kept = signal.signal(signal.SIGHUP, signal.SIG_DFL)
    yield
    signal.signal(signal.SIGHUP, kept)


def looked_after(watched: StationProcess) -> int:
    """A turn of the launcher."""
    watched.look()
    return watched.look_after()


def starts(watched: StationProcess, count: int) -> list[float]:
    """Look after the part until it has been started so many times; when that was."""
    seen: dict[int, float] = {}
    while len(seen) < count:
        assert looked_after(watched) == 0
        if watched.process is not None and watched.process.pid is not None:
            seen.setdefault(watched.process.pid, time.monotonic())
        time.sleep(0.01)
    return list(seen.values())


def test_what_dies_is_started_again_ever_later() -> None:
    dying = part("raise SystemExit(3)")
    dying.spawn()
    first, second, third = starts(dying, 3)
    assert 0.5 < second - first < third - second
    dying.end()


def test_what_makes_room_for_another_model_is_followed_at_once() -> None:
    leaving = part(f"raise SystemExit({DEPLOYED})")
    leaving.spawn()
    first, second = starts(leaving, 2)
    assert second - first < parts.FIRST_PAUSE
    leaving.end()


def test_what_had_recovered_is_started_again_soon(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parts, "STEADY", 0.0)
    dying = part("raise SystemExit(3)")
    dying.spawn()
    began = time.monotonic()
    starts(dying, 4)
    assert time.monotonic() - began < patience(3 * 0.5 + 2)
    dying.end()


def test_what_has_lived_for_some_time_is_followed_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parts, "BRIEF", 0.0)
    dying = part("raise SystemExit(3)")
    dying.spawn()
    first, second, third = starts(dying, 3)
    assert second - first < parts.FIRST_PAUSE
    assert third - second < parts.FIRST_PAUSE
    dying.end()


def test_a_part_ends_when_it_is_hung_up() -> None:
    waiting = part("import sys; raise SystemExit(len(sys.stdin.read()))")
    waiting.spawn()
    process = waiting.process
    assert process is not None
    waiting.hang_up()
    assert process.wait(20) == 0
    waiting.end()


def test_what_cannot_run_as_asked_is_given_up_at_first_but_not_once_it_ran() -> None:
    """A port that somebody took while the server was down must not stop the production of the others."""
    program = f"import time; time.sleep(0.1); raise SystemExit({UNUSABLE})"
    refusing = part(program)
    refusing.spawn()
    until(lambda: looked_after(refusing) == UNUSABLE)
    refusing.end()
    running = part(program)
    running.spawn()
    assert running.process is not None
    running.process.kill()
    starts(running, 3)
    running.end()


def test_what_does_not_end_in_good_order_is_killed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parts, "PATIENCE", 0.2)
    stubborn = part(
        "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); print(1, flush=True); time.sleep(60)"
    )
    stubborn.spawn()
    process = stubborn.process
    assert process is not None
    time.sleep(0.5)
    process.terminate()
    stubborn.end()
    assert process.returncode == -signal.SIGKILL


PARTS = {"emulate", "controller", "server"}


def begun(launcher: int) -> set[str]:
    """Those of them that there are."""
    there = descendants(launcher)
    return {name for name in PARTS if any(each.runs(name) for each in there)}


@pytest.mark.usefixtures("_no_nohup")
@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGHUP, signal.SIGKILL])
@pytest.mark.parametrize("after", [0.0, 1.0])
def test_nothing_outlives_the_launcher(how: signal.Signals, after: float, short_path: Path) -> None:
    """However it ends, and however early."""
    with (
        (short_path / "log").open("wb") as log,
        subprocess.Popen(
            command("run", str(MODEL), "--port", str(free_port()), "--emulator"),
            cwd=REPOSITORY,
            env={**environment(), "TMPDIR": str(short_path)},
            stdout=log,
            stderr=log,
        ) as running,
    ):
        try:
            # The fork server and the first part, or all of them.
            until(lambda: begun(running.pid) == PARTS if after else bool(begun(running.pid)))
            time.sleep(after)
            left = [each.number for each in descendants(running.pid)]
            running.send_signal(how)
            running.wait(20)
            until(lambda: are_gone(left))
        finally:
            running.kill()
    assert running.returncode == (-how if how is signal.SIGKILL else 0)
    until(lambda: [each.name for each in short_path.iterdir()] == ["log"])


def test_no_secret_of_the_environment_is_shown_by_the_system(tmp_path: Path) -> None:
    """What a process was started with can be read by whoever is the same user, as long as it lives."""
    database = f"sqlite:///{tmp_path}/station.sqlite"
    secrets = {CLIENT_SECRET: "of the client", PASSWORD: "of the database", DATABASE: database}
    provider = ("--oidc-issuer", "https://id.invalid", "--oidc-client", "station", "--oidc-others", "viewer")
    with (
        (tmp_path / "log").open("wb") as log,
        subprocess.Popen(
            command("run", str(MODEL), "--port", str(free_port()), "--emulator", *provider),
            cwd=REPOSITORY,
            env={**environment(), **secrets},
            stdout=log,
            stderr=log,
        ) as running,
    ):
        try:
            there = {"controller", "server", "emulate"}
            until(lambda: all(any(each.runs(name) for each in descendants(running.pid)) for name in there))
            for each in descendants(running.pid):
                shown = (Path("/proc") / str(each.number) / "environ").read_text(errors="replace")
                assert not [secret for secret in secrets.values() if secret in shown], each.title
        finally:
            running.terminate()


def test_a_part_has_the_secrets_that_it_needs_and_no_others(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    names = {CLIENT_SECRET, PASSWORD, DATABASE}
    for name in names:
        monkeypatch.setenv(name, f"of {name}")
    file = tmp_path / "environment"
    program = [sys.executable, "-c", f"import os; open({str(file)!r}, 'w').write(repr(dict(os.environ)))"]
    for given, wanted in ((None, set[str]()), (with_secrets(PASSWORD), {PASSWORD})):
        telling = StationProcess("part", Executed(program), given)
        telling.spawn()
        telling.end()
        assert {name for name in names if f"of {name}" in file.read_text()} == wanted


def test_beside_real_devices_nothing_is_emulated_and_nothing_starts_by_itself(tmp_path: Path) -> None:
    """The emulator refuses, and with it the demonstration: the real devices must not be set going."""
    heard: list[str] = []

    async def beside() -> subprocess.CompletedProcess[str]:
        async with foreign_node() as (transport, registry):
            state, type_name = "/ur10/state", "truck_engine_msgs/msg/RobotState"
            transport.advertise(state, type_name, QualityOfService.RELIABLE)
            transport.subscribe(
                "/ur10/command",
                "truck_engine_msgs/msg/RobotCommand",
                QualityOfService.RELIABLE,
                lambda batch: heard.extend(sample.topic for sample in batch),
            )

            async def report() -> None:
                while True:
                    transport.publish(state, type_name, registry.encode(type_name, {}))
                    await asyncio.sleep(0.05)

            reporting = asyncio.create_task(report())
            arguments = ("run", str(MODEL), "--port", str(free_port()), "--emulator", "--start")
            ended = await asyncio.to_thread(finished, *arguments)
            reporting.cancel()
            return ended

    ended = asyncio.run(beside())
    assert ended.returncode == UNUSABLE
    assert "the emulated devices would fight with it" in ended.stderr
    assert heard == []


def test_what_is_killed_is_followed_soon_while_the_others_go_on(tmp_path: Path) -> None:
    with station(tmp_path, "--emulator", "--start", "--emulator-speed", "5") as running:
        running.work_on(1)
        killed = running.child("server")
        os.kill(killed, signal.SIGKILL)
        until(lambda: killed not in running.children("server"))  # another may answer sooner than anybody looks
        until(running.up)
        assert running.get("production", "station") == "started"
        running.work_on(1)
        killed = running.child("controller")
        os.kill(killed, signal.SIGKILL)
        until(lambda: running.production() == "waiting")
        assert running.child("controller") != killed


def test_a_station_whose_fork_server_dies_goes_on_and_gets_another(tmp_path: Path) -> None:
    with station(tmp_path, "--emulator", "--start", "--emulator-speed", "5") as running:
        running.work_on(1)
        (before,) = fork_servers(running)
        server = running.child("server")
        os.kill(before, signal.SIGKILL)
        os.kill(server, signal.SIGKILL)
        until(lambda: server not in running.children("server"))
        until(running.up)
        assert running.get("production", "station") == "started"
        running.work_on(1)
        until(lambda: fork_servers(running) not in ([], [before]))


def fork_servers(station: RunningStation) -> list[int]:
    """The numbers of its processes from which others are forked."""
    return [each.number for each in descendants(station.process.pid) if "fork server" in each.title]
