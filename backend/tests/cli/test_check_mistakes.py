"""Mistakes of an engineer that `check` tells where they are."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from support.commands import command
from support.places import BOLT_TIGHTENING


@pytest.fixture
def model(tmp_path: Path) -> Path:
    return Path(shutil.copytree(BOLT_TIGHTENING, tmp_path / "station"))


def change(file: Path, old: str, new: str) -> None:
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new, 1), encoding="utf-8")


def test_operations_that_were_emptied(model: Path) -> None:
    (model / "work_masters.yaml").unlink()
    (model / "operations.yaml").write_text("# nothing any more\n", encoding="utf-8")
    code, out, _ = command("check", model)
    assert code == 1
    assert f"{model}/operations.yaml:1:1: warning: there is no operation here" in out
    assert "[no-operation]" in out


def test_a_resource_on_wrong_indentation(model: Path) -> None:
    file = model / "resources" / "nutrunner.yaml"
    change(file, "topics:\n", "  topics:\n")
    code, _, err = command("check", model)
    assert code == 2
    assert err.startswith(f"{file}:4:3: this is not YAML: this does not belong to what is above it")
    assert "look at the indentation" in err
    change(file, "title: {en: Nutrunner, sv: Mutterdragaren}\n", "title: Nutrunner\n")
    code, _, err = command("check", model)
    assert code == 2
    assert err.startswith(f"{file}:4:9: this is not YAML: a `name:` stands here where none may")
    assert "look at the indentation" in err


def test_a_value_with_the_name_of_a_variable(model: Path) -> None:
    change(model / "station.yaml", "above_engine", "target_pose")
    code, _, err = command("check", model)
    assert code == 2
    assert "the value `target_pose` of " in err
    assert "has the name of the variable `robot.target_pose`, which hides it: rename one of them" in err


def test_a_specification_that_forbids_the_initial_state(model: Path) -> None:
    specifications = model / "specifications.yaml"
    lines = len(specifications.read_text(encoding="utf-8").splitlines())
    with specifications.open("a", encoding="utf-8") as file:
        file.write("never_idle:\n  forbidden: nutrunner.set_tool_idle and not nutrunner.run_tool_forward\n")
    code, _, err = command("check", model)
    assert code == 2
    assert err == (
        f"{model}/specifications.yaml:{lines + 1}:1: `never_idle` forbids the initial state, in which "
        "nutrunner.set_tool_idle == true and nutrunner.run_tool_forward == false: begin otherwise (`initial` of a "
        "variable), or forbid less\n"
    )
