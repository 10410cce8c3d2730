"""What is named where in a station: definitions, references, other names for parts, and what documents declare."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from sequence_planner.editor.symbols.definitions import gather
from sequence_planner.editor.symbols.index import ModelPart, Occurrence
from sequence_planner.editor.symbols.rename import Usage, file_of_part, usage_of, usages
from sequence_planner.editor.symbols.texts import (
    OPERATIONS,
    SPECIFICATIONS,
    STATION,
    WORK_MASTERS,
    file_of,
    message_of,
)
from sequence_planner.editor.symbols.types import type_part
from sequence_planner.language_server.snapshot import StationSnapshot
from sequence_planner.model.yaml.reader import EntryPath

_HOMES = {
    "enumeration": STATION,
    "value": STATION,
    "set": STATION,
    "relation": STATION,
    "map": STATION,
    "operation": OPERATIONS,
    "sequence": OPERATIONS,
    "specification": SPECIFICATIONS,
    "work_master": WORK_MASTERS,
}
_NO_EXPRESSION = "\n"  # is in no expression: they are not looked at


@dataclass(frozen=True)
class Declaration:
    """A part where it is declared, with the entry that it is."""

    usage: Usage
    path: EntryPath


def named_in(snapshot: StationSnapshot, file: str) -> list[Usage]:
    """Every place of a file at which a part is named."""
    _, gathered = gather(snapshot.content, snapshot.messages, file=file)
    unique: dict[tuple[int, int, int], Occurrence] = {}
    for each in gathered.occurrences:
        if each.home_file == file and each.text is not None:
            found = usage_of(each)
            unique.setdefault((found.line, found.column, found.length), each)
    return [usage_of(each) for each in unique.values()]


def part_at(named: Iterable[Usage], line: int, column: int) -> Usage | None:
    """Which of the places holds a line and column, the innermost where names stand within names."""
    found = [each for each in named if each.line == line and each.column <= column <= each.column + each.length]
    return min(found, key=lambda each: each.length, default=None)


def declared_in(snapshot: StationSnapshot, file: str | None = None) -> list[Declaration]:
    """What a file declares, or what all do, in its order."""
    _, gathered = gather(snapshot.content, snapshot.messages, _NO_EXPRESSION, file)
    found = {
        (usage.file, usage.line, usage.column, usage.part): Declaration(usage, each.where.path)
        for each in gathered.occurrences
        if each.declares and file in (None, each.where.file)
        for usage in (usage_of(each),)
    }
    return [found[key] for key in sorted(found, key=lambda key: key[:3])]


def declarations_of(snapshot: StationSnapshot, part: ModelPart) -> Iterator[Usage]:
    """Where a part is declared."""
    for file in _homes(snapshot, part):
        for each in declared_in(snapshot, file):
            if each.usage.part == part:
                yield each.usage


def _homes(snapshot: StationSnapshot, part: ModelPart) -> list[str]:
    """The files that may declare it."""
    if part.kind == "message":
        return [file for file in snapshot.content.definitions if message_of(file) == part.name]
    if part.kind == "resource":
        return [file_of(part.name)]
    if part.kind == "type":
        return [file_of_part(part)]
    owner, _, name = (part.owner or "").partition(":")
    if owner == "type" and name:
        return [file_of_part(type_part(name))]
    if name:  # the parameter of an operation, say
        return [_HOMES[owner]]
    if part.kind in _HOMES:
        return [_HOMES[part.kind]]
    if part.owner is not None:
        return [file_of(part.owner.partition(".")[0])]
    return (
        [STATION]
        if part.kind in ("variable", "alarm", "predicate")
        else [file for _, file, _ in snapshot.content.resources()]
    )


def used_places(snapshot: StationSnapshot, files: Mapping[str, str], part: ModelPart) -> list[Usage]:
    """Every place at which a part is named, its declaration included."""
    return list(usages(files, part, snapshot.messages).found)
