"""Where a part is used: each place with what uses it, in words."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from sequence_planner.collection import collection_put_off
from sequence_planner.expressions.syntax import Span
from sequence_planner.model.reading import EntryPath
from sequence_planner.model.source import Finding
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.workshop.references.occurrences import Gathered, Occurrence
from sequence_planner.workshop.references.parts import Part, belongs_to
from sequence_planner.workshop.references.texts import Content
from sequence_planner.workshop.references.walking import gather


@dataclass(frozen=True)
class Usage:
    """A place at which a part is named. `part` is another one for values that are one with that asked for.

    Line and column count from 1; a resource is declared by its file, at a place without length.
    """

    part: Part
    file: str
    path: EntryPath
    line: int
    column: int
    length: int
    written: str
    used_by: str
    declares: bool


@dataclass(frozen=True)
class Usages:
    """What was found, in the order of the files, and in each from above.

    `unwritten` are entries that use it though no text in them names it, such as a topic whose message has a field of
    that name: each at the place of its own name. `skipped` are files that cannot be read as YAML, `unread` texts that
    make no sense and hold the name, and `bound` says why the name is not the model's alone.
    """

    found: tuple[Usage, ...]
    unwritten: tuple[Usage, ...] = ()
    skipped: tuple[Finding, ...] = ()
    unread: tuple[Finding, ...] = ()
    bound: str | None = None


@collection_put_off()
def usages(files: Mapping[str, str], part: Part, messages: MessageRegistry | None = None) -> Usages:
    """Every place at which a part is named, its declaration included.

    `messages` are the types of messages that the station knows. Without them nobody can say which variables are fields
    of a message. Values of enumerations that are compared with one another are one, and found together.
    """
    content = Content(files)
    _, gathered = _gathered(content, part, messages)
    together = one_with(part, gathered)
    return _answer(content, gathered, part, (each for each in gathered.occurrences if each.part in together))


@collection_put_off()
def dependants(files: Mapping[str, str], part: Part, messages: MessageRegistry | None = None) -> Usages:
    """Every place outside of a part at which it, or what goes with it, is named: what would be wrong without it."""
    content = Content(files)
    _, gathered = gather(content, messages)
    homes = [each for each in gathered.occurrences if each.declares and each.part == part]
    outside = [
        each
        for each in gathered.occurrences
        if not each.declares and belongs_to(each.part, part) and not any(_is_within(each, home) for home in homes)
    ]
    first: dict[tuple[str, EntryPath, Span, str | None], Occurrence] = {}
    for each in outside:
        first.setdefault((each.where.file, each.where.path, each.whole, each.text), each)
    return _answer(content, gathered, part, first.values())


def one_with(part: Part, gathered: Gathered) -> frozenset[Part]:
    """The part, and for a value those that it is one with: by comparisons, and by texts that are values of both."""
    together = {part}
    links = gathered.links | shared(gathered) if part.kind == "value" else set()
    while more := {other for link in links if link & together for other in link} - together:
        together |= more
    return frozenset(together)


def shared(gathered: Gathered) -> set[frozenset[Part]]:
    """Values that one and the same text names, such as that of an anchor with its aliases."""
    found: dict[tuple[str, int, int, int], set[Part]] = {}
    for each in gathered.occurrences:
        if each.part.kind == "value" and each.text is not None:
            place = each.text.place
            found.setdefault((place.file, place.line, place.column, each.span.start), set()).add(each.part)
    return {frozenset(parts) for parts in found.values() if len(parts) > 1}


def _gathered(content: Content, part: Part, messages: MessageRegistry | None) -> tuple[object, Gathered]:
    # What a value is one with shows in expressions that do not name it.
    return gather(content, messages, None if part.kind == "value" else part.name)


def _is_within(inner: Occurrence, home: Occurrence) -> bool:
    path = home.where.path
    return inner.where.file == home.where.file and inner.where.path[: len(path)] == path


def _answer(content: Content, gathered: Gathered, part: Part, found: Iterable[Occurrence]) -> Usages:
    unread = [
        Finding(text.place, f"{where.said}: this cannot be read, and may name `{part.name}`")
        for where, text in gathered.unread
        if part.name in text
    ]
    homes = homes_of(gathered)
    unwritten = {
        Usage(part, home.file, home.path, home.line, home.column, 0, "", each.where.said, False)
        for each in gathered.unwritten
        if each.part == part and (home := homes.get((each.where.file, each.where.path[: each.where.depth])))
    }
    unique = {(each.file, each.line, each.column, each.part): each for each in reversed(list(map(usage_of, found)))}
    ordered = sorted(unique.values(), key=lambda each: (each.file, each.line, each.column, each.part.id))
    beside = tuple(sorted(unwritten, key=lambda each: (each.file, each.line, each.column, each.used_by)))
    return Usages(tuple(ordered), beside, tuple(content.skipped), tuple(unread), gathered.ties.get(part))


def homes_of(gathered: Gathered) -> dict[tuple[str, EntryPath], Usage]:
    """Where entries of files are declared, by file and path."""
    return {(each.where.file, each.where.path): usage_of(each) for each in gathered.occurrences if each.declares}


def usage_of(found: Occurrence) -> Usage:
    """A place as people see it."""
    where, span = found.where, found.span
    if found.text is None:
        return Usage(found.part, where.file, (), 1, 1, 0, found.part.name, where.said, found.declares)
    place = found.text.at(span)
    written = found.text[span.start : span.end]
    length = span.end - span.start
    return Usage(
        found.part, where.file, where.path, place.line, place.column, length, written, where.said, found.declares
    )
