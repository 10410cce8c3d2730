"""Words of the language."""

from __future__ import annotations

import re
from dataclasses import dataclass

from sequence_planner.expressions.syntax import ExpressionError, Span

KEYWORDS = frozenset({"and", "or", "not", "implies", "in", "if", "true", "false"})

_WORD = re.compile(
    r"\s*(?:(?P<name>[A-Za-z_][A-Za-z0-9_]*)|(?P<number>[0-9]+)|(?P<sign>:=|==|!=|<=|>=|[-+<>.,()\[\]{}])|(?P<bad>\S))"
)

# Solvers and tables compute with 32 bits; sums of these fit.
MOST_DIGITS = 6

# What people write out of habit from other languages, and what it is here.
_HABITS = {
    "&": "and",
    "|": "or",
    "!": "not",
    "=": "== (or := in an action)",
    "¬": "not",
    "∧": "and",
    "∨": "or",
}


@dataclass(frozen=True)
class Token:
    """A word and its place. `kind` is `name`, `number`, `end`, or the keyword or sign itself."""

    kind: str
    text: str
    span: Span

    def __str__(self) -> str:
        return "the end of the text" if self.kind == "end" else f"`{self.text}`"


def tokens(text: str) -> list[Token]:
    """Split `text` into words, ended by one of kind `end`. Raises `ExpressionError` at a character that is none."""
    found: list[Token] = []
    place = 0
    while (match := _WORD.match(text, place)) is not None:
        kind = str(match.lastgroup)
        word = match[kind]
        span = Span(match.start(kind), match.end(kind))
        if kind == "bad":
            hint = f"; write {_HABITS[word]}" if word in _HABITS else ""
            raise ExpressionError(f"`{word}` has no meaning here{hint}", span)
        if kind == "number" and len(word) > MOST_DIGITS:
            raise ExpressionError(f"a number has at most {MOST_DIGITS} digits, found {len(word)}", span)
        if kind == "sign" or word in KEYWORDS:
            kind = word
        found.append(Token(kind, word, span))
        place = match.end()
    end = len(text.rstrip())
    return [*found, Token("end", "", Span(end, end))]
