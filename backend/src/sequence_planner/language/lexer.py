"""Words of the language."""

from __future__ import annotations

import re
from typing import NamedTuple

from sequence_planner.language.syntax import ExpressionError, Span
from sequence_planner.texts.late import message

KEYWORDS = frozenset({"and", "or", "not", "implies", "in", "if", "true", "false"})

# Operators of LTL over finite traces; names everywhere but in formulas.
PREFIX_LETTERS = frozenset("XNFG")
INFIX_LETTERS = frozenset("URW")

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
    "===": "==",
    "<=>": "==",
    "<>": "!=",
    "!==": "!=",
    "≠": "!=",
    "=<": "<=",
    "≤": "<=",
    "≥": ">=",
    "∈": "in {...}",
}
_HABITS_IN_GUARDS = {
    "=>": "implies (or >= between integers)",
    "=": "== (or := in an action)",
    ":": ":= in an action, == in a condition",
    "+=": "n := n + 1",
    "-=": "n := n - 1",
    "++": "n := n + 1",
    "*": "a sum with + and -",
    '"': "values without quotes",
    "'": "values without quotes",
}
COLON = "`:` has no meaning here; write := in an action, == in a condition"  # but behind a quantifier
_HABITS_OVER_RECORDS = {
    "=>": "implies (or >= between numbers)",
    "=": "==",
    ":=": "==",
    "**": "a product",
    '"': "texts in single quotes",
}


class Dialect:
    """The words that there are where an expression stands; the grammar is the same everywhere."""

    def __init__(self, number: str, most_digits: int, sign: str, text: str, habits: dict[str, str]) -> None:
        self.most_digits = most_digits
        self._habits = _HABITS | habits
        long = "|".join(re.escape(habit) for habit in sorted(self._habits, key=len, reverse=True) if len(habit) > 1)
        self.words = re.compile(
            rf"\s*(?:(?P<name>[A-Za-z_][A-Za-z0-9_]*)|(?P<number>{number})|"
            rf"(?P<habit>{long})|(?P<sign>{sign}|==|!=|<=|>=|[-+<>.,:()\[\]{{}}])|(?P<other>{text}\S))"
        )

    def meaningless(self, word: str) -> str:
        """Say what to write instead of a word that is none here."""
        if word == "'" and "'" not in self._habits:
            return message("wrong.open-text")
        if word in self._habits:
            return message("wrong.foreign", word=word, meant=self._habits[word])
        return message("wrong.meaningless", word=word)


# Conditions, actions and formulas. Solvers and tables compute with 32 bits; sums of integers of these digits fit.
MOST_DIGITS = 6
GUARDS = Dialect("[0-9]+", MOST_DIGITS, ":=", "", _HABITS_IN_GUARDS)

# Expressions over records: also real numbers, texts, products; integers have up to 64 bits.
RECORDS = Dialect(r"[0-9]+(?:\.[0-9]+)?(?:[eE][-+]?[0-9]+)?", 20, "[*/]", "'(?:[^']|'')*'|", _HABITS_OVER_RECORDS)
_NAME, _NUMBER, _HABIT, _SIGN = (GUARDS.words.groupindex[group] for group in ("name", "number", "habit", "sign"))


class Token(NamedTuple):
    """A word and its place. `kind` is `name`, `number`, `text`, `end`, or the keyword or sign itself."""

    kind: str
    text: str
    start: int
    end: int

    @property
    def span(self) -> Span:
        """The place of the word."""
        return Span(self.start, self.end)

    def __str__(self) -> str:
        return str(self.as_found)

    @property
    def as_found(self) -> str:
        """The word, as people are told of it."""
        return message("token.end-of-text") if self.kind == "end" else f"`{self.text}`"


def tokens(text: str, dialect: Dialect = GUARDS) -> list[Token]:
    """Split `text` into words, ended by one of kind `end`. Raises `ExpressionError` at a character that is none."""
    found: list[Token] = []
    for match in dialect.words.finditer(text):
        group = match.lastindex or 0
        word = match[group]
        start, end = match.span(group)
        kind = word
        if group == _NAME:
            if word not in KEYWORDS:
                kind = "name"
        elif group == _NUMBER:
            kind = "number"
            if len(word) > dialect.most_digits:
                too_long = message("wrong.digits", most=dialect.most_digits, found=len(word))
                raise ExpressionError(too_long, Span(start, end))
        elif group != _SIGN:
            if group == _HABIT or len(word) == 1:
                raise ExpressionError(dialect.meaningless(word), Span(start, end))
            kind = "text"
        found.append(Token(kind, word, start, end))
    end = len(text.rstrip())
    found.append(Token("end", "", end, end))
    return found
