"""The launcher: what dies is started again, what cannot run says so, and nothing outlives it."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from running.stations import MODEL, REPOSITORY, command, environment, finished, foreign_node, free_port, station
from sequence_planner import launcher
from sequence_planner.launcher import UNUSABLE, Part
from sequence_planner.lifeline import DEPLOYED
from sequence_planner.ros.transport import QualityOfService
from sequence_planner.secret_variables import CLIENT_SECRET, PASSWORD
from sequence_planner.storage.environment import DATABASE


def part(program: str) -> Part:
    return Part("part", [sys.executable, "-c", program])


def eventually(what: Callable[[], bool], seconds: float = 20) -> None:
    end = time.monotonic() + seconds
    while not what():
        assert time.monotonic() < end, "it did not come true in time"
        time.sleep(0.02)


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


def looked_after(watched: Part) -> int:
    """A turn of the launcher."""
    watched.look()
    return watched.look_after()


def starts(watched: Part, count: int) -> list[float]:
    """Look after the part until it has been started so many times; when that was."""
    seen: dict[int, float] = {}
    while len(seen) < count:
        assert looked_after(watched) == 0
        if watched.process is not None:
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
    assert second - first < launcher.FIRST_PAUSE
    leaving.end()


def test_what_had_recovered_is_started_again_soon(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(launcher, "STEADY", 0.0)
    dying = part("raise SystemExit(3)")
    dying.spawn()
    began = time.monotonic()
    starts(dying, 4)
    assert time.monotonic() - began < 3 * 0.5 + 2
    dying.end()


WAITING = """
import os, sys, time
from sequence_planner.lifeline import is_needed
if "--spare" in sys.argv and not is_needed():
    raise SystemExit(0)
time.sleep(60)
"""


def spared(monkeypatch: pytest.MonkeyPatch) -> tuple[Part, int, int]:
    """A part with a spare, and the numbers of both processes."""
    monkeypatch.setattr(launcher, "SPARE_AFTER", 0.0)
    watched = Part("part", [sys.executable, "-c", WAITING], has_spare=True)
    watched.spawn()
    return watched, *pair(watched)


def pair(watched: Part) -> tuple[int, int]:
    """The process of a part and its spare, as soon as it has one."""
    eventually(lambda: looked_after(watched) == 0 and watched.spare is not None)
    assert watched.process is not None
    assert watched.spare is not None
    return watched.process.pid, watched.spare.pid


def end(watched: Part) -> None:
    watched.terminate()
    watched.end()


def test_a_spare_follows_at_once_and_has_a_spare_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    watched, alive, spare = spared(monkeypatch)
    for _ in range(3):
        os.kill(alive, signal.SIGKILL)
        killed, before = time.monotonic(), spare
        while (now := pair(watched))[0] == alive:
            assert time.monotonic() < killed + 0.4, "it takes as long as to start another"
        alive, spare = now
        assert alive == before
    end(watched)
    assert are_gone([alive, spare])


def test_a_spare_that_has_died_too_does_no_harm(monkeypatch: pytest.MonkeyPatch) -> None:
    watched, alive, spare = spared(monkeypatch)
    for each in (spare, alive):
        os.kill(each, signal.SIGKILL)

    def goes_on() -> bool:
        assert looked_after(watched) == 0
        return watched.process is not None and watched.process.pid not in (alive, spare)

    eventually(goes_on)
    end(watched)


def test_a_spare_ends_with_its_launcher(monkeypatch: pytest.MonkeyPatch) -> None:
    watched, _, number = spared(monkeypatch)
    spare = watched.spare
    assert spare is not None
    assert spare.stdin is not None
    spare.stdin.close()  # as the end of the launcher does
    assert spare.wait(20) == 0
    end(watched)
    assert are_gone([number])


def test_what_cannot_run_as_asked_is_given_up_at_first_but_not_once_it_ran() -> None:
    """A port that somebody took while the server was down must not stop the production of the others."""
    program = f"import time; time.sleep(0.1); raise SystemExit({UNUSABLE})"
    refusing = part(program)
    refusing.spawn()
    eventually(lambda: looked_after(refusing) == UNUSABLE)
    refusing.end()
    running = part(program)
    running.spawn()
    assert running.process is not None
    running.process.kill()
    starts(running, 3)
    running.end()


def test_what_does_not_end_in_good_order_is_killed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(launcher, "PATIENCE", 0.2)
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
            eventually(lambda: len(children(running.pid)) == 3)
            parts = children(running.pid)
            time.sleep(after)
            grandchildren = [each for pid in parts for each in children(pid)]
            running.send_signal(how)
            running.wait(20)
            eventually(lambda: are_gone([*parts, *grandchildren]))
        finally:
            running.kill()
    assert running.returncode == (-how if how is signal.SIGKILL else 0)
    assert [each.name for each in short_path.iterdir()] == ["log"]


def test_secrets_of_the_environment_are_for_the_parts_that_need_them(tmp_path: Path) -> None:
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
            for name, needed in (
                ("controller", {PASSWORD, DATABASE}),
                ("server", {CLIENT_SECRET, PASSWORD, DATABASE}),
                ("emulate", set[str]()),
            ):
                assert secrets.keys() & its_environment(running.pid, name).keys() == needed, name
        finally:
            running.terminate()


def its_environment(launcher: int, name: str) -> dict[str, str]:
    """What the part that runs the command `name` was started with."""
    found: list[Path] = []

    def is_there() -> bool:
        folders = [Path("/proc") / str(pid) for pid in children(launcher)]
        found[:] = [each for each in folders if name.encode() in (each / "cmdline").read_bytes().split(b"\0")]
        return bool(found)

    eventually(is_there)
    lines = (found[0] / "environ").read_text().split("\0")
    return dict(line.split("=", 1) for line in lines if "=" in line)


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


def test_the_server_is_started_again_while_production_goes_on_and_the_controller_has_a_spare(tmp_path: Path) -> None:
    with station(tmp_path, "--emulator", "--start", "--emulator-speed", "5") as running:
        running.work_on(1)
        killed = running.child("server")
        os.kill(killed, signal.SIGKILL)
        eventually(lambda: killed not in running.children("server"))  # a spare may answer sooner than anybody looks
        eventually(running.up)
        assert running.get("production", "station") == "started"
        running.work_on(1)
        eventually(lambda: len(running.children("controller")) == 2)
        alive, spare = running.children("controller")
        os.kill(alive, signal.SIGKILL)
        eventually(lambda: running.production() == "waiting")
        assert running.child("controller") == spare
