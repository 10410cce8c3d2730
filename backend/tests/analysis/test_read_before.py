"""What a model means is kept for commands by all that lies in its folder, so that no change goes unseen."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from sequence_planner.analysis.store import content_key, folder, key, read, write
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.cli import loading
from sequence_planner.cli.loading import load_model, usable_automaton
from support.places import MODELS, SINGLE_BOLT


@pytest.fixture
def model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return Path(shutil.copytree(SINGLE_BOLT, tmp_path / "model"))


def test_a_model_that_was_read_before_is_not_read_again(model: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = usable_automaton(model)
    monkeypatch.setattr(loading, "load_model", None)
    again = usable_automaton(model)
    assert again == first
    assert again.places == first.places
    assert key(again) == key(first), "what is kept of one is found of the other"


@pytest.mark.parametrize("station", sorted(each.name for each in MODELS.iterdir() if each.is_dir()))
def test_what_is_kept_is_found_however_the_model_was_read(
    station: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    path = MODELS / station
    first, content = load_model(path).automaton, content_key(path)
    assert content is not None
    write(content, first)
    kept = read(content, Automaton)
    assert kept is not None
    assert kept == first
    assert key(kept) == key(first)


def test_what_one_process_keeps_is_found_by_all_others() -> None:
    """Each process has its own order of a set's members, by its seed of hashes."""
    asked = (
        "import sys; from pathlib import Path; from sequence_planner.analysis.store import key; "
        "from sequence_planner.cli.loading import load_model; print(key(load_model(Path(sys.argv[1])).automaton))"
    )
    found = {
        subprocess.run(
            [sys.executable, "-c", asked, str(MODELS / "truck_engine_station")],
            env={**os.environ, "PYTHONHASHSEED": seed},
            check=True,
            capture_output=True,
            text=True,
        ).stdout
        for seed in ("1", "2", "3")
    }
    assert len(found) == 1


def test_each_change_of_a_file_is_seen(model: Path) -> None:
    specifications = model / "specifications.yaml"
    before = usable_automaton(model)
    text = specifications.read_text(encoding="utf-8")
    status = specifications.stat()
    specifications.write_text(text.replace("always", "ALWAYS") if "always" in text else f"{text}# more\n")
    os.utime(specifications, ns=(status.st_atime_ns, status.st_mtime_ns))
    changed = content_key(model)
    specifications.write_text(text)
    assert content_key(model) != changed
    assert usable_automaton(model) == before
    more = model / "resources" / "another.yaml"
    more.write_text("title: Another\n", encoding="utf-8")
    assert "another" in usable_automaton(model).resources
    more.unlink()
    assert usable_automaton(model) == before


def test_the_same_files_under_another_name_have_other_places(model: Path) -> None:
    other = Path(shutil.copytree(model, model.parent / "other"))
    assert content_key(other) != content_key(model)


def test_a_damaged_file_is_not_believed(model: Path) -> None:
    first = usable_automaton(model)
    [file] = folder().glob("Automaton-*")
    content = bytearray(file.read_bytes())
    content[-20] ^= 4
    file.write_bytes(content)
    assert usable_automaton(model) == first


def test_what_is_more_than_a_model_is_read_each_time(model: Path) -> None:
    (model / "elsewhere").symlink_to(model.parent)
    assert content_key(model) is None
    assert usable_automaton(model).resources
    assert not list(folder().glob("Automaton-*"))
