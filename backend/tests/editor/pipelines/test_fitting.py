"""What fits at an edge is what the checker of the whole model accepts there, and nothing else."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.editor.draft import AddEntry, RemoveEntry, SetEntry
from sequence_planner.editor.pipelines.examples import preview
from sequence_planner.editor.pipelines.graph import DraftPipelines
from sequence_planner.editor.pipelines.reader import DraftReader
from sequence_planner.editor.pipelines.schemas import FitsView, Fitting, Preview, PreviewView, StageOfferView
from sequence_planner.editor.pipelines.suggestions import fits
from sequence_planner.model.files import write_files
from sequence_planner.model.paths import EditError
from sequence_planner.model.source import ModelError
from sequence_planner.model.stages.registry import StageDocument
from support.examples import SHARE, examples

from .drafts import MODELS, REACH, edited, files_of, graph_of, prepared, shipped

ROBOT, STATE, COMMAND, HOLDING = "resources/robot.yaml", "/robot/state", "/robot/command", "robot.holding"
EDGES = [
    (name, id_, edge)
    for name in (REACH, *MODELS)
    for id_, view in shipped(name).pipelines.items()
    for edge in range(len(view.edges))
    if view.stages_path is not None and all(stage.written is not None for stage in view.stages[:edge])
]


@cache
def offered(name: str, pipeline: str, edge: int) -> FitsView:
    fields = shipped(name).pipelines[pipeline].edges[edge].fields
    assert fields is not None
    return fits(1, shipped(name), Fitting(pipeline=pipeline, edge=edge, field=next(iter(fields))))


def offer(kind: str, pipeline: str, edge: int, name: str = REACH) -> StageOfferView:
    (found,) = [each for each in offered(name, pipeline, edge).stages if each.kind == kind]
    return found


def wrong(files: dict[str, str]) -> list[str]:
    """What makes a model unusable."""
    with TemporaryDirectory() as folder:
        try:
            prepared(files, Path(folder))
        except ModelError as error:
            return [str(finding) for finding in error.findings]
    return []


@examples(60)
@given(st.sampled_from(EDGES), st.data())
def test_the_checker_accepts_every_stage_that_fits(at: tuple[str, str, int], data: st.DataObject) -> None:
    name, pipeline, edge = at
    found = offered(name, pipeline, edge)
    assert [each.kind for each in found.stages] == list(StageDocument.model_fields)
    chosen = data.draw(st.sampled_from([each for each in found.stages if each.fits]))
    after = edited(files_of(name), *chosen.edits)
    assert wrong(after) == []
    view = graph_of(after).pipelines[pipeline]
    assert (view.stages[edge].kind, view.stages[edge].written) == (chosen.kind, chosen.stage)
    for refused in found.stages:
        assert refused.fits == (refused.reason is None) == bool(refused.edits)


@examples(60)
@given(st.sampled_from(EDGES), st.data())
def test_a_field_may_become_exactly_what_the_checker_lets_it(at: tuple[str, str, int], data: st.DataObject) -> None:
    name, pipeline, edge = at
    view = shipped(name).pipelines[pipeline]
    fields = view.edges[edge].fields
    assert fields is not None
    field = data.draw(st.sampled_from(sorted(fields)))
    targets = fits(1, shipped(name), Fitting(pipeline=pipeline, edge=edge, field=field)).targets
    if not targets:
        return
    target = data.draw(st.sampled_from(targets))
    pair = {target.name: field} if view.role == "outgoing" else {field: target.name}
    assert view.stages_path is not None
    written = sum(stage.written is not None for stage in view.stages)
    edit = AddEntry.model_validate(
        {
            "file": view.place.file,
            "path": [*view.stages_path, edge if edge < written else 0],
            "value": {"rename": pair},
            **({"before": edge} if edge < written else {}),
        }
    )
    refused = wrong(edited(files_of(name), edit))
    if target.fits:
        assert refused == []
    else:  # what becomes of variables is refused here, whether or not anything reads them by now
        assert refused or re.search("would be (no variable|.*, and is)", target.reason or ""), target.reason


@pytest.mark.parametrize(
    ("kind", "pipeline", "edge", "reason"),
    [
        ("undiscretise", STATE, 0, "`undiscretise` is for outgoing topics; use `discretise` here"),
        ("constant", STATE, 0, "`constant` is for outgoing topics: an incoming message has its own values"),
        ("match", COMMAND, 0, "`match` is for incoming topics"),
        ("member", STATE, 0, None),
        ("python", STATE, 0, "no file in the folder `stages` on the server has a function whose parameters"),
        ("match", "/robot/scene", 0, "`attached` is text[], and only texts are matched"),
        ("rename", "/robot/scene", 0, "every variable of the resource is given already: declare one first"),
    ],
)
def test_what_does_not_fit_says_why(kind: str, pipeline: str, edge: int, reason: str | None) -> None:
    found = offer(kind, pipeline, edge)
    assert found.fits == (reason is None)
    assert (reason or "") in (found.reason or "")


@pytest.mark.parametrize("at", EDGES[:: 1 if SHARE >= 1 else 4], ids=str)
def test_reasons_are_in_words_of_our_own_and_about_what_there_is(at: tuple[str, str, int]) -> None:
    for each in offered(*at).stages:
        assert "Input should" not in (each.reason or ""), each
        assert "`x`" not in (each.reason or ""), each


def test_a_function_of_the_station_is_offered_where_the_record_has_what_it_reads(tmp_path: Path) -> None:
    stages = tmp_path / "stages"
    stages.mkdir()
    (stages / "weight.py").write_text("def is_stuck(force, program):\n    return {'is_stuck': force > 3}\n")
    write_files(files_of(REACH), tmp_path)
    folder = tmp_path / "draft"
    folder.mkdir()
    (folder / "stages").symlink_to(stages)
    sketch = DraftReader(folder).sketch(files_of(REACH))
    found = fits(1, DraftPipelines(sketch), Fitting(pipeline=STATE, edge=0))
    (python,) = [each for each in found.stages if each.kind == "python"]
    assert python.stage == {
        "python": {
            "file": "stages/weight.py",
            "function": "is_stuck",
            "reads": {"force": "real", "program": "text"},
            "gives": {"is_stuck": "bool"},
        }
    }


def test_a_flow_may_have_further_sources_but_none_that_comes_of_itself() -> None:
    files = edited(
        files_of(REACH),
        AddEntry(file=ROBOT, path=["flows", "again"], value={"from": "holding", "pipeline": [{"tick": {"every": 1}}]}),
        AddEntry(
            file=ROBOT,
            path=["flows", "again", "pipeline", 0],
            value={"expression": {"still_holds": "holds_part"}},
        ),
        AddEntry(file=ROBOT, path=["measured", "still_holds"], value={"type": "bool"}),
    )
    graph = graph_of(files)
    assert graph.pipelines["robot.again"].findings == []
    found = {each.pipeline: each for each in fits(1, graph, Fitting(pipeline=HOLDING, edge=0)).sources}
    assert set(found) == {COMMAND, "robot.again"}
    assert "comes from itself" in (found["robot.again"].reason or "")
    assert "is an outgoing topic" in (found[COMMAND].reason or "")
    again = {each.pipeline: each for each in fits(1, graph, Fitting(pipeline="robot.again", edge=0)).sources}
    assert not again["/robot/scene"].fits  # nothing is common to both


def test_nobody_can_say_what_fits_behind_what_is_wrong() -> None:
    edit = SetEntry(file=ROBOT, path=["topics", STATE, "pipeline", 4, "match", "field"], was="program", value="force")
    graph = graph_of(edited(files_of(REACH), edit))
    assert fits(1, graph, Fitting(pipeline=STATE, edge=4)).stages
    for pipeline, edge in ((STATE, 5), (HOLDING, 0), (STATE, 99), ("/none", 0)):
        with pytest.raises(EditError):
            fits(1, graph, Fitting(pipeline=pipeline, edge=edge))


def previewed(*edits: object) -> PreviewView:
    question = Preview.model_validate({"edits": edits})
    with TemporaryDirectory() as folder:
        reader = DraftReader(Path(folder))
        graph = DraftPipelines(reader.sketch(files_of(REACH)))
        return preview(3, graph, files_of(REACH), reader, question)


def test_a_preview_says_what_is_new_and_what_is_otherwise() -> None:
    entry = shipped(REACH).pipelines[STATE].stages[2].written
    path: list[str | int] = ["topics", STATE, "pipeline", 2]
    gone = previewed(RemoveEntry(file=ROBOT, path=path, was=entry))
    assert (gone.refused, gone.gone) == (None, [])
    assert [each.message for each in gone.findings] == [
        "`/robot/state` → stage 3 `debounce`: there is no field `load` here; did you mean `mode`?"
    ]
    assert STATE in gone.pipelines
    assert COMMAND not in gone.pipelines
    tick = AddEntry(file=ROBOT, path=["topics", STATE, "pipeline", 0], before=0, value={"tick": {"every": 1}})
    fine = previewed(tick)
    assert fine.findings == []
    stale = previewed(RemoveEntry(file=ROBOT, path=path, was="something else"))
    assert "was changed meanwhile" in (stale.refused or "")
