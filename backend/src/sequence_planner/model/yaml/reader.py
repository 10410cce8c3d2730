"""YAML reader with source positions: syntax nodes, and documents of lists, maps and scalars."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError
from ruamel.yaml.nodes import CollectionNode, MappingNode, ScalarNode
from ruamel.yaml.nodes import Node as RuamelNode
from ruamel.yaml.reader import ReaderError
from ruamel.yaml.resolver import implicit_resolvers
from yaml import YAMLError
from yaml.cyaml import CParser
from yaml.events import (
    AliasEvent,
    CollectionStartEvent,
    DocumentStartEvent,
    Event,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    StreamEndEvent,
)

from sequence_planner.language.types import Place
from sequence_planner.model.source import Finding, ModelError, SourceText
from sequence_planner.texts.message import message

# The nodes of a YAML text: what stands where, before anything is made of it.
#
# libyaml composes the texts that it is known to read as ruamel.yaml reads YAML 1.2; ruamel.yaml composes all others,
# and says what is wrong.


class Mark(Protocol):
    """A place in a text; all three count from 0, in characters."""

    index: int
    line: int
    column: int


@dataclass(slots=True, eq=False)
class Node:
    """A text, list or mapping. A node that an alias refers to is there twice, and is the same object.

    `value` is the text, the list of the nodes, or the pairs of nodes. `style` is how a text is quoted (one of `'"|>`)
    or, for lists and mappings, `{` if they stand in brackets; else empty.
    """

    kind: str
    tag: str
    value: Any
    start: Mark
    end: Mark
    style: str


def compose(text: str) -> Node | None:
    """The root of `text`, or nothing if it is empty. Raises ruamel.yaml's errors."""
    if not _READ_ALIKE_UNLESS.search(text):
        try:
            return _Composer(text).root()
        except (YAMLError, _NotAlike):
            pass  # ruamel.yaml says what is wrong with it
    return compose_slowly(text)


def compose_slowly(text: str) -> Node | None:
    """`compose` by ruamel.yaml alone, which is the reference."""
    yaml = YAML(typ="safe", pure=True)
    yaml.composer.warn_double_anchors = False  # an anchor may be used again, and means the last one
    root = yaml.compose(text)
    return None if root is None else _own(root, {})


# Where the two scanners are not of one mind: characters beside the common ones (tabs, carriage returns, marks of byte
# order), directives, several documents, keys with `?`, lines of nothing but spaces, names of anchors with signs,
# a `#` right behind a `|` or `>`, and a `:` apart from the quotes before it.
_READ_ALIKE_UNLESS = re.compile(
    "[^\n -~\xa0-\u2027\u202a-\ud7ff\ue000-\ufefe\uff00-\ufffd\U00010000-\U0010ffff]"
    r"|^%|^---|^\.\.\.|^ +$|(?:^|[\s,\[{])(?:\?(?:\s|$)|[&*][\w-]*[^\s\w,\]}-]|[|>][-+0-9]*#)|[\"'] +:",
    re.MULTILINE | re.ASCII,
)


class _NotAlike(Exception):
    pass


