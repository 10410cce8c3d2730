"""The names in expressions over records, with the values that stand beside what they are values of."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from sequence_planner.expressions.lexer import Token
from sequence_planner.expressions.syntax import ExpressionError, Span
from sequence_planner.model.source import SourceText
from sequence_planner.pipelines.stages.calculation.words import words
from sequence_planner.workshop.references.occurrences import Where
from sequence_planner.workshop.references.parts import value_of
from sequence_planner.workshop.references.record import Names


class _Operand(NamedTuple):
    """A path, a text in single quotes, or any other word."""

    kind: str
    text: str
    start: int
    end: int

    @property
    def is_operand(self) -> bool:
        return self.kind in ("path", "text")


def read_calculation(names: Names, written: object, where: Where, expected: str | None = None) -> bool:
    """Note what an expression over a record names; `expected` is the enumeration of what it becomes.

    Returns whether it is a single field that no stage and no variable has given: a part of the message.
    """
    if not isinstance(written, SourceText):
        return False
    try:
        found = list(_operands(words(written)))
    except ExpressionError:
        names.naming.gathered.unread.append((where, written))
        return False
    if len(found) == 1 and found[0].kind == "path" and not names.is_known(written):
        return True
    _Calculation(names, written, where).read(found, expected)
    return False


def _operands(tokens: list[Token]) -> Iterator[_Operand]:
    """The words of a text, those of a path together. What stands in brackets behind it is read by itself."""
    at = 0
    while tokens[at].kind != "end":
        token = tokens[at]
        end = at
        if token.kind == "name":
            while tokens[end + 1].kind == "." and tokens[end + 2].kind == "name":
                end += 2
        kind = "path" if token.kind == "name" else token.kind
        text = "".join(each.text for each in tokens[at : end + 1])
        yield _Operand(kind, text, token.start, tokens[end].end)
        at = end + 1


class _Calculation:
    def __init__(self, names: Names, text: SourceText, where: Where) -> None:
        self._names = names
        self._text = text
        self._where = where
        self._done: set[int] = set()

    def read(self, found: list[_Operand], expected: str | None) -> None:
        """Comparisons first: beside an enumeration a word is one of its values."""
        if len(found) == 1 and expected is not None:
            self._names.naming.link(expected, self._beside(found[0], expected))
            return
        for index, word in enumerate(found):
            before, after = found[max(index - 1, 0)], found[min(index + 1, len(found) - 1)]
            if word.kind in ("==", "!=") and before.is_operand and after.is_operand:
                self._compare(self._subject(found, index - 1), after)
            elif word.kind == "]" and after.kind in ("==", "!=") and index + 2 < len(found):
                self._compare(self._subject(found, index), found[index + 2])
            elif word.kind == "in" and index:
                subject = self._subject(found, index - 1)
                end = next((at for at in range(index, len(found)) if found[at].kind == "}"), len(found))
                for option in found[index:end]:
                    if subject is not None and option.is_operand:
                        self._compare(subject, option)
        for word in found:
            if word.kind == "path" and word.start not in self._done:
                self._name(word)

    def _subject(self, found: list[_Operand], index: int) -> _Operand | None:
        """The operand that ends at `index`, which may be an item or an instance."""
        if found[index].kind == "]":
            index = next((at for at in range(index, 0, -1) if found[at].kind == "["), 1) - 1
        return found[index] if found[index].is_operand else None

    def _compare(self, left: _Operand | None, right: _Operand) -> None:
        if left is None or not right.is_operand:
            return
        one, other = self._type(left), self._type(right)
        naming = self._names.naming
        if one is not None and self._is_value(right, one, other):
            self._value(right, one)
        elif other is not None and self._is_value(left, other, one):
            self._value(left, other)
        else:
            naming.link(one, other)
            for kind, beside in ((one, right), (other, left)):
                if beside.kind == "path" and self._type(beside) is None:
                    naming.tie_values(kind, f"`{beside.text}` is compared with them, and has values of its own")

    def _beside(self, operand: _Operand, expected: str) -> str | None:
        if operand.kind == "text" and self._is_value(operand, expected, None):
            self._value(operand, expected)
            return None
        return self._name(operand) if operand.kind == "path" else None

    def _is_value(self, operand: _Operand, enumeration: str, own: str | None) -> bool:
        return own is None and self._names.naming.has(enumeration, operand.text.strip("'"))

    def _value(self, operand: _Operand, enumeration: str) -> None:
        self._done.add(operand.start)
        quote = operand.kind == "text"
        span = Span(operand.start + quote, operand.end - quote)
        part = value_of(enumeration, operand.text.strip("'"))
        self._names.naming.gathered.add(part, self._where, self._text, span)

    def _type(self, operand: _Operand) -> str | None:
        return self._names.enumeration(operand.text) if operand.kind == "path" else None

    def _name(self, operand: _Operand) -> str | None:
        """A path, with what stands in brackets behind it: the index of a variable is no path of its own."""
        noted = self._names.naming.gathered.occurrences
        before = len(noted)
        enumeration = self._names.read(self._text, self._where, operand.start, self._end(operand))
        self._done |= {operand.start, *(each.span.start for each in noted[before:])}
        return enumeration

    def _end(self, operand: _Operand) -> int:
        closing = self._text.find("]", operand.end) if self._text[operand.end : operand.end + 1] == "[" else -1
        return closing + 1 or operand.end
