"""The entry of a YAML document at a place of its text, which may be one that nobody has finished writing."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from ruamel.yaml.error import YAMLError

from sequence_planner.language.syntax import Span
from sequence_planner.language.types import Place
from sequence_planner.model.source import SourceText
from sequence_planner.model.yaml.reader import EntryPath, Node, compose

_KEY = re.compile(r"(\s*(?:- +)*)((?:\"[^\"]*\"|'[^']*'|[^\s#'\"\[{][^#]*?)):(?=\s|$)")
_LONE_WORD = re.compile(r"(\s*(?:- +)*)([\w/]*)\s*")
_CLOSING = {"[": "]", "{": "}"}
_SHORT = 50_000  # characters that are soon read, also where they are no YAML
_TYPED = "x"  # stands at the place while something is typed there: then there is something in any case


@dataclass(frozen=True)
class Cursor:
    """The name or value at a place: of the entry at `path`, beside others called `beside`.

    `text` is it as YAML reads it, and the place is at `offset` of it; in the file that is at `index`, and the text
    begins at `begin`. `parameters` are those of the ability, operation or specification around it.
    """

    path: EntryPath
    is_name: bool
    text: SourceText
    offset: int
    index: int
    begin: int
    beside: tuple[str, ...]
    parameters: dict[str, str] | None

    def begins_line(self, text: str) -> bool:
        """Return whether it is the first in its line of a file with that text, but for the marks of a list."""
        return not text[text.rfind("\n", 0, self.begin) + 1 : self.begin].strip(" -")

    def span_in_file(self, start: int, end: int) -> tuple[int, int]:
        """Return where `start` to `end` of the text stands in the file."""
        if not self.text[start:end].strip():
            return self.index, self.index
        first, last = self.text.written(Span(start, end))
        return self.begin + first, self.begin + last


def read_at(text: str, index: int) -> Cursor | None:
    """Return what stands at `index`, or None where nothing does, or nobody can say what."""
    block = _block_around(text, index)
    for piece in (block, _Piece(text, 0, 0)) if len(text) < _SHORT else (block,):
        root = _composed(piece.text)
        if root is not None:
            return _Finder(piece, piece.local(index), index, None).cursor(root)
    return None


def typed_at(text: str, index: int) -> Iterator[Cursor]:
    """Yield what something typed at `index` would be, the likeliest first: a name where it has a line for itself."""
    block = _block_around(text, index)
    for piece in (block, block.until(index), _spine(text, index)):
        found = list(_typed_in(piece, index))
        if found:
            beside = _names_beside(text, index)
            for each in found:
                yield replace(each, beside=(*each.beside, *beside)) if each.is_name and each.begins_line(text) else each
            return


def _typed_in(piece: _Piece, index: int) -> Iterator[Cursor]:
    at = piece.local(index)
    before, behind = piece.text[:at], piece.text[at:]
    line = before[before.rfind("\n") + 1 :] + behind.partition("\n")[0]
    rest = behind[len(_word(behind)) :]
    if _LONE_WORD.fullmatch(line):
        named = f"{before}{_TYPED}{_word(behind)}:{rest}"
        if (root := _composed(named)) is not None:
            found = _Finder(piece, at, index, named).cursor(root)
            if found is not None and found.is_name:
                yield found
    for closing in dict.fromkeys(("", _closing(before))):
        below = behind[behind.find("\n") :] if "\n" in behind else ""
        typed = f"{before}{_TYPED}{_word(behind)}{closing}{below}" if closing else f"{before}{_TYPED}{behind}"
        if (root := _composed(typed)) is not None and (found := _Finder(piece, at, index, typed).cursor(root)):
            yield found
            return


def _names_beside(text: str, index: int) -> list[str]:
    """The names of the mapping that the line of a place is a part of, where it is not in brackets."""
    lines = text.split("\n")
    row = text.count("\n", 0, index)
    level = _indentation(lines[row])
    if level is None:
        level = index - text.rfind("\n", 0, index) - 1
    names = []
    for rows in (range(row - 1, -1, -1), range(row + 1, len(lines))):
        for at in rows:
            indentation = _indentation(lines[at])
            if indentation is not None and indentation < level:
                break
            if indentation == level and (found := _KEY.match(lines[at])):
                names.append(found[2])
    return names


def _word(text: str) -> str:
    found = re.match(r"\w*", text)
    return found[0] if found else ""


def _closing(before: str) -> str:
    """Return what closes the brackets and the quote that are open in the last line, or in those above within it."""
    line = before[before.rfind("\n") + 1 :]
    open_: list[str] = []
    quote = ""
    for position, character in enumerate(line):
        if quote:
            quote = "" if character == quote else quote
        elif character in "'\"" and (not line[:position].rstrip() or line[:position].rstrip()[-1] in ":-[{,"):
            quote = character
        elif character in _CLOSING and (open_ or line[:position].rstrip()[-1:] in (":", "-", "")):
            open_.append(_CLOSING[character])
        elif open_ and character == open_[-1]:
            open_.pop()
    return quote + "".join(reversed(open_))


class _Piece(NamedTuple):
    """A part of a file that can be read alone: a first line that begins at `top` of it, and others from `rest` on."""

    text: str
    top: int
    rest: int

    @property
    def _head(self) -> int:
        return 0 if self.top == self.rest else self.text.find("\n") + 1

    def local(self, index: int) -> int:
        """Return where a place of the file is here."""
        return index - self.rest + self._head if index >= self.rest else index - self.top

    def outer(self, local: int) -> int:
        """Return where a place of it is in the file."""
        return local - self._head + self.rest if local >= self._head else local + self.top

    def until(self, index: int) -> _Piece:
        """The same to the end of the line of a place."""
        end = self.text.find("\n", self.local(index))
        return self if end < 0 else self._replace(text=self.text[: end + 1])


def entry_end(text: str, index: int) -> int:
    """Return where the entry ends whose name begins at `index`: with its line, or with what is indented below it."""
    start = text.rfind("\n", 0, index) + 1
    end = text.find("\n", index)
    if text[start:index].strip(" -") or end < 0:
        return len(text) if end < 0 else min(end, index + len(_word(text[index:])))
    level, last = index - start, end
    while end < len(text):
        begin, end = end + 1, text.find("\n", end + 1)
        end = len(text) if end < 0 else end
        indentation = _indentation(text[begin:end])
        if indentation is not None and indentation <= level:
            break
        last = end if indentation is not None else last
    return last


def _indentation(line: str) -> int | None:
    """Return how far a line is indented; None where nothing but a comment stands in it."""
    bare = line.lstrip(" ")
    return None if not bare or bare[0] in "#\r" else len(line) - len(bare)


def _block_around(text: str, index: int) -> _Piece:
    """The smallest part around a place that can be read alone: the entry of an entry of the document."""
    lines = text.split("\n")
    row = text.count("\n", 0, index)
    starts = _starts(lines)
    column = index - starts[row]
    own = _indentation(lines[row])
    own = column if own is None else own
    top = row
    while own and top > 0 and _indentation(lines[top]) != 0:
        top -= 1
    end = _next(lines, row + 1, 0)
    if own == 0 and (not lines[row].strip() or _KEY.fullmatch(lines[row].rstrip())):
        end = row + 1
    inner = next((at for at in range(top + 1, end) if _indentation(lines[at]) is not None), end)
    level = _indentation(lines[inner]) if inner < end else None
    is_block = _KEY.fullmatch(lines[top].partition(" #")[0].rstrip()) is not None
    if level is None or row == top or not is_block or lines[inner].lstrip().startswith("-") or own < level:
        return _piece(lines, starts, range(top, end))
    if own == level and not lines[row].strip():
        return _piece(lines, starts, range(row, row + 1), top)
    begin = row
    while begin > inner and _indentation(lines[begin]) != level:
        begin -= 1
    return _piece(lines, starts, range(begin, _next(lines, max(row, begin) + 1, level)), top)


def _next(lines: Sequence[str], row: int, level: int) -> int:
    """The next line from `row` on that is indented by no more than `level`."""
    for at in range(row, len(lines)):
        indentation = _indentation(lines[at])
        if indentation is not None and indentation <= level:
            return at
    return len(lines)


def _starts(lines: Sequence[str]) -> list[int]:
    starts, at = [], 0
    for line in lines:
        starts.append(at)
        at += len(line) + 1
    return starts


def _piece(lines: Sequence[str], starts: Sequence[int], rows: range, top: int | None = None) -> _Piece:
    body = "\n".join(lines[row] for row in rows)
    begin = starts[rows.start] if rows.start < len(starts) else 0
    return _Piece(body, begin, begin) if top is None else _Piece(f"{lines[top]}\n{body}", starts[top], begin)


def _spine(text: str, index: int) -> _Piece:
    """The line of a place below nothing but the names that it stands under: for where the rest makes no sense.

    Only the line itself is where it is in the file.
    """
    lines = text.split("\n")
    row = text.count("\n", 0, index)
    starts = _starts(lines)
    own = _indentation(lines[row])
    limit = index - starts[row] if own is None else own
    above: list[str] = []
    for at in range(row - 1, -1, -1):
        indentation = _indentation(lines[at])
        if indentation is not None and indentation < limit and (found := _KEY.match(lines[at])):
            above.insert(0, found[0])
            limit = indentation
    head = "".join(f"{line}\n" for line in above)
    return _Piece(head + lines[row], starts[row] - len(head), starts[row] - len(head))


def _composed(text: str) -> Node | None:
    try:
        return compose(text)
    except (YAMLError, RecursionError):
        return None


class _Finder:
    """Looks for what stands at a place of a piece, in whose text `typed` something may have been put there."""

    def __init__(self, piece: _Piece, at: int, index: int, typed: str | None) -> None:
        self._piece = piece
        self._at = at
        self._index = index
        self._typed = typed
        self._text = piece.text if typed is None else typed

    def cursor(self, root: Node) -> Cursor | None:
        found = self._in(root, (), ())
        return found and self._with_parameters(found, root)

    def _in(self, node: Node, path: EntryPath, beside: tuple[str, ...]) -> Cursor | None:
        if node.kind == "scalar":
            return self._scalar(node, path, False, beside) if self._touches(node) else None
        if node.kind == "sequence":
            entries = ((item, (*path, number)) for number, item in enumerate(node.value))
            return next((found for item, at in entries if (found := self._in(item, at, ())) is not None), None)
        names = [key.value for key, _ in node.value if key.kind == "scalar"]
        for key, value in node.value:
            if key.kind != "scalar":
                continue
            others = tuple(name for name in names if name != key.value)
            if self._touches(key):
                return self._scalar(key, (*path, key.value), True, others)
            if value.start.index >= key.end.index and (found := self._in(value, (*path, key.value), others)):
                return found
        return None

    def _touches(self, node: Node) -> bool:
        start, end = node.start.index, node.end.index
        if node.style in ("|", ">"):
            end = start + len(self._text[start:end].rstrip())
        return start <= self._at < end if self._typed is not None else start <= self._at <= end and start < end

    def _scalar(self, node: Node, path: EntryPath, is_name: bool, beside: tuple[str, ...]) -> Cursor | None:
        raw = self._text[node.start.index : node.end.index]
        if raw[:1] in ("&", "!", "*"):
            return None
        place, within = Place("", 1, 1), self._at - node.start.index
        value = str(node.value)
        text = SourceText(value, place, raw)
        offset = text.offset(within)
        if self._typed is not None:
            value, raw = value[:offset] + value[offset + 1 :], raw[:within] + raw[within + 1 :]
            text = SourceText(value, place, raw)
            path = (*path[:-1], value) if is_name else path
        begin = self._piece.outer(node.start.index)
        return Cursor(path, is_name, text, offset, self._index, begin, beside, None)

    def _with_parameters(self, found: Cursor, root: Node) -> Cursor:
        """With the parameters of what it stands in, as they are written now."""
        for depth in (2, 1):
            node: Node | None = root
            for step in (*found.path[:depth], "parameters"):
                node = _entry(node, step)
            if node is not None and node.kind == "mapping" and len(found.path) > depth:
                pairs = {key.value: value.value for key, value in node.value if value.kind == "scalar"}
                return replace(found, parameters=pairs)
        return found


def _entry(node: Node | None, step: str | int) -> Node | None:
    if node is None or node.kind != "mapping":
        return None
    return next((value for key, value in node.value if key.value == step), None)
