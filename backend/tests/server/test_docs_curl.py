"""What the documentation does with curl is done, at a server whose station is a demonstration."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest

from sequence_planner.auth.roles import Role
from sequence_planner.controller.commands.execution import ClearOverride, SetMode, SetOverride, TakeControl
from sequence_planner.controller.commands.tasks import AcknowledgeTask
from sequence_planner.server.settings import Settings
from support.example_view import example_view
from support.places import REPOSITORY
from support.server import Controller, Server
from support.waiting import until

TASK = example_view().tasks["7"].model_copy(update={"revision": 1})

pytestmark = pytest.mark.skipif(shutil.which("curl") is None, reason="there is no curl here")


@pytest.fixture
def settings(settings: Settings) -> Settings:
    return replace(settings, demonstration=True)


# What does not ask for `--fail` itself shows the problem and fails too.
CURL = """curl() {
  [[ " $* " == *" --fail "* ]] || set -- --fail-with-body "$@"
  command curl --silent --show-error "$@"
}
"""


def snippet(page: str, part: str) -> str:
    """The lines of `page` to be typed into a shell in which `part` is."""
    text = (REPOSITORY / page).read_text(encoding="utf-8")
    [found] = [each for each in re.findall(r"^```sh\n(.*?)^```$", text, re.MULTILINE | re.DOTALL) if part in each]
    return str(found)


def typed(lines: str, folder: Path, seconds: float = 30, /, **environment: str) -> str:
    """What is printed when all of `lines` are typed; every request must be granted but those that are waited for."""
    done = subprocess.run(
        ["bash", "-e", "-c", CURL + lines],
        cwd=folder,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=seconds,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def signing_in(server: Server) -> str:
    """The README's lines that sign in, at `server`."""
    lines = snippet("README.md", "session/demonstration").replace("http://127.0.0.1:8000", server.address)
    return "".join(lines.partition("demonstration\n")[:2])


def test_what_the_readme_types_reads_the_tasks_acknowledges_one_and_pauses(
    server: Server, controller: Controller, tmp_path: Path
) -> None:
    controller.show(example_view(tasks={"7": TASK}))
    until(lambda: server.app.state.controller.view.tasks["7"].revision == TASK.revision)
    lines = snippet("README.md", "session/demonstration").replace("http://127.0.0.1:8000", server.address)
    printed = typed(lines.replace("<id>/", "7/"), tmp_path)
    assert '"kind":"demonstration"' in printed
    assert '"revision":1' in printed
    assert [type(each) for each in controller.commands] == [AcknowledgeTask, SetMode, TakeControl, SetMode]


def test_what_the_page_about_pipelines_types_sets_and_clears_an_override(
    server: Server, controller: Controller, tmp_path: Path
) -> None:
    typed(signing_in(server) + snippet("docs/pipelines.md", "overrides/robot.speed"), tmp_path)
    assert [type(each) for each in controller.commands] == [TakeControl, SetOverride, ClearOverride]
    assert controller.commands[1].reason == "somebody is near"


def test_what_the_page_about_access_types_reads_the_station_with_a_key(server: Server, tmp_path: Path) -> None:
    with server.client(Role.ADMINISTRATOR) as administrator:
        body = {"name": "dashboard", "scopes": ["read"], "days": 30}
        secret = administrator.post("/api/v1/api-keys", json=body).json()["secret"]
    lines = snippet("docs/access.md", "STATION_KEY").replace("https://station.example", server.address)
    assert '"mode":"automatic"' in typed(lines, tmp_path, STATION_KEY=secret)
