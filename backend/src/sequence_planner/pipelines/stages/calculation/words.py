"""Words of expressions over records."""

from __future__ import annotations

import re

from sequence_planner.expressions.lexer import KEYWORDS, Token
from sequence_planner.expressions.syntax import ExpressionError, Span

MOST_DIGITS = 20  # of a number without a decimal point: those of 64 bits

# What people write out of habit from other languages, and what it is here.
_HABITS = {
    "&&": "and",
    "||": "or",
    "!": "not",
    "->": "implies",
    "=>": "implies (or >= between numbers)",
    "=": "==",
    ":=": "==",
    "<>": "!=",
    "≠": "!=",
    "=<": "<=",
    "≤": "<=",
    "≥": ">=",
    "**": "a product",
    '"': "texts in single quotes",
}
_LONG_HABITS = "|".join(re.escape(habit) for habit in sorted(_HABITS, key=len, reverse=True) if len(habit) > 1)
_WORD = re.compile(
    r"\s*(?:(?P<name>[A-Za-z_][A-Za-z0-9_]*)|(?P<number>[0-9]+(?:\.[0-9]+)?(?:[eE][-+]?[0-9]+)?)|"
    rf"(?P<text>'(?:[^']|'')*')|(?P<habit>{_LONG_HABITS})|"
    r"(?P<sign>==|!=|<=|>=|[-+*/<>.,()\[\]{}])|(?P<bad>\S))"
)


def words(text: str) -> list[Token]:
    """Split `text` into words, ended by one of kind `end`. Raises `ExpressionError` at a character that is none."""
    found: list[Token] = []
    for match in _WORD.finditer(text):
        group, word = match.lastgroup or "", match[match.lastindex or 0]
        start, end = match.span(group)
        if group == "number" and len(word) > MOST_DIGITS:
            raise ExpressionError(f"a number has at most {MOST_DIGITS} digits, found {len(word)}", Span(start, end))
        if group in ("habit", "bad"):
            raise ExpressionError(_meaningless(word), Span(start, end))
        kind = word if group == "sign" or word in KEYWORDS else group
        found.append(Token(kind, word, start, end))
    end = len(text.rstrip())
    found.append(Token("end", "", end, end))
    return found


def _meaningless(word: str) -> str:
    if word == "'":
        return "a text ends with a single quote"
    return f"`{word}` has no meaning here" + (f"; write {_HABITS[word]}" if word in _HABITS else "")


class Words:
    """The words of a text, read from left to right."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._words = words(text)
        self._next = 0

    @property
    def word(self) -> Token:
        """The word at hand."""
        return self._words[self._next]

    def advance(self) -> Token:
        """The word at hand, and go on to the next."""
        self._next += 1
        return self._words[self._next - 1]

    def expect(self, kind: str, what: str) -> Token:
        """The word at hand, which must be of `kind`; else an error says that `what` was expected."""
        if self.word.kind != kind:
            raise ExpressionError(f"expected {what}, found {self.word}", self.word.span)
        return self.advance()

    def since(self, start: int) -> Span:
        """From `start` to the end of the last word read."""
        return Span(start, self._words[self._next - 1].end)

    def written(self, span: Span) -> str:
        """The text of a span."""
        return self._text[span.start : span.end]

    def bracket(self) -> str:
        """What stands between the bracket at hand and its end; nothing when it is not closed."""
        found: list[str] = []
        for word in self._words[self._next + 1 :]:
            if word.kind == "]":
                return " ".join(found).replace(" ,", ",")
            found.append(word.text)
        return ""

    def skip_bracket(self) -> None:
        """Go on behind the end of the bracket at hand."""
        while self.advance().kind != "]":
            pass
