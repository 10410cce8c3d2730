"""`check` of a model that nobody has changed tells what it told, and that of another one what is true of that."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from sequence_planner.analysis.checks.connections import Connections
from sequence_planner.analysis.store import folder
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.cli.analysing import Found, Limits, checked
from sequence_planner.cli.model import check as module
from support.commands import command
from support.places import MODELS


@pytest.fixture
def model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return Path(shutil.copytree(MODELS / "robots_with_buffer", tmp_path / "model"))


def check(model: Path, *more: str) -> tuple[int, str, str]:
    return command("check", model, *more)


def test_what_was_found_is_told_again_without_looking(model: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first, as_document = check(model), check(model, "--json")
    monkeypatch.setattr(module, "check_model", None)
    assert check(model) == first
    assert check(model, "--json") == as_document


def test_a_change_is_seen_and_taken_back(model: Path) -> None:
    specifications = model / "specifications.yaml"
    text, first = specifications.read_text(encoding="utf-8"), check(model)
    specifications.write_text(f"{text}\nnonsense: 1\n", encoding="utf-8")
    code, out, err = check(model)
    assert (code, out) == (2, "")
    assert "specifications.yaml" in err
    assert check(model) == (code, out, err), "what cannot be used is looked at each time"
    specifications.write_text(text, encoding="utf-8")
    assert check(model) == first


def test_what_was_not_all_is_not_kept(model: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    look = checked

    def slow(automaton: Automaton, connections: Connections | None, limits: Limits) -> Found:
        return replace(look(automaton, connections, limits), unfinished="it took too long")

    with monkeypatch.context() as patch:
        patch.setattr(module, "checked", slow)
        code, out, _ = check(model)
        assert code == 1
        assert "it took too long" in out
    assert "it took too long" not in check(model)[1]


def test_of_a_model_with_python_of_its_own_nothing_is_kept(model: Path) -> None:
    (model / "stages").mkdir()
    (model / "stages" / "own.py").write_text("", encoding="utf-8")
    check(model)
    assert not list(folder().glob("check-*"))
