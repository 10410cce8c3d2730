"""Pictures and videos of instructions over HTTP: for whoever may look, and running nothing."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import httpx
import pytest

from sequence_planner.auth.roles import Role
from sequence_planner.controller.views.station import VariableView
from sequence_planner.model.files import LARGEST_PICTURE
from sequence_planner.server.services.instructions import with_state
from sequence_planner.server.settings import Settings
from support.network import free_port
from support.places import BOLT_TIGHTENING
from support.server import Controller, Loop, Server
from support.waiting import until

from .test_acting import problem
from .watching import FOREIGN, OWN, Device, active, station

PNG = b"\x89PNG\r\n\x1a\n" + bytes(20_000)
ADDRESS = "/api/v1/instructions"


@pytest.fixture
def model(tmp_path: Path) -> Path:
    folder = shutil.copytree(BOLT_TIGHTENING, tmp_path / "model")
    (folder / "instructions" / "a.png").write_bytes(PNG)
    (folder / "instructions" / "a.mp4").write_bytes(b"\0\0\0\x18ftypmp42" + bytes(50_000))
    (folder / "instructions" / "large.png").write_bytes(PNG + bytes(LARGEST_PICTURE))
    (folder / "instructions" / "note.txt").write_text("no picture")
    return folder


@pytest.fixture
def server(loop: Loop, settings: Settings, model: Path, controller: Controller) -> Iterator[Server]:
    server = Server(loop, Settings(**{**vars(settings), "model": model, "port": free_port()}))
    server.start()
    server.hear_controller()
    yield server
    server.stop()


@pytest.fixture
def viewer(server: Server) -> Iterator[httpx.Client]:
    with server.client(Role.VIEWER) as client:
        yield client


@pytest.mark.parametrize(
    ("name", "type_"), [("a.png", "image/png"), ("a.mp4", "video/mp4"), ("place_bolts.svg", "image/svg+xml")]
)
def test_it_is_what_lies_in_the_folder(viewer: httpx.Client, model: Path, name: str, type_: str) -> None:
    answer = viewer.get(f"{ADDRESS}/{name}")
    assert answer.status_code == 200
    assert answer.content == (model / "instructions" / name).read_bytes()
    assert answer.headers["Content-Type"].partition(";")[0] == type_


def test_a_drawing_has_the_state_of_what_its_parts_are_called_like() -> None:
    svg = '<svg><g id="pair_1"/><g class="a" id="pair_2"/><g id="pair_3"/><g id="door"/></svg>'
    values = {"engine.bolts[pair_1]": "tightened", "bolts[pair_2]": 'a"<', "bolts[pair_3]": None, "shut[door]": True}
    variables = {name: cast(VariableView, SimpleNamespace(value=value)) for name, value in values.items()}
    assert with_state(svg, variables) == (
        '<svg><g id="pair_1" data-bolts="tightened"/><g class="a" id="pair_2" data-bolts=\'a"&lt;\'/><g id="pair_3"/>'
        '<g id="door" data-shut="true"/></svg>'
    )


def test_with_a_state_a_drawing_is_another_and_pictures_are_not(viewer: httpx.Client) -> None:
    plain, drawn = (viewer.get(f"{ADDRESS}/place_bolts.svg{asked}") for asked in ("", "?state=a1"))
    assert drawn.status_code == 200
    assert drawn.headers["Content-Type"].partition(";")[0] == "image/svg+xml"
    assert drawn.headers["Content-Security-Policy"] == plain.headers["Content-Security-Policy"]
    assert drawn.headers["ETag"] != plain.headers["ETag"]
    assert viewer.get(f"{ADDRESS}/a.png?state=a1").content == PNG


def test_what_is_opened_by_itself_runs_nothing(viewer: httpx.Client) -> None:
    headers = viewer.get(f"{ADDRESS}/place_bolts.svg").headers
    policy = headers["Content-Security-Policy"].split("; ")
    assert {"default-src 'none'", "sandbox"} <= set(policy)
    assert not any(each.startswith("script-src") for each in policy)
    assert headers["X-Content-Type-Options"] == "nosniff"


def test_what_a_browser_has_is_not_sent_again_until_it_is_another(viewer: httpx.Client, model: Path) -> None:
    first = viewer.get(f"{ADDRESS}/a.png")
    assert first.headers["Cache-Control"] == "private, no-cache"
    again = viewer.get(f"{ADDRESS}/a.png", headers={"If-None-Match": first.headers["ETag"]})
    assert (again.status_code, again.content) == (304, b"")
    (model / "instructions" / "a.png").write_bytes(PNG + b"another")
    other = viewer.get(f"{ADDRESS}/a.png", headers={"If-None-Match": first.headers["ETag"]})
    assert other.status_code == 200
    assert other.content.endswith(b"another")


def test_a_part_of_a_video_can_be_asked_for(viewer: httpx.Client, model: Path) -> None:
    """As players do."""
    answer = viewer.get(f"{ADDRESS}/a.mp4", headers={"Range": "bytes=4-11"})
    assert (answer.status_code, answer.content) == (206, b"ftypmp42")
    size = (model / "instructions" / "a.mp4").stat().st_size
    assert answer.headers["Content-Range"] == f"bytes 4-11/{size}"
    assert viewer.get(f"{ADDRESS}/a.mp4", headers={"Range": "bytes=99999999-"}).status_code == 416


@pytest.mark.parametrize("name", ["b.png", "large.png", "note.txt", "a.PNG", ".a.png", "x" * 150 + ".png"])
def test_nothing_else_is_shown(viewer: httpx.Client, name: str) -> None:
    problem(viewer.get(f"{ADDRESS}/{name}"), 404, "no-such-instruction")


@pytest.mark.parametrize("name", ["..%2Fstation.yaml", "../station.yaml", "%00.png", "a.png%00", ""])
def test_no_name_leads_out_of_the_folder(viewer: httpx.Client, name: str) -> None:
    assert viewer.get(f"{ADDRESS}/{name}").status_code == 404


def test_a_watch_reads_the_pictures_of_its_own_tasks_alone(
    client: httpx.Client, device: Device, server: Server, controller: Controller
) -> None:
    active(client, device)
    shown = station()
    foreign, instruction = shown.tasks[FOREIGN], shown.tasks[OWN].instruction
    assert instruction is not None
    other = foreign.model_copy(update={"instruction": instruction.model_copy(update={"image": "instructions/a.png"})})
    controller.show(station(tasks={OWN: shown.tasks[OWN], FOREIGN: other}))
    until(lambda: server.app.state.controller.view.tasks[FOREIGN] == other)
    assert device.get(f"{ADDRESS}/place_bolts.svg").status_code == 200
    problem(device.get(f"{ADDRESS}/a.png"), 404, "no-such-instruction")
    assert client.get(f"{ADDRESS}/a.png").status_code == 200


def test_nobody_reads_it_without_an_account(server: Server) -> None:
    with httpx.Client(base_url=server.address) as stranger:
        assert stranger.get(f"{ADDRESS}/a.png").status_code == 401
