"""The graph of a draft: as the builder has it where it is sound, and as far as it goes where something is wrong."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given, reject
from hypothesis import strategies as st

from sequence_planner.analysis.report import FindingDocument
from sequence_planner.automaton.grounding.station import ground
from sequence_planner.editor.draft import AddEntry, MoveEntry, RemoveEntry, SetEntry, WriteText
from sequence_planner.editor.pipelines.graph import DraftPipelines, with_live_edges
from sequence_planner.editor.pipelines.reader import STATION, DraftReader
from sequence_planner.editor.pipelines.schemas import DraftPipelineView, Soundness
from sequence_planner.model.files import write_files
from sequence_planner.model.loader import load_station
from sequence_planner.model.paths import EditError
from sequence_planner.model.source import Finding, ModelError
from sequence_planner.model.yaml.content import content_at
from sequence_planner.pipelines.builder import build_pipelines, load_messages
from sequence_planner.pipelines.graph import StationPipelines
from sequence_planner.pipelines.inference import with_inferred_variables
from support.examples import examples
from support.told import as_message

from .drafts import MODELS, REACH, edited, files_of, graph_of, prepared, shipped

ROBOT, STATE, COMMAND, HOLDING = "resources/robot.yaml", "/robot/state", "/robot/command", "robot.holding"
STAGES = ("topics", STATE, "pipeline")
TICK = AddEntry(file=ROBOT, path=[*STAGES, 0], before=1, value={"tick": {"every": 1.0}})


def built(pipelines: StationPipelines) -> dict[str, list[dict[str, str]]]:
    """The types of the fields on all edges."""
    nodes = [(node.name, node.chain) for node in pipelines.nodes]
    out = (*pipelines.outgoing.items(), *pipelines.requests.items())
    return {
        name: [{field: str(type_) for field, type_ in fields.items()} for fields in chain.fields]
        for name, chain in (*nodes, *((name, each.chain) for name, each in out))
    }


def all_parts(view: DraftPipelineView) -> list[str]:
    return [view.id, *(stage.id for stage in view.stages), *(edge.id for edge in view.edges)]


@pytest.mark.parametrize("name", [*MODELS, REACH])
def test_every_edge_has_the_types_that_run(name: str, tmp_path: Path) -> None:
    graph = shipped(name)
    ready = prepared(files_of(name), tmp_path)
    assert {id_: [edge.fields for edge in view.edges] for id_, view in graph.pipelines.items()} == built(
        ready.pipelines
    )
    feeds = {variable.name: variable.fed for variable in graph.variables if variable.fed is not None}
    assert feeds == dict(ready.pipelines.feeds)
    assert {variable.name for variable in graph.variables} <= set(ready.automaton.variables)
    for view in graph.pipelines.values():
        assert (view.standing, view.findings) == (Soundness.GOOD, [])
        assert all(type_ in graph.types for edge in view.edges for type_ in (edge.fields or {}).values())
    assert graph.findings == []
    named = [part for view in graph.pipelines.values() for part in all_parts(view)]
    assert len(named) == len(set(named))


def test_a_flow_names_its_sources_and_these_what_reads_them() -> None:
    pipelines = shipped(REACH).pipelines
    flow = pipelines[HOLDING]
    assert list(pipelines)[-1] == HOLDING
    assert (flow.role, flow.joining, [end.becomes for end in flow.ends]) == ("flow", "merge", ["robot.holds_part"])
    assert [(each.alias, each.written, each.pipeline) for each in flow.sources] == [
        ("robot", STATE, STATE),
        ("scene", "/robot/scene", "/robot/scene"),
    ]
    assert flow.sources[0].place.path == ["flows", "holding", "from", "robot"]
    assert pipelines[STATE].readers == [HOLDING]
    assert [each.name for each in flow.examples] == ["a part without weight"]


def test_a_stage_that_follows_from_the_message_is_shown_and_belongs_to_nobody() -> None:
    stages = shipped(REACH).pipelines[STATE].stages
    assert [stage.kind for stage in stages[:2]] == ["discretise", "remember"]
    assert (stages[-1].kind, stages[-1].place, stages[-1].written) == ("map", None, None)


def test_what_is_shown_can_be_edited_by_what_is_shown() -> None:
    files = files_of(REACH)
    for view in shipped(REACH).pipelines.values():
        for stage in (each for each in view.stages if each.place is not None):
            assert stage.place is not None
            edit = RemoveEntry(file=stage.place.file, path=stage.place.path, was=stage.written)
            try:
                assert edited(files, edit) != files
            except EditError as error:
                assert "the anchor in line 11" in str(error)  # two stages share their points
        for source in view.sources:
            edit_source = SetEntry(file=view.place.file, path=source.place.path, was=source.written, value="/x")
            assert edited(files, edit_source) != files


def test_ids_stay_when_others_come_and_go_and_move() -> None:
    files = files_of(REACH)
    before = shipped(REACH).pipelines[STATE]
    inserted = graph_of(edited(files, TICK)).pipelines[STATE]
    assert set(all_parts(before)) < set(all_parts(inserted))
    first = before.stages[3]
    assert first.place is not None
    moved = MoveEntry(file=ROBOT, path=first.place.path, was=first.written, after=4)
    assert set(all_parts(graph_of(edited(files, moved)).pipelines[STATE])) == set(all_parts(before))


def test_what_is_not_changed_is_found_again_in_what_runs() -> None:
    running = shipped(REACH).pipelines
    drawn = with_live_edges(graph_of(edited(files_of(REACH), TICK)).pipelines, running)
    live = [edge.live for edge in drawn[STATE].edges]
    assert [None if each is None else (each.edge, each.same) for each in live[:5]] == [
        (0, True),
        (1, True),
        None,
        (2, False),
        (3, False),
    ]
    assert [each.live.same for each in drawn[HOLDING].edges if each.live] == [False, False]
    assert all(edge.live and edge.live.same for edge in drawn[COMMAND].edges)
    assert with_live_edges(running, {})[STATE].edges[0].live is None


def test_a_stage_of_a_wrong_type_keeps_what_stands_before_it() -> None:
    wrong = SetEntry(file=ROBOT, path=[*STAGES, 4, "match", "field"], was="program", value="force")
    graph = graph_of(edited(files_of(REACH), wrong))
    view = graph.pipelines[STATE]
    standings = [stage.standing for stage in view.stages]
    assert standings == [Soundness.GOOD] * 4 + [Soundness.WRONG] + [Soundness.UNKNOWN] * 2
    assert "only texts are matched" in view.stages[4].findings[0].message
    assert [edge.fields is None for edge in view.edges] == [False] * 5 + [True] * 3
    assert view.standing is Soundness.WRONG
    flow = graph.pipelines[HOLDING]
    assert (flow.sources[0].pipeline, flow.edges[0].fields) == (STATE, None)
    assert graph.pipelines["/robot/scene"].standing is Soundness.GOOD


@pytest.mark.parametrize(
    ("path", "was", "value", "said"),
    [
        ([*STAGES, 3], {"debounce": {"fields": ["load"], "seconds": 0.1}}, {"debounce": {}}, "`fields` is missing"),
        ([*STAGES, 3], {"debounce": {"fields": ["load"], "seconds": 0.1}}, {"shake": 1}, "`shake` is not known"),
        ([*STAGES, 3], {"debounce": {"fields": ["load"], "seconds": 0.1}}, 7, "expected"),
    ],
)
def test_what_is_no_stage_keeps_what_stands_before_it(
    path: list[str | int], was: object, value: object, said: str
) -> None:
    edit = SetEntry.model_validate({"file": ROBOT, "path": path, "was": was, "value": value})
    view = graph_of(edited(files_of(REACH), edit)).pipelines[STATE]
    assert [stage.standing for stage in view.stages][:5] == [Soundness.GOOD] * 3 + [Soundness.WRONG, Soundness.UNKNOWN]
    assert said in view.stages[3].findings[0].message
    assert view.edges[3].fields is not None
    assert view.edges[4].fields is None


def test_an_unknown_type_and_an_unknown_source_are_told_where_they_stand() -> None:
    files = edited(
        files_of(REACH),
        SetEntry(file=ROBOT, path=["topics", STATE, "type"], was="reach_msgs/msg/RobotState", value="no_msgs/msg/X"),
        SetEntry(file=ROBOT, path=["flows", "holding", "from", "scene"], was="/robot/scene", value="/robot/scent"),
    )
    pipelines = graph_of(files).pipelines
    assert "no message type" in pipelines[STATE].findings[0].message
    assert [stage.standing for stage in pipelines[STATE].stages] == [Soundness.UNKNOWN] * 7
    first, second = pipelines[HOLDING].sources
    assert (first.pipeline, first.findings) == (STATE, [])
    assert second.pipeline is None
    assert "did you mean `/robot/scene`" in second.findings[0].message


def test_a_file_that_cannot_be_read_is_shown_as_it_was(tmp_path: Path) -> None:
    reader, files = DraftReader(tmp_path), files_of(REACH)
    before = DraftPipelines(reader.sketch(files))
    broken = WriteText(file=ROBOT, was=files[ROBOT], text=files[ROBOT] + "]")
    after = DraftPipelines(reader.sketch(edited(files, broken)))
    assert after.sketch.unread == (ROBOT,)
    assert "not YAML" in after.findings[0].message
    assert after.pipelines == before.pipelines


def test_one_topic_in_two_resources_is_shown_twice() -> None:
    arm = WriteText(
        file="resources/arm.yaml", was=None, text=f"topics:\n  {STATE}: {{type: std_msgs/msg/Bool, direction: in}}\n"
    )
    pipelines = graph_of(edited(files_of(REACH), arm)).pipelines
    assert pipelines[STATE].resource == "arm"
    assert "a topic belongs to one resource" in pipelines[f"robot {STATE}"].findings[0].message


JUNK: st.SearchStrategy[object] = st.sampled_from(
    [None, 7, "x", [], {}, {"map": {}}, {"filter": "no_such_field"}, {"tick": {"every": -1}}, [[]]]
)


@st.composite
def broken(draw: st.DrawFn) -> tuple[dict[str, str], str, str]:
    """The files of a station of which some entry is junk, and the pipeline around it."""
    name = draw(st.sampled_from([REACH, *MODELS[:3]]))
    files = files_of(name)
    view = draw(st.sampled_from(list(shipped(name).pipelines.values())))
    document = shipped(name).sketch.documents[view.place.file]
    start = tuple(view.place.path)
    inside = [path for path in document.places if path[:2] == start and len(path) > 2]
    path = draw(st.sampled_from(inside))
    was = content_at(document.content, path)
    edit = SetEntry.model_validate({"file": view.place.file, "path": list(path), "was": was, "value": draw(JUNK)})
    try:
        return edited(files, edit), name, view.id
    except EditError:  # an anchor shares it
        reject()


@examples(100)
@given(broken())
def test_no_junk_makes_the_graph_empty(drawn: tuple[dict[str, str], str, str]) -> None:
    """What the checker refuses is said by the graph too, and what is elsewhere stays."""
    files, name, wrong = drawn
    graph = graph_of(files)
    before = shipped(name).pipelines
    assert set(graph.pipelines) >= set(before) - {wrong}
    behind = {wrong}
    for id_, view in before.items():
        if any(source.pipeline in behind for source in view.sources):
            behind.add(id_)
    for id_, view in before.items():
        if id_ not in behind and view.resource != before[wrong].resource:
            assert [edge.fields for edge in graph.pipelines[id_].edges] == [edge.fields for edge in view.edges]
    told = {each.message for each in (*graph.findings, *(e for v in graph.pipelines.values() for e in findings_in(v)))}
    with TemporaryDirectory() as folder:
        assert {each.message.replace(f"{folder}/", "") for each in refused(files, Path(folder))} <= told


def refused(files: dict[str, str], folder: Path) -> list[Finding]:
    """What the checker finds first that has to do with pipelines."""
    write_files(files, folder)
    try:
        station = load_station(folder)
        registry = load_messages(station)
        inferred = with_inferred_variables(station, registry)
    except ModelError as error:
        return error.findings
    try:
        automaton = ground(inferred)
    except ModelError:  # a guard misses a variable: not what is asked here
        return []
    try:
        build_pipelines(inferred, automaton, registry)
    except ModelError as error:
        return error.findings
    return []


def findings_in(view: DraftPipelineView) -> list[FindingDocument]:
    return [
        *view.findings,
        *(each for stage in view.stages for each in stage.findings),
        *(each for source in view.sources for each in source.findings),
    ]


def test_of_a_station_that_could_never_be_read_its_resources_are_shown(tmp_path: Path) -> None:
    files = files_of(REACH)
    broken = WriteText(file=STATION, was=files[STATION], text=files[STATION] + "]")
    shown = DraftPipelines(DraftReader(tmp_path).sketch(edited(files, broken)))
    assert shown.sketch.unread == (STATION,)
    (said,) = (each.message for each in shown.sketch.findings if each.place.file == STATION)
    assert as_message(said).id == "wrong.yaml"
    assert shown.pipelines.keys() == graph_of(files).pipelines.keys()
