"""Folds of the truck engine station as it was written before the language had short forms."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from golden.journals import model
from sequence_planner.editor.folds.finder import Fold, FoldFinder
from sequence_planner.editor.folds.sameness import difference
from sequence_planner.editor.schemas.draft import FoldKind
from sequence_planner.model.files import read_files, write_files
from sequence_planner.model.paths import EditError
from sequence_planner.model.source import ModelError
from sequence_planner.station import read_station

BEFORE = "29321a2f211e"  # the digest of its model begins so
TIGHTENED = "all pair in bolt_pair: bolts[pair] == tightened"


@pytest.fixture(scope="module")
def files() -> dict[str, str]:
    with model(BEFORE) as folder:
        return read_files(folder)


@pytest.fixture(scope="module")
def finder(tmp_path_factory: pytest.TempPathFactory) -> FoldFinder:
    return FoldFinder(tmp_path_factory.mktemp("finder"))


@pytest.fixture(scope="module")
def folds(finder: FoldFinder, files: dict[str, str]) -> list[Fold]:
    return finder.folds(files).folds


def _those(folds: list[Fold], kind: FoldKind) -> Iterator[Fold]:
    return (fold for fold in folds if fold.kind is kind)


def test_all_six_pairs_are_tightened_in_four_places(folds: list[Fold], files: dict[str, str]) -> None:
    said = next(fold for fold in _those(folds, FoldKind.QUANTIFIER) if TIGHTENED in fold.title)
    assert [place.file for place in said.places] == ["operations.yaml"] * 3 + ["resources/engine.yaml"]
    for place in said.places:
        line = files[place.file].splitlines()[place.line - 1]
        assert line[place.column - 1 :].startswith("bolts[AtBoltPair1TCPPose] == tightened")
        assert place.was.count("tightened") == 6
    assert said.saved_lines == 20
    named = next(fold for fold in _those(folds, FoldKind.PREDICATE) if fold.name == "all_tightened")
    assert len(named.places) == 4
    assert f"all_tightened: '{TIGHTENED}'" in named.files["station.yaml"]
    assert {" ".join(fold.title.split()) for fold in _those(folds, FoldKind.QUANTIFIER)} >= {
        "Write `any pair in bolt_pair: bolts[pair] == placed`",
        "Write `all pair in bolt_pair: bolts[pair] != empty`",
    }


def test_the_lists_of_poses_are_found(folds: list[Fold]) -> None:
    (included,) = _those(folds, FoldKind.INCLUDES)
    assert "  pose:\n    values: [UNKNOWN]\n    includes: [named_pose]\n" in included.files["station.yaml"]
    (left_out,) = _those(folds, FoldKind.MAP)
    assert left_out.saved_lines == 20
    (rows,) = _those(folds, FoldKind.ROWS)
    assert rows.files["resources/robot.yaml"].count("bolt_pair") == 2
    sets = {fold.name: fold for fold in _those(folds, FoldKind.SET)}
    assert len(sets[None].places) == 2  # the pairs of bolts, which have a name
    assert {"attach_tcp_pose", "some_named_poses"} <= sets.keys()


def test_the_pose_graph_is_a_relation(folds: list[Fold]) -> None:
    (graph,) = _those(folds, FoldKind.RELATION)
    assert "pose != position and belong_together(pose, position)\n" in graph.files["resources/robot.yaml"]
    relation = graph.files["station.yaml"].partition("relations:\n")[2].partition("\n\n")[0]
    assert relation.startswith("  belong_together:\n    between: [pose, pose]\n    symmetric: true\n    pairs:\n")
    assert relation.count("AttachLFToolTCPPose") == 1


def test_what_is_taken_means_the_same_and_keeps_all_else(
    folds: list[Fold], finder: FoldFinder, files: dict[str, str], tmp_path: Path
) -> None:
    before = read_station(_written(files, tmp_path / "before")).automaton
    after, taken = dict(files), 0
    for fold in folds:
        try:
            after |= finder.fold(after, fold.id).files
        except EditError:  # what is left of it has another name by now
            continue
        taken += 1
    assert taken >= 7
    now = read_station(_written(after, tmp_path / "now")).automaton
    assert difference(before, now) is None
    lines = [sum(text.count("\n") for text in each.values()) for each in (files, after)]
    assert lines[0] - lines[1] > 80
    for file, text in files.items():
        kept = [line for line in text.splitlines() if line.lstrip().startswith("#")]
        assert kept == [line for line in after[file].splitlines() if line.lstrip().startswith("#")]


def test_a_name_can_be_given(folds: list[Fold], finder: FoldFinder, files: dict[str, str]) -> None:
    docked = next(fold for fold in folds if fold.name == "attach_tcp_pose")
    found = finder.fold(files, docked.id, "docked")
    assert "sets:\n  docked:\n    of: named_pose\n" in found.files["station.yaml"]
    assert "not robot.pose in docked" in found.files["resources/end_effector.yaml"]


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("2nd", "`2nd` is no name: use letters, digits and `_`, and no digit first"),
        ("tool", "`tool` is the name of something else: take another one"),
        ("in", "`in` is a word of the language: take another name"),
    ],
)
def test_a_name_that_cannot_be(
    folds: list[Fold], finder: FoldFinder, files: dict[str, str], name: str, message: str
) -> None:
    docked = next(fold for fold in folds if fold.name == "attach_tcp_pose")
    with pytest.raises(EditError) as refused:
        finder.fold(files, docked.id, name)
    assert str(refused.value) == message.format(docked.id)


def test_what_is_not_there(folds: list[Fold], finder: FoldFinder, files: dict[str, str]) -> None:
    with pytest.raises(EditError, match="there is no fold `00000000`: look at those that there are now"):
        finder.fold(files, "00000000")
    (included,) = _those(folds, FoldKind.INCLUDES)
    with pytest.raises(EditError, match="adds nothing that could be called `poses`"):
        finder.fold(files, included.id, "poses")
    with pytest.raises(EditError, match="there is no fold"):
        finder.fold({**files, **included.files}, included.id)


def test_a_station_that_cannot_be_used(finder: FoldFinder, files: dict[str, str]) -> None:
    with pytest.raises(ModelError, match="unknown variable"):
        finder.folds({**files, "station.yaml": files["station.yaml"].replace("operator.task ==", "operator.tsk ==")})


def _written(files: dict[str, str], folder: Path) -> Path:
    folder.mkdir()
    write_files(files, folder)
    return folder
