"""`test` carries out the scenarios of a station, and says what did not come about and where that is written."""

from __future__ import annotations

import json
import re
from pathlib import Path
from shutil import copytree
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.analysis.kept import with_supervisor
from sequence_planner.automaton.automaton import State
from sequence_planner.editor.simulating.scenario_run import ScenarioRunner
from sequence_planner.editor.simulating.simulation import DraftSimulation
from sequence_planner.editor.usable import Usable, supervisor_in
from sequence_planner.language.types import Place
from sequence_planner.process.budget import Budget
from sequence_planner.scenarios.scenario import Scenario, ScenarioCondition, ScenarioStep
from sequence_planner.station import prepare_station
from support.commands import as_json, command
from support.places import BOLT_TIGHTENING

NOWHERE = Place("tests/law.yaml", 1, 1)


@pytest.fixture
def station(tmp_path: Path) -> Path:
    """A station of the test's own, without scenarios."""
    folder = copytree(BOLT_TIGHTENING, tmp_path / "bolts")
    for file in (folder / "tests").iterdir():
        file.unlink()
    return folder


def write(station: Path, text: str, name: str = "work") -> Path:
    file = station / "tests" / f"{name}.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def test_those_of_the_bolt_tightening_station_pass(tmp_path: Path) -> None:
    junit = tmp_path / "found.xml"
    code, out, err = command("test", BOLT_TIGHTENING, "--junit", junit)
    assert (code, err) == (0, "")
    assert "passed  an_engine_is_tightened" in out
    assert "3 scenarios: 3 passed, 0 failed" in out
    (suite,) = ElementTree.parse(junit).getroot()
    assert suite.attrib["tests"] == "3"
    assert suite.attrib["failures"] == "0"
    assert {(case.attrib["classname"], case.attrib["line"]) for case in suite} == {
        ("work", "2"),
        ("work", "13"),
        ("work", "26"),
    }


def test_what_fails_is_told_with_its_place_and_what_happened_last(station: Path, tmp_path: Path) -> None:
    file = write(station, "too_soon:\n  steps:\n    - completes: new_engine\n      within: 4\n")
    junit = tmp_path / "found.xml"
    code, out, err = command("test", station, "--junit", junit)
    assert (code, err) == (1, "")
    first, why, *moments, counts, _, _ = out.splitlines()
    assert first.split() == ["FAILED", "too_soon", "4.0", "s"]
    assert why == f"  {file}:3:7: the operation new_engine was not completed within 4 s"
    assert len(moments) == 5
    assert counts == "1 scenario: 0 passed, 1 failed"
    (case,) = ElementTree.parse(junit).getroot()[0]
    assert case[0].attrib["message"] == "the operation new_engine was not completed within 4 s"
    code, document = as_json("test", station)
    assert code == 1
    (told,) = document["scenarios"]
    assert (told["name"], told["passed"], told["seconds"], told["line"]) == ("too_soon", False, 4.0, 1)
    assert told["failure"] == {"file": str(file), "line": 3, "column": 7, "message": case[0].attrib["message"]}
    assert "new_engine" in document["not_exercised"]["operations"]


def test_one_is_asked_for_by_its_name(station: Path) -> None:
    write(station, "one:\n  steps: [{wait: 1}]\nother:\n  steps: [{wait: 2}]\n")
    code, document = as_json("test", station, "other")
    assert (code, [each["name"] for each in document["scenarios"]]) == (0, ["other"])
    code, _, err = command("test", station, "othr")
    assert code == 2
    assert err.strip() == "there is no scenario `othr` that can be carried out; did you mean `other`?"


def test_a_station_without_scenarios_says_where_to_write_one(station: Path) -> None:
    code, _, err = command("test", station)
    assert code == 2
    assert f"write one in {station / 'tests'}" in err


WRONG = {
    "given: {robot.pos: home}": "there is no variable `robot.pos`; did you mean `robot.pose`?",
    "given: {robot.pose: hom}": "`hom` is no value of `robot.pose`, which ranges over {unknown, home, above_engine, "
    "bolt_pair_1, bolt_pair_2, bolt_pair_3}; did you mean `home`?",
    "given: {operator.requested_pair: null}": "`operator.requested_pair` is not measured, and so always known",
    "never: robot.pose == hom": "unknown variable or value `hom`; did you mean `home`?",
    "steps: [{fault: robt silent}]": "no emulated device has `robt`: name a resource, a topic or a variable; did "
    "you mean `robot`?",
    "steps: [{set: {'bolts[bolt_pair_1]': placed}}]": "no device tells `bolts[bolt_pair_1]`: only measured variables "
    "are brought to values by hand",
    "steps: [{starts: robot.move}]": "there is no ability `robot.move`",
    "steps: [{starts: []}]": "expected a text or at least one entry, found an empty list",
    "steps: [{completes: new_engin}]": "there is no operation `new_engin`; did you mean `new_engine`?",
    "steps: [{done: operator.place_bolt_pair}]": "people do their tasks by themselves here: write `people: wait` for "
    "steps that say `done`",
    "people: wait\n  steps: [{done: robot.move_to_previous}]": "nobody has a task of `robot.move_to_previous`: it is "
    "no ability of a person",
    "steps: [{starts: new_engine}]": "`new_engine` is an operation: write `completes`",
    "steps: [{completes: robot.move_to_previous}]": "`robot.move_to_previous` is an ability: write `starts`",
    "steps: [{fault: engine silent}]": "no emulated device has `engine`",
    "steps: []": "expected at least one entry, found an empty list",
    "steps: [{}]": "a step is about one thing: fault, set, done, wait, holds, starts, completes",
    "steps: [{wait: 1, completes: new_engine}]": "a step is about one thing: fault, set, done, wait, holds, starts, "
    "completes",
    "steps: [{wait: 1, within: 3}]": "`within` says how long may pass until something has come about: it belongs to "
    "holds, starts, completes",
    "steps: [{wait: -1}]": "expected a number of at least 0, found `-1`",
    "steps: [{waits: 1}]": "`waits` is not known here; did you mean `wait`?",
}


