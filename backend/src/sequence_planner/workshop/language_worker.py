"""Answers to questions about texts, in the light of the draft as far as it can be read."""

from __future__ import annotations

import contextlib
import shutil
from collections.abc import Callable, Mapping
from multiprocessing.connection import Connection
from pathlib import Path

from sequence_planner.model.loading import Station, load_station
from sequence_planner.model.source import ModelError
from sequence_planner.workshop.files import Files, write_files
from sequence_planner.workshop.language import Field, Lexicon, check, complete, formatted, hover
from sequence_planner.workshop.language.view import completion_view, hover_view, problem_view
from sequence_planner.workshop.language_view import CompletionView
from sequence_planner.workshop.questions import (
    FormatView,
    HoverAnswer,
    LanguageAnswer,
    LanguageQuestionKind,
    PlaceInText,
    ProblemsView,
    TextAt,
)

STATION, NOTHING = "station.yaml", "name: draft\n"

# Files that are others since the last question, none for those that are gone; what is asked, and about which text.
Question = tuple[Mapping[str, str | None], LanguageQuestionKind, TextAt]


class Draft:
    """The draft while it is edited, and what its names mean. Its files are written into the empty `folder`.

    A file that cannot be used stands as it was when it could be: what is written elsewhere is not wrong because of it.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._files: dict[str, str] = {}
        self._usable: dict[str, str] = {}
        self._lexicon: Lexicon | None = None

    def take(self, changed: Mapping[str, str | None]) -> None:
        """Take note of files that are others now."""
        for path, text in changed.items():
            if text is None:
                self._files.pop(path, None)
            else:
                self._files[path] = text
        if changed:
            self._lexicon = None

    @property
    def lexicon(self) -> Lexicon:
        """What names mean now."""
        if self._lexicon is None:
            self._lexicon = Lexicon.of(self._station())
        return self._lexicon

    def _station(self) -> Station:
        files = {STATION: NOTHING, **self._files}
        while True:
            try:
                station = self._loaded(files)
                break
            except ModelError as error:
                wrong = {finding.place.file.removeprefix(f"{self._folder}/") for finding in error.findings}
                for path in wrong & files.keys() or files.keys() - {STATION}:
                    files = self._without(files, path)
        self._usable = {path: text for path, text in files.items() if text != NOTHING}
        return station

    def _without(self, files: Files, path: str) -> dict[str, str]:
        """With the file as it was when it could be used, or else without it."""
        others = {name: text for name, text in files.items() if name != path}
        usable = self._usable.get(path)
        if usable is not None and usable != files[path]:
            return {**others, path: usable}
        return {**others, STATION: NOTHING} if path == STATION else others

    def _loaded(self, files: Files) -> Station:
        shutil.rmtree(self._folder, ignore_errors=True)
        self._folder.mkdir()
        write_files(files, self._folder)
        return load_station(self._folder)


def answer(draft: Draft, kind: LanguageQuestionKind, asked: TextAt) -> LanguageAnswer:
    """What is answered; what is no text that names stand in has nothing to be said of."""
    lexicon = draft.lexicon
    field = lexicon.field(asked.file, tuple(asked.path), asked.parameters)
    offset = min(asked.offset, len(asked.text)) if isinstance(asked, PlaceInText) else 0
    if field is None:
        nothing: dict[LanguageQuestionKind, LanguageAnswer] = {
            LanguageQuestionKind.CHECK: ProblemsView(problems=()),
            LanguageQuestionKind.COMPLETION: CompletionView(start=offset, end=offset, options=()),
            LanguageQuestionKind.HOVER: HoverAnswer(hover=None),
            LanguageQuestionKind.FORMAT: FormatView(text=asked.text),
        }
        return nothing[kind]
    answers: dict[LanguageQuestionKind, Callable[[Field], LanguageAnswer]] = {
        LanguageQuestionKind.CHECK: lambda field: ProblemsView(
            problems=tuple(map(problem_view, check(lexicon, field, asked.text)))
        ),
        LanguageQuestionKind.COMPLETION: lambda field: completion_view(complete(lexicon, field, asked.text, offset)),
        LanguageQuestionKind.HOVER: lambda field: HoverAnswer(
            hover=None if (found := hover(lexicon, field, asked.text, offset)) is None else hover_view(found)
        ),
        LanguageQuestionKind.FORMAT: lambda field: FormatView(text=formatted(field, asked.text)),
    }
    return answers[kind](field)


def answering(connection: Connection, folder: Path) -> None:
    """Answer questions until nobody is there any more."""
    draft = Draft(folder / "draft")
    with contextlib.suppress(EOFError, OSError):
        while True:
            question: Question = connection.recv()
            changed, kind, asked = question
            draft.take(changed)
            connection.send(answer(draft, kind, asked))
