"""Hover information: the meaning of the name at a text position."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from sequence_planner.automaton.declarations import OPERATION
from sequence_planner.editor.language.completion import chain_at, word_at
from sequence_planner.editor.language.field import FieldKind, TextField
from sequence_planner.editor.language.schemas import NameKind
from sequence_planner.editor.language.scope import Family, Lexicon, VisibleNames
from sequence_planner.language.parser import parse, parse_assignment, parse_formula
from sequence_planner.language.resolver import (
    NameScope,
    resolve_assignment,
    resolve_formula,
    resolve_predicate,
)
from sequence_planner.language.syntax import Constant, Expression, ExpressionError, Name, Span, children
from sequence_planner.language.types import BOOLEAN, EnumerationType, Place, Type, Value, contains

# What resolution makes of one name of a text.


def is_value_at(span: Span, text: str, kind: FieldKind, scope: NameScope) -> bool:
    """Return whether the name there is read as a value; not where the text makes no sense."""
    try:
        parts = _resolved(text, kind, scope)
    except ExpressionError:
        return False
    return any(isinstance(leaf, Constant) and leaf.span == span for part in parts for leaf in _leaves(part))


def _resolved(text: str, kind: FieldKind, scope: NameScope) -> tuple[Expression, ...]:
    if kind is FieldKind.FORMULA:
        return (resolve_formula(parse_formula(text), scope),)
    if kind is FieldKind.CONDITION:
        return (resolve_predicate(parse(text), scope),)
    action = resolve_assignment(parse_assignment(text), scope)
    return (action.value,) if action.condition is None else (action.value, action.condition)


def _leaves(expression: Expression) -> Iterator[Expression]:
    parts = children(expression)
    if not parts:
        yield expression
    for part in parts:
        yield from _leaves(part)


# What the name at a place of a text is.

_MOST_NAMES = 100


@dataclass(frozen=True)
class Hover:
    """The thing that stands from `start` to `end` of a text.

    `names` are the full names it has for the choices of the parameters, and `pattern` is all of them at once, with the
    parameters as they are written. `place` is where it is declared, within the station; `part` is the id by which it is
    looked for there, but for a parameter.
    """

    start: int
    end: int
    name: str
    kind: NameKind
    pattern: str
    names: tuple[str, ...] = ()
    type: Type | None = None
    initial: Value | None = None
    resource: str | None = None
    title: str | None = None
    place: Place | None = None
    part: str | None = None


def hover(lexicon: Lexicon, field: TextField, text: str, offset: int) -> Hover | None:
    """Say what the name at `offset` is, or return None where there is none that means anything."""
    if field.kind in (FieldKind.CONDITION, FieldKind.FORMULA, FieldKind.ACTION):
        return _Hovering(lexicon, field, text).at(offset)
    start = len(text) - len(text.lstrip())
    span = Span(start, len(text.rstrip()))
    return _Hovering(lexicon, field, text).choice(span) if span.start <= offset <= span.end else None


class _Hovering:
    def __init__(self, lexicon: Lexicon, field: TextField, text: str) -> None:
        self._lexicon = lexicon
        self._field = field
        self._text = text
        self._sight = VisibleNames(lexicon, field)

    def at(self, offset: int) -> Hover | None:
        chain = chain_at(self._text, offset, self._field.kind is FieldKind.FORMULA)
        span = Span(chain.start, chain.end)
        word = word_at(self._text, offset)
        if chain.start < word.start and self._text[chain.start : word.start].rstrip()[-1:] in "([,":
            return self._argument(word)
        name = self._name(span)
        if name is None:
            return None
        if name.is_word and (found := self._parameter(span)):
            return found
        if name.is_word and is_value_at(span, self._text, self._field.kind, self._sight.scope):
            return self._value(span)
        return self._variable(span, name) or (self._value(span) if name.is_word else None)

    def choice(self, span: Span) -> Hover | None:
        """Say what the whole text is, where that is one name of few."""
        word = self._text[span.start : span.end]
        match self._field.kind:
            case FieldKind.TYPE | FieldKind.ENUMERATION:
                return self._enumeration(span, word)
            case FieldKind.INITIAL:
                return self._value(span, self._field.type)
            case FieldKind.ACKNOWLEDGEMENT:
                full = f"{self._field.resource}.{word}"
                return self._family(span, full, (full,), self._lexicon.family.get(full))
            case FieldKind.OPERATION:
                return self._operation(span, word)
            case FieldKind.ABILITY:
                return self._ability(span)
        return None

    def _name(self, span: Span) -> Name | None:
        try:
            name = parse(self._text[span.start : span.end])
        except ExpressionError:
            return None
        return name if isinstance(name, Name) else None

    def _argument(self, span: Span) -> Hover | None:
        return self._parameter(span) or self._value(span)

    def _parameter(self, span: Span) -> Hover | None:
        word = self._text[span.start : span.end]
        type_ = self._sight.parameters.get(word)
        if type_ is None:
            return None
        key = next(name for name in self._field.parameters if name == word)
        place = self._lexicon.within(key.place) if key.place.file else None
        return Hover(span.start, span.end, word, NameKind.PARAMETER, word, type=type_, place=place)

    def _value(self, span: Span, type_: Type | None = None) -> Hover | None:
        word = self._text[span.start : span.end]
        for name, values in self._lexicon.station.station.enumeration_values().items():
            declared = self._lexicon.declarations.enumerations[name]
            if word in declared.values and (type_ is None or type_ == declared):
                place = self._lexicon.within(values[declared.values.index(word)].place)
                return Hover(
                    span.start, span.end, word, NameKind.VALUE, word, type=declared, title=name, place=place,
                    part=f"value:{name}.{word}",
                )  # fmt: skip
        if type_ is not None and not isinstance(type_, EnumerationType) and contains(type_, _read(word)):
            return Hover(span.start, span.end, word, NameKind.VALUE, word, type=type_)
        return None

    def _enumeration(self, span: Span, word: str) -> Hover | None:
        for name in self._lexicon.station.station.enumerations:
            if name == word:
                type_ = self._lexicon.declarations.enumerations[word]
                place = self._lexicon.within(name.place)
                return Hover(
                    span.start, span.end, word, NameKind.ENUMERATION, word, type=type_, place=place,
                    part=f"enumeration:{word}",
                )  # fmt: skip
        return None

    def _ability(self, span: Span) -> Hover | None:
        name = self._name(span)
        if name is None:
            return None
        full = {f"{scope.substitute(name)}" for scope in self._scopes()}
        own = [family for family in self._lexicon.families if family.suffix == ".executing"]
        for family in own:
            instances = [each.removesuffix(family.suffix) for each in family.instances(self._sight.enumerations)]
            meant = [each for each in instances if each in full or family.name in full]
            if meant:
                return Hover(
                    span.start, span.end, str(name), NameKind.ABILITY, str(name), tuple(meant[:_MOST_NAMES]),
                    resource=family.owner, title=family.title,
                    place=self._lexicon.within(self._lexicon.declarations.places[family.name]),
                    part=f"ability:{family.name}",
                )  # fmt: skip
        return None

    def _operation(self, span: Span, word: str) -> Hover | None:
        """An operation, for all choices of the parameters, or a sequence."""
        if (name := self._name(span)) is None:
            return None
        full = tuple(dict.fromkeys(str(scope.substitute(name)) for scope in self._scopes()))
        families = (self._lexicon.family.get(f"{OPERATION}.{each}.active") for each in full)
        if (family := next((each for each in families if each is not None), None)) is not None:
            title, place, part = family.title, family.place, _part(family)
        else:
            sequences = self._lexicon.station.sequences
            if (key := next((each for each in sequences if each == word), None)) is None:
                return None
            title, place, part = sequences[key].title, key.place, f"sequence:{word}"
        return Hover(
            span.start, span.end, word, NameKind.OPERATION, word, full[:_MOST_NAMES], title=title,
            place=self._lexicon.within(place), part=part,
        )  # fmt: skip

    def _variable(self, span: Span, name: Name) -> Hover | None:
        found = [variable.name for scope in self._scopes() if (variable := scope.find(name)) is not None]
        if not found:
            return None
        full = tuple(dict.fromkeys(found))
        return self._family(span, self._pattern(name), full, self._lexicon.family.get(full[0]))

    def _pattern(self, name: Name) -> str:
        """The full name with its parameters as written."""
        scope = self._sight.scope
        text = str(scope.substitute(name))
        for prefix, pattern in zip(scope.prefixes, self._field.prefix_patterns, strict=True):
            if prefix + text in scope.variables:
                return f"{pattern}{name}"
        return str(name)

    def _family(self, span: Span, pattern: str, full: tuple[str, ...], family: Family | None) -> Hover | None:
        word = self._text[span.start : span.end]
        if family is None:  # a flag of an ability, or an operation, that is not in the draft yet
            known = full[0] in self._sight.scope.variables
            kind = NameKind.FLAG if self._field.ability else NameKind.ACTIVITY
            return Hover(span.start, span.end, word, kind, pattern, full[:_MOST_NAMES], BOOLEAN) if known else None
        return Hover(
            span.start, span.end, word, family.kind, pattern, full[:_MOST_NAMES], family.type, family.initial,
            family.owner, family.title, self._lexicon.within(family.place), _part(family),
        )  # fmt: skip

    def _scopes(self) -> list[NameScope]:
        return list(self._field.scopes(self._lexicon.meaning(self._field))) or [self._sight.scope]


def _part(family: Family) -> str:
    match family.kind:
        case NameKind.FLAG:
            return f"ability:{family.name}"
        case NameKind.ACTIVITY:
            return f"operation:{family.name.removeprefix(f'{OPERATION}.')}"
    return f"variable:{family.name}"


def _read(word: str) -> Value:
    if word in ("true", "false"):
        return word == "true"
    return int(word) if word.lstrip("-").isdecimal() else word