@pytest.mark.parametrize("written", WRONG)
def test_one_that_cannot_be_carried_out_is_told_and_the_station_can_be_used(written: str, station: Path) -> None:
    steps = "" if "steps:" in written else "  steps: [{wait: 1}]\n"
    file = write(station, f"wrong:\n  {written}\n{steps}")
    code, out, err = command("test", station)
    assert (code, out) == (2, "")
    place, _, said = err.strip().partition(": ")
    assert WRONG[written] in said
    assert re.fullmatch(rf"{re.escape(str(file))}:[23]:\d+", place)
    code, out, _ = command("check", station)
    assert code == 1
    assert f"{place}: warning: {said} [broken-scenario]" in out


def test_two_of_one_name(station: Path) -> None:
    first = write(station, "same:\n  steps: [{wait: 1}]\n", "a")
    second = write(station, "same:\n  steps: [{wait: 1}]\n", "b")
    code, _, err = command("test", station)
    assert code == 2
    assert (
        err.strip() == f"{second}:1:1: there is a scenario `same` already, at {first}:1:1: give this one another name"
    )


def test_files_that_are_not_read_are_told(station: Path) -> None:
    write(station, "fine:\n  steps: [{wait: 1}]\n")
    (station / "tests" / "more").mkdir()
    others = [
        station / "tests" / "forgotten.yml",
        station / "tests" / "more" / "work.yaml",
        station / "tests" / "a b.yaml",
        station / "tests" / "2.yaml",
    ]
    for other in others:
        other.write_text("fine:\n  steps: [{wait: 1}]\n", encoding="utf-8")
    (station / "tests" / "gone.yaml").symlink_to("nowhere.yaml")
    code, _, err = command("test", station)
    assert code == 2
    said = "this is not read: scenarios stand in `tests/<name>.yaml`, as in `work.yaml`"
    places = [*others, station / "tests" / "gone.yaml"]
    assert sorted(err.splitlines()) == sorted(f"{place}:1:1: {said}" for place in places)
    code, document = as_json("test", station, "fine")
    assert (code, len(document["scenarios"])) == (0, 1), "those that are named can be carried out"


def test_what_is_wrong_is_told_to_programs_too(station: Path) -> None:
    file = write(station, 'wrong:\n  steps: [{completes: new_engin}]\n"no name":\n  steps: [{wait: 1}]\n')
    code, out, _ = command("test", station, "--json")
    assert code == 2
    told = json.loads(out)
    assert told["scenarios"] == []
    assert [(each["file"], each["line"]) for each in told["wrong"]] == [(str(file), 2), (str(file), 3)]


def test_where_no_report_can_be_written_nothing_is_carried_out(station: Path, tmp_path: Path) -> None:
    write(station, "fine:\n  steps: [{wait: 1}]\n")
    for junit in (tmp_path, tmp_path / "nowhere" / "found.xml"):
        code, out, err = command("test", station, "--junit", junit)
        assert (code, out) == (2, "")
        assert err.strip() == f"{junit}: no file can be written there: name one in a folder that exists"


FAILING = {
    "never: true\n  steps: [{wait: 1}]": "after 0 s `true` held: it reads no variable",
    "steps: [{holds: false, within: 1}]": "`false` did not come to hold within 1 s: it reads no variable",
    "people: wait\n  steps: [{starts: operator.place_bolt_pair}, {done: operator.place_bolt_pair}, "
    "{done: operator.place_bolt_pair}]": "nobody has a task of ",
    "steps: [{holds: 'bolts[bolt_pair_1] == tightened', within: 0}]": "`bolts[bolt_pair_1] == tightened` does not hold "
    "here: bolts[bolt_pair_1] == empty",
    "steps: [{holds: 'bolts[bolt_pair_1] == tightened', within: 2}]": "`bolts[bolt_pair_1] == tightened` did not come "
    "to hold within 2 s: bolts[bolt_pair_1] == empty",
    "people: wait\n  steps: [{starts: nutrunner.run_nut, within: 30}]": "nutrunner.run_nut did not start within 30 s",
    "people: wait\n  steps: [{done: operator.place_bolt_pair}]": "nobody has a task of ",
    "never: operator.requested_pair != none\n  steps: [{wait: 5}]": "after 0.1 s `operator.requested_pair != none` held"
    ": operator.requested_pair == ",
    "never: robot.pose == home\n  steps: [{wait: 5}]": "after 0 s `robot.pose == home` held: robot.pose == home",
}


