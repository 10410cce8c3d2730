"""The trace of a variable: which fields tell it, what each stage made of them, who reads it, and what changed since."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from controller.test_commander import Wire
from pipelines.station_writing import station_with
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.queries import AskTrace
from sequence_planner.controller.io.inputs import Inputs
from sequence_planner.controller.io.outputs import Outputs
from sequence_planner.controller.tracing.passage import Passages
from sequence_planner.controller.tracing.schemas import TracedPipelineView, TraceView
from sequence_planner.core.clock import Timestamp
from sequence_planner.ros.transport import Sample
from sequence_planner.station import ReadyStation
from support.cell import COMMAND, STATE, Arm, Bench, bench

FIELDS = {
    "Scene": "string[] objects\nbool moving\n",
    "Arm": "float64 force\nbool moving\ngeometry_msgs/Pose pose\n",
}
GRIPPED = """
topics:
  /scene: {type: tank_msgs/msg/Scene, direction: in, ignore: [moving]}
  /left: {type: tank_msgs/msg/Arm, direction: in, ignore: [moving]}
  /order:
    type: std_msgs/msg/Bool
    direction: out
    pipeline:
      - limit: {every: 0.5}
      - rename: {data: wanted}
flows:
  gripped:
    from: {scene: /scene, arm: /left}
    pipeline:
      - member: {field: scene.objects, item: tool, variable: attached}
      - expression: {holds: "attached and arm.force > 2.5", high: arm.pose.position.z > 1}
  surely:
    from: gripped
    pipeline:
      - filter: holds
      - expression: {sure: holds and high}
measured:
  attached: {type: bool}
  holds: {type: bool}
  sure: {type: bool}
output:
  wanted: {type: bool, initial: false}
"""

Passing = tuple[ReadyStation, Inputs, Outputs, Passages]


@pytest.fixture
def passing(tmp_path: Path) -> Passing:
    station = station_with(tmp_path, GRIPPED, FIELDS)
    inputs = Inputs(station.pipelines, station.registry)
    outputs = Outputs(station.pipelines.outgoing, station.registry, Wire())
    return station, inputs, outputs, Passages(station.pipelines, inputs, outputs)


def hear(passing: Passing, topic: str, at: float, **fields: object) -> None:
    station, inputs, _, _ = passing
    type_name = station.pipelines.incoming[topic].topic.type_name
    inputs.take([Sample(topic, station.registry.encode(type_name, fields), at)])


def way(passing: Passing, name: str, now: float = 20.0) -> list[TracedPipelineView]:
    _, inputs, outputs, passages = passing
    moment = Timestamp(1000.0 + now, now)
    observed = inputs.observed() | outputs.observed()
    return [*passages.incoming(name, observed, moment), *passages.outgoing(name, observed, moment)]


def steps(pipeline: TracedPipelineView) -> list[tuple[str | None, bool, dict[str, object] | None]]:
    return [(step.kind, step.passes, None if step.fields is None else dict(step.fields)) for step in pipeline.steps]


def test_before_anything_was_heard_that_is_said(passing: Passing) -> None:
    scene, left, gripped = way(passing, "tank.holds")
    assert (scene.name, scene.role, scene.last, scene.fresh) == ("/scene", "incoming", None, False)
    assert (left.name, gripped.name, gripped.sources) == ("/left", "tank.gripped", ["/scene", "/left"])
    assert [step.fields for step in gripped.steps] == [None, None, None]
    assert gripped.becomes == {"holds": "tank.holds"}


def test_each_step_has_the_fields_from_which_the_variable_comes(passing: Passing) -> None:
    hear(passing, "/scene", 10.0, objects=["tool"], moving=True)
    hear(passing, "/left", 12.0, force=3.0, moving=True)
    scene, left, gripped = way(passing, "tank.holds")
    assert (scene.last, scene.fresh, left.last) == (1010.0, True, 1012.0)
    assert steps(scene) == [(None, False, {"objects": ["tool"]})]
    assert steps(left) == [(None, False, {"force": 3.0, "pose.position.z": 0.0})], "all that the last stage reads"
    assert steps(gripped) == [
        (None, False, {"scene.objects": ["tool"], "arm.force": 3.0, "arm.pose.position.z": 0.0}),
        ("member", False, {"attached": True}),
        ("expression", False, {"holds": True}),
    ]
    assert [step.at for step in gripped.steps] == [1012.0] * 3
    (_, _, told) = way(passing, "tank.attached")
    assert steps(told)[2] == ("expression", True, {"attached": True}), "what does not bear on it lets it pass"


def test_a_flow_comes_behind_its_sources_and_says_what_it_holds(passing: Passing) -> None:
    hear(passing, "/scene", 10.0, objects=[])
    hear(passing, "/left", 12.0, force=3.0)
    *_, gripped, surely = way(passing, "tank.sure")
    assert gripped.becomes == {}
    assert steps(gripped)[-1][2] == {"holds": False, "high": False}
    (first, held, last) = surely.steps
    assert first.fields == {"holds": False, "high": False}
    assert (held.kind, held.held, held.fields, last.fields) == ("filter", 1, None, None)


def test_an_output_goes_down_to_its_message(passing: Passing) -> None:
    station, _, outputs, passages = passing
    state = {**station.automaton.initial_valuation, "tank.wanted": True}
    outputs.publish(state, 15.0)
    (order,) = way(passing, "tank.wanted")
    assert (order.name, order.role, order.last) == ("/order", "outgoing", 1015.0)
    assert steps(order) == [
        (None, False, {"wanted": True}),
        ("limit", True, {"wanted": True}),
        ("rename", False, {"data": True}),
    ]
    assert order.becomes == {"data": "data"}
    assert passages.carrying("tank.holds") == []


def test_time_changes_what_a_timed_stage_stands_before(tmp_path: Path) -> None:
    resource = """
