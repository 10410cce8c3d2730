"""What the server's log tells of requests, and what it never tells: passwords, tokens and keys."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import httpx

from sequence_planner.auth.first_start import new_link_token
from sequence_planner.db.database import Database
from support.network import free_port
from support.waiting import until

PROGRAM = "from sequence_planner.core.logging import configure_logs\nconfigure_logs()\n"
SERVE = """
import sys
from pathlib import Path
from sequence_planner.server.server import serve
from sequence_planner.server.settings import Settings
folder = Path(sys.argv[1])
database = f"sqlite:///{folder / 'station.sqlite'}"
serve(Settings(controller_socket=folder / "controller.sock", page=folder, database=database, port=int(sys.argv[2])))
"""
PASSWORD, WRONG, NEW = "correct horse battery", "an unfit attempt 4711", "another staple 0815"


def test_no_secret_is_in_the_log(tmp_path: Path) -> None:
    url, port = f"sqlite:///{tmp_path / 'station.sqlite'}", free_port()
    with contextlib.closing(Database.open(url)) as database:
        database.upgrade()
        with database.writing() as connection:
            link = new_link_token(connection, time.time())
    command = [sys.executable, "-c", PROGRAM + SERVE, str(tmp_path), str(port)]
    environment = {**os.environ, "SEQUENCE_PLANNER_LOG_FORMAT": "json"}
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=environment) as process:
        try:
            secrets, numbers = _used(f"http://127.0.0.1:{port}", link)
            process.send_signal(signal.SIGTERM)
            _, log = process.communicate(timeout=20)
        finally:
            process.kill()
    events = [json.loads(line) for line in log.splitlines()]
    answered = [event for event in events if event["event"] == "answered"]
    assert [event["request"] for event in answered] == numbers
    assert [event["status"] for event in answered] == [201, 204, 401, 200, 200, 201, 503]
    assert {event["route"] for event in answered} >= {"/api/v1/session", "/api/v1/api-keys"}
    for name, secret in secrets.items():
        assert secret, name
        assert secret not in log, name


def _used(address: str, link: str) -> tuple[dict[str, str], list[str]]:
    """All the ways in which secrets come to the server; they, and the numbers of the requests that change something."""

    def is_there() -> bool:
        with contextlib.suppress(httpx.TransportError):
            return httpx.get(f"{address}/healthz").status_code == 503
        return False

    until(is_there, seconds=30)
    with httpx.Client(base_url=f"{address}/api/v1", timeout=20) as browser:
        began = {"token": link, "name": "Ada", "password": PASSWORD}
        answers = [browser.post("/setup", json=began)]
        cookie = next(iter(browser.cookies.values()))
        answers += [
            browser.request("DELETE", "/session"),
            browser.post("/session", json={"name": "Ada", "password": WRONG}),
            browser.post("/session", json={"name": "Ada", "password": PASSWORD}),
            browser.put("/session/password", json={"old": PASSWORD, "new": NEW}),
            browser.post("/api-keys", json={"name": "MES", "scopes": ["read"], "days": 1}),
        ]
        again, key = next(iter(browser.cookies.values())), answers[-1].json()["secret"]
        httpx.get(f"{address}/api/v1/state", headers={"Authorization": f"Bearer {key}"})
        answers.append(browser.put("/mode", json={"mode": "paused", "reason": PASSWORD}))
    secrets = {"link": link, "old": PASSWORD, "wrong": WRONG, "new": NEW, "first": cookie, "again": again, "key": key}
    return secrets, [answer.headers["x-request-id"] for answer in answers]