@pytest.mark.parametrize("written", FAILING)
def test_what_does_not_come_about_fails(written: str, station: Path) -> None:
    write(station, f"fails:\n  {written}\n")
    code, out, _ = command("test", station)
    assert code == 1
    assert FAILING[written] in out


PASSING = {
    "a fault, and its end": """
  steps:
    - starts: operator.place_bolt_pair
    - fault: robot offline
    - wait: 20
    - holds: robot.target_pose == home
      within: 0
    - fault: clear robot
    - starts: robot.move_to_position
""",
    "what somebody moves by hand": """
  people: wait
  steps:
    - set: {robot.pose: unknown}
    - holds: robot.pose == unknown
      within: 1
""",
    "a given state, and starts in their order": """
  given: {"bolts[bolt_pair_1]": placed, "bolts[bolt_pair_2]": tightened, "bolts[bolt_pair_3]": tightened}
  steps:
    - starts: [robot.move_to_position(above_engine), nutrunner.run_nut]
    - completes: new_engine
""",
    "a task that a person does": """
  people: wait
  steps:
    - starts: operator.place_bolt_pair
    - wait: 30
    - done: operator.place_bolt_pair
    - completes: tighten_bolt_pair(bolt_pair_1)
""",
}


@pytest.mark.parametrize("written", PASSING)
def test_what_comes_about_passes(written: str, station: Path) -> None:
    text = PASSING[written]
    if "tighten_bolt_pair(bolt_pair_1)" in text:  # which pair is first is the planner's
        text = text.replace(
            "completes: tighten_bolt_pair(bolt_pair_1)", "holds: 'any p in bolt_pair: bolts[p] == tightened'"
        )
    write(station, f"passes:{text}")
    code, out, err = command("test", station)
    assert (code, err) == (0, ""), out


@pytest.fixture(scope="module")
def meant() -> Usable:
    station = prepare_station(BOLT_TIGHTENING)
    return Usable(station, supervisor_in("whole", with_supervisor(station.automaton)))


# With one pair left there is one way to go until the next engine comes: no other plan is as good.
ONE_LEFT = {"bolts[bolt_pair_1]": "placed", "bolts[bolt_pair_2]": "tightened", "bolts[bolt_pair_3]": "tightened"}
Happened = tuple[float, State, tuple[str, ...]]


@pytest.fixture(scope="module")
def reference(meant: Usable) -> list[Happened]:
    """The states of the station as they follow one another, and what starts in each, before the engine is ready."""
    simulation = DraftSimulation(meant, ONE_LEFT, goes_back=False)
    found: list[Happened] = [(0.0, simulation.present, ())]
    while not any(name == "engine.next_engine" for name in found[-1][2]):
        (moment,), _ = simulation.go_on(60.0, Budget.seconds(600), once=True)
        found.append((moment.seconds, simulation.present, moment.started))
    return [each for each in found if each[0] < found[-1][0]]


def _run(meant: Usable, *steps: ScenarioStep) -> bool:
    scenario = Scenario("law", "Law", NOWHERE, ONE_LEFT, False, (), steps)
    return ScenarioRunner(meant, scenario, Budget.seconds(600)).run().failure is None


@given(data=st.data())
def test_a_condition_is_found_where_it_comes_to_hold_in_time(
    data: st.DataObject, meant: Usable, reference: list[Happened]
) -> None:
    name = data.draw(st.sampled_from(list(meant.automaton.variables)))
    value = data.draw(st.sampled_from(list(meant.automaton.variables[name].type.domain)))
    seconds = data.draw(st.sampled_from([0.0, *(round(at, 1) for at, _, _ in reference)]))
    text = f"{name} == {str(value).lower() if isinstance(value, bool) else value}"
    condition = ScenarioCondition(text, NOWHERE, meant.automaton.read_condition(text))
    # At once is before anything happens; and else what happens at the last moment counts.
    comes = any((at <= seconds + 0.01 if seconds else at == 0) and state[name] == value for at, state, _ in reference)
    assert _run(meant, ScenarioStep(NOWHERE, holds=condition, within=seconds)) is comes


@given(data=st.data())
def test_starts_are_found_in_the_order_in_which_they_happen(
    data: st.DataObject, meant: Usable, reference: list[Happened]
) -> None:
    happened = [name for _, _, started in reference for name in started]
    wanted = data.draw(st.lists(st.sampled_from(sorted({*happened, "robot.move_to_previous"})), min_size=1, max_size=4))
    rest = iter(happened)
    comes = all(any(each == name for each in rest) for name in wanted)
    seconds = reference[-1][0]
    step = ScenarioStep(NOWHERE, starts=tuple((name, frozenset({name})) for name in wanted), within=seconds)
    assert _run(meant, step) is comes