topics:
  /door:
    type: std_msgs/msg/Bool
    direction: in
    pipeline: [debounce: {fields: [data], seconds: 5}, rename: {data: is_open}]
  /lamp: {type: std_msgs/msg/Bool, direction: in, pipeline: [rename: {data: is_lit}]}
measured: {is_open: {type: bool}, is_lit: {type: bool}}
"""
    assert station_with(tmp_path, resource, {}).pipelines.timed == {"tank.is_open"}


async def asked(one: Bench, name: str) -> TraceView:
    answer = await one.controller.answer(AskTrace(name=name))
    assert isinstance(answer, TraceView)
    return answer


def test_a_measured_variable_leads_to_the_starts_and_to_what_was_sent_for_it() -> None:
    async def scenario() -> None:
        async with bench() as one:
            arm = Arm(one.network)
            with arm.saying("home"):
                await one.start()
                await one.until(lambda: "out" in arm.commands)
                trace = await asked(one, "arm.pose")
            assert (trace.value, trace.kind, trace.resource) == ("home", "measured", "arm")
            (state,) = trace.incoming
            assert (state.name, state.becomes, state.fresh) == (STATE, {"pose": "arm.pose"}, True)
            readers = {(each.name, each.part): (each.holds, each.decides) for each in trace.readers}
            assert readers["arm.move(out)", "enabled"] == (False, True), "it is not at its target"
            assert readers["arm.move(out)", "executing"] == (True, True)
            assert readers["arm.move(out)", "finish"] == (False, True)
            (goto,) = [each for each in trace.changes if each.name == "arm.goto"]
            assert (goto.value, goto.by, list(goto.sent)) == ("out", "arm.move(out)", [COMMAND])
            assert goto.sent[COMMAND] is not None
            assert trace.since is not None
            assert goto.same_tick == (goto.since == trace.since)

    asyncio.run(scenario())


def test_an_output_says_who_wrote_it_and_what_was_sent() -> None:
    async def scenario() -> None:
        async with bench() as one:
            arm = Arm(one.network)
            with arm.saying("home"):
                await one.start()
                await one.until(lambda: "out" in arm.commands)
                trace = await asked(one, "arm.goto")
                estimate = await asked(one, "parts[left]")
                with pytest.raises(CommandRefused) as refused:
                    await asked(one, "arm.goal")
            assert (trace.value, trace.written_by, trace.incoming) == ("out", "arm.move(out)", [])
            (command,) = trace.outgoing
            assert command.steps[1].fields == {"joints": [1.0, 0.5]}
            assert [(each.name, each.how) for each in trace.writers] == [("arm.move(home)", "start")]
            assert estimate.belief is not None
            assert (estimate.written_by, estimate.from_beginning, estimate.outgoing) == (None, True, [])
            assert {(each.of, each.name) for each in estimate.readers} == {
                ("operation", "fetch(left)"),
                ("specification", "never"),
            }
            goal = next(each for each in estimate.readers if each.part == "goal")
            assert (goal.holds, goal.decides) == (False, False), "the pose decides"
            assert (refused.value.slug, refused.value.status) == ("unknown-variable", 404)

    asyncio.run(scenario())
