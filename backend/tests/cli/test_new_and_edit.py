"""`new` writes a station to begin from, and `edit` changes one entry of one."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path
from shutil import copytree

import httpx
import pytest
from jsonschema import Draft202012Validator
from ruamel.yaml import YAML

from sequence_planner.model.files import read_files
from support.commands import as_json, command
from support.network import DOMAIN
from support.places import MODELS
from support.station import signed_in


@pytest.fixture(scope="module")
def new(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A station as `new` has written it."""
    folder = tmp_path_factory.mktemp("new") / "north gate"
    code, out, err = command("new", folder)
    assert (code, err) == (0, "")
    assert f"{folder}/resources/gate.yaml" in out.splitlines()
    return folder


@pytest.fixture
def gate(new: Path, tmp_path: Path) -> Path:
    """A station of the test's own."""
    return copytree(new, tmp_path / new.name)


def test_a_new_station_is_fine(gate: Path) -> None:
    code, document = as_json("check", gate)
    assert (code, document["findings"]) == (0, [])
    assert document["summary"]["guarded_abilities"] == ["gate.open_gate"]
    assert "\nname: north_gate\n" in (gate / "station.yaml").read_text(encoding="utf-8")


def test_its_scenarios_pass(gate: Path) -> None:
    code, document = as_json("test", gate)
    assert (code, len(document["scenarios"])) == (0, 2)
    assert document["not_exercised"] == {"abilities": [], "operations": []}


def test_its_files_name_schemas_that_they_satisfy(gate: Path) -> None:
    files = [*gate.glob("*.yaml"), *gate.glob("resources/*.yaml"), *gate.glob("tests/*.yaml")]
    assert len(files) == 5
    for file in files:
        first, _, text = file.read_text(encoding="utf-8").partition("\n")
        schema = file.parent / first.partition("$schema=")[2]
        content = YAML(typ="safe").load(text)
        Draft202012Validator(YAML(typ="safe").load(schema)).validate(content)


def test_what_was_written_for_programs(tmp_path: Path) -> None:
    code, document = as_json("new", tmp_path / "gate")
    assert code == 0
    assert document["folder"] == str(tmp_path / "gate")
    assert str(tmp_path / "gate" / "station.yaml") in document["files"]
    assert all(Path(file).is_file() for file in document["files"])


def test_an_empty_station_is_there_to_be_built(tmp_path: Path) -> None:
    folder = tmp_path / "single bolt"
    code, out, _ = command("new", folder, "--empty")
    assert code == 0
    assert f"sequence-planner run {folder} --emulator\n" in out
    assert (folder / "station.yaml").read_text(encoding="utf-8") == "name: single_bolt\n"
    assert [path.name for path in folder.iterdir() if not path.name.startswith(".")] == ["station.yaml"]
    code, document = as_json("check", folder)
    assert (code, document["findings"]) == (0, [])
    assert command("new", folder, "--empty")[0] == 2


@pytest.mark.parametrize("name", sorted(path.parent.name for path in MODELS.glob("*/station.yaml")))
def test_an_example_is_copied_under_the_name_of_the_folder(tmp_path: Path, name: str) -> None:
    folder = tmp_path / "north gate"
    code, out, err = command("new", folder, "--example", name)
    assert (code, err) == (0, "")
    assert f"{folder}/station.yaml" in out.splitlines()
    copied, example = read_files(folder), read_files(MODELS / name)
    assert copied.keys() == example.keys()
    assert "\nname: north_gate\n" in copied["station.yaml"]
    for path, text in copied.items():
        first, _, rest = text.partition("\n")
        if "$schema=" in first:  # an editor finds what it completes by
            assert ((folder / path).parent / first.partition("$schema=")[2]).is_file(), path
        if path != "station.yaml":
            assert rest == example[path].partition("\n")[2], path
    code, document = as_json("check", folder)
    assert [each for each in document["findings"] if each["severity"] == "error"] == []


def test_an_unknown_example_is_refused_with_those_that_there_are(tmp_path: Path) -> None:
    code, out, err = command("new", tmp_path / "gate", "--example", "nowhere")
    assert (code, out) == (2, "")
    assert "there is no example 'nowhere': take one of bolt_tightening, docking_agv" in err
    assert not (tmp_path / "gate").exists()
    assert command("new", tmp_path / "gate", "--example", "../models/single_bolt")[0] == 2
    assert command("new", tmp_path / "gate", "--example", "single_bolt", "--empty")[0] == 2


