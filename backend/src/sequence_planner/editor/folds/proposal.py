"""A fold that somebody may want: what would be written instead of what, before it is known whether that is the same."""

from __future__ import annotations

import hashlib
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeVar

from sequence_planner.editor.draft import AddEntry, Edit, EditBase, SetEntry, WriteText
from sequence_planner.editor.folds.texts import FoldableText, Rewriting
from sequence_planner.editor.schemas.draft import FoldKind
from sequence_planner.language.syntax import Span
from sequence_planner.model.fields import fault_of_name
from sequence_planner.model.source import SourceText

_Named = TypeVar("_Named", bound=EditBase)

NAME = "\0"
"""Stands for the name that what a fold adds is given."""


@dataclass(frozen=True)
class WrittenPlace:
    """A place where something is written longer than it need be, to its `last` line: what is there, and would be."""

    file: str
    line: int
    column: int
    last: int
    was: str
    now: str


@dataclass(frozen=True)
class FoldProposal:
    """What would be written instead of what. `name` is proposed for what it adds, None where that is nothing."""

    kind: FoldKind
    title: str
    replacements: tuple[Rewriting, ...] = ()
    entries: tuple[tuple[Edit, WrittenPlace], ...] = ()
    added: AddEntry | WriteText | None = None
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

    def fault_of(self, name: str) -> str | None:
        """Say why what it adds cannot have a name; return None where it can, or nothing is added."""
        section = str(self.added.path[0]).removesuffix("s") if isinstance(self.added, AddEntry) else "type"
        return fault_of_name(name, section)

    def with_name(self, name: str) -> FoldProposal:
        """The same with a name in its place."""
        if self.name is None:
            return self
        return replace(
            self,
            title=self.title.replace(NAME, name),
            replacements=tuple(replace(each, now=each.now.replace(NAME, name)) for each in self.replacements),
            entries=tuple((_with_name(edit, name), place) for edit, place in self.entries),
            added=self.added and _with_name(self.added, name),
            name=name,
        )

    @property
    def worth(self) -> int:
        """About how many characters fewer are written with it, as far as that shows before it is made."""
        added = len(str(self.added.value)) if isinstance(self.added, AddEntry) else 0
        said = sum(len(each.was) - len(each.now) for each in self.replacements)
        return said - added + sum(len(str(edit)) for edit, _ in self.entries)

    @property
    def places(self) -> list[WrittenPlace]:
        """All places of it, in order."""
        found = [_place(each) for each in self.replacements] + [place for _, place in self.entries]
        return sorted(found, key=lambda each: (each.file, each.line, each.column))

    def touches(self, file: str, first: int, last: int) -> bool:
        """Return whether one of its places is in these lines of a file."""
        return any(each.file == file and each.line <= last and first <= each.last for each in self.places)

    @property
    def edits(self) -> list[Edit]:
        """The edits that make it, to be carried out together."""
        by_text: Mapping[tuple[str, tuple[str | int, ...]], list[Rewriting]] = defaultdict(list)
        for each in self.replacements:
            by_text[each.text.file, each.text.path].append(each)
        changed: list[Edit] = [
            SetEntry(file=file, path=list(path), was=str(parts[0].text.text), value=with_replacements(parts))
            for (file, path), parts in by_text.items()
        ]
        return [*changed, *(edit for edit, _ in self.entries), *([] if self.added is None else [self.added])]


def with_replacements(parts: list[Rewriting]) -> str:
    """The text that several parts of it are replaced in."""
    text = str(parts[0].text.text)
    for each in sorted(parts, key=lambda part: part.span, reverse=True):
        text = text[: each.span.start] + each.now + text[each.span.end :]
    return text


def apart(parts: list[Rewriting]) -> tuple[Rewriting, ...]:
    """The same without those that lie in others."""
    found: list[Rewriting] = []
    for each in sorted(parts, key=lambda part: (part.span.start, -part.span.end)):
        if not any(_meet(each, other) for other in found):
            found.append(each)
    return tuple(found)


def _meet(one: Rewriting, other: Rewriting) -> bool:
    alike = one.text.file == other.text.file and one.text.path == other.text.path
    return alike and one.span.start < other.span.end and other.span.start < one.span.end


def is_within(one: Rewriting, other: Rewriting) -> bool:
    """Return whether a part lies within another one."""
    return _meet(one, other) and other.span.start <= one.span.start and one.span.end <= other.span.end


def part_of(text: FoldableText, span: Span, now: str) -> Rewriting:
    """`now` in the place of a part, in brackets where there are none around it and `now` is of several words."""
    is_open = now.partition(" ")[0] in ("all", "any", "none") and ":" in now
    return Rewriting(text, span, f"({now})" if is_open and not text.is_bracketed(span) else now)


def place_between(file: str, first: SourceText, last: SourceText, was: str, now: str) -> WrittenPlace:
    """The place of all that is written from one text to another one."""
    return WrittenPlace(file, first.place.line, first.place.column, last.place.line, was, now)


def _place(part: Rewriting) -> WrittenPlace:
    at, end = (part.text.text.at(each) for each in (part.span, Span(part.span.end - 1, part.span.end)))
    return WrittenPlace(part.text.file, at.line, at.column, end.line, part.was, part.now)


def _with_name(edit: _Named, name: str) -> _Named:
    """An edit with a name in its place."""
    return type(edit).model_validate(_named(edit.model_dump(), name))


def _named(value: Any, name: str) -> Any:  # noqa: ANN401 (as JSON is)
    if isinstance(value, str):
        return value.replace(NAME, name)
    if isinstance(value, dict):
        return {str(key).replace(NAME, name): _named(each, name) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_named(each, name) for each in value]
    return value
