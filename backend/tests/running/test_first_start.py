"""The first start, at a terminal and as a service: how the first administrator gets in, and nobody else."""

from __future__ import annotations

import os
import pty
import re
import signal
import ssl
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import pytest

from support.certificates import Certified, certify
from support.network import free_port
from support.places import REPOSITORY
from support.station import MODEL, command, environment, process
from support.waiting import until

NAME = "station.example"
LINK = re.compile(r"https://station\.example:(\d+)/setup#([\w-]+)")


@contextmanager
def at_a_terminal(errors: Path, *arguments: str) -> Iterator[int]:
    """A process whose standard output is a terminal, to be read there; what it logs is in the file `errors`."""
    terminal, its_end = pty.openpty()
    with errors.open("wb") as log:
        running = subprocess.Popen(
            command(*arguments), cwd=REPOSITORY, env=environment(), stdout=its_end, stderr=log, start_new_session=True
        )
    os.close(its_end)
    try:
        yield terminal
    finally:
        running.send_signal(signal.SIGTERM)
        running.wait(timeout=20)
        os.close(terminal)


def shown(terminal: int, wanted: re.Pattern[str]) -> str:
    """All that is shown until `wanted` is."""
    text = ""

    def there() -> bool:
        nonlocal text
        text += os.read(terminal, 4096).decode()
        return wanted.search(text) is not None

    until(there)
    return text


def command_lines() -> str:
    """What anybody on this machine sees of its processes."""
    return subprocess.run(["ps", "-eww", "-o", "args="], capture_output=True, text=True, check=True).stdout


def browser(made: Certified, port: int) -> httpx.Client:
    """A browser that trusts the certificate, and knows by itself where the name is."""
    trusting = ssl.create_default_context(cafile=made.authority)
    trusting.check_hostname = False  # it connects to an address
    headers = {"Host": f"{NAME}:{port}"}
    return httpx.Client(base_url=f"https://127.0.0.1:{port}/api/v1/", verify=trusting, headers=headers)


def test_the_link_is_for_the_terminal_alone_and_works_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made, port = certify(tmp_path / "certificate", NAME), free_port()
    url = f"sqlite:///{tmp_path / 'kept' / 'station.sqlite'}"
    monkeypatch.setenv("SEQUENCE_PLANNER_DATABASE", url)
    serving = ("--certificate", str(made.certificate), "--private-key", str(made.private_key), "--name", NAME)
    arguments = ("run", str(MODEL), "--port", str(port), "--host", "0.0.0.0", *serving)
    errors, log = tmp_path / "errors", tmp_path / "log"
    with at_a_terminal(errors, *arguments) as terminal:
        text = shown(terminal, re.compile(r"setup#[\w-]+\s"))
        assert f"open https://{NAME}:{port} " in text
        [(at, token)] = LINK.findall(text)
        assert at == str(port)
        assert token not in command_lines()
        assert url not in command_lines()
        with browser(made, port) as opened:
            body = {"token": token, "name": "Ada", "password": "a long enough one"}
            first = opened.post("setup", json=body)
            assert first.status_code == 201
            assert first.headers["set-cookie"].startswith("__Host-sequence-planner=")
            again = opened.post("setup", json=body | {"name": "Eve"})
            assert (again.status_code, again.json()["type"]) == (403, "/problems/setup-link-invalid")
    assert token not in errors.read_text()
    with process(log, *arguments):
        until(lambda: "runs: open" in log.read_text())
    assert "first administrator" not in log.read_text()


def test_where_there_is_no_terminal_it_is_only_said_how_to_get_the_link(tmp_path: Path) -> None:
    log, port, url = tmp_path / "log", free_port(), f"sqlite:///{tmp_path / 'station.sqlite'}"
    with process(log, "run", str(MODEL), "--port", str(port), "--database", url):
        until(lambda: "users setup-link" in log.read_text())
    text = log.read_text()
    how = f"`sequence-planner users setup-link {MODEL} --url http://127.0.0.1:{port}`"
    assert f"{how} prints the link for the first administrator" in text
    assert "/setup" not in text


def test_a_demonstration_is_forgotten(short_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """And it asks for no administrator."""
    log, port = short_path / "log", free_port()
    monkeypatch.setenv("TMPDIR", str(short_path))
    with (
        process(log, "run", str(MODEL), "--port", str(port), "--emulator", "--demonstration") as running,
        httpx.Client(base_url=f"http://127.0.0.1:{port}/api/v1/") as opened,
    ):

        def is_open() -> bool:
            assert running.poll() is None, log.read_text()
            try:
                return opened.post("session/demonstration", json={}).status_code == httpx.codes.OK
            except httpx.HTTPError:
                return False

        until(is_open)
        assert opened.get("session").json()["kind"] == "demonstration"
        assert [*short_path.glob("*/demonstration.sqlite")]
    assert [*short_path.iterdir()] == [log]
    assert "administrator" not in log.read_text()
