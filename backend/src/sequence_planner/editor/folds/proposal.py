"""A fold that somebody may want: what would be written instead of what, before it is known whether that is the same."""

from __future__ import annotations

import hashlib
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from sequence_planner.editor.draft import AddEntry, Edit, SetEntry
from sequence_planner.editor.folds.texts import FoldableText, Replacement
from sequence_planner.editor.schemas.draft import FoldKind
from sequence_planner.language.syntax import Span
from sequence_planner.model.source import SourceText

NAME = "\0"
"""Stands for the name that what a fold adds is given."""


@dataclass(frozen=True)
class WrittenPlace:
    """A place where something is written longer than it need be: what is there, and what would be there."""

    file: str
    line: int
    column: int
    was: str
    now: str


@dataclass(frozen=True)
class Proposal:
    """What would be written instead of what. `name` is proposed for what it adds, None where that is nothing."""

    kind: FoldKind
    title: str
    replacements: tuple[Replacement, ...] = ()
    entries: tuple[tuple[Edit, WrittenPlace], ...] = ()
    added: AddEntry | None = None
    name: str | None = None

    @property
    def id(self) -> str:
        """A short mark of this fold, the same as long as it is one of the same parts of the same texts."""
        parts = [
            self.kind.value,
            *sorted(f"{each.text.file} {each.text.path} {each.was} {each.now}" for each in self.replacements),
            *(f"{place.file} {edit}" for edit, place in self.entries),
        ]
        return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:8]

    def named(self, name: str) -> Proposal:
        """The same with a name in its place."""
        if self.name is None:
            return self
        return replace(
            self,
            title=self.title.replace(NAME, name),
            replacements=tuple(replace(each, now=each.now.replace(NAME, name)) for each in self.replacements),
            added=self.added and AddEntry.model_validate(_named(self.added.model_dump(), name)),
            name=name,
        )

    @property
    def worth(self) -> int:
        """About how many characters fewer are written with it, as far as that shows before it is made."""
        added = 0 if self.added is None else len(str(self.added.value))
        said = sum(len(each.was) - len(each.now) for each in self.replacements)
        return said - added + sum(len(str(edit)) for edit, _ in self.entries)

    @property
    def places(self) -> list[WrittenPlace]:
        """All places of it, in order."""
        found = [_place(each) for each in self.replacements] + [place for _, place in self.entries]
        return sorted(found, key=lambda each: (each.file, each.line, each.column))

    @property
    def edits(self) -> list[Edit]:
        """The edits that make it, to be carried out together."""
        by_text: Mapping[tuple[str, tuple[str | int, ...]], list[Replacement]] = defaultdict(list)
        for each in self.replacements:
            by_text[each.text.file, each.text.path].append(each)
        changed: list[Edit] = [
            SetEntry(file=file, path=list(path), was=str(parts[0].text.text), value=with_replacements(parts))
            for (file, path), parts in by_text.items()
        ]
        return [*changed, *(edit for edit, _ in self.entries), *([] if self.added is None else [self.added])]


def with_replacements(parts: list[Replacement]) -> str:
    """The text that several parts of it are replaced in."""
    text = str(parts[0].text.text)
    for each in sorted(parts, key=lambda part: part.span, reverse=True):
        text = text[: each.span.start] + each.now + text[each.span.end :]
    return text


def apart(parts: list[Replacement]) -> tuple[Replacement, ...]:
    """The same without those that lie in others."""
    found: list[Replacement] = []
    for each in sorted(parts, key=lambda part: (part.span.start, -part.span.end)):
        if not any(_meet(each, other) for other in found):
            found.append(each)
    return tuple(found)


def _meet(one: Replacement, other: Replacement) -> bool:
    alike = one.text.file == other.text.file and one.text.path == other.text.path
    return alike and one.span.start < other.span.end and other.span.start < one.span.end


def is_within(one: Replacement, other: Replacement) -> bool:
    """Return whether a part lies within another one."""
    return _meet(one, other) and other.span.start <= one.span.start and one.span.end <= other.span.end


def part_of(text: FoldableText, span: Span, now: str) -> Replacement:
    """`now` in the place of a part, in brackets where there are none around it and `now` is of several words."""
    is_open = now.partition(" ")[0] in ("all", "any", "none") and ":" in now
    return Replacement(text, span, f"({now})" if is_open and not text.is_bracketed(span) else now)


def place_of_text(file: str, text: SourceText, was: str, now: str) -> WrittenPlace:
    """The place of a text as a whole."""
    return WrittenPlace(file, text.place.line, text.place.column, was, now)


def _place(part: Replacement) -> WrittenPlace:
    at = part.text.text.at(part.span)
    return WrittenPlace(part.text.file, at.line, at.column, part.was, part.now)


def _named(value: Any, name: str) -> Any:  # noqa: ANN401 (as JSON is)
    if isinstance(value, str):
        return value.replace(NAME, name)
    if isinstance(value, dict):
        return {str(key).replace(NAME, name): _named(each, name) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_named(each, name) for each in value]
    return value
