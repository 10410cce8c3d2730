"""Starting and stopping the server as a process, and what it refuses to start with."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

import httpx
import pytest
from websockets.sync.client import connect

from sequence_planner.web.settings import SettingsError, bind, check_host, check_port

from .running import free_port, until

PROGRAM = """
import sys
from pathlib import Path
from sequence_planner.web.server import serve
from sequence_planner.web.settings import Settings
serve(Settings(controller_socket=Path(sys.argv[1]), page=Path(sys.argv[1]), host=sys.argv[2], port=int(sys.argv[3])))
"""


def start(folder: Path, host: str, port: int) -> subprocess.Popen[str]:
    command = [sys.executable, "-c", PROGRAM, str(folder / "controller.sock"), host, str(port)]
    return subprocess.Popen(command, stderr=subprocess.PIPE, text=True)


def test_it_serves_until_it_is_told_to_stop(tmp_path: Path) -> None:
    port = free_port()

    def answers() -> bool:
        try:
            return httpx.get(f"http://localhost:{port}/healthz").status_code == 200
        except httpx.TransportError:
            return False

    with start(tmp_path, "localhost", port) as process:
        until(answers, 15)
        with connect(f"ws://127.0.0.1:{port}/api/v1/stream") as stream:
            assert "lost" in str(stream.recv(2))
            begun = time.monotonic()
            process.send_signal(signal.SIGTERM)
            process.wait(10)
        assert time.monotonic() - begun < 5
        assert process.stderr is not None
        assert process.stderr.read() == ""


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "::1", "192.168.1.1", "", "station.example"])
def test_any_address_but_the_loopback_is_refused(tmp_path: Path, host: str) -> None:
    with pytest.raises(SettingsError, match="until there is sign-in, only"):
        check_host(host)
    with pytest.raises(SettingsError):
        bind(host, free_port())


def test_a_refused_host_is_said_and_exits_with_2(tmp_path: Path) -> None:
    with start(tmp_path, "0.0.0.0", free_port()) as process:
        assert process.wait(15) == 2
        assert process.stderr is not None
        message = process.stderr.read()
        assert "cannot serve on 0.0.0.0" in message
        assert "Traceback" not in message


def test_a_taken_port_is_said_and_exits_with_2(tmp_path: Path) -> None:
    port = free_port()
    with bind("127.0.0.1", port), start(tmp_path, "127.0.0.1", port) as process:
        assert process.wait(15) == 2
        assert process.stderr is not None
        assert process.stderr.read() == f"port {port} is taken; use --port\n"


def test_a_port_can_be_asked_for_before_anything_starts() -> None:
    port = free_port()
    check_port("127.0.0.1", port)
    with bind("127.0.0.1", port), pytest.raises(SettingsError, match=f"port {port} is taken; use --port"):
        check_port("127.0.0.1", port)
    for wrong in (0, -1, 65536):
        with pytest.raises(SettingsError, match="is not a port"):
            check_port("127.0.0.1", wrong)
