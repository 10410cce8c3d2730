"""Recursive descent from a text to a typed expression over records. The grammar is that of the package."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from sequence_planner.expressions.lexer import Token
from sequence_planner.expressions.syntax import ExpressionError, Span
from sequence_planner.expressions.types import BOOLEAN, EnumerationType, IntegerRange
from sequence_planner.pipelines.paths import FieldPath, NoFieldError, find_field
from sequence_planner.pipelines.record import FieldType, ListType, RecordType
from sequence_planner.pipelines.stages.calculation.terms import (
    Operand,
    Term,
    UnknownWord,
    Values,
    arithmetic,
    comparison,
    constant,
    field_term,
    item_term,
    junction,
    known,
    negation,
    truth,
)
from sequence_planner.pipelines.stages.calculation.words import Words
from sequence_planner.pipelines.stages.values import REAL, shown

MOST_NESTED = 30  # reading a record descends as deep as the expression is
MOST_OPERATIONS = 50

_RELATIONS = frozenset({"==", "!=", "<", "<=", ">", ">="})


@dataclass(frozen=True)
class Calculation:
    """An expression over records: its type, the fields it reads, and the values that are written in it."""

    type: FieldType
    reads: Mapping[str, tuple[FieldPath, FieldType]]
    constants: tuple[object, ...]
    _term: Term

    def value(self, values: Values, troubles: list[str]) -> object:
        """Its value for a record, None when that is unknown; what makes no sense is added to `troubles`."""
        try:
            return self._term.read(values, troubles)
        except TypeError:  # a record is what its type says; this is for one that is not
            found = {name: path.get(values) for name, (path, _) in self.reads.items()}
            troubles.append(f"nothing can be computed from {shown(found)}")
            return None


def read_calculation(text: str, fields: RecordType) -> Calculation:
    """The meaning of `text` for records with `fields`. Raises `ExpressionError` with the place within the text."""
    reader = _Reader(text, fields)
    term = reader.whole()
    return Calculation(term.type, reader.reads, tuple(reader.constants), term)


def read_condition(text: str, fields: RecordType) -> Calculation:
    """The same, of a text that must be a truth value."""
    calculation = read_calculation(text, fields)
    truth(calculation._term)
    return calculation


class _Reader(Words):
    def __init__(self, text: str, fields: RecordType) -> None:
        super().__init__(str(text))
        self._fields = fields
        self._depth = self._operations = 0
        self.reads: dict[str, tuple[FieldPath, FieldType]] = {}
        self.constants: list[object] = []

    def _nested(self, rule: Callable[[], Operand], opening: Token) -> Operand:
        self._depth += 1
        if self._depth > MOST_NESTED:
            raise ExpressionError(f"nested more than {MOST_NESTED} deep: split it up", opening.span)
        result = rule()
        self._depth -= 1
        return result

    def whole(self) -> Term:
        """The term of the whole text."""
        term = known(self.expression())
        if self.word.kind != "end":
            chained = self.word.kind in _RELATIONS or self.word.kind == "in"
            hint = "; comparisons do not chain: join two with and" if chained else ""
            raise ExpressionError(f"expected an operator or the end, found {self.word}{hint}", self.word.span)
        return term

    def expression(self) -> Operand:
        """`implies` groups to the right."""
        start = self.word.start
        left = self._junction("or", True, lambda: self._junction("and", False, self.negation))
        if self.word.kind != "implies":
            return left
        premise = negation(truth(left), left.span)
        conclusion = truth(self._nested(self.expression, self.advance()))
        return junction([premise, conclusion], True, self.since(start))

    def _junction(self, kind: str, decisive: bool, part: Callable[[], Operand]) -> Operand:
        start = self.word.start
        first = part()
        if self.word.kind != kind:
            return first
        parts = [truth(first)]
        while self.word.kind == kind:
            self.advance()
            parts.append(truth(part()))
        return junction(parts, decisive, self.since(start))

    def negation(self) -> Operand:
        """`not` before a negation or relation."""
        if self.word.kind != "not":
            return self.relation()
        word = self.advance()
        operand = truth(self._nested(self.negation, word))
        return negation(operand, self.since(word.start))

    def relation(self) -> Operand:
        """A sum, or a comparison of two."""
        start = self.word.start
        left = self.sum()
        kind = self.word.kind
        if kind in _RELATIONS:
            self.advance()
            right = self.sum()
            return comparison(kind, left, right, self.since(start))
        if kind == "in":
            self.advance()
            return self._membership(left, start)
        return left

    def _membership(self, left: Operand, start: int) -> Term:
        self.expect("{", "`{`, as in `pose in {home, above}`")
        subject, options = known(left), [self.sum()]
        while self.word.kind == ",":
            self.advance()
            options.append(self.sum())
        self.expect("}", "`,` or `}`")
        span = self.since(start)
        return junction([comparison("==", subject, option, span) for option in options], True, span)

    def sum(self) -> Operand:
        """Products added and subtracted, from left to right."""
        return self._operation(("+", "-"), lambda: self._operation(("*", "/"), self.factor))

    def _operation(self, signs: tuple[str, ...], part: Callable[[], Operand]) -> Operand:
        start = self.word.start
        left = part()
        while self.word.kind in signs:
            sign = self.advance()
            self._operations += 1
            if self._operations > MOST_OPERATIONS:
                raise ExpressionError(f"more than {MOST_OPERATIONS} operations in one expression", sign.span)
            right = known(part())
            span = self.since(start)
            left = arithmetic(sign.text, known(left), right, span, self.written(span))
        return left

    def factor(self) -> Operand:
        """A value, a field, an item of a list, or an expression in brackets."""
        token = self.word
        match token.kind:
            case "name":
                return self._items(self._field())
            case "number" | "text" | "true" | "false":
                return self._literal(self.advance())
            case "-":
                return self._negative(self.advance())
            case "(":
                inner_operand = self._nested(self.expression, self.advance())
                self.expect(")", "an operator or `)`")
                return inner_operand
        raise ExpressionError(f"expected a field, a value or `(`, found {token}", token.span)

    def _negative(self, sign: Token) -> Term:
        if self.word.kind == "number":
            return self._number(self.advance(), -1, sign.start)
        operand = known(self._nested(self.factor, sign))
        span = self.since(sign.start)
        return arithmetic("-", constant(0, IntegerRange(0, 0), sign.span), operand, span, self.written(span))

    def _literal(self, token: Token) -> Term:
        if token.kind == "number":
            return self._number(token, 1, token.start)
        if token.kind == "text":
            text = token.text[1:-1].replace("''", "'")
            return self._constant(text, EnumerationType((text,)), token.span)
        return self._constant(token.kind == "true", BOOLEAN, token.span)

    def _number(self, token: Token, sign: int, start: int) -> Term:
        if token.text.isdigit():
            integer = sign * int(token.text)
            return self._constant(integer, IntegerRange(integer, integer), self.since(start))
        real = sign * float(token.text)
        if not math.isfinite(real):
            raise ExpressionError("the number is too large", token.span)
        return self._constant(real, REAL, self.since(start))

    def _constant(self, value: object, type_: FieldType, span: Span) -> Term:
        self.constants.append(value)
        return constant(value, type_, span)

    def _field(self) -> Operand:
        start = self.word.start
        text = self.advance().text
        while (longer := self._longer(text)) is not None:
            text = longer
        span = self.since(start)
        try:
            path, type_ = find_field(self._fields, text)
        except NoFieldError as error:
            return UnknownWord(text, span, ExpressionError(str(error), span))
        self.reads[text] = (path, type_)
        return field_term(path, type_, span)

    def _longer(self, text: str) -> str | None:
        """`text` with the part of the path that follows, if one does: `.x`, `[0]` or `[left]`."""
        kind = self.word.kind
        if kind == ".":
            self.advance()
            return f"{text}.{self.expect('name', 'the name of a field').text}"
        if kind != "[":
            return None
        inside = self.bracket()
        longer = f"{text}[{inside}]"
        if longer not in self._fields and not inside.isdigit():
            return None
        self.skip_bracket()
        return longer

    def _items(self, operand: Operand) -> Operand:
        """Items at computed places: `joints[axis]`."""
        while self.word.kind == "[":
            items = known(operand)
            if not isinstance(items.type, ListType):
                raise ExpressionError(f"`{self.written(items.span)}` is no list", items.span)
            index = known(self._nested(self.sum, self.advance()))
            self.expect("]", "`]`")
            span = self.since(items.span.start)
            operand = item_term(items, index, span, self.written(items.span))
        return operand
