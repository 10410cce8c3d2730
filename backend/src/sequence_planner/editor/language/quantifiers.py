"""The quantifiers before a place of an unfinished text: the words that they bind there, and what comes next."""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum
from typing import NamedTuple

from sequence_planner.language.lexer import Token
from sequence_planner.language.parser import QUANTIFIERS

_OPENING, _CLOSING = frozenset("([{"), frozenset(")]}")
_NO_QUANTIFIER_BEHIND = frozenset({"==", "!=", "<", "<=", ">", ">=", "{", ",", "["})


class QuantifierPart(Enum):
    """What of a quantifier can stand next."""

    WORD = "word"
    SET = "set"
    VALUE = "value"
    NOTHING = ""


class Quantifiers(NamedTuple):
    """The quantifiers before a place. `bound` are the words that stand for something there, each with its set or its
    values; `signs` are the numbers of the `where` and `:` that belong to quantifiers; `values` are those written so
    far where one stands next.
    """

    bound: dict[str, str | tuple[str, ...]]
    expected: QuantifierPart
    signs: frozenset[int]
    values: tuple[str, ...] = ()


def quantifiers_before(tokens: Sequence[Token]) -> Quantifiers:
    """The quantifiers among the words before a place."""
    return _Reader(tokens).quantifiers()


class _Reader:
    def __init__(self, tokens: Sequence[Token]) -> None:
        self._tokens = tokens
        self._at = 0
        self._depth = 0
        self._open: list[tuple[int, dict[str, str | tuple[str, ...]]]] = []
        self._signs: set[int] = set()

    def quantifiers(self) -> Quantifiers:
        while self._at < len(self._tokens):
            if self._begins():
                words: dict[str, str | tuple[str, ...]] = {}
                self._open.append((self._depth, words))
                expected, values = self._header(words)
                if expected is not QuantifierPart.NOTHING:
                    return self._found(expected, values)
                continue
            token = self._tokens[self._at]
            if token.kind in _OPENING:
                self._depth += 1
            elif token.kind in _CLOSING:
                self._depth -= 1
                while self._open and self._open[-1][0] > self._depth:
                    self._open.pop()
            elif token.kind == ":":
                self._signs.add(self._at)
            self._at += 1
        return self._found(QuantifierPart.NOTHING, ())

    def _found(self, expected: QuantifierPart, values: tuple[str, ...]) -> Quantifiers:
        bound = {word: domain for _, words in self._open for word, domain in words.items()}
        return Quantifiers(bound, expected, frozenset(self._signs), values)

    def _kind(self, ahead: int) -> str:
        at = self._at + ahead
        return self._tokens[at].kind if at < len(self._tokens) else ""

    def _text(self, ahead: int) -> str:
        at = self._at + ahead
        return self._tokens[at].text if at < len(self._tokens) else ""

    def _begins(self) -> bool:
        """Step over a quantifier, if one stands here."""
        word, before = self._text(0), self._tokens[self._at - 1].kind if self._at else ""
        length = 0
        if word in QUANTIFIERS:
            is_last = not self._kind(1) and before not in _NO_QUANTIFIER_BEHIND
            is_begun = self._kind(1) == "name" and self._kind(2) in ("", "in", ",")
            length = 1 if is_last or is_begun else 0
        elif word == "exactly" and self._kind(1) == "number":
            length = 2
        elif word == "at" and self._text(1) in ("least", "most") and self._kind(2) == "number":
            length = 3
        self._at += length
        return length > 0

    def _header(self, words: dict[str, str | tuple[str, ...]]) -> tuple[QuantifierPart, tuple[str, ...]]:
        """Read what a quantifier is about, up to its `:` or `where`; returns what is missing at the end of the text."""
        while True:
            group: list[str] = []
            while self._kind(0) == "name":
                group.append(self._text(0))
                self._at += 2 if self._kind(1) == "," else 1
            if not self._kind(0):
                is_next = not group or self._tokens[-1].kind == ","
                return (QuantifierPart.WORD if is_next else QuantifierPart.NOTHING), ()
            if self._kind(0) != "in":
                return QuantifierPart.NOTHING, ()
            self._at += 1
            if not self._kind(0):
                return QuantifierPart.SET, ()
            domain: str | tuple[str, ...] = self._text(0)
            self._at += 1
            while self._kind(0) == "." and self._kind(1) == "name":  # a set of a resource
                domain = f"{domain}.{self._text(1)}"
                self._at += 2
            if domain == "{":
                values = []
                while self._kind(0) in ("name", ","):
                    values += [self._text(0)] if self._kind(0) == "name" else []
                    self._at += 1
                domain = tuple(values)
                if not self._kind(0):
                    is_next = self._tokens[-1].kind != "name"
                    return (QuantifierPart.VALUE if is_next else QuantifierPart.NOTHING), domain
                self._at += 1
            words.update(dict.fromkeys(group, domain))
            if self._kind(0) != ",":
                break
            self._at += 1
        if self._kind(0) == ":" or self._text(0) == "where":
            self._signs.add(self._at)
            self._at += 1
        return QuantifierPart.NOTHING, ()
