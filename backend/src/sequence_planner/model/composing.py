"""The nodes of a YAML text: what stands where, before anything is made of it.

libyaml composes the texts that it is known to read as ruamel.yaml reads YAML 1.2; ruamel.yaml composes all others, and
says what is wrong.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, Protocol

from ruamel.yaml import YAML
from ruamel.yaml.nodes import CollectionNode, MappingNode, ScalarNode
from ruamel.yaml.nodes import Node as RuamelNode
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
    """What an unquoted text means in YAML 1.2, by ruamel.yaml's own table."""
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
