"""A draft that is read again and again while it is edited: what is found in it is what is found from scratch."""

from __future__ import annotations

import os
import re
import tempfile
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from editor.models import bolts
from sequence_planner.analysis.report import FindingDocument
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.editor.language.draft import LanguageDraft
from sequence_planner.editor.language_worker import answer, errors
from sequence_planner.editor.processes import LanguageQuestionKind, PlaceInText
from sequence_planner.model.files import FolderReader, read_files, write_files
from sequence_planner.model.source import ModelError
from sequence_planner.station import Before, read_station
from support.examples import examples
from support.places import CELL

MODELS = (bolts(), read_files(CELL))
WORD = re.compile(r"[A-Za-z_][A-Za-z_0-9]*|[0-9]+|[:=,.(){}\[\]-]+")


@st.composite
def edited(draw: st.DrawFn) -> list[dict[str, str]]:
    """A model, and what becomes of it by some edits: most of them wrong, as drafts are."""
    first = draw(st.sampled_from(MODELS))
    words = sorted({word for text in first.values() for word in WORD.findall(text)})
    versions = [dict(first)]
    for _ in range(draw(st.integers(1, 5))):
        files = dict(versions[-1])
        path = draw(st.sampled_from(sorted(first)))
        match draw(st.sampled_from(("word", "word", "word", "line", "twice", "gone", "back"))):
            case "word" if found := list(WORD.finditer(files.get(path, ""))):
                place = draw(st.sampled_from(found))
                files[path] = files[path][: place.start()] + draw(st.sampled_from(words)) + files[path][place.end() :]
            case "line" | "twice" as what if lines := files.get(path, "").splitlines(keepends=True):
                at = draw(st.integers(0, len(lines) - 1))
                lines[at : at + 1] = [] if what == "line" else [lines[at], lines[at]]
                files[path] = "".join(lines)
            case "gone":
                files.pop(path, None)
            case _:
                files[path] = first[path]
        versions.append(files)
    # Some are put right again: what comes after an error counts as well.
    return [*versions, versions[0]]


def changes(before: dict[str, str], after: dict[str, str]) -> dict[str, str | None]:
    return {path: after.get(path) for path in before.keys() | after.keys() if before.get(path) != after.get(path)}


def meant(folder: Path, before: Before | None) -> Automaton | str:
    try:
        return read_station(folder, before).automaton
    except ModelError as error:
        return str(error)


def of_scratch(files: dict[str, str]) -> tuple[list[FindingDocument], str]:
    with tempfile.TemporaryDirectory() as folder:
        draft = LanguageDraft(Path(folder))
        draft.take(files)
        return errors(draft), told(draft, files)


def told(draft: LanguageDraft, files: dict[str, str]) -> str:
    """What the language says of some text, of what there is in the draft."""
    path = max((path for path in files if path.startswith("resources/")), default="resources/new.yaml")
    place: list[str | int] = ["abilities", "new", "enabled"]
    asked = PlaceInText(file=path, path=place, text="pose == and not", offset=0, parameters={})
    return "".join(answer(draft, kind, asked).model_dump_json() for kind in LanguageQuestionKind)


@examples(20)
@given(edited())
def test_what_makes_a_draft_unusable_is_what_is_found_from_scratch(versions: list[dict[str, str]]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        draft, known = LanguageDraft(Path(folder)), dict[str, str]()
        for files in versions:
            draft.take(changes(known, files))
            known = files
            expected, said = of_scratch(files)
            assert errors(draft) == expected
            if not expected:  # else what was usable before may count
                assert told(draft, files) == said


@examples(20)
@given(edited())
def test_a_station_that_was_read_before_means_the_same_as_one_that_was_not(versions: list[dict[str, str]]) -> None:
    before = Before()
    with tempfile.TemporaryDirectory() as folder:
        place, known = Path(folder), dict[str, str]()
        for files in versions:
            write_files(files, place)
            for path in known.keys() - files.keys():
                (place / path).unlink()
            known = files
            again, fresh = meant(place, before), meant(place, None)
            assert again == fresh
            if isinstance(again, Automaton) and isinstance(fresh, Automaton):
                assert list(again.places.items()) == list(fresh.places.items())
                assert list(again.abilities) == list(fresh.abilities)


def test_a_folder_is_read_again_as_it_is_whatever_its_clock_says(tmp_path: Path) -> None:
    write_files(bolts(), tmp_path)
    (tmp_path / "notes.txt").write_text("no file of a model")
    seen = FolderReader(tmp_path)
    assert seen.read() == bolts()
    operations = tmp_path / "operations.yaml"
    # Written once more at once, as long as it was, and with the old time.
    status, text = operations.stat(), operations.read_text()
    operations.write_text(text[::-1])
    os.utime(operations, ns=(status.st_atime_ns, status.st_mtime_ns))
    assert seen.read() == {**bolts(), "operations.yaml": text[::-1]}
    old = status.st_mtime_ns - 10**10
    os.utime(operations, ns=(old, old))
    assert seen.read()["operations.yaml"] == text[::-1]
    operations.write_text("{}\n")
    assert seen.read()["operations.yaml"] == "{}\n"
    operations.unlink()
    (tmp_path / "resources" / "robot.yaml").write_bytes(b"\xff")
    assert seen.read().keys() == bolts().keys() - {"operations.yaml", "resources/robot.yaml"}
    assert FolderReader(tmp_path / "nothing").read() == {}
