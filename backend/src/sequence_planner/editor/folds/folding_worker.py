"""Answers to what could be said shorter in a draft, in a process of its own, as a proof for each takes its time."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from sequence_planner.editor.folds.finder import FoldFinder, FoundFolds
from sequence_planner.editor.folds.views import fold_view
from sequence_planner.editor.processes import encoded
from sequence_planner.editor.schemas.draft import FoldsView
from sequence_planner.model.source import ModelError

WITHIN = 40.0  # seconds in which folds are proven

# Files that are others since the last question, none for those that are gone; what is asked, and about what.
FoldQuestion = tuple[Mapping[str, str | None], str, tuple[int, str | None, str | None]]


def answering(folder: Path) -> Callable[[FoldQuestion, object], object]:
    """Return what answers questions, in an empty folder; a process's life."""
    finder, files = FoldFinder(folder / "station"), dict[str, str]()

    def _answer(question: FoldQuestion, _: object) -> object:
        changed, _, (number, wanted, name) = question
        for path, text in changed.items():
            if text is None:
                files.pop(path, None)
            else:
                files[path] = text
        try:
            if wanted is None:
                found = finder.folds(files, WITHIN)
            else:
                found = FoundFolds([finder.fold(files, wanted, name)], is_whole=True)
        except ModelError:
            return encoded(FoldsView(number=number, folds=(), usable=False, whole=False))
        views = tuple(map(fold_view, found.folds))
        return encoded(FoldsView(number=number, folds=views, usable=True, whole=found.is_whole))

    return _answer
