"""Names in the conditions and actions of a type that no instance has: what they can be is known as far as it does not
depend on arguments.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import reduce
from typing import NamedTuple

from sequence_planner.language.lexer import KEYWORDS
from sequence_planner.language.names.scope import ENDS, STEPS
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.parser import parse, parse_assignment
from sequence_planner.language.syntax import (
    ArgumentWord,
    Assignment,
    Binder,
    Comparison,
    Component,
    Expression,
    Membership,
    Name,
    NamedMembership,
    Quantified,
    children,
)
from sequence_planner.model.documents import ResourceDocument
from sequence_planner.model.fields import FLAGS, OPERATION
from sequence_planner.model.loader import Station
from sequence_planner.model.source import ExpandedText, Finding
from sequence_planner.model.stages.rename import RenameDocument
from sequence_planner.model.types.layers import UnusedType
from sequence_planner.model.types.unused import ReadText, texts_of
from sequence_planner.texts.message import message

_SECTIONS = ("measured", "output", "estimated", "predicates", "relations", "maps")
_MISSPELT = 0.7  # as like a known name as a wrong one has to be where it could be one of another station


def depends_on_arguments(document: ResourceDocument) -> bool:
    """Return whether arguments decide what the variables of a type are called."""
    types = [
        *(each.type for each in document.topics.values()),
        *(each.type for each in document.services.values()),
        *(each.type for each in document.actions.values()),
    ]
    names = [*(name for section in _SECTIONS for name in getattr(document, section)), *document.abilities]
    return any(isinstance(each, ExpandedText) for each in (*types, *names, *_renamed(document)))


def unknown_names(unused: UnusedType, document: ResourceDocument, station: Station) -> list[Finding]:
    """The names that mean nothing whatever the arguments are; `document` is the resource of the type, and `station`
    that in which it could be, both with the variables that follow from messages.
    """
    known = _Known(unused, document, station)
    return [finding for text in texts_of(document) for finding in known.unknown_in(text)]


def _renamed(document: ResourceDocument) -> Iterator[str]:
    """The variables whose names stages give to fields: without the field, which may be called as an argument says, they
    are none.
    """
    stages = [
        *(topic.pipeline for topic in document.topics.values()),
        *(each for service in document.services.values() for each in (service.request, service.response)),
        *(each for action in document.actions.values() for each in (action.goal, action.feedback, action.result)),
    ]
    for stage in (each.content for pipeline in stages for each in pipeline):
        if isinstance(stage, RenameDocument):
            yield from stage.names.values()


def _names_of(document: ResourceDocument) -> Iterator[str]:
    for section in _SECTIONS:
        yield from map(str, getattr(document, section))
    for ability in document.abilities:
        yield from (f"{ability}.{flag}" for flag in FLAGS)


class _Around(NamedTuple):
    """What is known at one place of a text beside all else: words, and whether a value can stand there."""

    words: frozenset[str]
    is_value: bool = False


class _Known:
    def __init__(self, unused: UnusedType, document: ResourceDocument, station: Station) -> None:
        whole = station.station
        self._kinds = unused.kinds
        self._standing = {name for kind in ("value", "number", "resource") for name in self._of_kind(kind)}
        self._is_packaged = bool(unused.package)
        self._own = {*_names_of(document), *map(str, _renamed(document))}
        self._station = {str(name) for each in ("estimated", *_SECTIONS[3:]) for name in getattr(whole, each)}
        self._station |= {f"{OPERATION}.{name}.active" for name in station.operations}
        for resource, other in station.resources.items():
            self._station |= {f"{resource}.{name}" for name in _names_of(other)}
        self._values = {str(value) for values in whole.enumeration_values().values() for value in values}
        self._domains = {*map(str, (*whole.enumerations, *whole.sets, *document.sets)), *self._of_kind("enumeration")}
        self._domains |= {f"{resource}.{name}" for resource, other in station.resources.items() for name in other.sets}

    def unknown_in(self, read: ReadText) -> Iterator[Finding]:
        """The unknown names in a text."""
        words = frozenset(map(str, (*read.parameters, *(FLAGS if read.in_ability else ()))))
        if read.is_action:
            found = self._of_action(parse_assignment(read.text), words)
        else:
            found = self._in(parse(read.text), _Around(words))
        for name, said in found:
            yield Finding(read.text.at(name.span), said)

    def _of_action(self, action: Assignment, words: frozenset[str]) -> Iterator[tuple[Name, str]]:
        yield from self._in_binders(action.binders, words)
        words |= {binder.word for binder in action.binders}
        assert isinstance(action.target, Name)
        yield from self._in_name(action.target, _Around(words))
        yield from self._in(action.value, _Around(words, True))
        if action.condition is not None:
            yield from self._in(action.condition, _Around(words))

    def _in(self, part: Expression, around: _Around) -> Iterator[tuple[Name, str]]:
        match part:
            case Name():
                yield from self._in_name(part, around)
                return
            case NamedMembership(_, domain):
                yield from self._in_domain(domain)
            case Quantified(binders=binders):
                yield from self._in_binders(binders, around.words)
                around = around._replace(words=around.words | {binder.word for binder in binders})
        is_value = isinstance(part, Comparison | Membership | NamedMembership)
        for each in children(part):
            yield from self._in(each, around._replace(is_value=is_value))

    def _in_binders(self, binders: tuple[Binder, ...], words: frozenset[str]) -> Iterator[tuple[Name, str]]:
        for binder in binders:
            if isinstance(binder.domain, Name):
                yield from self._in_domain(binder.domain)
            else:
                for value in binder.domain:
                    yield from self._in_name(value, _Around(words, True))

    def _in_domain(self, name: Name) -> Iterator[tuple[Name, str]]:
        if str(name) not in self._domains:
            near = suggestion(str(name), self._domains, self._likeness)
            if near or not self._is_packaged:
                yield name, message("wrong.no-set", name=str(name), hint=near)

    def _in_name(self, name: Name, around: _Around) -> Iterator[tuple[Name, str]]:
        skeleton = ".".join(part.name for part in name.path)
        if not self._is_known(name, skeleton, around) and (near := self._meant(skeleton, around)) is not None:
            is_value = around.is_value and len(name.path) == 1
            id_ = "wrong.unknown-name" if is_value else "wrong.unknown-variable"
            yield name, message(id_, name=str(name), hint=near)
        for argument in (each for part in name.path for each in part.arguments):
            if str(argument) not in self._domains:
                yield from self._in_name(_as_name(argument, name), around._replace(is_value=True))

    def _is_known(self, name: Name, skeleton: str, around: _Around) -> bool:
        first = name.path[0]
        if name.is_word and (skeleton in around.words or skeleton in self._values or skeleton in self._standing):
            return True
        if self._kinds.get(first.name) == "resource" or skeleton in self._own or skeleton in self._station:
            return True
        return len(name.path) == 1 and bool(first.arguments) and (first.name in STEPS or first.name in ENDS)

    def _meant(self, word: str, around: _Around) -> str | None:
        """Say what may have been meant; None where the name may be right with some argument or in another station."""
        if word.lower() in KEYWORDS:
            return message("hint.write", what=word.lower())
        if flags := [f"{word}.{flag}" for flag in FLAGS if f"{word}.{flag}" in self._own]:
            return message(
                "hint.write", what=reduce(lambda most, each: message("list.or", most=most, last=each), flags)
            )
        known = [*sorted(around.words), *sorted(self._standing), *sorted(self._own)]
        if not self._is_packaged:
            known += sorted(self._station)
        elif around.is_value and self._of_kind("enumeration"):
            return None
        if around.is_value:
            known += sorted(self._values)
        near = suggestion(word, known, self._likeness)
        return near if near or not self._is_packaged else None

    @property
    def _likeness(self) -> float:
        return _MISSPELT if self._is_packaged else 0.5

    def _of_kind(self, kind: str) -> set[str]:
        return {name for name, each in self._kinds.items() if each == kind}


def _as_name(argument: str | Name, whole: Name) -> Name:
    if isinstance(argument, Name):
        return argument
    return Name((Component(argument),), argument.span if isinstance(argument, ArgumentWord) else whole.span)