class _Composer:
    """Composes from libyaml's events. (PyYAML's own composer overflows the stack of the process on deep texts.)"""

    def __init__(self, text: str) -> None:
        self._text = text
        self._next = CParser(text).get_event
        self._anchors: dict[str, Node] = {}

    def root(self) -> Node | None:
        self._next()  # the beginning of the stream
        if not isinstance(self._next(), DocumentStartEvent):
            return None
        root = self._node(self._next())
        self._next()  # the end of the document
        if not isinstance(self._next(), StreamEndEvent) or root.kind == "scalar":
            raise _NotAlike
        return root

    def _node(self, event: Event) -> Node:
        if isinstance(event, AliasEvent):
            if event.anchor not in self._anchors:
                raise _NotAlike
            return self._anchors[event.anchor]
        assert isinstance(event, ScalarEvent | CollectionStartEvent)
        if event.tag is not None:
            raise _NotAlike  # what tags mean is not the same to both
        if isinstance(event, ScalarEvent):
            tag = _tag(event.value) if event.implicit[0] else "str"
            node = Node("scalar", tag, event.value, event.start_mark, event.end_mark, event.style or "")
        else:
            is_mapping = isinstance(event, MappingStartEvent)
            kind, tag, style = "mapping" if is_mapping else "sequence", "map" if is_mapping else "seq", event.flow_style
            node = Node(kind, tag, [], event.start_mark, event.end_mark, "{" if style else "")
        if event.anchor is not None:
            self._anchors[event.anchor] = node
        if node.kind == "mapping":
            self._fill_mapping(node)
        elif node.kind == "sequence":
            self._fill_sequence(node)
        return node

    def _fill_sequence(self, node: Node) -> None:
        event = self._next()
        while not isinstance(event, SequenceEndEvent):
            node.value.append(self._node(event))
            event = self._next()
        node.end = event.end_mark

    def _fill_mapping(self, node: Node) -> None:
        if node.style and self._text[node.start.index] != "{":
            raise _NotAlike  # a pair within a list
        event = self._next()
        while not isinstance(event, MappingEndEvent):
            key = self._node(event)
            node.value.append((key, self._node(self._next())))
            event = self._next()
        node.end = event.end_mark


_PLAIN: dict[str, list[tuple[str, re.Pattern[str]]]] = {}
for _versions, _name, _pattern, _firsts in implicit_resolvers:
    if (1, 2) in _versions:
        for _first in _firsts:
            _PLAIN.setdefault(_first, []).append((_name.rsplit(":", 1)[-1], re.compile(_pattern.pattern, re.VERBOSE)))


def _tag(text: str) -> str:
    """Return what an unquoted text means in YAML 1.2, by ruamel.yaml's own table."""
    for tag, pattern in _PLAIN.get(text[:1], ()):
        if pattern.match(text):
            return tag
    return "str"


def _own(node: RuamelNode, known: dict[int, Node]) -> Node:
    if id(node) in known:
        return known[id(node)]
    tag = str(node.tag).rsplit(":", 1)[-1]
    if isinstance(node, ScalarNode):
        own = Node("scalar", tag, node.value, node.start_mark, node.end_mark, node.style or "")
    else:
        assert isinstance(node, CollectionNode)
        kind = "mapping" if isinstance(node, MappingNode) else "sequence"
        own = Node(kind, tag, node.value, node.start_mark, node.end_mark, "{" if node.flow_style else "")
    known[id(node)] = own
    if own.kind == "sequence":
        own.value = [_own(item, known) for item in node.value]
    elif own.kind == "mapping":
        own.value = [(_own(key, known), _own(value, known)) for key, value in node.value]
    return own


# Reading YAML with places: dicts, lists, numbers and texts, of which each is known by its line and column.

EntryPath = tuple[str | int, ...]

# Aliases of aliases can make a short file mean a gigantic one: of entries that stand in the file itself, and of those
# that aliases stand for, which are there already.
MOST_ENTRIES, MOST_REPEATED = 100_000, 10_000

# An anchor or a tag before a text: no part of it.
_NO_TEXT = re.compile("[\0\ud800-\udfff]")
_PROPERTIES = re.compile(r"(?:[&!]\S*\s+)+")


@dataclass(frozen=True)
class YamlDocument:
    """The content of one file, and the place of each entry by its path of keys and indices.

    The place of a named entry is that of its name; `values` has where what stands behind the name begins.
    """

    file: str
    content: object
    places: dict[EntryPath, Place]
    values: dict[EntryPath, Place]

    def place(self, path: EntryPath) -> Place:
        """The place of the entry at `path`, or of the innermost entry around it."""
        while path not in self.places and path:
            path = path[:-1]
        return self.places.get(path, Place(self.file, 1, 1))

    def place_of_value(self, path: EntryPath) -> Place:
        """Like `place`, but behind the name where the value stands in the same line."""
        while path not in self.places and path:
            path = path[:-1]
        return self.values.get(path, self.place(path))


