"""Symbol collection in the stages of a pipeline, by what their declarations say of each name and value in them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple, TypeVar

from sequence_planner.editor.symbols.collectors import Names, read_calculation
from sequence_planner.editor.symbols.index import Declared, Where
from sequence_planner.editor.symbols.texts import MarkedStages
from sequence_planner.model.source import SourceText
from sequence_planner.model.stages.marks import (
    EntryPath,
    FormulaMark,
    Marked,
    NameMark,
    NamesMark,
    NameUse,
    TableMark,
    ValueMark,
)

T = TypeVar("T")


def kinds_of(stages: MarkedStages, declared: Declared, resource: str) -> dict[str, str]:
    """The enumerations of names that are no variables, by the variables that they become in later stages."""
    found: dict[str, str] = {}
    for _, _, marked in reversed(stages):
        for name, source in _become(marked):
            kind = declared.enumeration(resource, str(name)) or found.get(str(name))
            if kind is not None:
                found.setdefault(str(source), kind)
    return found


def _become(marked: list[Marked]) -> Iterator[tuple[SourceText, SourceText]]:
    """The names that an incoming stage gives to values as they are, each with their source."""
    sources = {path: text for text, path, mark in marked if isinstance(mark, NameMark) and not _is_given(mark)}
    formulas = {path: text for text, path, mark in marked if isinstance(mark, FormulaMark)}
    for text, path, mark in marked:
        if isinstance(mark, NameMark) and _is_given(mark):
            source = _of_entry(path, sources) if mark.alike else formulas.get(path)
            if source is not None:
                yield text, source


def _is_given(mark: NameMark) -> bool:
    return mark.incoming is NameUse.GIVEN


def _of_entry(path: EntryPath, found: Mapping[EntryPath, T]) -> T | None:
    """What belongs to an entry: what stands above it, or has its key or its place in a row, or is the only one."""
    above = (at for at in found if path[: len(at)] == at)
    beside = (at for at in found if path[-1:] == at[-1:])
    at = next(above, None) or next(beside, None) or (next(iter(found)) if len(found) == 1 else None)
    return None if at is None else found[at]


class _Read(NamedTuple):
    """A name that a stage reads: the enumeration over which it ranges, and whether it is a field of the message."""

    enumeration: str | None
    is_message: bool


class Stages:
    """Reads stages one after the other. `called` is the pipeline in words."""

    def __init__(self, names: Names, called: str) -> None:
        self.names = names
        self._called = called

    def read(self, stages: MarkedStages, where: Where) -> None:
        """All stages of a pipeline."""
        for index, kind, marked in stages:
            self._read_stage(marked, where.to(index, kind))

    def _read_stage(self, marked: list[Marked], where: Where) -> None:
        """All is read before anything is given: two names may change places."""
        given: dict[EntryPath, tuple[SourceText, NameMark]] = {}
        read: dict[EntryPath, _Read] = {}
        for text, path, mark in marked:
            if isinstance(mark, NameMark) and (use := mark.use(self.names.incoming)) is not None:
                if use is NameUse.GIVEN:
                    given[path] = text, mark
                else:
                    read[path] = self._read(text, where.to(*path), mark, use)
        for text, path, mark in marked:
            if isinstance(mark, FormulaMark):
                self._read_formula(text, where.to(*path), given[path][0] if path in given else None)
        made = {
            path: self._give(text, where.to(*path), mark, _of_entry(path, read)) for path, (text, mark) in given.items()
        }
        ranges = {path: each.enumeration for path, each in read.items()}
        for text, path, mark in marked:
            if isinstance(mark, NamesMark):
                self.tie(made.get(path) or ranges.get(path), self._spoken(text))
            if isinstance(mark, TableMark):
                self.names.naming.note_table(mark.kind, where.to(*path), text, self.names.resource)
            if isinstance(mark, ValueMark) and text != mark.but:
                is_of_given = mark.is_of_given(self.names.incoming)
                enumeration = _of_entry(path, made if is_of_given else ranges)
                if enumeration is not None and not is_of_given:  # a set may stand for several
                    self.names.naming.note_member(enumeration, where.to(*path), text)
                else:
                    self.names.naming.note_value(enumeration, where.to(*path), text)

    def _read(self, text: SourceText, where: Where, mark: NameMark, use: NameUse) -> _Read:
        before = len(self.names.naming.gathered.occurrences)
        is_message = not self.names.is_known(text)
        enumeration = self.names.read(text, where, is_message=use is NameUse.CONSUMED)
        if use is NameUse.RENAMED and not self.names.incoming:
            self.tie(enumeration, self._spoken(text))
        self._tie_outside(mark, enumeration, before)
        return _Read(enumeration, is_message)

    def _give(self, text: SourceText, where: Where, mark: NameMark, source: _Read | None) -> str | None:
        before = len(self.names.naming.gathered.occurrences)
        enumeration = self.names.give(text, where)
        if mark.alike:
            found = None if source is None else source.enumeration
            self.names.naming.link(enumeration, found)
            if found is None or (source is not None and source.is_message):
                self.tie(enumeration, self._spoken(text))
        self._tie_outside(mark, enumeration, before)
        return enumeration

    def _read_formula(self, text: SourceText, where: Where, name: SourceText | None) -> None:
        own = None
        if name is not None and self.names.incoming:
            own = self.names.naming.declared.enumeration(self.names.resource, str(name))
        is_message = read_calculation(self.names, text, where, own)
        is_single = str(text).isidentifier()
        if is_message or (is_single and self.names.enumeration(str(text)) is None):
            self.tie(own, self._spoken(name))
        elif name is not None and not self.names.incoming and is_single:
            self.tie(self.names.enumeration(str(text)), self._spoken(text))

    def _tie_outside(self, mark: NameMark, enumeration: str | None, before: int) -> None:
        """Note that somebody else knows a name and its values, whose occurrences are those from `before` on."""
        if mark.outsider is None:
            return
        self.tie(enumeration, f"{mark.outsider} gives its values by their names")
        why = f"{mark.outsider} is called with it by this name: change the function and the stage by hand"
        for found in self.names.naming.gathered.occurrences[before:]:
            self.names.naming.gathered.tie(found.part, why)

    def tie(self, enumeration: str | None, why: str) -> None:
        """Note that the values of an enumeration are texts or constants of a message."""
        self.names.naming.tie_values(enumeration, why)

    def _spoken(self, name: object) -> str:
        return f"{self._called} says the values of `{name}` by their names"
