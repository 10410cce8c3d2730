"""The tutorial is done as it is written: after each step the station checks, and has the guards that are shown."""

from __future__ import annotations

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

import pytest
from typer.testing import CliRunner

from sequence_planner.cli.main import app
from sequence_planner.execution.record.recorder import model_digest
from sequence_planner.execution.vocabulary import PlanStatus
from sequence_planner.station import prepare_station, read_station
from sequence_planner.synthesis.supervisor import Supervision, synthesise
from sequence_planner.synthesis.transition_relation import Plant
from support.places import DOCS, MODELS, REPOSITORY
from support.simulated import Rig

TEXT = (DOCS / "tutorial.md").read_text(encoding="utf-8")
FIRST_PART, SECOND_PART = TEXT.split("\n# Part 2")


@dataclass(frozen=True)
class Block:
    """What stands between two fences; `label` is what stands behind its kind."""

    kind: str
    label: str
    content: str


def blocks(text: str) -> list[Block]:
    return [Block(*found) for found in re.findall(r"^```(\w+) ?(.*)\n((?:.*\n)*?)```$", text, re.MULTILINE)]


STEPS = [blocks(step) for step in re.split(r"^## \d", FIRST_PART, flags=re.MULTILINE)[1:]]
QUOTED = [block for block in blocks(TEXT) if block.label.startswith("from ")]


def files_after(step: int) -> dict[str, str]:
    """What has been written by the end of a step, counted from 1."""
    files: dict[str, str] = {}
    for block in (block for blocks_of_step in STEPS[:step] for block in blocks_of_step):
        if block.kind not in ("yaml", "text"):
            continue
        name = block.label.removeprefix("more of ")
        assert (name in files) == (name != block.label), f"{block.label} is new, or is there already"
        files[name] = files.get(name, "") + block.content
    return files


def station_after(step: int, folder: Path) -> Path:
    for name, content in files_after(step).items():
        path = folder / "my_station" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content, encoding="utf-8")
    return folder / "my_station"


def check(station: Path) -> tuple[int, str]:
    """What the command that the tutorial shows ends with, and says."""
    result = CliRunner().invoke(app, ["check", str(station)])
    return result.exit_code, result.output


def assert_guards(station: Path, guards: list[Block]) -> None:
    """Wherever the station can come to, and the ability could start as written, it may where its guard shown holds."""
    automaton = prepare_station(station).automaton
    supervision = Supervision(Plant(automaton, tuple(automaton.variables)))
    reached = supervision.reachable(supervised=True)
    for guard in guards:
        shown = supervision.plant.where(automaton.read_condition(guard.content.strip()))
        allowed, disallowed = (reached & states for states in supervision.guard(guard.label))
        assert (allowed | disallowed).satisfiable(), f"{guard.label} never has a choice"
        assert allowed == (allowed | disallowed) & shown, guard.label


def test_there_is_something_to_try() -> None:
    assert len(STEPS) == 6
    assert {block.kind for block in blocks(TEXT)} == {"sh", "yaml", "text", "guard", "warning"}
    assert len([block for block in blocks(TEXT) if block.kind == "guard"]) >= 8
    assert len(QUOTED) >= 6


@pytest.mark.parametrize("step", range(1, len(STEPS) + 1))
def test_each_step_checks_and_has_the_guards_shown(tmp_path: Path, step: int) -> None:
    station = station_after(step, tmp_path)
    warnings = [block.content.strip() for block in STEPS[step - 1] if block.kind == "warning"]
    code, said = check(station)
    assert code == (1 if warnings else 0), said
    assert said.count("warning:") == len(warnings)
    assert all(f"warning: {warning}" in said for warning in warnings)
    assert "Two robots and a buffer" in said
    assert_guards(station, [block for block in STEPS[step - 1] if block.kind == "guard"])


def test_the_commands_shown_are_there(tmp_path: Path) -> None:
    """Those that only look are run where they stand; of the others, that there are such options."""
    ran: set[str] = set()
    for step, shown in enumerate(STEPS, start=1):
        station = station_after(step, tmp_path / str(step))
        for line in lines("".join(block.content for block in shown if block.kind == "sh")):
            program, command, *arguments = shlex.split(line)
            assert program.endswith("/sequence-planner")
            ran.add(command)
            if command in ("check", "show"):
                arguments = [str(station) if argument == "my_station" else argument for argument in arguments]
                result = CliRunner().invoke(app, [command, *arguments])
                assert result.exit_code in (0, 1), result.output
                assert command == "check" or {"robot_1.move_to(infeed)", "robot_1.move_to(buffer)"} <= set(
                    re.findall(r"robot_1\.move_to\(\w+\)", result.output)
                )
            else:
                found = CliRunner().invoke(app, [command, "--help"])
                assert found.exit_code == 0
                assert all(argument in found.output for argument in arguments if argument.startswith("--"))
    assert ran == {"check", "show", "run", "by-hand"}


