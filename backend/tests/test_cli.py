"""The command line and bad models: what is wrong goes to standard error, line by line, and the exit code is 2."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from sequence_planner.cli.main import app
from support.places import BOLT_TIGHTENING, CELL


def check(model: Path, verb: str = "check", *options: str) -> tuple[int, str, str]:
    """The exit code, standard output and standard error of one command on `model`."""
    result = CliRunner().invoke(app, [verb, str(model), *options])
    assert result.exception is None or isinstance(result.exception, SystemExit)
    return result.exit_code, result.stdout, result.stderr


@pytest.fixture
def cell(tmp_path: Path) -> Path:
    return Path(shutil.copytree(CELL, tmp_path / "cell"))


def edit(file: Path, old: str, new: str) -> None:
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new, 1), encoding="utf-8")


def test_a_good_station_is_said_to_be_one() -> None:
    code, out, err = check(BOLT_TIGHTENING)
    assert (code, err) == (0, "")
    assert out.startswith("Bolt tightening station: 16 variables, 13 abilities, 8 operations;")


def test_the_program_itself(cell: Path) -> None:
    (cell / "station.yaml").write_text("name: cell\nrest: " + "(" * 5000, encoding="utf-8")
    command = [sys.executable, "-m", "sequence_planner.cli", "check", str(cell)]
    run = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    assert (run.returncode, run.stdout) == (2, "")
    assert f"{cell}/station.yaml:2:37: nested more than 30 deep: split it up" in run.stderr.splitlines()
    assert "Traceback" not in run.stderr


@pytest.mark.parametrize("verb", ["check", "run", "emulate", "messages"])
def test_every_verb_refuses_a_bad_model_alike(cell: Path, verb: str, tmp_path: Path) -> None:
    edit(cell / "station.yaml", "name: cell", "nam: cell")
    options = ["--ament", str(tmp_path / "ament")] if verb == "messages" else []
    assert check(cell, verb, *options) == (
        2,
        "",
        f"{cell}/station.yaml:1:1: `nam` is not known here; did you mean `name`?\n"
        f"{cell}/station.yaml:1:1: `name` is missing here\n",
    )


def test_all_that_is_wrong_is_said_at_once(cell: Path) -> None:
    edit(cell / "resources" / "arm.yaml", "enabled: goto == pose", "enabled: goto == poze")
    edit(cell / "resources" / "arm.yaml", "goto := position", "goto := moving")
    edit(cell / "operations.yaml", "    parts[which]", "    partz[which]")
    assert check(cell) == (
        2,
        "",
        f"{cell}/operations.yaml:6:5: unknown variable `partz[which]`; did you mean `parts[…]`, as in `parts[left]`?\n"
        f"{cell}/resources/arm.yaml:33:22: unknown variable or value `poze`; did you mean `pose`?\n"
        f"{cell}/resources/arm.yaml:35:20: expected one of {{home, out}}, found a truth value\n",
    )


def test_what_is_no_station(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "file.yaml").write_text("name: cell\n", encoding="utf-8")
    for name in ("empty", "file.yaml", "missing"):
        folder = tmp_path / name
        message = f"{folder}/station.yaml:1:1: a station is a folder with a station.yaml: there is none here\n"
        assert check(folder) == (2, "", message)


@pytest.mark.parametrize(
    ("content", "line"),
    [
        (f"name: {'9' * 5000}", "1:7: `999999999999999999999999999...` is no number that can be used"),
        ("name: x\nrest: " + "(" * 2000 + "true" + ")" * 2000, "2:37: nested more than 30 deep: split it up"),
        ("name: x\nrest: " + "not " * 3000 + "true", "2:127: nested more than 30 deep: split it up"),
        ("name: x\nrest: " + "1 + " * 3000 + "1 == 2", "2:209: more than 50 operations in one expression"),
        ("name: " + "[" * 3000 + "]" * 3000, "1:1: cannot be read: it is nested too deeply"),
        ("name: " + "{a: " * 3000 + "}" * 3000, "1:1: cannot be read: it is nested too deeply"),
        ("name: &a [*a]", "1:7: this contains itself, by an alias of its own anchor"),
        ("name: cell\n\ttitle: tab", "2:1: this is not YAML: a tab stands where only spaces may"),
        ("name: ce\x00ll", "1:9: this is not YAML: the character 0x0000 is not allowed"),
        ("name: a\n--- \nname: b", "2:1: this is not YAML: a second document begins here, and a file has one"),
    ],
    ids=range(10),
)
def test_files_meant_to_break_something(cell: Path, content: str, line: str) -> None:
    (cell / "station.yaml").write_text(content, encoding="utf-8")
    code, out, err = check(cell)
    assert (code, out) == (2, "")
    assert f"{cell}/station.yaml:{line}" in err.splitlines()


def test_enormous_ranges_are_refused_before_they_are_enumerated(cell: Path) -> None:
    edit(cell / "resources" / "arm.yaml", "moving: {type: bool, initial: false}", "moving: {type: 0..999999999999}")
    code, _, err = check(cell)
    assert code == 2
    assert "the range 0..999999999999 has more than 1000 values: use a coarser measure" in err


def test_a_specification_that_forbids_the_initial_state(cell: Path) -> None:
    edit(cell / "specifications.yaml", "arm.pose == out and\n    parts[left] == full", "arm.pose == home")
    code, out, err = check(cell)
    assert (code, out) == (2, "")
    assert err.startswith(f"{cell}/specifications.yaml:1:1: `never` forbids the initial state, in which arm.pose == ")


def test_a_specification_that_cannot_be_met(cell: Path) -> None:
    """The model can be read, so that is a finding; `run` refuses it."""
    edit(cell / "specifications.yaml", "arm.pose == out and\n    parts[left] == full", "arm.pose == unknown")
    effect = "      gets_lost: {kind: starting, when: not moving and pose == home, do: [pose := unknown]}\n"
    edit(cell / "resources" / "arm.yaml", "    effects:\n", f"    effects:\n{effect}")
    code, out, err = check(cell)
    assert (code, err) == (1, "")
    assert f"{cell}/specifications.yaml:1:1: warning: specification never cannot be met" in out
    assert out.splitlines()[-1] == "cell: 6 variables, 2 abilities, 2 operations; no supervisor"


@pytest.mark.parametrize("verb", ["run", "controller", "check"])
def test_a_formula_that_is_too_large_to_be_followed(cell: Path, verb: str, tmp_path: Path) -> None:
    file = cell / "operations.yaml"
    formula = f"F (arm.moving and {'X ' * 9}arm.moving)"
    file.write_text(file.read_text(encoding="utf-8") + f"  local: {formula}\n", encoding="utf-8")
    line = len(file.read_text(encoding="utf-8").splitlines())
    options = ["--socket", str(tmp_path / "socket")] if verb == "controller" else []
    code, out, err = check(cell, verb, *options)
    assert (code, out) == (2, "")
    assert err.startswith(f"{file}:{line}:10: `{formula}` takes more than ")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no /dev/full")
@pytest.mark.parametrize("verb", ["check", "show"])
def test_a_disk_that_is_full_is_said_in_words(cell: Path, verb: str) -> None:
    with Path("/dev/full").open("w") as full:
        command = [sys.executable, "-m", "sequence_planner.cli", verb, str(cell)]
        run = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (run.returncode, run.stderr) == (2, "what was to be printed cannot be written: no space is left\n")
