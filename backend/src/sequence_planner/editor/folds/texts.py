"""The texts of a station in which something may be written shorter, and parts of them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property

from sequence_planner.core.immutable import replace
from sequence_planner.editor.language.field import FieldKind, TextField
from sequence_planner.editor.language.scope import Lexicon
from sequence_planner.editor.language.service import check
from sequence_planner.editor.symbols.texts import ModelContent
from sequence_planner.language.parser import parse, parse_assignment, parse_formula
from sequence_planner.language.syntax import (
    And,
    Arithmetic,
    BinaryTemporal,
    Comparison,
    Component,
    Expression,
    ExpressionError,
    Implies,
    Membership,
    Name,
    NamedMembership,
    Not,
    Or,
    Quantified,
    Span,
    UnaryTemporal,
    children,
)
from sequence_planner.language.types import EnumerationType
from sequence_planner.model.documents import VariableDocument
from sequence_planner.model.source import SourceText
from sequence_planner.model.yaml.reader import EntryPath
from sequence_planner.station import MeantStation

_JOINING = re.compile(r"\b(?:and|or)\b")


def _parts_of_action(text: str) -> Iterator[Expression]:
    action = parse_assignment(text)
    yield action.value
    if action.condition is not None:
        yield action.condition


_READ: Mapping[FieldKind, Callable[[str], Iterable[Expression]]] = {
    FieldKind.CONDITION: lambda text: (parse(text),),
    FieldKind.FORMULA: lambda text: (parse_formula(text),),
    FieldKind.ACTION: _parts_of_action,
}


@dataclass(frozen=True)
class FoldableText:
    """A condition, formula or action of the station, with where it stands."""

    file: str
    path: EntryPath
    text: SourceText
    field: TextField

    @cached_property
    def nodes(self) -> tuple[Expression, ...]:
        """All conditions and values in it, what is in them behind what they are in."""
        return tuple(node for tree in _READ[self.field.kind](self.text) for node in nodes_of(tree))

    def of_operands(self, node: And | Or, first: int, last: int) -> Span:
        """Where the operands of `node` from `first` to `last` stand, with the brackets around them."""
        start, end = node.span
        if first:
            between = Span(node.operands[first - 1].span.end, node.operands[first].span.start)
            word = list(_JOINING.finditer(self.text, *between))[-1]
            start = len(self.text) - len(self.text[word.end() :].lstrip())
        if last < len(node.operands) - 1:
            between = Span(node.operands[last].span.end, node.operands[last + 1].span.start)
            word = next(_JOINING.finditer(self.text, *between))
            end = len(self.text[: word.start()].rstrip())
        return Span(start, end)

    def with_brackets(self, span: Span) -> Span:
        """The same part with the brackets that are around it alone: a single name needs none."""
        start, end = len(self.text[: span.start].rstrip()) - 1, span.end
        end += len(self.text[end:]) - len(self.text[end:].lstrip())
        is_around = start >= 0 and self.text[start] == "(" and self.text[end : end + 1] == ")"
        if is_around and (start == 0 or self.text[start - 1] in " (\n"):
            return self.with_brackets(Span(start, end + 1))
        return span

    def is_bracketed(self, span: Span) -> bool:
        """Return whether brackets, or the ends of a condition, are around a part."""
        before, behind = self.text[: span.start].rstrip(), self.text[span.end :].lstrip()
        return (not before or before.endswith(("(", " if"))) and (not behind or behind.startswith(")"))


@dataclass(frozen=True)
class Rewriting:
    """A part of a text, and what can be written in its place."""

    text: FoldableText
    span: Span
    now: str

    @property
    def was(self) -> str:
        """What is written now."""
        return self.text.text[self.span.start : self.span.end]


@dataclass(frozen=True)
class FoldableStation:
    """A station as it is written: its files with their texts, and what its names mean."""

    content: ModelContent
    lexicon: Lexicon
    texts: tuple[FoldableText, ...] = field(repr=False)

    @classmethod
    def made_of(cls, files: Mapping[str, str], meant: MeantStation) -> FoldableStation:
        """The station of these files, which was read. What is written in types and packages is left alone."""
        content, lexicon = ModelContent(files), Lexicon.of(meant.station, meant.registry)
        found = (
            FoldableText(file, path, text, where)
            for file in content
            for path, text in _values(content[file], ())
            if (where := lexicon.field(file, path)) is not None and where.kind in _READ
        )
        return cls(content, lexicon, tuple(each for each in found if _is_readable(each)))

    @cached_property
    def domains(self) -> dict[str, EnumerationType]:
        """Its enumerations and named sets."""
        return dict(self.lexicon.declarations.enumerations)

    @cached_property
    def every_value(self) -> frozenset[str]:
        """The values of all of them."""
        return frozenset(value for each in self.domains.values() for value in each.values)

    def with_values(self, values: Iterable[str]) -> list[str]:
        """The enumerations and sets that have these values and no others."""
        wanted = set(values)
        return [name for name, type_ in self.domains.items() if set(type_.values) == wanted]

    def smallest_with(self, values: Iterable[str]) -> str | None:
        """The smallest enumeration that has these values, and perhaps others."""
        wanted = set(values)
        sets = self.lexicon.sets
        found = [
            name for name, each in self.domains.items() if name not in map(str, sets) and wanted <= set(each.values)
        ]
        return min(found, key=lambda name: len(self.domains[name].values), default=None)

    @cached_property
    def indices(self) -> dict[str, tuple[str, ...]]:
        """By variable, the words that its declaration has for its indices."""
        documents: list[tuple[str, Mapping[SourceText, VariableDocument]]] = [
            ("", self.lexicon.station.station.estimated)
        ]
        for name, each in self.lexicon.station.resources.items():
            documents += [(f"{name}.", part) for part in (each.measured, each.output, each.estimated)]
        return {
            f"{prefix}{name}": tuple(map(str, document.each))
            for prefix, part in documents
            for name, document in part.items()
            if document.each
        }

    def is_right(self, text: FoldableText, new: str) -> bool:
        """Return whether `new` could stand in the place of a text."""
        return not check(self.lexicon, text.field, new)

    @cached_property
    def taken(self) -> frozenset[str]:
        """All words that stand for something already: a new name is none of them."""
        declared = (*self.lexicon.declarations.types, *self.domains, *self.lexicon.short, *self.every_value)
        return frozenset(word for name in declared for word in re.findall(r"\w+", name))

    def unused(self, wanted: str) -> str:
        """A name like `wanted` that nothing has."""
        name, number = wanted, 1
        while name in self.taken:
            number += 1
            name = f"{wanted}_{number}"
        return name


def _is_readable(text: FoldableText) -> bool:
    try:
        return bool(text.nodes)
    except ExpressionError:
        return False


def _values(content: object, path: EntryPath) -> Iterator[tuple[EntryPath, SourceText]]:
    if isinstance(content, SourceText):
        yield path, content
    elif isinstance(content, dict):
        for key, value in content.items():
            yield from _values(value, (*path, str(key)))
    elif isinstance(content, list):
        for index, value in enumerate(content):
            yield from _values(value, (*path, index))


# Trees, and trees with other words


def nodes_of(expression: Expression) -> Iterator[Expression]:
    """An expression with all that is in it, what is in something behind that."""
    yield expression
    for part in children(expression):
        yield from nodes_of(part)


def words_of(expression: Expression) -> set[str]:
    """The words in an expression that could be values: those alone, and arguments."""
    if isinstance(expression, Name):
        if expression.is_word:
            return {str(expression)}
        arguments = {each for part in expression.path for each in part.arguments}
        return {word for each in arguments for word in ([each] if isinstance(each, str) else words_of(each))}
    return {word for part in children(expression) for word in words_of(part)}


def with_word(expression: Expression, word: str, other: str) -> Expression:
    """An expression with `other` wherever it has the value `word`."""

    def _part(inner: Expression) -> Expression:
        return with_word(inner, word, other)

    match expression:
        case Name():
            return _renamed(expression, word, other)
        case Not(operand) | UnaryTemporal(_, operand):
            return replace(expression, operand=_part(operand))
        case And(operands) | Or(operands):
            return replace(expression, operands=tuple(map(_part, operands)))
        case Implies(left, right) | Comparison(_, left, right) | Arithmetic(_, left, right):
            return replace(expression, left=_part(left), right=_part(right))
        case BinaryTemporal(_, left, right):
            return replace(expression, left=_part(left), right=_part(right))
        case Membership(left, options):
            return replace(expression, left=_part(left), options=tuple(map(_part, options)))
        case NamedMembership(left):
            return replace(expression, left=_part(left))
        case Quantified(where=where, body=body):
            return replace(expression, where=where and _part(where), body=_part(body))
    return expression


def _renamed(name: Name, word: str, other: str) -> Name:
    if name.is_word:
        return Name((Component(other),), name.span) if str(name) == word else name

    def argument(each: str | Name) -> str | Name:
        if isinstance(each, Name):
            return _renamed(each, word, other)
        return other if each == word else each

    return Name(
        tuple(Component(part.name, tuple(map(argument, part.arguments)), part.indexed) for part in name.path), name.span
    )


def names_in(expression: Expression) -> Iterator[Name]:
    """All names in an expression, but for those of sets."""
    if isinstance(expression, Name):
        yield expression
    for part in children(expression):
        yield from names_in(part)
