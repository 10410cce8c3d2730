"""`export --to pddl` and `--to smv`: questions for other planners."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from support.commands import command, plain
from support.places import BOLT_TIGHTENING, WORKED_EXAMPLE


def test_the_problem_is_put_beside_the_domain(tmp_path: Path) -> None:
    file = tmp_path / "station.pddl"
    goal = "bolts[bolt_pair_1] == tightened"
    assert command("export", BOLT_TIGHTENING, "--to", "pddl", "--goal", goal, "--output", file) == (0, "", "")
    problem = (tmp_path / "station.problem.pddl").read_text(encoding="utf-8")
    assert file.read_text(encoding="utf-8").startswith("(define (domain ")
    assert "(:goal (reached_bolts_bolt_pair_1_tightened))" in problem


def test_a_plain_automaton_asks_for_what_is_wanted(tmp_path: Path) -> None:
    code, out, err = command("export", plain(tmp_path), "--to", "pddl", "--goal", "user == has")
    assert (code, err) == (0, "")
    assert "(:action start-grab" in out
    assert "(:goal (reached_user_has))" in out
    assert command("export", plain(tmp_path), "--to", "pddl")[2].startswith("the model has no goal")


def test_in_smv_from_another_state(tmp_path: Path) -> None:
    state = tmp_path / "state.json"
    state.write_text(json.dumps({"state": {"bolts": "placed"}}), encoding="utf-8")
    code, out, err = command("export", WORKED_EXAMPLE, "--to", "smv", "--state", state)
    assert (code, err) == (0, "")
    assert "\nMODULE main\n" in out
    assert "  init(bolts) := v_placed;\n" in out


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--to", "pddl", "--goal", "bolt == tightened"), "--goal 'bolt == tightened': unknown variable `bolt`"),
        (("--to", "cif", "--goal", "true"), "--goal and --state belong to a question"),
    ],
)
def test_what_is_refused(options: tuple[str, ...], said: str) -> None:
    code, out, err = command("export", WORKED_EXAMPLE, *options)
    assert (code, out) == (2, "")
    assert err.startswith(said)
