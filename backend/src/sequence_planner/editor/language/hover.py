"""Hover information: the meaning of the name at a text position."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import islice, product

from sequence_planner.automaton.declarations import OPERATION
from sequence_planner.editor.language.completion import chain_at, word_at, words_of
from sequence_planner.editor.language.families import SHORT, Family, definition_of
from sequence_planner.editor.language.field import FieldKind, TextField, placed
from sequence_planner.editor.language.quantifiers import quantifiers_before
from sequence_planner.editor.language.schemas import NameKind
from sequence_planner.editor.language.scope import Lexicon, VisibleNames
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse, parse_assignment, parse_formula
from sequence_planner.language.printer import print_expression, print_value
from sequence_planner.language.resolver import resolve_assignments, resolve_formula, resolve_predicate
from sequence_planner.language.shorthand.titles import in_language
from sequence_planner.language.simplifier import simplify
from sequence_planner.language.syntax import (
    And,
    Binder,
    Constant,
    Expression,
    ExpressionError,
    Name,
    NamedMembership,
    Quantified,
    Span,
    children,
)
from sequence_planner.language.types import BOOLEAN, EnumerationType, Place, Type, Value, contains

# What resolution makes of one name of a text.


def is_value_at(span: Span, text: str, kind: FieldKind, scope: NameScope) -> bool:
    """Return whether the name there is read as a value; not where the text makes no sense."""
    try:
        parts = _resolved(text, kind, scope)
    except ExpressionError:
        return False
    word = text[span.start : span.end]
    # What a predicate is written out to stands where its name does.
    constants = (leaf for part in parts for leaf in _leaves(part) if isinstance(leaf, Constant) and leaf.span == span)
    return any(leaf.value == word for leaf in constants)


def _resolved(text: str, kind: FieldKind, scope: NameScope) -> tuple[Expression, ...]:
    if kind is FieldKind.FORMULA:
        return (resolve_formula(parse_formula(text), scope),)
    if kind is FieldKind.CONDITION:
        return (resolve_predicate(parse(text), scope),)
    actions = resolve_assignments(parse_assignment(text), scope)
    return tuple(part for each in actions for part in (each.value, each.condition) if part is not None)


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
    looked for there, but for a parameter. Where it is written for short, `definition` is the condition that it was
    given, and `expansion` what it stands for in the end.
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
    expansion: str | None = None
    definition: str | None = None


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
        self._outer = self._sight.scope

    def at(self, offset: int) -> Hover | None:
        chain = chain_at(self._text, offset, self._field.kind is FieldKind.FORMULA)
        word = word_at(self._text, offset)
        bound = quantifiers_before(words_of(self._text[: word.start])).bound
        if bound:
            self._sight = VisibleNames(self._lexicon, self._field, bound)
        tree = self._tree()
        if (quantified := _quantified_at(tree, offset)) is not None:
            return self._quantified(quantified, word, offset)
        if (named := _set_at(tree, offset)) is not None:
            return self._enumeration(named.span, str(named))
        whole = _name_at(tree, offset)
        span = Span(chain.start, chain.end) if whole is None or whole.is_word else whole.span
        if span.start < word.start and self._text[span.start : word.start].rstrip()[-1:] in "([,":
            return self._argument(word)
        name = self._name(span)
        if name is None:
            return None
        if name.is_word and (found := self._parameter(span)):
            return found
        if name.is_word and is_value_at(span, self._text, self._field.kind, self._outer):
            return self._value(span)
        found = self._variable(span, name) or self._for_short(span, name) or self._of_array(span, name)
        return found or (self._value(span) if name.is_word else None)

    def choice(self, span: Span) -> Hover | None:
        """Say what the whole text is, where that is one name of few."""
        word = self._text[span.start : span.end]
        match self._field.kind:
            case FieldKind.TYPE | FieldKind.ENUMERATION:
                return self._enumeration(span, word)
            case FieldKind.INITIAL:
                return self._value(span, self._field.type)
            case FieldKind.MEMBER:
                return self._value(span) or self._enumeration(span, word)
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
        found = self._parameter(span) or self._value(span) or self._enumeration(span, self._text[span.start : span.end])
        name = self._name(span)
        return found if found is not None or name is None else self._variable(span, name)

    def _parameter(self, span: Span) -> Hover | None:
        word = self._text[span.start : span.end]
        type_ = self._sight.parameters.get(word)
        if type_ is None:
            return None
        key = next((name for name in self._field.parameters if name == word), None)
        place = self._lexicon.within(key.place) if key is not None and key.place.file else None
        return Hover(span.start, span.end, word, NameKind.PARAMETER, word, type=type_, place=place)

    def _value(self, span: Span, type_: Type | None = None) -> Hover | None:
        word = self._text[span.start : span.end]
        for name, values in self._lexicon.station.station.enumeration_values().items():
            declared = self._lexicon.declarations.enumerations[name]
            if word in declared.values and (type_ is None or set(type_.domain) <= set(declared.values)):
                place = self._lexicon.within(values[declared.values.index(word)].place)
                return Hover(
                    span.start, span.end, word, NameKind.VALUE, word, type=declared,
                    title=self._called(name, declared, word), place=place, part=f"value:{name}.{word}",
                )  # fmt: skip
        if type_ is not None and not isinstance(type_, EnumerationType) and contains(type_, _read(word)):
            return Hover(span.start, span.end, word, NameKind.VALUE, word, type=type_)
        return None

    def _called(self, enumeration: str, type_: EnumerationType, value: str) -> str:
        """The enumeration of a value, and what people are told in its place."""
        said = in_language(self._lexicon.declarations.titles.of_value(type_, value), "en")
        return enumeration if said is None else f"{enumeration}: {said}"

    def _enumeration(self, span: Span, word: str) -> Hover | None:
        for name in self._lexicon.station.station.enumerations:
            if name == word:
                type_ = self._lexicon.declarations.enumerations[word]
                place = self._lexicon.within(name.place)
                return Hover(
                    span.start, span.end, word, NameKind.ENUMERATION, word, type=type_, place=place,
                    part=f"enumeration:{word}",
                )  # fmt: skip
        declared = self._lexicon.declarations
        full = str(declared.domain_in(placed(word), self._field.resource))
        for each in self._lexicon.sets:
            if each == full and full in declared.enumerations:
                type_, place = declared.enumerations[full], self._lexicon.within(each.place)
                return Hover(
                    span.start, span.end, word, NameKind.SET, full, type=type_, place=place, part=f"set:{full}"
                )
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
            title, place, part = sequences[key].main_title, key.place, f"sequence:{word}"
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
        scopes = list(self._field.scopes(self._lexicon.meaning(self._field))) or [self._sight.scope]
        bound = self._sight.bound
        choices = product(*([(value, type_) for value in type_.values] for type_ in bound.values()))
        return [scope.binding(dict(zip(bound, choice, strict=True))) for choice in choices for scope in scopes]

    # What is written for short.

    def _tree(self) -> tuple[Expression, ...]:
        """The text as it is read, or nothing where it makes no sense."""
        try:
            if self._field.kind is FieldKind.ACTION:
                action = parse_assignment(self._text)
                parts = (action.target, action.value, *(() if action.condition is None else (action.condition,)))
                if not action.binders:
                    return parts
                # Read as a quantifier: all of it stands within.
                begin = Span(action.target.span.start, action.span.end)
                return (Quantified("all", None, action.binders, None, And(parts, begin), action.span),)
            return (parse_formula(self._text) if self._field.kind is FieldKind.FORMULA else parse(self._text),)
        except ExpressionError:
            return ()

    def _quantified(self, quantified: Quantified, word: Span, offset: int) -> Hover | None:
        """What stands before the body of a quantifier: itself, its words, or what these range over."""
        for binder in quantified.binders:
            if binder.span.start <= offset <= binder.span.end:
                bound = {each.word: _domain(each) for each in quantified.binders}
                self._sight = VisibleNames(self._lexicon, self._field, bound)
                return self._parameter(binder.span)
            for domain in binder.domain if isinstance(binder.domain, tuple) else (binder.domain,):
                if domain.span.start <= offset <= domain.span.end:
                    return self._enumeration(domain.span, str(domain)) or self._value(domain.span)
        read = resolve_formula if self._field.kind is FieldKind.FORMULA else resolve_predicate
        return Hover(
            word.start, word.end, self._text[word.start : word.end], NameKind.KEYWORD, quantified.quantifier,
            expansion=self._expansion(lambda scope: read(quantified, scope)),
        )  # fmt: skip

    def _for_short(self, span: Span, name: Name) -> Hover | None:
        """A predicate, a relation, a map, or a function of an ordered enumeration."""
        skeleton = ".".join(part.name for part in name.path)
        word, vocabulary = self._text[span.start : span.end], self._sight.scope.vocabulary
        prefixes = (*self._sight.scope.prefixes, "")
        full = next((prefix + skeleton for prefix in prefixes if prefix + skeleton in self._lexicon.short), None)
        family = None if full is None else self._lexicon.short[full]
        if full is None or family is None:
            if (family := self._lexicon.short.get(str(name))) is None:
                return None
            return Hover(span.start, span.end, word, family.kind, word, type=family.type)
        expansion: str | None = None
        definition: str | None = None
        match family.kind:
            case NameKind.KEYWORD:
                return Hover(span.start, span.end, word, family.kind, word, type=family.type)
            case NameKind.PREDICATE:
                expansion = self._expansion(lambda scope: resolve_predicate(name, scope), *name.path[-1].arguments)
                words = tuple(map(str, name.path[-1].arguments))
                definition = _shortened(definition_of(self._lexicon.station, family, words))
            case NameKind.RELATION:
                expansion = _shortened(", ".join(map(" – ".join, sorted(vocabulary.relations[full].pairs))))
            case NameKind.MAP:
                table = vocabulary.maps[full].table.items()
                expansion = _shortened(", ".join(f"{key} → {print_value(value)}" for key, value in table))
        return Hover(
            span.start, span.end, word, family.kind, f"{full}{word[len(skeleton):]}", (), family.type,
            resource=family.owner, title=family.title, place=self._lexicon.within(family.place),
            part=f"{family.kind}:{full}", expansion=expansion, definition=definition,
        )  # fmt: skip

    def _of_array(self, span: Span, name: Name) -> Hover | None:
        """A variable or flag whose index or argument has a value itself."""
        skeleton = ".".join(part.name for part in name.path)
        for prefix in (*self._sight.scope.prefixes, ""):
            family = next((each for each in self._lexicon.families if each.skeleton == prefix + skeleton), None)
            if family is not None and family.arguments and family.kind not in SHORT:
                names = tuple(islice(family.instances(self._sight.enumerations), _MOST_NAMES))
                return self._family(span, f"{prefix}{name}", names, family)
        return None

    def _expansion(self, read: Callable[[NameScope], Expression], *words: str | Name) -> str | None:
        """What a part of the text is written out to, for the first choice of the words in it that stand for values."""
        scope = self._sight.scope
        try:
            said = _shortened(print_expression(simplify(read(scope))))
        except ExpressionError:
            return None
        chosen = [f"{word} = {scope.parameters[str(word)][0]}" for word in words if str(word) in scope.parameters]
        return f"{', '.join(chosen)}: {said}" if chosen else said


_LONGEST = 400


def _shortened(text: str) -> str:
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST].rpartition(' ')[0]} …"


def _domain(binder: Binder) -> str | tuple[str, ...]:
    return str(binder.domain) if isinstance(binder.domain, Name) else tuple(map(str, binder.domain))


def _around(parts: tuple[Expression, ...], offset: int) -> Iterator[Expression]:
    """All that is written around a place, the outermost first."""
    for part in parts:
        if part.span.start <= offset <= part.span.end:
            yield part
            inner = tuple(each for step in part.path for each in step.arguments) if isinstance(part, Name) else ()
            yield from _around(children(part) + tuple(each for each in inner if isinstance(each, Name)), offset)


def _quantified_at(tree: tuple[Expression, ...], offset: int) -> Quantified | None:
    """The quantifier before whose body or condition a place is."""
    for part in _around(tree, offset):
        if isinstance(part, Quantified):
            inside = (part.body,) if part.where is None else (part.where, part.body)
            last = part.binders[-1].domain
            end = last.span.end if isinstance(last, Name) else last[-1].span.end
            if part.span.start <= offset <= end and not any(
                each.span.start <= offset <= each.span.end for each in inside
            ):
                return part
    return None


def _set_at(tree: tuple[Expression, ...], offset: int) -> Name | None:
    """The set or enumeration that stands there behind `in`."""
    memberships = (part for part in _around(tree, offset) if isinstance(part, NamedMembership))
    found = (part.domain for part in memberships if part.domain.span.start <= offset <= part.domain.span.end)
    return next(found, None)


def _name_at(tree: tuple[Expression, ...], offset: int) -> Name | None:
    """The innermost name that stands there."""
    names = [part for part in _around(tree, offset) if isinstance(part, Name)]
    return names[-1] if names else None


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
