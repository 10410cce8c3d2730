"""Folds as they are told to a page, and to programs."""

from __future__ import annotations

from sequence_planner.controller.views.part import View
from sequence_planner.editor.draft import Edit
from sequence_planner.editor.folds.finder import Fold
from sequence_planner.editor.folds.proposal import FoldKind


class FoldPlaceView(View):
    """A place where something is written longer than it need be: what is there, and what would be there."""

    file: str
    line: int
    column: int
    was: str
    now: str


class FoldView(View):
    """A way to write something shorter that was proven to mean the same. `name` is proposed for what it adds.

    `edits` make it, carried out together.
    """

    id: str
    kind: FoldKind
    title: str
    name: str | None
    places: tuple[FoldPlaceView, ...]
    saved_lines: int
    saved_characters: int
    edits: tuple[Edit, ...]


class FoldsView(View):
    """All folds of the draft after change `number`, those first that save most. `unusable` where it has errors."""

    number: int
    folds: tuple[FoldView, ...]
    unusable: bool = False


def fold_view(fold: Fold) -> FoldView:
    """The view of `fold`."""
    return FoldView(
        id=fold.id,
        kind=fold.kind,
        title=fold.title,
        name=fold.name,
        places=tuple(FoldPlaceView(**vars(each)) for each in fold.places),
        saved_lines=fold.saved_lines,
        saved_characters=fold.saved_characters,
        edits=tuple(fold.edits),
    )
