"""Texts of documents and places in them, as an editor counts: lines, and units of the encoding that it has chosen."""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property

from lsprotocol import types

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*(?:[(\[][\w\s,]*[)\]])?(?:\.[A-Za-z_][A-Za-z0-9_]*(?:[(\[][\w\s,]*[)\]])?)*")
_QUOTED = re.compile(r"\"[^\"\n]*\"|'[^'\n]*'")
_SOLID = re.compile(r"[^\s,\]}]+")
_WIDTHS = {types.PositionEncodingKind.Utf8: "utf-8", types.PositionEncodingKind.Utf32: "utf-32-le"}


@dataclass(frozen=True)
class DocumentText:
    """A text with lines that end in a line feed; `encoding` is that in whose units an editor counts."""

    text: str
    encoding: str = types.PositionEncodingKind.Utf16

    @cached_property
    def _starts(self) -> list[int]:
        return [0, *(found.end() for found in re.finditer("\n", self.text))]

    def row(self, row: int) -> str:
        """A line, from 0 on, without its end; empty where there is none."""
        if row >= len(self._starts):
            return ""
        end = self._starts[row + 1] - 1 if row + 1 < len(self._starts) else len(self.text)
        return self.text[self._starts[row] : end]

    def index(self, position: types.Position) -> int:
        """The character at a position, or the end of its line where that is shorter."""
        if position.line >= len(self._starts):
            return len(self.text)
        line = self.row(position.line)
        if line.isascii():
            return self._starts[position.line] + min(position.character, len(line))
        units, at = 0, 0
        while at < len(line) and units < position.character:
            units += self._units(line[at])
            at += 1
        return self._starts[position.line] + at

    def position(self, index: int) -> types.Position:
        """The position of a character."""
        row = bisect_right(self._starts, index) - 1
        return types.Position(row, self._units(self.text[self._starts[row] : index]))

    def range(self, start: int, end: int) -> types.Range:
        """The range between two characters."""
        return types.Range(self.position(start), self.position(end))

    def index_of(self, line: int, column: int) -> int:
        """The character at a line and column, from 1 on, or the one nearest to it."""
        row = min(max(line, 1), len(self._starts)) - 1
        return self._starts[row] + min(max(column, 1) - 1, len(self.row(row)))

    def word(self, index: int) -> tuple[int, int]:
        """Return where the name, quoted text or value that begins at a character begins and ends."""
        for pattern in (_NAME, _QUOTED, _SOLID):
            if found := pattern.match(self.text, index):
                return found.span()
        return index, index

    def _units(self, text: str) -> int:
        if text.isascii():
            return len(text)
        if self.encoding == types.PositionEncodingKind.Utf16:
            return len(text) + sum(character > "\uffff" for character in text)
        encoded = text.encode(_WIDTHS[types.PositionEncodingKind(self.encoding)], "surrogatepass")
        return len(encoded) if self.encoding == types.PositionEncodingKind.Utf8 else len(text)


@dataclass
class OpenDocument:
    """A document that is open in an editor, with what has been typed there. Line feeds end its lines here."""

    uri: str
    version: int
    content: DocumentText

    def change(self, changes: list[types.TextDocumentContentChangeEvent], version: int) -> None:
        """Take over what was typed."""
        for change in changes:
            text, new = self.content.text, plain_lines(change.text)
            if isinstance(change, types.TextDocumentContentChangePartial):
                start, end = self.content.index(change.range.start), self.content.index(change.range.end)
                new = text[:start] + new + text[max(start, end) :]
            self.content = DocumentText(new, self.content.encoding)
        self.version = version


def plain_lines(text: str) -> str:
    """`text` with lines that end in nothing but a line feed, and no mark of byte order."""
    return text.removeprefix("\ufeff").replace("\r\n", "\n")


def edits_between(old: DocumentText, new: str) -> list[types.TextEdit]:
    """The edits that make `new` of `old`: one in each line that differs, or one for all where lines come or go."""
    before, after = old.text.split("\n"), new.split("\n")
    if len(before) != len(after):
        return [_edit(old, 0, old.text, new)]
    rows = (row for row, line in enumerate(before) if line != after[row])
    return [_edit(old, old.index_of(row + 1, 1), before[row], after[row]) for row in rows]


def _edit(old: DocumentText, begin: int, before: str, after: str) -> types.TextEdit:
    """The smallest edit that makes `after` of `before`, which begins at a character of `old`."""
    start = _alike(before, after)
    same = _alike(before[start:][::-1], after[start:][::-1])
    where = old.range(begin + start, begin + len(before) - same)
    return types.TextEdit(where, after[start : len(after) - same])


def _alike(one: str, other: str) -> int:
    """How many characters are the same from the beginning on."""
    return next(
        (at for at, pair in enumerate(zip(one, other, strict=False)) if pair[0] != pair[1]), min(len(one), len(other))
    )
