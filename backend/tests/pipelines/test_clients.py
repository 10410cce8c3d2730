"""Services and actions in documents: what they become, the variables that follow, and what is found wrong with them."""

from __future__ import annotations

from pathlib import Path

import pytest

from pipelines.station_writing import write_station
from sequence_planner.analysis.checks.connections import check_connections
from sequence_planner.automaton.automaton import Kind
from sequence_planner.cli.loading import load_model
from sequence_planner.model.source import ModelError
from sequence_planner.pipelines.graph import GoalState
from sequence_planner.station import ReadyStation, prepare_station
from support.places import TESTS

TANK = """\
services:
  /tank/level:
    type: tank_msgs/srv/Level
    every: 0.5
  /tank/flush:
    type: std_srvs/srv/Trigger
    when: flush
    ignore: [message]
    response:
      - rename: {success: flushed}
actions:
  /tank/stir:
    type: tank_msgs/action/Stir
    when: stir
    status: stirring
    goal:
      - undiscretise: {variable: pace, field: speed, values: {slow: [0.5], fast: [2.0]}}
    feedback:
      - discretise: {field: turned, variable: mixture, ranges: {separate: [null, 3.0], mixed: [3.0, null]}}
measured:
  mixture: {type: mixture}
output:
  pace: {type: pace}
"""
ENUMERATIONS = "mixture: [separate, mixed]\npace: [slow, fast]"


def written(folder: Path, tank: str = TANK) -> Path:
    station = write_station(folder, tank, {}, ENUMERATIONS)
    for kind, name, fields in (
        ("srv", "Level", "string tank\n---\nuint8 level\nbool open\n"),
        ("action", "Stir", "float64[1] speed\n---\nuint8 turns\n---\nfloat64 turned\n"),
    ):
        (station / "messages" / "tank_msgs" / kind).mkdir()
        (station / "messages" / "tank_msgs" / kind / f"{name}.{kind}").write_text(fields, encoding="utf-8")
    return station


def ready(folder: Path) -> ReadyStation:
    return prepare_station(written(folder))


def test_variables_follow_from_requests_and_answers(tmp_path: Path) -> None:
    station = ready(tmp_path)
    variables = station.automaton.variables
    kinds = {name: (each.kind, str(each.type)) for name, each in variables.items() if each.resource == "tank"}
    assert kinds == {
        "tank.level": (Kind.MEASURED, "0..255"),
        "tank.open": (Kind.MEASURED, "bool"),
        "tank.flushed": (Kind.MEASURED, "bool"),
        "tank.turns": (Kind.MEASURED, "0..255"),
        "tank.mixture": (Kind.MEASURED, "{separate, mixed}"),
        "tank.stirring": (Kind.MEASURED, f"{{{', '.join(GoalState)}}}"),
        "tank.flush": (Kind.OUTPUT, "bool"),
        "tank.stir": (Kind.OUTPUT, "bool"),
        "tank.pace": (Kind.OUTPUT, "{slow, fast}"),
    }
    feeds = {name: fed for name, fed in station.pipelines.feeds.items() if name.startswith("tank.")}
    assert feeds == {
        "tank.level": "/tank/level response",
        "tank.open": "/tank/level response",
        "tank.flushed": "/tank/flush response",
        "tank.turns": "/tank/stir result",
        "tank.mixture": "/tank/stir feedback",
        "tank.stirring": "/tank/stir status",
    }
    assert {"tank.flush", "tank.stir", "tank.pace"} <= station.pipelines.carried
    assert not {"/tank/level response", "/tank/stir goal"} & {*station.pipelines.incoming, *station.pipelines.outgoing}


def test_check_takes_answers_and_requests_for_connections(tmp_path: Path) -> None:
    model = load_model(written(tmp_path))
    assert model.connections is not None
    kinds = {
        (warning.kind, warning.message.split("`")[1])
        for warning in check_connections(model.automaton, model.connections)
    }
    assert not {kind for kind, _ in kinds} & {"nothing-feeds", "carried-nowhere"}


def test_a_flow_can_come_of_an_answer(tmp_path: Path) -> None:
    flow = """\
flows:
  both:
    from: {level: /tank/level response, stir: /tank/stir result}
    pipeline:
      - expression: {full: "level.open and level.level > 3 and stir.turns > 0"}
"""
    tank = flow + TANK.replace("measured:\n", "measured:\n  full: {type: bool}\n")
    assert prepare_station(written(tmp_path, tank)).pipelines.feeds["tank.full"] == "tank.both"


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        (
            "tank_msgs/srv/Level",
            "tank_msgs/srv/Levle",
            "3:11: no service type `tank_msgs/srv/Levle` is known; did you mean",
        ),
        (
            "tank_msgs/action/Stir",
            "tank_msgs/action/Sir",
            "13:11: no action type `tank_msgs/action/Sir` is known; did you mean",
        ),
        ("    every: 0.5\n", "", "say when the service is called"),
        ("[message]", "[mesage]", "8:14: the service has no field `mesage`; did you mean `message`?"),
        (
            "when: stir",
            "when: pace",
            "14:11: `when` is an output of type bool, and `tank.pace` is an output variable of type {",
        ),
        (
            "when: stir",
            "when: mixture",
            "14:11: `when` is an output of type bool, and `tank.mixture` is a measured variable of type",
        ),
        ("status: stirring", "status: mixture", "15:13: `tank.mixture` says what has become of a goal: "),
        (
            "status: stirring",
            "status: pace",
            "15:13: `status` is a measured variable, and `tank.pace` is an output variable",
        ),
        ("/tank/stir:", "/tank stir:", "12:3: "),
        ("rename: {success: flushed}", "rename: {succes: flushed}", "`/tank/flush response` → stage 1 `rename`: "),
        ("field: turned", "field: turnt", "`/tank/stir feedback` → stage 1 `discretise`: "),
        ("[0.5]", "[0.5, 1.0]", "`/tank/stir goal` → stage 1 `undiscretise`"),
    ],
)
def test_what_is_wrong_is_found_with_its_place(tmp_path: Path, old: str, new: str, told: str) -> None:
    assert old in TANK
    with pytest.raises(ModelError) as caught:
        prepare_station(written(tmp_path, TANK.replace(old, new)))
    assert told in str(caught.value)


def test_the_page_shows_the_mixer() -> None:
    """What the page about pipelines shows is part of a station that is run by tests."""
    tests = TESTS
    page = (tests.parents[1] / "docs" / "pipelines.md").read_text(encoding="utf-8")
    shown = page.split("## Services and actions")[1].split("```yaml\n")[1].split("```")[0]
    assert shown in (tests / "stations" / "mixer" / "resources" / "tank.yaml").read_text(encoding="utf-8")
