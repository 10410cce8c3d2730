"""What can be written at a place of a document: names and words of conditions, names of entries and their values."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from sequence_planner.editor.language.completion import NO_MATCH, likeness
from sequence_planner.editor.language.schemas import NameKind
from sequence_planner.editor.language.types.places import parameters_of, text_place
from sequence_planner.editor.symbols.texts import message_of
from sequence_planner.language_server.documents.cursor import Cursor, typed_at
from sequence_planner.language_server.documents.schemas import DocumentSchemas
from sequence_planner.language_server.snapshot import StationSnapshot
from sequence_planner.model.documents import ResourceDocument
from sequence_planner.model.paths import resource_of, type_of
from sequence_planner.model.yaml.reader import EntryPath
from sequence_planner.ros.types.errors import UnknownMessageTypeError

_MESSAGE_KINDS = {"topics": "msg", "services": "srv", "actions": "action"}


@dataclass(frozen=True)
class Proposal:
    """Something that can be written from `start` to `end` of a file. One of no `kind` is a name of an entry."""

    label: str
    insert: str
    start: int
    end: int
    kind: NameKind | None
    detail: str = ""
    about: str = ""


def proposals(snapshot: StationSnapshot, schemas: DocumentSchemas, file: str, text: str, index: int) -> list[Proposal]:
    """Return what can be written in a file at a character of its text, the most useful first."""
    for cursor in typed_at(text, index):
        found = list(_at(snapshot, schemas, file, cursor))
        if not cursor.is_name and cursor.begins_line(text):  # names of what is to stand there can begin here
            found += _names(schemas, file, cursor, cursor.path)
        if found:
            return found
    return []


def _at(snapshot: StationSnapshot, schemas: DocumentSchemas, file: str, cursor: Cursor) -> Iterator[Proposal]:
    if cursor.is_name:
        yield from _names(schemas, file, cursor, cursor.path[:-1])
        yield from _known(cursor, _free_names(snapshot, file, cursor.path))
        return
    place = text_place(snapshot.lexicon, file, cursor.path, cursor.parameters)
    if place is not None:
        found = place.completion(str(cursor.text), cursor.offset)
        start, end = cursor.span_in_file(found.start, found.end)
        for option in found.options:
            yield Proposal(option.label, option.insert, start, end, option.kind, option.detail)
        if found.options:
            return
    yield from _known(cursor, [(value, NameKind.VALUE) for value in schemas.listed_values(file, cursor.path)])
    yield from _known(cursor, _values(snapshot, file, cursor.path))


def _names(schemas: DocumentSchemas, file: str, cursor: Cursor, path: EntryPath) -> Iterator[Proposal]:
    """The names of entries that are not there yet."""
    start, end = cursor.span_in_file(0, len(cursor.text))
    for name, about, holds in schemas.entry_names(file, path):
        if (name not in cursor.beside or not cursor.is_name) and _fits(cursor, name):
            yield Proposal(name, f"{name}:" if holds else f"{name}: ", start, end, None, "", about)


def _fits(cursor: Cursor, name: str) -> bool:
    return likeness(str(cursor.text)[: cursor.offset].strip(), name) < NO_MATCH


def _known(cursor: Cursor, names: Iterable[tuple[str, NameKind]]) -> Iterator[Proposal]:
    start, end = cursor.span_in_file(0, len(cursor.text))
    for name, kind in names:
        if _fits(cursor, name):
            insert = f"{name}: " if cursor.is_name else name
            yield Proposal(name, insert, start, end, kind)


def _free_names(snapshot: StationSnapshot, file: str, path: EntryPath) -> Iterator[tuple[str, NameKind]]:
    """The names of other parts that name an entry."""
    match file, path:
        case "specifications.yaml", (str(), "zone", str()):
            yield from ((name, NameKind.RESOURCE) for name in sorted(snapshot.lexicon.station.resources))
        case "work_masters.yaml", (str(), "operations", str()):
            yield from ((name, NameKind.OPERATION) for name in snapshot.lexicon.operations)
        case _, ("arguments", str()):
            yield from ((str(name), NameKind.PARAMETER) for name in parameters_of(snapshot.lexicon, file))


def _values(snapshot: StationSnapshot, file: str, path: EntryPath) -> Iterator[tuple[str, NameKind]]:
    """The names that stand as values outside of conditions."""
    match path:
        case ("type",) if resource_of(file) or type_of(file):
            yield from ((name, NameKind.RESOURCE) for name in sorted(filter(None, map(type_of, snapshot.files))))
        case ("arguments", str(name)):
            given = parameters_of(snapshot.lexicon, file)
            if any(key == name and each.kind == "resource" for key, each in given.items()):
                yield from ((each, NameKind.RESOURCE) for each in sorted(snapshot.lexicon.station.resources))
    resource = snapshot.lexicon.station.resources.get(resource_of(file) or "")
    if resource is None:
        return
    match path:
        case ("topics" | "services" | "actions" as section, str(), "type"):
            yield from ((name, NameKind.VALUE) for name in _messages(snapshot, section))
        case ("services" | "actions", str(), "when"):
            yield from ((str(name), NameKind.OUTPUT) for name in resource.output)
        case ("actions", str(), "status"):
            yield from ((str(name), NameKind.MEASURED) for name in resource.measured)
        case ("flows", str(), "from", *_):
            yield from (
                (str(name), NameKind.RESOURCE)
                for each in snapshot.lexicon.station.resources.values()
                for name in (*each.topics, *each.flows)
            )
        case ("topics", str(name), "ignore" | "pipeline", *_):
            yield from _of_topic(snapshot, resource, name)


def _messages(snapshot: StationSnapshot, section: str) -> list[str]:
    """The types of messages, those of the station first."""
    own = {name for name in map(message_of, snapshot.files) if name is not None}
    kind, known = _MESSAGE_KINDS[section], snapshot.messages
    all_ = (
        ()
        if known is None
        else {"msg": known.type_names, "srv": known.service_names, "action": known.action_names}[kind]()
    )
    return [*sorted(name for name in own if name.split("/")[1] == kind), *(name for name in all_ if name not in own)]


def _of_topic(snapshot: StationSnapshot, resource: ResourceDocument, name: str) -> Iterator[tuple[str, NameKind]]:
    """The fields of a topic's message, and the variables that become of them or of which they are made."""
    topic = next((each for key, each in resource.topics.items() if key == name), None)
    if topic is None:
        return
    section = resource.measured if topic.direction == "in" else resource.output
    yield from ((str(each), NameKind.MEASURED if topic.direction == "in" else NameKind.OUTPUT) for each in section)
    if snapshot.messages is not None:
        try:
            fields = snapshot.messages.fields(str(topic.type))
        except UnknownMessageTypeError:
            return
        yield from ((field, NameKind.VALUE) for field in fields if field not in section)
