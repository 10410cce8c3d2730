"""Answers about outlines: what one becomes, and those to begin with."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from importlib.resources import files

from pydantic import JsonValue

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
def templates(language: str = "en") -> TemplatesView:
    """Return the outlines to begin with; titles in English, or in another language as far as they are known in it."""
    folder = files("sequence_planner.editor.outline") / "templates"
    titles = folder / f"titles.{language}.json"
    words: Mapping[str, str] = json.loads(titles.read_text(encoding="utf-8")) if titles.is_file() else {}
    found = {
        each.name.removesuffix(".json"): Outline.model_validate(
            _titled(json.loads(each.read_text(encoding="utf-8")), words)
        )
        for each in folder.iterdir()
        if each.name.endswith(".json") and not each.name.startswith("titles.")
    }
    return TemplatesView(templates=dict(sorted(found.items())))


def _titled(part: JsonValue, words: Mapping[str, str]) -> JsonValue:
    """The same with its titles in other words."""
    if isinstance(part, dict):
        return {
            key: words.get(value, value) if key == "title" and isinstance(value, str) else _titled(value, words)
            for key, value in part.items()
        }
    return [_titled(each, words) for each in part] if isinstance(part, list) else part
