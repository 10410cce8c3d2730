"""Folds as a page and programs are told of them."""

from __future__ import annotations

from sequence_planner.editor.folds.finder import Fold
from sequence_planner.editor.schemas.draft import FoldPlaceView, FoldView


def fold_view(fold: Fold) -> FoldView:
    """The view of `fold`."""
    return FoldView(
        id=fold.id,
        kind=fold.kind,
        title=fold.title,
        name=fold.name,
        places=tuple(
            FoldPlaceView(file=each.file, line=each.line, column=each.column, was=each.was, now=each.now)
            for each in fold.places
        ),
        saved_lines=fold.saved_lines,
        saved_characters=fold.saved_characters,
        edits=tuple(fold.edits),
    )