def test_a_misspelt_name_is_found_as_promised(tmp_path: Path) -> None:
    station = station_after(1, tmp_path)
    file = station / "resources" / "robot_1.yaml"
    file.write_text(file.read_text().replace("not part_in_gripper", "not part_in_griper", 1))
    code, said = check(station)
    assert code == 2
    assert re.search(r"robot_1.yaml:\d+:\d+: unknown variable `part_in_griper`; did you mean `part_in_gripper`", said)


def test_counting_without_a_limit_is_refused(tmp_path: Path) -> None:
    station = station_after(2, tmp_path)
    file = station / "resources" / "robot_1.yaml"
    text = file.read_text()
    assert text.count("not part_in_gripper and parts_on_buffer < 2") == 1
    file.write_text(text.replace("not part_in_gripper and parts_on_buffer < 2", "not part_in_gripper"))
    code, said = check(station)
    assert code == 2
    assert "`parts_on_buffer := parts_on_buffer + 1` may write 3" in said


def test_the_first_robot_fills_the_buffer_and_rests(tmp_path: Path) -> None:
    rig = Rig(folder=station_after(2, tmp_path))
    rig.start_production()
    rig.run(60)
    once = ["robot_1.pick", "robot_1.move_to(buffer)", "robot_1.place"]
    assert rig.started[:7] == [*once, "robot_1.move_to(infeed)", *once]
    assert rig.completed == ["refill_buffer"]
    assert rig.value("parts_on_buffer") == 2
    assert rig.execution.plan.status is PlanStatus.IDLE


def test_the_guard_of_the_first_robot_alone_goes_with_the_second(tmp_path: Path) -> None:
    third = station_after(3, tmp_path / "third")
    assert set(synthesise(prepare_station(third).automaton).guards) == {"robot_1.pick"}
    fourth = station_after(4, tmp_path / "fourth")
    assert not synthesise(prepare_station(fourth).automaton).guards


def test_without_the_specification_both_robots_come_to_the_buffer(tmp_path: Path) -> None:
    automaton = prepare_station(station_after(4, tmp_path)).automaton
    supervision = Supervision(Plant(automaton, tuple(automaton.variables)))
    both = automaton.read_condition("robot_1.at == buffer and robot_2.at == buffer")
    assert (supervision.reachable(supervised=True) & supervision.plant.where(both)).satisfiable()


def test_a_fault_without_a_way_out_forbids_the_beginning(tmp_path: Path) -> None:
    station = station_after(6, tmp_path)
    assert_guards(station, [block for block in STEPS[4] if block.kind == "guard"][-1:])
    file = station / "resources" / "robot_1.yaml"
    text = file.read_text()
    opens = text.index("  open_gripper:")
    line = "    start:\n      do: [close_gripper := false]\n"
    assert text.count(line, opens) == 1
    file.write_text(text[:opens] + text[opens:].replace(line, ""))
    assert_guards(station, [Block("guard", "robot_1.pick", "false")])
    rig = Rig(folder=station)
    rig.start_production()
    rig.run(1)
    assert rig.started == []
    assert rig.execution.plan.status is PlanStatus.NONE


def test_the_last_step_is_the_model(tmp_path: Path) -> None:
    """The same station: the model has its robots as two instances of one type."""
    written, model = (read_station(folder) for folder in (station_after(6, tmp_path), MODELS / "robots_with_buffer"))
    assert model_digest(written.automaton) == model_digest(model.automaton)
    messages = {path.name: lines(path.read_text()) for path in (MODELS / "robots_with_buffer").rglob("*.msg")}
    assert {Path(name).name: lines(text) for name, text in files_after(6).items() if name.endswith(".msg")} == messages


def test_what_is_quoted_stands_there() -> None:
    for block in QUOTED:
        assert block.content in (REPOSITORY / block.label.removeprefix("from ")).read_text(encoding="utf-8")


def test_the_guards_of_the_second_station() -> None:
    guards = [block for block in blocks(SECOND_PART) if block.kind == "guard"]
    assert {guard.label for guard in guards} >= {"agv.drive_to(store)", "dock.hold"}
    assert_guards(MODELS / "docking_agv", guards)


def test_the_local_formula_is_accepted(tmp_path: Path) -> None:
    (shown,) = [block for block in blocks(SECOND_PART) if (block.kind, block.label) == ("yaml", "operation")]
    model = MODELS / "docking_agv"
    for path in model.rglob("*"):
        if path.is_file():
            (tmp_path / path.relative_to(model)).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / path.relative_to(model)).write_text(path.read_text())
    operations = tmp_path / "operations.yaml"
    local = next(line for line in shown.content.splitlines() if line.startswith("  local:"))
    without = shown.content.replace(f"{local}\n", "")
    assert without in operations.read_text()
    operations.write_text(operations.read_text().replace(without, shown.content))
    assert prepare_station(tmp_path).automaton.operations["fetch_kit"].local is not None


def lines(text: str) -> list[str]:
    """All but blank ones, and the one that is for editors."""
    return [line for line in text.splitlines() if line.strip() and not line.startswith("# yaml-language-server:")]
