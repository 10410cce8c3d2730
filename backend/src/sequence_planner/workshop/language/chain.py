"""The name that is being written at a place of a text: `robot.move(ho` before it, `me).done` behind it."""

from __future__ import annotations

import re
from typing import NamedTuple

from sequence_planner.expressions.lexer import INFIX_LETTERS, KEYWORDS, PREFIX_LETTERS
from sequence_planner.expressions.syntax import Span

_WORD = r"[A-Za-z_][A-Za-z0-9_]*"
_ARGUMENTS = r"(?:\([\w\s,]*\)|\[[\w\s,]*\])"
_WHOLE = re.compile(rf"{_WORD}{_ARGUMENTS}?(?:\.{_WORD}{_ARGUMENTS}?)*|[0-9]+")
_UNFINISHED = re.compile(
    rf"(?<![A-Za-z0-9_.])(?:(?:{_WORD}{_ARGUMENTS}?\.)*(?:{_WORD}(?:[(\[][\w\s,]*[)\]]?)?)?|[0-9]+)\Z"
)
_REST = re.compile(r"[A-Za-z0-9_]*")
_FURTHEST = 400  # characters in which a name is looked for


class Chain(NamedTuple):
    """Where the name begins and ends, and what of it stands before the place."""

    start: int
    end: int
    typed: str


def chain_at(text: str, offset: int, temporal: bool = False) -> Chain:
    """The name at `offset`, empty where none is; in a `temporal` text a letter before a bracket is no name."""
    floor = max(0, offset - _FURTHEST)
    found = _UNFINISHED.search(text[floor:offset])
    typed = "" if found is None else _behind_words(found[0], temporal)
    start = offset - len(typed)
    whole = whole_at(text, start, temporal)
    end = whole if whole >= offset else offset + len(_matched(text, offset))
    return Chain(start, end, typed)


def whole_at(text: str, start: int, temporal: bool = False) -> int:
    """Where the name or number that begins at `start` ends."""
    found = _WHOLE.match(text, start)
    if found is None:
        return start
    head = _matched(text, start)
    return start + len(head) if _is_no_name(head, temporal) and found[0] != head else found.end()


def word_at(text: str, offset: int) -> Span:
    """The letters and digits around `offset`."""
    start = offset
    while start > 0 and _matched(text, start - 1):
        start -= 1
    return Span(start, offset + len(_matched(text, offset)))


def _behind_words(typed: str, temporal: bool) -> str:
    """What is left of `typed` behind words of the language that stand before a bracket, as in `not(a`."""
    head = _matched(typed, 0)
    behind = typed[len(head) :]
    if behind[:1] == "(" and _is_no_name(head, temporal) and ")" not in behind:
        return _behind_words(behind[1:].lstrip(), temporal)
    return typed


def _is_no_name(word: str, temporal: bool) -> bool:
    return word in KEYWORDS or (temporal and word in PREFIX_LETTERS | INFIX_LETTERS)


def _matched(text: str, at: int) -> str:
    found = _REST.match(text, at)
    return "" if found is None else found[0]
