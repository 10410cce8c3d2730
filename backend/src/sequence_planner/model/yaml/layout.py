"""Where the entries of a YAML text begin and end, comments and blank lines included: what an edit may touch."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from sequence_planner.model.paths import EditError
from sequence_planner.model.yaml.reader import EntryPath, Node, compose
from sequence_planner.texts.message import message

_ALIAS = re.compile(r"\*[^\s,\]}]+")
_PROPERTIES = re.compile(r"(?:[&!]\S*(?:[ \t]+|$))+", re.MULTILINE)


@dataclass(frozen=True)
class YamlEntry:
    """One entry of a mapping or list. It is written from `start`, its value from `value_start` to `end`.

    `head` is just behind the `:` of its name or its `-`.
    """

    key: Node | None
    node: Node
    start: int
    head: int
    value_start: int
    end: int
    is_alias: bool


@dataclass(frozen=True)
class Layout:
    """A text and its nodes."""

    text: str
    root: Node

    @classmethod
    def of(cls, text: str) -> Layout | None:
        """Nothing for a text in which nothing stands."""
        root = compose(text)
        return None if root is None else cls(text, root)

    def entries(self, parent: Node) -> list[YamlEntry]:
        """The entries of a mapping or list, in order."""
        found: list[YamlEntry] = []
        at = self.skip_properties(parent)
        for item in parent.value:
            is_pair = parent.kind == "mapping"
            found.append(self._pair(*item) if is_pair else self._item(parent, item, at, is_first=not found))
            at = found[-1].end
        return found

    def find(self, path: EntryPath) -> list[tuple[Node, int]]:
        """The way to the entry at `path`, which exists: each mapping or list passed, and the position of the next."""
        way: list[tuple[Node, int]] = []
        node = self.root
        for step in path:
            if node.kind == "sequence":
                way.append((node, int(step)))
                node = node.value[int(step)]
            else:
                names = [key.value for key, _ in node.value]
                way.append((node, names.index(step)))
                node = node.value[names.index(step)][1]
        return way

    def entry(self, way: list[tuple[Node, int]]) -> YamlEntry:
        """The entry that a way leads to."""
        parent, position = way[-1]
        return self.entries(parent)[position]

    def refuse_shared(self, way: list[tuple[Node, int]], last: YamlEntry | None) -> None:
        """Refuse to change what an anchor shares with its aliases: what the way leads through, and all of `last`."""
        aliases = list(self._aliases(self.root))
        shared = {id(alias.node): alias for alias in aliases}
        for parent, position in way if last is None else way[:-1]:
            entry = self.entries(parent)[position]
            if id(entry.node) in shared:
                self._refuse(shared[id(entry.node)])
        if last is not None and not last.is_alias:
            inner = {id(node) for node in self._nodes(last)}
            for alias in aliases:
                if id(alias.node) in inner and not last.start <= alias.start < last.end:
                    self._refuse(alias)

    def _refuse(self, alias: YamlEntry) -> None:
        anchor, use = (self.line(index) for index in (alias.node.start.index, alias.value_start))
        raise EditError(message("edit.shared", anchor=anchor, use=use))

    def comments_above(self, parent: Node, position: int) -> int:
        """Return where the line of a block's entry begins, or those of the comments directly above it at its column.

        A comment that begins the file is about the file, and not about its first entry.
        """
        return self._comments_above(parent, self.entries(parent), position)

    def extents(self, parent: Node) -> list[tuple[int, int]]:
        """Return where each entry begins and ends with what goes with it: in a block the comments directly above it,
        the one behind it, and those below it that are indented more deeply. The margin of its first line is not in it.
        """
        entries = self.entries(parent)
        if parent.style:
            return [(entry.start, entry.end) for entry in entries]
        found: list[tuple[int, int]] = []
        for position, entry in enumerate(entries):
            begin = self._comments_above(parent, entries, position)
            while self.text[begin] == " ":
                begin += 1
            found.append((begin, self._comments_below(entry)))
        return found

    def _comments_below(self, entry: YamlEntry) -> int:
        """Return where the line of an entry's end ends, or the last of the comments below it that are indented more."""
        column = entry.start - self.line_start(entry.start)
        found = at = self.line_end(entry.end)
        while at < len(self.text):
            end = self.line_end(at + 1)
            line = self.text[at + 1 : end]
            inner = line.lstrip(" ")
            if inner and not (inner.startswith("#") and len(line) - len(inner) > column):
                break
            at = end
            if inner:
                found = end
        return found

    def _comments_above(self, parent: Node, entries: list[YamlEntry], position: int) -> int:
        start = entries[position].start
        floor = self.line_end(entries[position - 1].end) if position else self._head_end(parent)
        top = self.line_start(start)
        margin = " " * (start - top) + "#"
        if self.text[top:start].strip():
            return start
        begin = top
        while begin > floor + 1 and self.text.startswith(margin, self.line_start(begin - 1)):
            begin = self.line_start(begin - 1)
        return top if begin == 0 else begin

    def blank_above(self, index: int) -> int:
        """Count the blank lines that there are directly above the line that begins at `index`."""
        above = self.text[:index]
        return max(len(above) - len(above.rstrip("\n")) - 1, 0) if above.strip("\n") else len(above)

    def blank_below(self, index: int) -> int:
        """Count the blank lines that there are directly below the line that ends at `index`."""
        below = self.text[index + 1 :]
        return len(below) - len(below.lstrip("\n"))

    def _head_end(self, parent: Node) -> int:
        """Return where the line ends in which the name of a mapping or list stands, or -1 for the root."""
        if parent is self.root:
            return -1
        start = self.line_start(parent.start.index)
        above = re.compile(r"(?:[ ]*(?:#[^\n]*)?\n)*\Z").search(self.text, 0, start)
        return (above.start() if above else start) - 1

    def line(self, index: int) -> int:
        """The line of a character, from 1."""
        return self.text.count("\n", 0, index) + 1

    def line_start(self, index: int) -> int:
        """Return where the line of a character begins."""
        return self.text.rfind("\n", 0, index) + 1

    def line_end(self, index: int) -> int:
        """Return where the line of a character ends, before its line break."""
        found = self.text.find("\n", index)
        return len(self.text) if found < 0 else found

    def skip_properties(self, node: Node) -> int:
        """Return where a node begins behind its anchor and tag."""
        at = node.start.index
        if node.start.index < node.end.index and (found := _PROPERTIES.match(self.text, at)):
            at = found.end()
        return at

    def end_of(self, node: Node) -> int:
        """Just behind the last character of a node, without what only follows it."""
        if node.style in ("|", ">"):
            raw = self.text[node.start.index : node.end.index]
            keeps_blank_lines = "+" in raw.partition("\n")[0].partition("#")[0]
            return node.start.index + len(raw.removesuffix("\n") if keeps_blank_lines else raw.rstrip())
        if node.kind == "scalar" or node.style or not node.value:
            return node.end.index
        return self.entries(node)[-1].end

    def _pair(self, key: Node, value: Node) -> YamlEntry:
        start, behind = key.start.index, self._skip(self.end_of(key))
        if self.text[:start].rstrip(" ").endswith("?"):
            raise EditError(message("edit.question-mark", line=self.line(start)))
        has_colon = self.text[behind : behind + 1] == ":"
        value_at = behind + 1 if has_colon else self.end_of(key)
        return self._entry(key, value, start, value_at, self._skip(value_at) if has_colon else value_at)

    def _item(self, parent: Node, value: Node, after: int, is_first: bool) -> YamlEntry:
        if parent.style:
            start = self._skip(after + is_first, "," if not is_first else "")
            return self._entry(None, value, start, start, start)
        start = self._skip(after)
        return self._entry(None, value, start, start + 1, self._skip(start + 1))

    def _entry(self, key: Node | None, value: Node, start: int, empty_at: int, value_at: int) -> YamlEntry:
        if value.start.index < start:
            alias = _ALIAS.match(self.text, value_at)
            assert alias is not None, "a node that stands above is there by an alias"
            return YamlEntry(key, value, start, empty_at, alias.start(), alias.end(), True)
        if value.start.index == value.end.index:
            return YamlEntry(key, value, start, empty_at, empty_at, empty_at, False)
        return YamlEntry(key, value, start, empty_at, value_at, self.end_of(value), False)

    def _skip(self, at: int, also: str = "") -> int:
        """Behind white space and comments."""
        found = re.compile(rf"(?:[\s{also}]|#[^\n]*)*").match(self.text, at)
        return found.end() if found else at

    def _aliases(self, node: Node) -> Iterator[YamlEntry]:
        if node.kind != "scalar":
            for entry in self.entries(node):
                if entry.is_alias:
                    yield entry
                else:
                    yield from self._aliases(entry.node)

    def _nodes(self, entry: YamlEntry) -> Iterator[Node]:
        yield entry.node
        if entry.key is not None:
            yield entry.key
        if entry.node.kind != "scalar":
            for inner in self.entries(entry.node):
                if not inner.is_alias:
                    yield from self._nodes(inner)
