"""Typed expressions over pipeline records: tokens, parser and evaluation."""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from sequence_planner.language.evaluator import RELATIONS
from sequence_planner.language.lexer import KEYWORDS, Token
from sequence_planner.language.records.field_paths import (
    REAL,
    FieldPath,
    NoFieldError,
    find_field,
    is_numeric,
    is_textual,
    shown,
)
from sequence_planner.language.records.record import FieldType, ListType, RealType, RecordType, TextType
from sequence_planner.language.syntax import ExpressionError, Span
from sequence_planner.language.types import BOOLEAN, BooleanType, EnumerationType, IntegerRange

# Parts of an expression over records: each has a type, and says its value for a record.

Values = Mapping[str, object]

#: The value of a term for the values of a record, None when it is unknown. What makes no sense is added to the list.
Reader = Callable[[Values, list[str]], object]

_OPERATIONS: Mapping[str, Callable[[Any, Any], Any]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
}


@dataclass(frozen=True)
class Term:
    """A part of an expression. `word` is the single word it is written as, which may also be a value's name."""

    type: FieldType
    read: Reader
    span: Span
    word: str | None = None


@dataclass(frozen=True)
class UnknownWord:
    """A word that is no field: it may be a value of the enumeration beside which it stands. `error` if it is not."""

    word: str
    span: Span
    error: ExpressionError


Operand = Term | UnknownWord


def describe(type_: FieldType) -> str:
    """A type, for people."""
    match type_:
        case BooleanType():
            return "a truth value"
        case IntegerRange(minimum, maximum):
            return f"the integer {minimum}" if minimum == maximum else f"an integer in {type_}"
        case EnumerationType((single,)):
            return f"the value `{single}`"
        case EnumerationType():
            return f"one of {type_}"
        case RealType():
            return "a real number"
        case TextType():
            return "a text"
    return f"a {type_}"


def known(operand: Operand) -> Term:
    """`operand` as a term. Raises `ExpressionError` for a word that is no field."""
    if isinstance(operand, UnknownWord):
        raise operand.error
    return operand


def constant(value: object, type_: FieldType, span: Span) -> Term:
    """A value written in the expression."""
    return Term(type_, lambda values, troubles: value, span)


def field_term(path: FieldPath, type_: FieldType, span: Span) -> Term:
    """A field of the record; a real one that is no finite number is unknown."""
    get = path.get
    is_word = "." not in path.text and "[" not in path.text
    reader: Reader = path.read if isinstance(type_, RealType) else lambda values, troubles: get(values)
    return Term(type_, reader, span, path.text if is_word else None)


def item_term(items: Term, index: Term, span: Span, text: str) -> Term:
    """An item of a list at a computed place; beyond its end it is unknown, and that is a trouble."""
    if not isinstance(items.type, ListType):
        raise ExpressionError(f"only lists have items, and this is {describe(items.type)}", items.span)
    if not isinstance(index.type, IntegerRange):
        raise ExpressionError(f"the place in a list is an integer, found {describe(index.type)}", index.span)

    def read(values: Values, troubles: list[str]) -> object:
        found, place = items.read(values, troubles), index.read(values, troubles)
        if not isinstance(found, list) or not isinstance(place, int):
            return None
        value = found[place] if 0 <= place < len(found) else None
        if value is None or (isinstance(value, float) and not math.isfinite(value)):
            troubles.append(f"{text} is {shown(value)}" if value is not None else f"{text} has no item {place}")
            return None
        return value

    return Term(items.type.element, read, span)


def arithmetic(sign: str, left: Term, right: Term, span: Span, text: str) -> Term:
    """`+ - * /` of two numbers: an integer of integers, but for `/`, whose result is real."""
    for side in (left, right):
        if not is_numeric(side.type):
            raise ExpressionError(f"`{sign}` needs numbers, found {describe(side.type)}", side.span)
    operation, read_left, read_right = _OPERATIONS[sign], left.read, right.read

    def read(values: Values, troubles: list[str]) -> object:
        a, b = read_left(values, troubles), read_right(values, troubles)
        if a is None or b is None:
            return None
        try:
            result = operation(a, b)
        except ZeroDivisionError:
            troubles.append(f"{text} divides by zero")
            return None
        except OverflowError:
            result = math.inf
        if isinstance(result, float) and not math.isfinite(result):
            troubles.append(f"{text} is too large a number")
            return None
        return result

    return Term(_result(sign, left.type, right.type), read, span)


