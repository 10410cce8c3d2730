"""`check`: exit codes, and findings for people and for programs."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

from support.commands import as_json, command, plain
from support.places import BOLT_TIGHTENING, CELL, MODELS, WORKED_EXAMPLE


def test_a_fine_station() -> None:
    code, document = as_json("check", BOLT_TIGHTENING)
    assert code == 0
    assert (document["model"], document["findings"]) == (str(BOLT_TIGHTENING), [])
    assert document["summary"]["kind"] == "station"
    assert "robot.move_to_position(bolt_pair_1)" in document["summary"]["guarded_abilities"]


def test_warnings() -> None:
    code, out, err = command("check", CELL)
    assert (code, err) == (1, "")
    assert out == (
        f"{CELL}/resources/arm.yaml:26:3: warning: nothing reads `arm.last`: leave it out, and list its field under "
        "`ignore` if a message has it [never-read]\n"
        f"{CELL}/resources/arm.yaml:27:3: warning: nothing reads `arm.moving`: leave it out, and list its field under "
        "`ignore` if a message has it [never-read]\n"
        f"{CELL}/station.yaml:8:3: warning: no ability writes `parts`: it stays `empty`. Write the action that is "
        "missing, or leave it out [never-written]\n"
        "3 findings: 2 never-read, 1 never-written\n"
        "cell: 6 variables, 2 abilities, 2 operations; the supervisor guards 0 abilities\n"
    )


def test_of_a_long_run_its_length_is_told_and_all_of_it_where_it_is_asked_for(tmp_path: Path) -> None:
    """The devices count to twenty by themselves, and what may not be comes at the end."""
    document = {
        "name": "clock",
        "variables": {"n": {"min": 0, "max": 20}},
        "initial": "n == 0",
        "transitions": [{"event": "ticks", "controllable": False, "guard": "n < 20", "set": {"n": "n + 1"}}],
        "forbidden": ["n == 20"],
    }
    file = tmp_path / "clock.efa.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    code, out, _ = command("check", file)
    warning, run, counts, summary = out.splitlines()
    assert (code, run) == (1, "  a run of 20 steps shows it, which `check --runs` prints")
    assert counts == "1 finding: 1 specification-cannot-be-met"
    _, out, _ = command("check", file, "--runs")
    first, *steps, last, end = out.splitlines()
    assert (first, last, end) == (warning, counts, summary)
    assert [step.partition(":")[0] for step in steps] == [f"  step {number}" for number in range(1, 21)]
    assert steps[-1].endswith("which forbidden_1 forbids")


def test_how_many_starts_and_goals_are_possible_is_counted(tmp_path: Path) -> None:
    document = {
        "name": "valve",
        "variables": {"n": {"min": 0, "max": 2}},
        "initial": "n == 0",
        "marked": "n <= 1",
        "transitions": [
            {"event": "open", "controllable": True, "guard": "n == 0", "set": {"n": "1"}},
            {"event": "burst", "controllable": True, "guard": "n == 1", "set": {"n": "2"}},
        ],
        "forbidden": ["n == 2"],
    }
    file = tmp_path / "valve.efa.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    for _ in ("found out", "told again"):
        code, out, _ = command("check", file)
        assert (code, out.splitlines()[-2]) == (1, "2 events and goals: 1 always possible, 1 not, 0 not known")
        _, told = as_json("check", file)
        assert told["summary"]["questions"] == {"possible": 1, "impossible": 1, "open": 0}
    document["forbidden"] = []
    file.write_text(json.dumps(document), encoding="utf-8")
    _, told = as_json("check", file)
    assert told["summary"]["questions"]["possible"] == 1


def test_one_of_each_is_told_as_one(tmp_path: Path) -> None:
    (tmp_path / "resources").mkdir()
    (tmp_path / "station.yaml").write_text("name: lamp\nestimated: {lit: {type: bool, initial: false}}\n")
    ability = "  light:\n    start:\n      do: [lit := true]\n"
    (tmp_path / "resources" / "lamp.yaml").write_text(f"abilities:\n{ability}")
    (tmp_path / "operations.yaml").write_text("light:\n  precondition: not lit\n  goal: lit\n")
    _, out, err = command("check", tmp_path)
    assert err == ""
    assert out.splitlines()[-1] == "lamp: 1 variable, 1 ability, 1 operation; the supervisor guards 0 abilities"


def test_warnings_for_programs() -> None:
    code, document = as_json("check", WORKED_EXAMPLE)
    assert code == 1
    (finding,) = [each for each in document["findings"] if each["kind"] == "relies-on-executing"]
    assert finding.pop("message").startswith("`nutrunner.run_nut` finishes only after it was seen executing")
    file = str(WORKED_EXAMPLE / "resources" / "nutrunner.yaml")
    place = {"file": file, "line": 19, "column": 13}
    found = {"severity": "warning", "kind": "relies-on-executing", **place}
    assert finding == {**found, "members": [], "trace": None, "fixes": []}


def test_what_is_so_of_all_instances_is_told_once(tmp_path: Path) -> None:
    """For people with the run of the first, for programs with all of them."""
    model = Path(shutil.copytree(BOLT_TIGHTENING, tmp_path / "model"))
    specifications = model / "specifications.yaml"
    written = specifications.read_text(encoding="utf-8")
    specifications.write_text(written.replace(" and not nutrunner.run_nut.executing", ""), encoding="utf-8")
    code, out, _ = command("check", model)
    first, *run, _, _, _ = out.splitlines()
    assert code == 1
    assert first.startswith(
        f"{model / 'operations.yaml'}:8:1: warning: for all pair in bolt_pair: `tighten_bolt_pair(pair)` cannot be "
        "completed under the supervisor, though it could without it"
    )
    assert "breaks `no_standing_tool_on_placed_bolts(pair)`. Let another way" in first
    assert any("robot.move_to_position(bolt_pair_1)" in line for line in run)
    _, document = as_json("check", model)
    (finding,) = document["findings"]
    assert finding["members"] == [f"tighten_bolt_pair(bolt_pair_{number})" for number in (1, 2, 3)]
    assert finding["trace"]["steps"]


def test_what_is_so_of_instances_of_a_type_is_told_once_and_names_them(tmp_path: Path) -> None:
    model = Path(shutil.copytree(MODELS / "robots_with_buffer", tmp_path / "model"))
    robot = model / "types" / "robot.yaml"
    written = robot.read_text(encoding="utf-8")
    guard = "at == target and close_gripper and not part_in_gripper"
    assert written.count(guard) == 1
    robot.write_text(written.replace(guard, f"{guard} or not close_gripper or at != target or at == target"), "utf-8")
    code, out, _ = command("check", model)
    told = [line for line in out.splitlines() if "[always-holds]" in line]
    assert code == 1
    line = written[: written.index(guard)].count("\n") + 1
    assert len(told) == 1
    first = f"in robot_1 ({model / 'resources' / 'robot_1.yaml'}:2:7) and robot_2: `"
    assert told[0].startswith(f"{robot}:{line}:14: warning: {first}")
    assert "robot_1.at" in told[0]
    assert "robot_2.at" not in told[0]
    _, document = as_json("check", model)
    [finding] = [each for each in document["findings"] if each["kind"] == "always-holds"]
    assert finding["members"] == ["robot_1", "robot_2"]
    with (model / "resources" / "robot_2.yaml").open("a", encoding="utf-8") as other:
        other.write(f"  open_gripper: {{enabled: {guard}}}\n")
    _, out, _ = command("check", model)
    [alone] = [line for line in out.splitlines() if "[always-holds]" in line]
    assert f"warning: {first.partition(' and ')[0]}: `robot_1.at" in alone


def test_unusable_input_for_programs(tmp_path: Path) -> None:
    cell = Path(shutil.copytree(CELL, tmp_path / "cell"))
    (cell / "station.yaml").write_text("nam: cell\nname: cell\n", encoding="utf-8")
    code, document = as_json("check", cell)
    assert (code, document["summary"]) == (2, None)
    assert document["findings"][0] == {
        "severity": "error",
        "kind": "unusable",
        "file": str(cell / "station.yaml"),
        "line": 1,
        "column": 1,
        "message": "`nam` is not known here; did you mean `name`?",
        "members": [],
        "trace": None,
        "fixes": [{"was": "nam", "now": "name", "is_sure": True}],
    }


def test_a_plain_automaton(tmp_path: Path) -> None:
    code, out, err = command("check", plain(tmp_path))
    assert (code, err) == (0, "")
    assert out.startswith("two-users: 2 variables, 2 controllable and 1 uncontrollable transition;")


def test_a_plain_automaton_that_is_none(tmp_path: Path) -> None:
    file = plain(tmp_path)
    file.write_text(file.read_text(encoding="utf-8").replace("user == waits and", "usr == waits and"), encoding="utf-8")
    code, out, err = command("check", file)
    assert (code, out) == (2, "")
    assert "did you mean `user`?" in err


def test_a_trace_is_told_step_by_step_up_to_what_is_forbidden(tmp_path: Path) -> None:
    file = plain(tmp_path)
    text = file.read_text(encoding="utf-8").replace('"user == idle"}', '"true"}')
    file.write_text(text.replace("user == has and free", "user == has"), encoding="utf-8")
    code, out, err = command("check", file)
    assert (code, err) == (1, "")
    assert out.splitlines()[:3] == [
        f"{file}:6:14: warning: `grab` never starts, as the supervisor forbids it wherever it could: it would lead to "
        "what `forbidden_1` forbids. Let something else happen before it, forbid less, or leave it out [never-allowed]",
        "  step 1: ask: user := waits",
        "  step 2: grab: user := has, free := false, which forbidden_1 forbids",
    ]


def test_specifications_that_cannot_be_met_for_programs(tmp_path: Path) -> None:
    file = plain(tmp_path)
    file.write_text(file.read_text(encoding="utf-8").replace("user == has and free", "user == waits"), encoding="utf-8")
    code, document = as_json("check", file)
    (finding,) = document["findings"]
    assert (code, finding["kind"], finding["line"]) == (1, "specification-cannot-be-met", 8)
    assert finding["message"].endswith("Already these conflict: `forbidden_1`, with what no start decides: `ask`")
    changes = {"kind": "transition", "names": ["ask"], "finished": [], "changes": {"user": "waits"}}
    text = "step 1: ask: user := waits, which forbidden_1 forbids"
    assert finding["trace"] == {
        "initial": {"user": "idle", "free": True},
        "forbidden_by": [],
        "steps": [{**changes, "forbidden_by": ["forbidden_1"], "text": text}],
    }
