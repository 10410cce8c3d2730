"""What the grammar allows behind the beginning of a text: the parser itself is asked."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from functools import cached_property

from sequence_planner.expressions.lexer import INFIX_LETTERS, PREFIX_LETTERS, Token, tokens
from sequence_planner.expressions.parser import can_go_on, parse
from sequence_planner.expressions.resolution import Scope, type_of
from sequence_planner.expressions.syntax import ExpressionError
from sequence_planner.expressions.types import BOOLEAN, IntegerRange, Type
from sequence_planner.workshop.language.field import FieldKind

EQUALITIES = ("==", "!=")
ORDERS = ("<", "<=", ">", ">=")
JUNCTIONS = ("and", "or", "implies")
_CLOSING = {")": "(", "}": "{", "]": "["}
_LAST = re.compile(r"(\w+|\S)\s*\Z")
_BEFORE_OPERAND = frozenset({*JUNCTIONS, "not", "if", "in"})
_BOUNDS = frozenset({*EQUALITIES, *ORDERS, *JUNCTIONS, "not", "in", "if", ":=", "{", ","})


@dataclass(frozen=True)
class Beginning:
    """The text before a place, and what names mean in it."""

    text: str
    kind: FieldKind
    scope: Scope
    _fitting: dict[str, bool] = field(default_factory=dict, compare=False, repr=False)

    def fits(self, word: str) -> bool:
        """Whether `word` can stand next, if the right words follow."""
        if word not in self._fitting:
            is_action, is_formula = self.kind is FieldKind.ACTION, self.kind is FieldKind.FORMULA
            self._fitting[word] = can_go_on(f"{self.text} {word}", is_action, is_formula)
        return self._fitting[word]

    @cached_property
    def tokens(self) -> tuple[Token, ...]:
        """Its words, if they are words of the language."""
        try:
            return tuple(tokens(self.text)[:-1])
        except ExpressionError:
            return ()

    @cached_property
    def wants_name(self) -> bool:
        """Whether a name can stand next; where what is before makes no sense, as far as its last word tells."""
        if self._is_broken:
            last = _LAST.search(self.text)
            return last is None or last[1] in _BEFORE_OPERAND or not (last[1][-1].isalnum() or last[1] in ")]}_")
        return self.fits("x")

    @cached_property
    def wants_target(self) -> bool:
        """Whether the variable that an action writes can stand next."""
        return self.kind is FieldKind.ACTION and not self.text.strip()

    def words(self) -> list[str]:
        """The operators and other words of the language that can stand next."""
        if self._is_broken:
            return ["not", "true", "false"] if self.wants_name else [*EQUALITIES, "in", *JUNCTIONS]
        return self._beginning_words() if self.wants_name else self._joining_words()

    def _beginning_words(self) -> list[str]:
        """What an operand can begin with, beside names."""
        expected = self.expected()
        found = ["not"] if self.fits("not") else []
        if expected is None or expected == BOOLEAN:
            found += (word for word in ("true", "false") if self.fits(word))
        if self.kind is FieldKind.FORMULA and "not" in found:
            found += sorted(PREFIX_LETTERS)
        if isinstance(expected, IntegerRange) and self.fits("-"):
            found.append("-")
        return [*found, "("] if self.fits("(") else found

    def _joining_words(self) -> list[str]:
        """What can stand behind an operand."""
        begin = self._begin_before(len(self.tokens))
        operand = self._type_before(len(self.tokens))
        if begin and self.tokens[begin - 1].kind == ":=":
            target = self._type_before(begin - 1)
            if target is not None and target != BOOLEAN:  # what it is compared with, or joined to, is no value of it
                signs = ("+", "-", "if") if isinstance(target, IntegerRange) else ("if",)
                return [sign for sign in signs if self.fits(sign)]
        compares, is_truth = self.fits("=="), operand is None or operand == BOOLEAN
        is_number = operand is None or isinstance(operand, IntegerRange)
        found: list[str] = []
        if (is_truth or not compares) and self.fits("and"):
            found += JUNCTIONS
            if self.kind is FieldKind.FORMULA and self.fits("U"):
                found += sorted(INFIX_LETTERS)
        if compares:
            found += (*EQUALITIES, *(ORDERS if is_number else ()), *(("in",) if operand != BOOLEAN else ()))
        if is_number and self.fits("+"):
            found += ["+", "-"]
        return [*found, *(word for word in (":=", "if", "{", ")", "}", ",") if self.fits(word))]

    def expected(self) -> Type | None:
        """The type of what stands next beside an operator, as far as the other side tells it."""
        if not self.tokens:
            return None
        last = self.tokens[-1].kind
        if last in EQUALITIES or last == ":=":
            return self._type_before(len(self.tokens) - 1)
        if last in (*ORDERS, "+", "-"):
            return self._type_before(len(self.tokens) - 1) or IntegerRange(0, 0)
        if last in ("{", ","):
            opening = self._opening(len(self.tokens))
            if opening and self.tokens[opening - 1].kind == "in":
                return self._type_before(opening - 1)
        return None

    @cached_property
    def _is_broken(self) -> bool:
        return bool(self.text.strip()) and not any(self.fits(word) for word in ("x", "and", ")", "}", ":=", "{", "1"))

    def _opening(self, at: int) -> int | None:
        """The bracket that is open before the word `at`."""
        depth = 0
        for index in range(at - 1, -1, -1):
            kind = self.tokens[index].kind
            if kind in _CLOSING:
                depth += 1
            elif kind in _CLOSING.values():
                if depth == 0:
                    return index
                depth -= 1
        return None

    def _begin_before(self, at: int) -> int:
        """The first word of the operand that ends before the word `at`."""
        begin, depth = at, 0
        while begin > 0:
            kind = self.tokens[begin - 1].kind
            if kind in _CLOSING:
                depth += 1
            elif kind in _CLOSING.values():
                depth -= 1
            if depth < 0 or (depth == 0 and kind in _BOUNDS):
                break
            begin -= 1
        return begin

    def _type_before(self, at: int) -> Type | None:
        """The type of that operand."""
        begin = self._begin_before(at)
        if begin == at:
            return None
        written = self.text[self.tokens[begin].start : self.tokens[at - 1].end]
        try:
            return type_of(parse(written), self.scope)
        except ExpressionError:
            return None