def _result(sign: str, left: FieldType, right: FieldType) -> FieldType:
    if sign == "/" or not isinstance(left, IntegerRange) or not isinstance(right, IntegerRange):
        return REAL
    ends = [_OPERATIONS[sign](a, b) for a in (left.minimum, left.maximum) for b in (right.minimum, right.maximum)]
    return IntegerRange(min(ends), max(ends))


def comparison(sign: str, left: Operand, right: Operand, span: Span) -> Term:
    """`== != < <= > >=`; both sides must have a value in common, and an order where it is asked for."""
    first, second = beside(left, right), beside(right, left)
    _check_comparable(first, second)
    if sign not in ("==", "!=") and not is_numeric(first.type):
        raise ExpressionError(f"`{sign}` compares numbers, not {describe(first.type)}", span)
    relation, read_first, read_second = RELATIONS[sign], first.read, second.read

    def read(values: Values, troubles: list[str]) -> object:
        a, b = read_first(values, troubles), read_second(values, troubles)
        return None if a is None or b is None else relation(a, b)

    return Term(BOOLEAN, read, span)


def beside(operand: Operand, other: Operand) -> Term:
    """`operand` where it stands beside `other`: a word there may be a value of the other's enumeration."""
    type_ = other.type if isinstance(other, Term) else None
    if operand.word is None or not isinstance(type_, EnumerationType) or operand.word not in type_.values:
        if isinstance(operand, UnknownWord):
            raise _no_field(operand, other)
        return operand
    if isinstance(operand, Term) and is_textual(operand.type):
        message = f"`{operand.word}` is both a value and a field here: put the value into single quotes"
        raise ExpressionError(message, operand.span)
    return constant(operand.word, EnumerationType((operand.word,)), operand.span)


def _no_field(operand: UnknownWord, other: Operand) -> ExpressionError:
    """That a word is no field, and what may have been meant beside a field that is a text or a number."""
    hint = ""
    if isinstance(other, Term) and other.word is not None:
        if isinstance(other.type, TextType):
            hint = f"; a text is written '{operand.word}'"
        elif isinstance(other.type, IntegerRange):
            hint = f"; `{other.word}` is a number here, whose values get names by a `map` before this"
    return ExpressionError(f"{operand.error.message}{hint}", operand.span)


def _check_comparable(left: Term, right: Term) -> None:
    a, b = left.type, right.type
    if isinstance(a, IntegerRange) and isinstance(b, IntegerRange):
        fits = a.minimum <= b.maximum and b.minimum <= a.maximum
    elif isinstance(a, EnumerationType) and isinstance(b, EnumerationType):
        fits = not set(a.values).isdisjoint(b.values)
    else:
        fits = (is_numeric(a) and is_numeric(b)) or (is_textual(a) and is_textual(b)) or a == b == BOOLEAN
    if not fits:
        raise ExpressionError(f"cannot compare {describe(a)} with {describe(b)}", right.span)


def truth(operand: Operand) -> Term:
    """`operand` as a truth value. Raises `ExpressionError` when it is none."""
    term = known(operand)
    if not isinstance(term.type, BooleanType):
        raise ExpressionError(f"expected a truth value, found {describe(term.type)}", term.span)
    return term


def negation(operand: Term, span: Span) -> Term:
    """`not`."""
    inner = operand.read

    def read(values: Values, troubles: list[str]) -> object:
        value = inner(values, troubles)
        return None if value is None else not value

    return Term(BOOLEAN, read, span)


def junction(parts: list[Term], decisive: bool, span: Span) -> Term:
    """Several truth values, of which a `decisive` one decides: false with `and`, true with `or`."""
    readers = [part.read for part in parts]

    def read(values: Values, troubles: list[str]) -> object:
        unknown = False
        for reader in readers:
            value = reader(values, troubles)
            if value is decisive:
                return decisive
            unknown = unknown or value is None
        return None if unknown else not decisive

    return Term(BOOLEAN, read, span)


# Words of expressions over records.

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
        """Return what stands between the bracket at hand and its end; nothing when it is not closed."""
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


# Recursive descent from a text to a typed expression over records. The grammar is that of the package.

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