@dataclass(frozen=True)
class MadePlaces:
    """The places of a document that is made of others: of its entries, and of what stands behind their names."""

    names: dict[EntryPath, Place]
    values: dict[EntryPath, Place]

    def overlay(self, names: dict[EntryPath, Place], values: dict[EntryPath, Place]) -> None:
        """Have what stands at the same path in another document."""
        self.names.update(names)
        self.values.update(values)

    def copy_from(self, document: YamlDocument, path: EntryPath, to: EntryPath, instance: str) -> None:
        """Have what stands at `path` in another document, for an instance of a type."""
        for made, found in ((self.names, document.places), (self.values, document.values)):
            if (place := found.get(path)) is not None:
                made[to] = place._replace(instance=instance)

    def give(self, path: EntryPath, instance: str, *, of_name: bool = False) -> None:
        """Have another instance, with the place of an argument in it, for the value at `path`, or for its name."""
        is_entry = of_name or (bool(path) and isinstance(path[-1], int))
        made = self.names if is_entry else self.values
        if path in made:
            made[path] = made[path]._replace(instance=instance)


def read_yaml(path: Path, name: str) -> YamlDocument:
    """Read one YAML file; `name` is how it is called in messages. Raises `ModelError`."""
    return read_text(text_of(path, name), name)


def text_of(path: Path, name: str) -> str:
    """The text of a file; `name` is how it is called in messages. Raises `ModelError`."""
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror or str(error) if isinstance(error, OSError) else message("wrong.unreadable.utf-8")
        raise ModelError([Finding(Place(name, 1, 1), message("wrong.unreadable", why=reason))]) from error


def read_text(text: str, name: str) -> YamlDocument:
    """Read YAML; `name` is how the text is called in messages. Raises `ModelError`."""
    reader = _Reader(name, text)
    try:
        root = compose(text)
        content = {} if root is None else reader.read(root, ())
    except MarkedYAMLError as error:
        raise ModelError([_not_yaml(name, error)]) from error
    except ReaderError as error:
        strange = message("wrong.yaml.character", code=f"{ord(text[error.position]):#06x}")
        what = message("wrong.yaml", problem=strange)
        raise ModelError([Finding(reader.place_at(error.position), what)]) from error
    except RecursionError as error:
        raise ModelError(
            [Finding(Place(name, 1, 1), message("wrong.unreadable", why=message("wrong.unreadable.nested")))]
        ) from error
    if reader.findings:
        raise ModelError(reader.findings)
    return YamlDocument(name, content, reader.places, reader.values)


def _not_yaml(name: str, error: MarkedYAMLError) -> Finding:
    """The parser's complaint, in plain words where it has none, and at the opening of what is never closed."""
    problem, mark = str(error.problem), error.problem_mark
    if "end of stream" in problem:
        problem, mark = message("wrong.yaml.quote"), error.context_mark or mark
    elif "'\\t'" in problem:
        problem = message("wrong.yaml.tab")
    elif "another document" in problem:
        problem = message("wrong.yaml.document")
    elif "expected ',' or" in problem:
        problem = message("wrong.yaml.in-line", problem=problem)
    elif "mapping values are not allowed" in problem:
        problem = message("wrong.yaml.name")
    elif "'<document start>'" in problem or "<block end>" in problem:
        problem = message("wrong.yaml.indentation")
    place = Place(name, mark.line + 1, mark.column + 1) if mark else Place(name, 1, 1)
    return Finding(place, message("wrong.yaml", problem=problem))


