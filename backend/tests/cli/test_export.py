"""`export`: a model for other tools."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from sequence_planner.cli.loading import load_model
from support.commands import as_json, command, plain
from support.places import BOLT_TIGHTENING, CELL, TESTS, WORKED_EXAMPLE

SCHEMA = TESTS.parents[1] / "docs" / "schemas" / "efa.schema.json"


@pytest.mark.parametrize("model", [WORKED_EXAMPLE, BOLT_TIGHTENING, CELL], ids=lambda path: path.name)
def test_a_station_as_a_plain_automaton_that_can_be_read(model: Path, tmp_path: Path) -> None:
    file = tmp_path / "station.efa.json"
    code, out, _ = command("export", model, "--to", "efa", "--output", file)
    assert (code, out) == (0, "")
    document = json.loads(file.read_text(encoding="utf-8"))
    Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8"))).validate(document)
    assert load_model(file).automaton.one_at_a_time


def test_the_same_starts_are_guarded(tmp_path: Path) -> None:
    file = tmp_path / "station.efa.json"
    command("export", WORKED_EXAMPLE, "--to", "efa", "--output", file)
    station, written = (as_json("check", model)[1]["summary"] for model in (WORKED_EXAMPLE, file))
    assert written["kind"] == "plain automaton"
    assert {"operator.place_bolt", "robot.move(bolt_pair)"} <= set(written["guarded_abilities"])
    assert written["guarded_abilities"] == station["guarded_abilities"]


def test_its_goals_can_be_planned(tmp_path: Path) -> None:
    file = tmp_path / "station.efa.json"
    command("export", WORKED_EXAMPLE, "--to", "efa", "--output", file)
    code, document = as_json("plan", file, "goal_1", "--deadline", "60")
    assert (code, document["status"]) == (0, "plan")
    assert document["transitions"].count("tick") >= 5
    assert {"operator.place_bolt", "nutrunner.run_nut", "robot.move(bolt_pair)"} <= set(document["transitions"])


def test_to_standard_output(tmp_path: Path) -> None:
    code, out, err = command("export", plain(tmp_path), "--to", "cif")
    assert (code, err) == (0, "")
    assert out.startswith("// two-users\n")
    assert "    edge grab when user = user_waits and free do user := user_has, free := false;\n" in out


def test_what_is_not_said_and_new_names() -> None:
    code, _, err = command("export", BOLT_TIGHTENING, "--to", "efa")
    lines = err.splitlines()
    assert code == 0
    assert lines[0] == "restart abilities are left out: robot.move_to_previous"
    assert "`bolts[bolt_pair_1]` is called `bolts_bolt_pair_1` there" in lines


def test_nothing_is_overwritten(tmp_path: Path) -> None:
    file = plain(tmp_path)
    before = file.read_text(encoding="utf-8")
    code, out, err = command("export", file, "--to", "efa", "--output", file)
    assert (code, out, err) == (2, "", f"{file} is there already: name a new file\n")
    assert file.read_text(encoding="utf-8") == before
    nowhere = tmp_path / "none" / "x.cif"
    assert command("export", file, "--to", "cif", "--output", nowhere)[2] == (
        f"{nowhere} cannot be written: No such file or directory\n"
    )


def test_a_model_that_cannot_be_used(tmp_path: Path) -> None:
    file = plain(tmp_path)
    file.write_text(file.read_text(encoding="utf-8").replace("user == waits", "usr == waits"), encoding="utf-8")
    code, out, err = command("export", file, "--to", "cif")
    assert (code, out) == (2, "")
    assert "unknown variable `usr`" in err
