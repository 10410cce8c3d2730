"""Answers about outlines: what one becomes, and those to begin with."""

from __future__ import annotations

from functools import cache
from importlib.resources import files

from sequence_planner.editor.outline.documents import files_made_of
from sequence_planner.editor.outline.facts import things_of
from sequence_planner.editor.outline.outline import Outline, OutlineView, TemplatesView
from sequence_planner.editor.outline.wrong import problems_of


def outlined(outline: Outline, name: str) -> OutlineView:
    """Return the documents of a station called `name` that an outline becomes, as far as it is sound."""
    problems = problems_of(outline)
    made = {} if problems else files_made_of(outline, name)
    return OutlineView(files=made, things=things_of(outline), problems=problems, errors=[])


@cache
def templates() -> TemplatesView:
    """Return the outlines to begin with."""
    folder = files("sequence_planner.editor.outline") / "templates"
    found = {
        each.name.removesuffix(".json"): Outline.model_validate_json(each.read_text(encoding="utf-8"))
        for each in folder.iterdir()
        if each.name.endswith(".json")
    }
    return TemplatesView(templates=dict(sorted(found.items())))
