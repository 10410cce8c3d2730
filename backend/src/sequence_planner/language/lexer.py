"""Words of the language."""

from __future__ import annotations

import re
from typing import NamedTuple

from sequence_planner.language.syntax import ExpressionError, Span

KEYWORDS = frozenset({"and", "or", "not", "implies", "in", "if", "true", "false"})

# Operators of LTL over finite traces; names everywhere but in formulas.
PREFIX_LETTERS = frozenset("XNFG")
INFIX_LETTERS = frozenset("URW")

# Solvers and tables compute with 32 bits; sums of these fit.
MOST_DIGITS = 6

# What people write out of habit from other languages, and what it is here.
_HABITS = {
    "&": "and",
    "&&": "and",
    "∧": "and",
    "|": "or",
    "||": "or",
    "∨": "or",
    "!": "not",
    "~": "not",
    "¬": "not",
    "->": "implies",
    "→": "implies",
    "⇒": "implies",
    "=>": "implies (or >= between integers)",
    "=": "== (or := in an action)",
    "===": "==",
    "<=>": "==",
    "<>": "!=",
    "!==": "!=",
    "≠": "!=",
    "=<": "<=",
    "≤": "<=",
    "≥": ">=",
    "∈": "in {...}",
    "+=": "n := n + 1",
    "-=": "n := n - 1",
    "++": "n := n + 1",
    "*": "a sum with + and -",
    '"': "values without quotes",
    "'": "values without quotes",
}
COLON = "`:` has no meaning here; write := in an action, == in a condition"  # but behind a quantifier
_LONG_HABITS = "|".join(re.escape(habit) for habit in sorted(_HABITS, key=len, reverse=True) if len(habit) > 1)
_WORD = re.compile(
    r"\s*(?:(?P<name>[A-Za-z_][A-Za-z0-9_]*)|(?P<number>[0-9]+)|"
    rf"(?P<habit>{_LONG_HABITS})|(?P<sign>:=|==|!=|<=|>=|[-+<>.,:()\[\]{{}}])|(?P<bad>\S))"
)
_NAME, _NUMBER, _SIGN = (_WORD.groupindex[group] for group in ("name", "number", "sign"))


class Token(NamedTuple):
    """A word and its place. `kind` is `name`, `number`, `end`, or the keyword or sign itself."""

    kind: str
    text: str
    start: int
    end: int

    @property
    def span(self) -> Span:
        """The place of the word."""
        return Span(self.start, self.end)

    def __str__(self) -> str:
        return "the end of the text" if self.kind == "end" else f"`{self.text}`"


def tokens(text: str) -> list[Token]:
    """Split `text` into words, ended by one of kind `end`. Raises `ExpressionError` at a character that is none."""
    found: list[Token] = []
    for match in _WORD.finditer(text):
        group = match.lastindex or 0
        word = match[group]
        start, end = match.span(group)
        kind = word
        if group == _NAME:
            if word not in KEYWORDS:
                kind = "name"
        elif group == _NUMBER:
            kind = "number"
            if len(word) > MOST_DIGITS:
                raise ExpressionError(f"a number has at most {MOST_DIGITS} digits, found {len(word)}", Span(start, end))
        elif group != _SIGN:
            hint = f"; write {_HABITS[word]}" if word in _HABITS else ""
            raise ExpressionError(f"`{word}` has no meaning here{hint}", Span(start, end))
        found.append(Token(kind, word, start, end))
    end = len(text.rstrip())
    found.append(Token("end", "", end, end))
    return found
