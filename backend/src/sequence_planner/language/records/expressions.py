"""Typed expressions over pipeline records: the meaning of their tree, and evaluation."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

from sequence_planner.language.evaluator import RELATIONS
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.parser import parse_calculation
from sequence_planner.language.records.field_paths import (
    REAL,
    FieldPath,
    NoFieldError,
    common_type,
    find_field,
    is_numeric,
    is_textual,
    shown,
)
from sequence_planner.language.records.record import FieldType, ListType, NestedType, RealType, RecordType, TextType
from sequence_planner.language.shorthand.vocabulary import NO_VOCABULARY, ValueMap, ValueRelation, Vocabulary
from sequence_planner.language.syntax import (
    And,
    Arithmetic,
    Comparison,
    Constant,
    Expression,
    ExpressionError,
    Implies,
    Membership,
    Name,
    Not,
    Or,
    RecordConstant,
    Selection,
    Span,
)
from sequence_planner.language.types import (
    BOOLEAN,
    BooleanType,
    EnumerationType,
    IntegerRange,
    Type,
    described,
    overlap,
)
from sequence_planner.texts.late import message

if TYPE_CHECKING:
    from sequence_planner.texts.message import Message

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
    """A part of an expression. `word` is the single word it is written as, which may also be a value's name; `partial`
    holds for a truth value that may be `NOTHING`.
    """

    type: FieldType
    read: Reader
    span: Span
    word: str | None = None
    partial: bool = False


@dataclass(frozen=True)
class UnknownWord:
    """A word that is no field: it may be a value of the enumeration beside which it stands. `error` if it is not."""

    word: str
    span: Span
    error: ExpressionError


Operand = Term | UnknownWord

# What a map says of what it has no value for: a comparison with it is false, as in a condition on variables.
NOTHING = object()


def describe(type_: FieldType) -> Message:
    """A type, for people."""
    match type_:
        case RealType():
            return message("type.real")
        case TextType():
            return message("type.text")
        case ListType() | NestedType():
            return message("type.other", type=str(type_))
    return described(type_)


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


def item_term(items: Term, type_: FieldType, index: Term, span: Span, text: str) -> Term:
    """An item of a list at a computed place; beyond its end it is unknown, and that is a trouble."""
    if not isinstance(index.type, IntegerRange):
        raise ExpressionError(message("wrong.place-in-list", found=describe(index.type)), index.span)

    def read(values: Values, troubles: list[str]) -> object:
        found, place = items.read(values, troubles), index.read(values, troubles)
        if not isinstance(found, list) or not isinstance(place, int):
            return None
        value = found[place] if 0 <= place < len(found) else None
        if value is None or (isinstance(value, float) and not math.isfinite(value)):
            troubles.append(f"{text} is {shown(value)}" if value is not None else f"{text} has no item {place}")
            return None
        return value

    return Term(type_, read, span)


def arithmetic(sign: str, left: Term, right: Term, span: Span, text: str) -> Term:
    """`+ - * /` of two numbers: an integer of integers, but for `/`, whose result is real."""
    for side in (left, right):
        if not is_numeric(side.type):
            raise ExpressionError(message("wrong.needs-numbers", operator=sign, type=describe(side.type)), side.span)
    operation, read_left, read_right = _OPERATIONS[sign], left.read, right.read

    def read(values: Values, troubles: list[str]) -> object:
        a, b = read_left(values, troubles), read_right(values, troubles)
        if a is NOTHING or b is NOTHING:
            return NOTHING
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
        raise ExpressionError(message("wrong.compares-numbers", operator=sign, type=describe(first.type)), span)
    relation, read_first, read_second = RELATIONS[sign], first.read, second.read

    def read(values: Values, troubles: list[str]) -> object:
        a, b = read_first(values, troubles), read_second(values, troubles)
        if a is NOTHING or b is NOTHING:
            return False
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
        raise ExpressionError(message("wrong.value-and-field", name=operand.word), operand.span)
    return constant(operand.word, EnumerationType((operand.word,)), operand.span)


def _no_field(operand: UnknownWord, other: Operand) -> ExpressionError:
    """That a word is no field, and what may have been meant beside a field that is a text or a number."""
    hint = ""
    if isinstance(other, Term) and other.word is not None:
        if isinstance(other.type, TextType):
            hint = message("hint.text", text=operand.word)
        elif isinstance(other.type, IntegerRange):
            hint = message("hint.number-here", name=other.word)
    return ExpressionError(message("wrong.with-hint", what=operand.error.message, hint=hint), operand.span)


def _check_comparable(left: Term, right: Term) -> None:
    a, b = left.type, right.type
    if isinstance(a, Type) and isinstance(b, Type):
        fits = overlap(a, b)
    else:
        fits = (is_numeric(a) and is_numeric(b)) or (is_textual(a) and is_textual(b))
    if not fits:
        raise ExpressionError(message("wrong.compared", one=describe(a), other=describe(b), hint=""), right.span)


def truth(operand: Operand) -> Term:
    """`operand` as a truth value. Raises `ExpressionError` when it is none."""
    term = known(operand)
    if not isinstance(term.type, BooleanType):
        raise ExpressionError(
            message("wrong.expected", wanted=described(BOOLEAN), found=describe(term.type), hint=""), term.span
        )
    return _certain(term) if term.partial else term


def _certain(term: Term) -> Term:
    """A truth value that is false where there is none."""
    inner = term.read

    def read(values: Values, troubles: list[str]) -> object:
        value = inner(values, troubles)
        return False if value is NOTHING else value

    return replace(term, read=read, partial=False)


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


def map_term(table: ValueMap, argument: Operand, span: Span) -> Term:
    """The value that a map has for a field or a value."""
    read_argument, values_of = _among(argument, table.source).read, table.table

    def read(values: Values, troubles: list[str]) -> object:
        value = read_argument(values, troubles)
        return None if value is None else values_of.get(str(value), NOTHING)

    return Term(table.target, read, span, partial=isinstance(table.target, BooleanType))


def relation_term(relation: ValueRelation, first: Operand, second: Operand, span: Span) -> Term:
    """That a relation holds between two fields or values."""
    one, other = (_among(each, type_).read for each, type_ in zip((first, second), relation.types, strict=True))
    pairs = relation.pairs

    def read(values: Values, troubles: list[str]) -> object:
        a, b = one(values, troubles), other(values, troubles)
        if a is NOTHING or b is NOTHING:
            return False
        return None if a is None or b is None else (a, b) in pairs

    return Term(BOOLEAN, read, span)


def _among(argument: Operand, type_: EnumerationType) -> Term:
    """What stands where a value of an enumeration is asked for: a value, or something that can have one."""
    expected = constant(None, type_, argument.span)
    term = beside(argument, expected)
    _check_comparable(expected, term)
    return term


# From the tree of an expression to its meaning for records.


class Tables(NamedTuple):
    """The relations and maps of a station that expressions name; those under one of `prefixes` without it."""

    vocabulary: Vocabulary = NO_VOCABULARY
    prefixes: tuple[str, ...] = ()

    def table_named(self, name: str) -> ValueMap | ValueRelation | None:
        """A map or a relation by its name."""
        for full in (f"{prefix}{name}" for prefix in (*self.prefixes, "")):
            found = self.vocabulary.maps.get(full) or self.vocabulary.relations.get(full)
            if found is not None:
                return found
        return None

    def meant(self, name: str) -> str:
        """Say what may have been meant by the name of a relation that there is not."""
        short = [each.removeprefix(prefix) for prefix in self.prefixes for each in self.vocabulary.relations]
        return suggestion(name, [*short, *self.vocabulary.relations])


NO_TABLES = Tables()


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
            found = self._term.read(values, troubles)
            return found if found is not NOTHING else False if isinstance(self.type, BooleanType) else None
        except TypeError:  # a record is what its type says; this is for one that is not
            given = {name: path.get(values) for name, (path, _) in self.reads.items()}
            troubles.append(f"nothing can be computed from {shown(given)}")
            return None


def read_calculation(text: str, fields: RecordType, tables: Tables = NO_TABLES) -> Calculation:
    """The meaning of `text` for records with `fields`. Raises `ExpressionError` with the place within the text."""
    text = str(text)
    reader = _Reader(text, fields, tables)
    term = known(reader.read(parse_calculation(text)))
    return Calculation(term.type, reader.reads, tuple(reader.constants), term)


def read_condition(text: str, fields: RecordType, tables: Tables = NO_TABLES) -> Calculation:
    """The same, of a text that must be a truth value."""
    calculation = read_calculation(text, fields, tables)
    truth(calculation._term)
    return calculation


class _Reader:
    """Reads a tree for records with `fields`."""

    def __init__(self, text: str, fields: RecordType, tables: Tables) -> None:
        self._text = text
        self._fields = fields
        self._tables = tables
        self.reads: dict[str, tuple[FieldPath, FieldType]] = {}
        self.constants: list[object] = []

    def read(self, part: Expression) -> Operand:
        """The term that a part of the tree is, or a word that may be a value beside another part."""
        span = part.span
        match part:
            case Name() | Selection() if (path := self._field(part)) is not None:
                return self._value_of(path, span)
            case Selection(whole, tuple(at), _, called) if (
                found := self._tabulated(whole, at, called, span)
            ) is not None:
                return found
            case Selection(whole, at):
                return self._item(whole, at, span)
            case Constant(value):
                return self._constant(value, span)
            case RecordConstant(value):
                return self._constant(value, span)
            case Not(operand):
                return negation(self._truth(operand), span)
            case And(operands):
                return junction(list(map(self._truth, operands)), False, span)
            case Or(operands):
                return junction(list(map(self._truth, operands)), True, span)
            case Implies(left, right):
                return junction([negation(self._truth(left), left.span), self._truth(right)], True, span)
            case Comparison(sign, left, right):
                return comparison(sign, self.read(left), self.read(right), span)
            case Membership(left, options):
                subject = known(self.read(left))
                return junction([comparison("==", subject, self.read(each), span) for each in options], True, span)
            case Arithmetic(sign, left, right):
                return arithmetic(sign, known(self.read(left)), known(self.read(right)), span, self._written(span))
        raise ExpressionError(message("wrong.not-over-records", text=self._written(span)), span)

    def _truth(self, part: Expression) -> Term:
        return truth(self.read(part))

    def _written(self, span: Span) -> str:
        return self._text[span.start : span.end]

    def _constant(self, value: float | str, span: Span) -> Term:
        if span.start < span.end:  # the zero before a minus is not written
            self.constants.append(value)
        type_ = common_type([value])
        assert type_ is not None
        return constant(value, type_, span)

    def _value_of(self, text: str, span: Span) -> Operand:
        try:
            path, type_ = find_field(self._fields, text)
        except NoFieldError as error:
            return UnknownWord(text, span, ExpressionError(error.why, span))
        self.reads[text] = (path, type_)
        return field_term(path, type_, span)

    def _field(self, part: Expression) -> str | None:
        """The path of a field; None for what stands at a computed place, such as `joints[axis]`."""
        if not isinstance(part, Selection):
            return str(part)
        whole = self._field(part.whole)
        if whole is None:
            return None
        if isinstance(part.at, str):
            return f"{whole}.{part.at}"
        if part.called:
            return None
        inside = ", ".join(self._written(each.span) for each in part.at)
        return path if (path := f"{whole}[{inside}]") in self._fields or inside.isdigit() else None

    def _tabulated(self, whole: Expression, at: tuple[Expression, ...], called: bool, span: Span) -> Term | None:
        """What a map or a relation says; None for an item of a list."""
        name = self._field(whole)
        table = None if name is None or name in self._fields else self._tables.table_named(name)
        if table is None:
            if called:
                said = (
                    message("wrong.no-such-relation", name=name, hint=self._tables.meant(name))
                    if name
                    else message("wrong.called")
                )
                raise ExpressionError(said, whole.span)
            return None
        wanted = 1 if isinstance(table, ValueMap) else 2
        if called is isinstance(table, ValueMap):
            inside = ", ".join(map(self._written_as, at))
            form = f"{name}[{inside}]" if called else f"{name}({inside})"
            id_ = "wrong.is-map" if called else "wrong.is-relation"
            raise ExpressionError(message(id_, name=str(name), form=form), span)
        if len(at) != wanted:
            how_many = message("arguments.count", count=wanted)
            raise ExpressionError(message("wrong.arguments", name=str(name), wanted=how_many, found=len(at)), span)
        arguments = [self.read(each) for each in at]
        if isinstance(table, ValueMap):
            self._note_texts(arguments, (table.source,))
            return map_term(table, arguments[0], span)
        self._note_texts(arguments, table.types)
        return relation_term(table, arguments[0], arguments[1], span)

    def _note_texts(self, arguments: Sequence[Operand], types: Sequence[EnumerationType]) -> None:
        """The values that a text can have where it is looked up in a table are as if they were written."""
        for argument, type_ in zip(arguments, types, strict=True):
            if isinstance(argument, Term) and isinstance(argument.type, TextType):
                self.constants += type_.values

    def _written_as(self, part: Expression) -> str:
        return self._written(part.span)

    def _item(self, whole: Expression, at: str | tuple[Expression, ...], span: Span) -> Term:
        items = known(self.read(whole))
        text = self._written(items.span)
        if isinstance(at, str):
            raise ExpressionError(message("wrong.computed-place", field=at), Span(items.span.end, span.end))
        if not isinstance(items.type, ListType):
            raise ExpressionError(message("wrong.not-list", name=text), items.span)
        if len(at) > 1:
            raise ExpressionError(message("wrong.one-place", found=len(at)), at[1].span)
        return item_term(items, items.type.element, known(self.read(at[0])), span, text)