class _Reader:
    """Turns YAML nodes into dicts, lists, numbers and placed texts."""

    def __init__(self, file: str, text: str) -> None:
        self._file = file
        self._text = text
        self._entries = self._repeated = 0
        self._repeating = 0  # how many of the lists and mappings around stand elsewhere in the text
        self._read: set[Node] = set()
        self._around: list[Node] = []
        self.places: dict[EntryPath, Place] = {}
        self.values: dict[EntryPath, Place] = {}
        self.findings: list[Finding] = []

    def read(self, node: Node, path: EntryPath) -> object:
        """The content of `node`, which stands at `path`."""
        if path not in self.places:
            self.places[path] = self._place(node)
        if node.kind == "scalar":
            return self._scalar(node)
        if node in self._around:
            self._found(self._place(node), "this contains itself, by an alias of its own anchor")
            return None
        is_repeated = node in self._read
        self._read.add(node)
        self._around.append(node)
        self._repeating += is_repeated
        content = self._mapping(node, path) if node.kind == "mapping" else self._sequence(node, path)
        self._repeating -= is_repeated
        self._around.pop()
        return content

    def place_at(self, index: int) -> Place:
        """The place of a character of the file."""
        line = self._text.count("\n", 0, index)
        return Place(self._file, line + 1, index - self._text.rfind("\n", 0, index))

    def _sequence(self, node: Node, path: EntryPath) -> list[object]:
        return [self.read(item, (*path, index)) for index, item in enumerate(node.value) if self._has_room(item)]

    def _mapping(self, node: Node, path: EntryPath) -> dict[SourceText, object]:
        content: dict[SourceText, object] = {}
        written: dict[str, str] = {}
        for key_node, value_node in node.value:
            if key_node.kind != "scalar":
                self._found(self._place(key_node), message("wrong.no-name"))
                continue
            key = self._text_of(key_node)
            if key_node.tag == "merge":
                self._found(key.place, message("wrong.merge-key"))
                continue
            value = self._text[value_node.start.index : value_node.end.index].strip()
            if key in content:
                first = self.places[(*path, str(key))]
                id_ = "wrong.duplicate-same" if value == written[key] else "wrong.duplicate"
                self._found(key.place, message(id_, name=str(key), line=first.line))
                continue
            written[key] = value
            if not self._has_room(key_node):
                break
            self.places[(*path, str(key))] = key.place
            if value_node.start.line == key_node.start.line and value_node.value != "":
                self.values[(*path, str(key))] = self._place(value_node)
            content[key] = self.read(value_node, (*path, str(key)))
        return content

    def _has_room(self, node: Node) -> bool:
        if self._repeating:
            self._repeated += 1
            if self._repeated == MOST_REPEATED:
                what = f"too large: its aliases stand for more than {MOST_REPEATED} entries; write out what is meant"
                self._found(self._place(node), what)
            return self._repeated < MOST_REPEATED
        self._entries += 1
        if self._entries == MOST_ENTRIES:
            what = f"too large: it has more than {MOST_ENTRIES} entries; divide it into several files"
            self._found(self._place(node), what)
        return self._entries < MOST_ENTRIES

    def _found(self, place: Place, message: str) -> None:
        self.findings.append(Finding(place, message))

    def _scalar(self, node: Node) -> object:
        kind = node.tag
        if kind == "null":
            return None
        if kind == "bool":
            return node.value.lower() in (
                "true",
                "yes",
                "on",
                "y",
            )  # all but `true` only where a file asks for YAML 1.1
        if kind in ("int", "float"):
            try:
                return _integer(node.value) if kind == "int" else _float(node.value)
            except ValueError:
                shown = node.value if len(node.value) <= 30 else f"{node.value[:27]}..."
                self._found(self._place(node), f"`{shown}` is no number that can be used")
                return 0
        return self._text_of(node)

    def _text_of(self, node: Node) -> SourceText:
        raw = self._text[node.start.index : node.end.index]
        place = self._place(node)
        if raw[:1] in ("&", "!") and (properties := _PROPERTIES.match(raw)):
            raw = raw[properties.end() :]
            place = self.place_at(node.start.index + properties.end())
        value = str(node.value)
        if (wrong := _NO_TEXT.search(value)) is not None:
            self._found(place, f"this would hold the character {ord(wrong[0]):#06x}, which no text does")
            value = _NO_TEXT.sub("?", value)  # nobody could be told of it
        return SourceText(value, place, raw)

    def _place(self, node: Node) -> Place:
        return Place(self._file, node.start.line + 1, node.start.column + 1)


def _integer(text: str) -> int:
    digits = text.replace("_", "")
    try:
        return int(digits, 0)
    except ValueError:
        return int(digits)  # leading zeros


def _float(text: str) -> float:
    """A number as YAML writes it; `.inf` and `.nan` too, which no document part accepts."""
    digits = text.replace("_", "").lower()
    return float(digits.replace(".inf", "inf").replace(".nan", "nan"))
