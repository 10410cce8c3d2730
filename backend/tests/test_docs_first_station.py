"""The tutorial in the browser says what the model of this repository has: its conditions, pipelines and guard."""

from __future__ import annotations

import re

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.model.yaml.reader import read_text
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import Supervision
from sequence_planner.synthesis.transition_relation import Plant
from support.places import DOCS, SINGLE_BOLT

TEXT = (DOCS / "first-station.md").read_text(encoding="utf-8")
PROSE = re.sub(r"^```.*?^```$", "", TEXT, flags=re.MULTILINE | re.DOTALL)
BLOCKS = re.findall(r"^```(\w+) ?(.*)\n((?:.*\n)*?)```$", TEXT, re.MULTILINE)


def written() -> str:
    """All that the files of the model say, in one line."""
    files = (path.read_text(encoding="utf-8") for path in sorted(SINGLE_BOLT.rglob("*.*")) if path.is_file())
    return " ".join(" ".join(files).split())


def test_what_is_to_be_written_is_in_the_model() -> None:
    model = written()
    shown = [
        *re.findall(r"`([^`]* (?:==|:=|!=) [^`]*)`", PROSE),
        *re.findall(r"`((?:bool|string|float64)\S* \w+)`", PROSE),
    ]
    assert len(shown) >= 20
    assert [each for each in shown if " ".join(each.split()) not in model] == []


def test_the_pipelines_are_those_of_the_model() -> None:
    pipelines = [content for kind, label, content in BLOCKS if label.startswith("pipeline of ")]
    assert len(pipelines) == 2
    assert "*poses" in pipelines[1]
    text = "".join(f"{place}:\n{pipeline}" for place, pipeline in zip("ab", pipelines, strict=True))
    robot = read_text((SINGLE_BOLT / "resources" / "robot.yaml").read_text(encoding="utf-8"), "robot.yaml").content
    assert isinstance(robot, dict)
    topics = robot["topics"]
    expected = {"a": topics["/robot/state"]["pipeline"], "b": topics["/robot/command"]["pipeline"]}
    assert read_text(text, "first-station.md").content == expected


def test_the_guard_shown_is_the_one_that_is_added() -> None:
    ((ability, shown),) = ((label, content) for kind, label, content in BLOCKS if kind == "guard")
    automaton: Automaton = prepare_station(SINGLE_BOLT).automaton
    supervision = Supervision(Plant(automaton, tuple(automaton.variables)))
    reached = supervision.reachable(supervised=True)
    guard = supervision.plant.where(automaton.read_condition(shown.strip()))
    allowed, disallowed = (reached & states for states in supervision.guard(ability))
    assert (allowed | disallowed).satisfiable()
    assert allowed == (allowed | disallowed) & guard