def test_nothing_is_overwritten(gate: Path) -> None:
    assert command("new", gate) == (2, "", f"{gate} is not empty: name a folder that is new or empty\n")
    assert command("new", gate / "station.yaml")[0] == 2


def test_a_new_station_runs(gate: Path) -> None:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        port = listener.getsockname()[1]
    program = [sys.executable, "-m", "sequence_planner.cli", "run", str(gate), "--emulator", "--start"]
    environment = {**os.environ, "ROS_DOMAIN_ID": str(DOMAIN)}
    with (gate / "log").open("wb") as log:
        running = subprocess.Popen([*program, "--port", str(port)], stdout=log, stderr=log, env=environment)
    try:
        assert _completed(signed_in(gate, port), time.monotonic() + 60), (gate / "log").read_text()
    finally:
        running.send_signal(signal.SIGTERM)
        assert running.wait(timeout=20) == 0


def _completed(browser: httpx.Client, end: float) -> bool:
    while time.monotonic() < end:
        try:
            operations = browser.get("operations").json()["operations"]
            if operations["let_through"]["completed"] == 1:
                return True
        except (httpx.HTTPError, KeyError):
            pass
        time.sleep(0.2)
    return False


def test_an_edit_keeps_comments_and_is_shown(gate: Path) -> None:
    file = gate / "resources" / "gate.yaml"
    before = file.read_text(encoding="utf-8")
    code, out, err = command("edit", gate, "resources/gate.yaml", "abilities.open_gate.timeouts.finish", "12")
    assert (code, err) == (0, "")
    changed = [line for line in out.splitlines() if line[0] in "+-" and line[:3] not in ("+++", "---")]
    assert changed == [
        "-    timeouts: {finish: 10} # seconds until an alarm is raised",
        "+    timeouts: {finish: 12} # seconds until an alarm is raised",
    ]
    assert file.read_text(encoding="utf-8") == before.replace("finish: 10", "finish: 12")


def test_an_edit_that_would_make_the_station_unusable(gate: Path) -> None:
    file = gate / "resources" / "gate.yaml"
    before = file.read_text(encoding="utf-8")
    change = ("edit", gate, "resources/gate.yaml", "abilities.open_gate.enabled", "is_closd")
    said = f"{file}:37:14: unknown variable `is_closd`; did you mean `is_closed`?\n"
    refused = "the station could not be used after this change, so it was not made (--force makes it)\n"
    assert command(*change) == (2, "", said + refused)
    assert file.read_text(encoding="utf-8") == before
    code, out, err = command(*change, "--force")
    assert (code, err) == (2, said)
    assert "+    enabled: is_closd\n" in out
    assert "    enabled: is_closd\n" in file.read_text(encoding="utf-8")


def test_edits_of_what_is_not_there(gate: Path) -> None:
    assert command("edit", gate, "resources/gat.yaml", "title", "x")[2] == (
        f"{gate}/resources/gat.yaml: there is no such file\n"
    )
    assert command("edit", gate, "../other.yaml", "title", "x")[2] == f"../other.yaml is not in {gate}\n"
    code, _, err = command("edit", gate, "resources/gate.yaml", "abilities.open_gat.title", "x")
    assert code == 2
    assert "open_gat" in err


def test_a_bad_edit_by_an_absolute_path_is_not_made_either(gate: Path) -> None:
    file = gate / "station.yaml"
    before = file.read_text(encoding="utf-8")
    for named in (file, Path("..") / gate.name / "station.yaml"):
        code, _, err = command("edit", gate, named, "rest", "nonsense == 3")
        assert code == 2
        assert "unknown variable `nonsense`" in err
        assert file.read_text(encoding="utf-8") == before


@pytest.mark.parametrize("value", ["2020-12-05", "!!int foo", "a: b: c", "", "[1", "!!python/none x"])
def test_a_value_that_is_none(gate: Path, value: str) -> None:
    before = (gate / "station.yaml").read_text(encoding="utf-8")
    code, _, err = command("edit", gate, "station.yaml", "title", value)
    assert (code, "Traceback" in err) in ((0, False), (2, False))
    if code == 2:
        assert (gate / "station.yaml").read_text(encoding="utf-8") == before
