"""Pipelines of a draft run on their own: examples, what somebody tries, and examples made of what a station heard."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import JsonValue

from sequence_planner.controller.io.monitor import record_view
from sequence_planner.core.clock import Timestamp
from sequence_planner.editor.draft import AddEntry, SetEntry
from sequence_planner.editor.pipelines.examples import recorded, run_examples, run_trial
from sequence_planner.editor.pipelines.graph import DraftPipelines
from sequence_planner.editor.pipelines.schemas import Examples, Recording, RunsView, Trial, TrialStep
from sequence_planner.model.paths import EditError
from sequence_planner.pipelines.runtime import RunningPipelines
from support.examples import examples as so_many

from .drafts import REACH, edited, files_of, graph_of, prepared, shipped

ROBOT, STATE, SCENE, COMMAND = "resources/robot.yaml", "/robot/state", "/robot/scene", "/robot/command"
HOLDING = "robot.holding"
EXAMPLES = ["topics", STATE, "examples"]


def examples(graph: DraftPipelines, pipeline: str, name: str | None = None) -> RunsView:
    return run_examples(1, graph, Examples(pipeline=pipeline, name=name))


def tried(pipeline: str, *steps: TrialStep) -> RunsView:
    return run_trial(1, shipped(REACH), Trial(pipeline=pipeline, steps=list(steps)))


def test_the_examples_of_the_draft_hold() -> None:
    for id_, view in shipped(REACH).pipelines.items():
        runs = examples(shipped(REACH), id_).runs
        assert [(run.name, run.passed) for run in runs] == [(each.name, True) for each in view.examples]


def test_a_wrong_example_says_what_came_and_where_it_stands() -> None:
    edit = SetEntry(file=ROBOT, path=[*EXAMPLES, 0, "gives", "pose"], was="home", value="out")
    graph = graph_of(edited(files_of(REACH), edit))
    (run,) = examples(graph, STATE, "at home").runs
    assert (run.passed, run.refused) == (False, None)
    values = {value.name: value for value in run.steps[0].values}
    assert (values["pose"].came, values["pose"].expected, values["pose"].right) == ("home", "out", False)
    assert (values["load"].right, values["mode"].right) == (True, None)
    (finding,) = run.findings
    assert finding.message == "expected `pose` to be out, and it is home"
    lines = graph.sketch.documents[ROBOT].places
    assert finding.line == lines[(*EXAMPLES, 0, "gives", "pose")].line
    assert run.place is not None
    assert run.place.path == [*EXAMPLES, 0]


def test_what_is_given_wrongly_is_refused() -> None:
    edit = SetEntry(file=ROBOT, path=[*EXAMPLES, 0, "given"], was=given_at_home(), value={"joint": 3})
    (run,) = examples(graph_of(edited(files_of(REACH), edit)), STATE, "at home").runs
    assert run.passed is False
    assert "joint" in (run.refused or "")
    with pytest.raises(EditError, match="did you mean"):
        examples(shipped(REACH), STATE, "at hom")


def given_at_home() -> JsonValue:
    written = shipped(REACH).pipelines[STATE].examples[0].written
    assert isinstance(written, dict)
    return written["given"]


def test_a_message_is_followed_from_stage_to_stage() -> None:
    (run,) = tried(STATE, TrialStep(given={"joints": [0.0, 0.0], "force": 30.0})).runs
    assert (run.passed, run.refused) == (None, None)
    edges = run.steps[0].edges
    assert [edge.id for edge in edges] == [edge.id for edge in shipped(REACH).pipelines[STATE].edges]
    assert "pose" not in (edges[0].last or {})
    assert (edges[1].last or {})["pose"] == "home"
    assert (edges[3].last or {})["load"] == "heavy"
    came = {value.name: value.came for value in run.steps[0].values}
    assert (came["pose"], came["mode"]) == ("home", "idle")


def test_time_passes_in_a_trial() -> None:
    steps = [TrialStep(at=0, given={"force": 0.0}), TrialStep(at=1, given={"force": 30.0}), TrialStep(at=1.2)]
    (run,) = tried(STATE, *steps).runs
    loads = [{value.name: value.came for value in step.values}["load"] for step in run.steps]
    assert loads == ["none", "none", "heavy"]
    assert "order of time" in (tried(STATE, steps[1], steps[0]).runs[0].refused or "")


def test_variables_are_tried_on_the_way_out() -> None:
    (run,) = tried(COMMAND, TrialStep(given={"goto": "out", "gripper": "part"})).runs
    came = {value.name: value.came for value in run.steps[0].values}
    assert (came["joints"], came["speed"]) == ([1.0, 0.5], 0.5)
    assert "ranges over" in (tried(COMMAND, TrialStep(given={"goto": "moon"})).runs[0].refused or "")


def test_what_is_wrong_cannot_be_run() -> None:
    edit = SetEntry(file=ROBOT, path=["topics", STATE, "pipeline", 4, "match", "field"], was="program", value="force")
    graph = graph_of(edited(files_of(REACH), edit))
    assert "only texts are matched" in (examples(graph, STATE).obstacle or "")
    assert (examples(graph, HOLDING).obstacle, examples(graph, HOLDING).runs) == (
        "what stands before it cannot be used",
        [],
    )
    assert examples(graph, SCENE).runs[0].passed


MESSAGES = st.fixed_dictionaries(
    {},
    optional={
        "joints": st.sampled_from([[0.0, 0.0], [1.0, 0.5], [0.5, 0.2], [float("nan"), 0.0]]),
        "force": st.floats(-5, 40, width=32) | st.just(float("inf")),
        "mode": st.integers(0, 4),
        "program": st.sampled_from(["", "assembly_7", "other", "é: 'x'"]),
    },
)


@so_many(60)
@given(st.lists(MESSAGES, min_size=1, max_size=4))
def test_what_is_recorded_holds_in_the_draft(messages: list[dict[str, object]]) -> None:
    """Whatever was heard before it, the example passes, and expects nothing that the station has not had."""
    graph = shipped(REACH)
    registry, type_name = graph.sketch.registry, "reach_msgs/msg/RobotState"
    running = RunningPipelines(graph.sketch.built.pipelines)
    for moment, message in enumerate(messages):
        running.take(STATE, registry.decode(type_name, registry.encode(type_name, message)), moment * 0.05)
    record = record_view(running.observed()[STATE], Timestamp(1000.0, 1.0))
    assert record is not None
    try:
        made = recorded(graph, Recording(pipeline=STATE, name="heard", first=record.first, last=record.last))
    except EditError as error:
        assert "is not finite" in str(error)
        assert not all(math.isfinite(each) for each in numbers_in(messages[-1]))
        return
    edit = AddEntry(file=made.file, path=[*made.path, 0], value=made.example)
    after = graph_of(edited(files_of(REACH), edit))
    (run,) = examples(after, STATE, "heard").runs
    assert run.passed, run
    station = running.values({STATE: True, SCENE: True})
    gives = made.example["gives"]
    assert isinstance(gives, dict)
    assert all(station[f"robot.{name}"] == value for name, value in gives.items())
    assert {*gives, *(each.name for each in made.left_out)} == {end.field for end in graph.pipelines[STATE].ends}


def numbers_in(message: dict[str, object]) -> list[float]:
    joints, force = message.get("joints", []), message.get("force", 0.0)
    assert isinstance(joints, list)
    assert isinstance(force, float)
    return [*joints, force]


def test_an_example_of_what_was_said_and_of_a_flow(tmp_path: Path) -> None:
    graph = shipped(REACH)
    ready = prepared(files_of(REACH), tmp_path)
    running = RunningPipelines(ready.pipelines)
    registry = ready.registry
    for topic, type_name, message in (
        (STATE, "reach_msgs/msg/RobotState", {"force": 3.0}),
        (SCENE, "reach_msgs/msg/Scene", {"attached": ["part"], "switches": [True, True]}),
    ):
        running.take(topic, registry.decode(type_name, registry.encode(type_name, message)), 0.0)
    record = record_view(running.observed()[HOLDING], Timestamp.now())
    assert record is not None
    made = recorded(graph, Recording(pipeline=HOLDING, name="held", first=record.first, last=record.last))
    assert made.example["gives"] == {"holds_part": True}
    said: dict[str, JsonValue] = {"goto": "out", "load": "heavy", "door_closed": True}
    out = recorded(graph, Recording(pipeline=COMMAND, name="said", first=said, last={"joints": [1.0, 0.5], "speed": 1}))
    assert out.example["given"] == said
    assert out.example["gives"] == {"joints": [1.0, 0.5]}
    assert [each.name for each in out.left_out] == ["speed"]
    with pytest.raises(EditError, match="already"):
        recorded(graph, Recording(pipeline=STATE, name="at home", first={}, last={}))
