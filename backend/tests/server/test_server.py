"""Starting and stopping the server as a process, and what it refuses to start with."""

from __future__ import annotations

import contextlib
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from websockets.sync.client import connect

from sequence_planner.auth import users
from sequence_planner.auth.roles import Role
from sequence_planner.auth.sessions import open_session
from sequence_planner.core.actor import SYSTEM, ActorKind
from sequence_planner.db.database import Database
from sequence_planner.server.binding import bind, check_endpoint
from sequence_planner.server.settings import Endpoint, SettingsError
from support.network import free_port
from support.waiting import patience, until

PROGRAM = """
import sys
from pathlib import Path
from sequence_planner.server.server import serve
from sequence_planner.server.settings import Settings
socket = Path(sys.argv[1])
database = f"sqlite:///{socket.parent / 'station.sqlite'}"
serve(Settings(controller_socket=socket, page=socket, database=database, host=sys.argv[2], port=int(sys.argv[3])))
"""


@contextlib.contextmanager
def started(folder: Path, host: str, port: int) -> Iterator[subprocess.Popen[str]]:
    """A server; nothing is left of it whatever comes of the test."""
    command = [sys.executable, "-c", PROGRAM, str(folder / "controller.sock"), host, str(port)]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        try:
            yield process
        finally:
            process.kill()


def viewer(folder: Path, port: int) -> dict[str, str]:
    """The header of somebody who is signed in and may look on."""
    url = f"sqlite:///{folder / 'station.sqlite'}"
    with contextlib.closing(Database.open(url)) as database, database.writing() as connection:
        person = users.create(connection, "Vera", Role.VIEWER, "none", SYSTEM, time.time(), temporary=False)
        kind = ActorKind.PERSON
        token, _ = open_session(connection, person, time.time(), kind=kind, address="127.0.0.1", agent="")
    return {"Cookie": f"sequence-planner-{port}={token}"}


def test_it_serves_until_it_is_told_to_stop(tmp_path: Path) -> None:
    port = free_port()

    def answers() -> bool:
        try:
            return "lost" in httpx.get(f"http://localhost:{port}/healthz").text
        except httpx.TransportError:
            return False

    with started(tmp_path, "localhost", port) as process:
        until(answers, seconds=15)
        with connect(f"ws://127.0.0.1:{port}/api/v1/stream", additional_headers=viewer(tmp_path, port)) as stream:
            assert "lost" in str(stream.recv(patience(2)))
            begun = time.monotonic()
            process.send_signal(signal.SIGTERM)
            process.wait(10)
        assert time.monotonic() - begun < patience(5)
        assert process.stderr is not None
        assert process.stderr.read() == ""


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.1", "::ffff:192.168.1.1", "fe80::1"])
def test_beyond_the_loopback_plain_http_is_refused(host: str) -> None:
    with pytest.raises(SettingsError, match="without HTTPS: give --certificate and --private-key, or the --proxy"):
        bind(Endpoint(host=host, port=free_port()))


@pytest.mark.parametrize("host", ["", "station.example", "127.0.0.1:8000", "http://127.0.0.1", "127.1", "256.0.0.1"])
def test_what_is_no_address_is_refused(host: str) -> None:
    with pytest.raises(SettingsError, match="is no address; use --host"):
        check_endpoint(Endpoint(host=host))


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "LOCALHOST", "::1", "127.0.0.2", "::ffff:127.0.0.1"])
def test_every_address_of_the_loopback_is_served(host: str) -> None:
    endpoint = Endpoint(host=host, port=free_port())
    with bind(endpoint) as listener:
        assert listener.getsockname()[1] == endpoint.port


def test_a_refused_host_is_said_and_exits_with_2(tmp_path: Path) -> None:
    with started(tmp_path, "0.0.0.0", free_port()) as process:
        assert process.wait(15) == 2
        assert process.stderr is not None
        message = process.stderr.read()
        assert "cannot serve on 0.0.0.0 without HTTPS" in message
        assert "Traceback" not in message


def test_a_taken_port_is_said_and_exits_with_2(tmp_path: Path) -> None:
    port = free_port()
    with bind(Endpoint(port=port)), started(tmp_path, "127.0.0.1", port) as process:
        assert process.wait(15) == 2
        assert process.stderr is not None
        assert process.stderr.read() == f"port {port} is taken; use --port\n"


def test_a_port_that_cannot_be_used_is_said_before_anything_starts() -> None:
    port = free_port()
    with bind(Endpoint(port=port)), pytest.raises(SettingsError, match=f"port {port} is taken; use --port"):
        bind(Endpoint(port=port))
    for wrong in (0, -1, 65536):
        with pytest.raises(SettingsError, match="is not a port"):
            bind(Endpoint(port=wrong))


def test_a_database_that_cannot_be_used_is_said_and_exits_with_2(tmp_path: Path) -> None:
    (tmp_path / "station.sqlite").write_text("no database, but somebody's notes")
    with started(tmp_path, "127.0.0.1", free_port()) as process:
        assert process.wait(15) == 2
        assert process.stderr is not None
        message = process.stderr.read()
        assert "station.sqlite" in message
        assert "Traceback" not in message
