"""Revisions: commits that git itself can read."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.editor.revisions import BEFORE, Revisions, tree_of
from sequence_planner.model.paths import EditError
from support.people import ADAM, EVA

FILES = {"station.yaml": "name: cell\n", "resources/robot.yaml": "title: Robot ü\n"}
CHANGED = {**FILES, "station.yaml": "name: cell\ntitle: Cell\n"}


@pytest.fixture
def revisions(tmp_path: Path) -> Revisions:
    return Revisions(tmp_path / "state" / "revisions.git")


def git(folder: Path, *arguments: str) -> str:
    alone = {**os.environ, "GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_NOSYSTEM": "1"}
    return subprocess.run(
        ["git", "-C", str(folder), *arguments], capture_output=True, text=True, check=True, env=alone
    ).stdout


def test_the_first_revision_follows_what_the_station_was(revisions: Revisions) -> None:
    assert list(revisions.all()) == []
    saved = revisions.save(CHANGED, FILES, "With a title", "It had none.\n", EVA, 1000.7)
    newest, oldest = revisions.all()
    assert newest == saved
    assert (saved.name, saved.message, saved.by, saved.time) == ("With a title", "It had none.", "Eva", 1000.0)
    assert oldest.name == BEFORE
    assert revisions.files(saved.id) == CHANGED
    assert revisions.files(oldest.id) == FILES
    assert saved.tree == tree_of(CHANGED) != oldest.tree == tree_of(FILES)


def test_one_that_is_as_the_station_was_needs_none_before_it(revisions: Revisions) -> None:
    revisions.save(FILES, FILES, "First", "", EVA, 1000.0)
    assert [each.name for each in revisions.all()] == ["First"]


def test_git_reads_them(tmp_path: Path, revisions: Revisions) -> None:
    revisions.save(FILES, {}, "First", "", EVA, 1000.0)
    revisions.save(CHANGED, FILES, "Second", "Why\nthat is", ADAM, 2000.0)
    git(tmp_path, "clone", "-q", "state/revisions.git", "copy")
    copy = tmp_path / "copy"
    assert git(copy, "fsck", "--strict") == ""
    assert git(copy, "log", "--format=%an|%s|%at") == "Adam|Second|2000\nEva|First|1000\n"
    assert (copy / "resources" / "robot.yaml").read_text(encoding="utf-8") == "title: Robot ü\n"
    assert "+title: Cell" in git(copy, "show")


@pytest.mark.parametrize(
    ("files", "name", "said"),
    [
        (CHANGED, " \n ", "needs a name"),
        (CHANGED, "x" * 101, "up to 100"),
        (CHANGED, " First ", "already"),
        (FILES, "Second", "nothing differs from the revision “First”"),
    ],
)
def test_what_cannot_be_saved_is_said(revisions: Revisions, files: dict[str, str], name: str, said: str) -> None:
    revisions.save(FILES, FILES, "First", "", EVA, 1000.0)
    with pytest.raises(EditError, match=said):
        revisions.save(files, FILES, name, "", EVA, 1001.0)
    assert len(list(revisions.all())) == 1


@pytest.mark.parametrize("id", ["", "main", "../..", "f" * 40])
def test_what_is_no_revision_is_not_found(revisions: Revisions, id: str) -> None:
    revisions.save(FILES, FILES, "First", "", EVA, 1000.0)
    with pytest.raises(EditError, match="no revision"):
        revisions.files(id)


def test_a_name_of_somebody_does_no_harm(tmp_path: Path, revisions: Revisions) -> None:
    odd = Actor(kind=ActorKind.PERSON, id="a>b", name="E <va>\nauthor", session=None)
    revisions.save(FILES, FILES, "First", "", odd, 1000.0)
    assert git(tmp_path / "state" / "revisions.git", "fsck", "--strict") == ""
    assert next(revisions.all()).by == "E  va  author"
