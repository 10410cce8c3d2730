"""Answers about outlines, by a process that keeps what it has read of the documents that the last one became."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from sequence_planner.analysis.report import error_document
from sequence_planner.editor.language.draft import LanguageDraft
from sequence_planner.editor.model_graph import station_of
from sequence_planner.editor.outline.beginning import outlined
from sequence_planner.editor.outline.outline import Outline
from sequence_planner.editor.processes import encoded
from sequence_planner.editor.schemas.check import listed

# The files of the draft that are others since the last question; what is asked, and about what.
OutlineQuestion = tuple[Mapping[str, str | None], str, tuple[Outline]]


def answering(folder: Path) -> Callable[[OutlineQuestion, object], object]:
    """Return what answers questions, in an empty folder; a process's life."""
    made = LanguageDraft(folder / "made")
    draft: dict[str, str | None] = {}

    def respond(question: OutlineQuestion, _: object) -> object:
        changed, _, (outline,) = question
        draft.update(changed)
        name, _ = station_of({path: text for path, text in draft.items() if text is not None})
        view = outlined(outline, name or "station")
        if not view.files:
            return encoded(view)
        gone = dict.fromkeys(made.files.keys() - view.files.keys())
        made.take({**gone, **{path: text for path, text in view.files.items() if made.files.get(path) != text}})
        errors = listed([error_document(each) for each in made.errors()])
        return encoded(view.model_copy(update={"errors": errors}))

    return respond
