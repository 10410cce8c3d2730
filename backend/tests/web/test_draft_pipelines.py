"""The pipelines of the draft over REST: seen, tried and run as they are edited, without touching what runs."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from sequence_planner.identity.roles import Role
from sequence_planner.web.settings import Settings
from workshop.models import BOLTS

from .running import Loop, Server, free_port
from .test_acting import problem
from .test_model import change, made, read

PIPELINES = "/api/v1/model/pipelines"
ROBOT = "resources/robot.yaml"
STATE, COMMAND = "/ur10/state", "/ur10/command"
STAGES = ["topics", STATE, "pipeline"]
PATIENCE = 60.0


@pytest.fixture
def model(tmp_path: Path) -> Path:
    return shutil.copytree(BOLTS, tmp_path / "model")


@pytest.fixture
def server(loop: Loop, settings: Settings, model: Path) -> Iterator[Server]:
    server = Server(
        loop,
        Settings(**{**vars(settings), "model": model, "port": free_port()}),  # the controller is not there
    )
    server.start()
    yield server
    server.stop()


@pytest.fixture
def eva(server: Server) -> Iterator[httpx.Client]:
    with server.client(Role.ENGINEER) as client:
        client.timeout = httpx.Timeout(PATIENCE)
        yield client


def graph(client: httpx.Client) -> dict[str, Any]:
    return read(client, "/pipelines")


def asked(client: httpx.Client, what: str, **body: object) -> dict[str, Any]:
    answer = client.post(f"{PIPELINES}/{what}", json=body)
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def kinds(pipeline: dict[str, Any]) -> list[str]:
    return [stage["kind"] for stage in pipeline["stages"]]


def test_sample(eva: httpx.Client) -> None:
    import json

    found = graph(eva)
    Path("/check/bolt-sample.json").write_text(json.dumps(found, indent=1))
