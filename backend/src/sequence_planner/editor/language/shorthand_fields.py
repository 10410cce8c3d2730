"""The fields of what is written out: what enumerations include, named sets, relations and maps."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from sequence_planner.automaton.findings import Findings
from sequence_planner.automaton.grounding.meaning import Meaning
from sequence_planner.automaton.shorthand import ShorthandReader, check_included
from sequence_planner.editor.language.field import FieldKind, Reading, TextField, placed, with_text
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.types import EnumerationType, Type
from sequence_planner.model.documents import (
    EnumerationDocument,
    Members,
    RelationDocument,
    SetDocument,
    ValueMapDocument,
)
from sequence_planner.model.loader import Station
from sequence_planner.model.source import SourceText
from sequence_planner.model.yaml.reader import EntryPath

Document = TypeVar("Document", SetDocument, RelationDocument, ValueMapDocument)


def field_of_enumeration(station: Station, name: SourceText, index: int) -> TextField:
    """An enumeration that another one includes."""
    written = station.station.enumerations.get(name)
    included = written.includes if isinstance(written, EnumerationDocument) else []

    def reading(meaning: Meaning, text: SourceText, scope: NameScope) -> None:
        document = EnumerationDocument(includes=with_text(included, index, text))
        check_included(name, document, station, meaning.findings)

    return TextField(FieldKind.ENUMERATION, reading)


def field_of_set(station: Station, name: SourceText, path: EntryPath, meaning: Meaning) -> TextField | None:
    """The field at `path` of a named set, which need not be there yet."""
    none = placed("")
    document = station.station.sets.get(name) or SetDocument.model_construct(of=none, values=None, excludes=None)

    def reading(part: str, text: Callable[[SourceText], object]) -> Reading:
        return _reading(station, document, part, text, lambda reader, changed: reader.read_set(name, changed))

    match path:
        case ("of",):
            return TextField(FieldKind.ENUMERATION, reading("of", lambda text: text))
        case ("values" | "except" as key, int(index)):
            part = "values" if key == "values" else "excludes"
            texts: list[SourceText] = getattr(document, part) or []
            return _member(meaning, document.of, reading(part, lambda text: with_text(texts, index, text)))
    return None


def field_of_relation(station: Station, name: SourceText, path: EntryPath, meaning: Meaning) -> TextField | None:
    """The field at `path` of a relation, which need not be there yet."""
    none = placed("")
    written = station.station.relations.get(name)
    document = written or RelationDocument.model_construct(between=[none, none], symmetric=False, pairs=[])

    def reading(part: str, text: Callable[[SourceText], object]) -> Reading:
        return _reading(station, document, part, text, lambda reader, changed: reader.read_relation(changed))

    match path:
        case ("between", int(index)):
            return TextField(
                FieldKind.ENUMERATION, reading("between", lambda text: with_text(document.between, index, text)[:2])
            )
        case ("pairs", int(row), 0 | 1 as side, *rest):
            pair = document.pairs[row] if row < len(document.pairs) else [none, none]

            def changed(text: SourceText) -> list[list[Members]]:
                members = pair[side]
                put: Members = text
                if rest and isinstance(rest[0], int):
                    put = with_text(members if isinstance(members, list) else [], rest[0], text)
                new = [put if index == side else each for index, each in enumerate(pair)]
                return [*document.pairs[:row], new, *document.pairs[row + 1 :]]

            return _member(meaning, document.between[side], reading("pairs", changed))
    return None


def field_of_map(station: Station, name: SourceText, path: EntryPath, meaning: Meaning) -> TextField | None:
    """The field at `path` of a map, which need not be there yet."""
    none = placed("")
    written = station.station.maps.get(name)
    document = written or ValueMapDocument.model_construct(source=none, to=none, values={}, otherwise=None)

    def reading(part: str, text: Callable[[SourceText], object]) -> Reading:
        return _reading(station, document, part, text, lambda reader, changed: reader.read_map(name, changed))

    target: Type | None = meaning.declarations.noting(Findings()).type_of(name, document.to, None)
    match path:
        case ("from",):
            return TextField(FieldKind.ENUMERATION, reading("source", lambda text: text))
        case ("to",):
            return TextField(FieldKind.TYPE, reading("to", lambda text: text))
        case ("otherwise",):
            return TextField(FieldKind.INITIAL, reading("otherwise", lambda text: text), type=target)
        case ("values", str(key)):
            return TextField(
                FieldKind.INITIAL, reading("values", lambda text: {**document.values, placed(key): text}), type=target
            )
    return None


def _reading(
    station: Station,
    document: Document,
    part: str,
    changed: Callable[[SourceText], object],
    read: Callable[[ShorthandReader, Document], object],
) -> Reading:
    """What is found in a document with another text in one part."""

    def reading(meaning: Meaning, text: SourceText, scope: NameScope) -> None:
        reader = ShorthandReader(meaning.declarations, station, meaning.findings)
        read(reader, document.model_copy(update={part: changed(text)}))

    return reading


def _member(meaning: Meaning, domain: SourceText, read: Reading) -> TextField:
    """A value of an enumeration or set, or the name of a set of such values."""
    enumerations = meaning.declarations.enumerations
    whole = enumerations.get(domain) or EnumerationType(())
    sets = (name for name, type_ in enumerations.items() if set(type_.values) <= set(whole.values))
    return TextField(FieldKind.MEMBER, read, choices=tuple(sets), type=whole)
