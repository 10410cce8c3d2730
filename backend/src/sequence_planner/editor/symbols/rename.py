"""Rename refactoring and usage search: conflict checks and byte-preserving text edits."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from sequence_planner.editor.symbols.definitions import gather
from sequence_planner.editor.symbols.index import (
    ROS_KINDS,
    Declared,
    Gathered,
    ModelPart,
    Occurrence,
    belongs_to,
    following,
    variable_of,
)
from sequence_planner.editor.symbols.pipelines import said, unsaid
from sequence_planner.editor.symbols.texts import ModelContent, file_of
from sequence_planner.language.syntax import Span
from sequence_planner.language.types import Place
from sequence_planner.model.fields import fault_of_name
from sequence_planner.model.paths import EditError
from sequence_planner.model.source import Finding, ModelError, SourceText
from sequence_planner.model.stages.map import ANY
from sequence_planner.model.yaml.content import same
from sequence_planner.model.yaml.editor import scalar
from sequence_planner.model.yaml.reader import EntryPath, read_text
from sequence_planner.process.gc_tuning import collection_put_off
from sequence_planner.ros.names import check_topic
from sequence_planner.ros.types.messages import MessageRegistry

# Where a part is used: each place with what uses it, in words.


@dataclass(frozen=True)
class Usage:
    """A place at which a part is named. `part` is another one for values that are one with that asked for.

    Line and column count from 1; a resource is declared by its file, at a place without length.
    """

    part: ModelPart
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
    """The usages that were found, in the order of the files, and in each from above.

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
def usages(files: Mapping[str, str], part: ModelPart, messages: MessageRegistry | None = None) -> Usages:
    """Every place at which a part is named, its declaration included.

    `messages` are the types of messages that the station knows. Without them nobody can say which variables are fields
    of a message. Values of enumerations that are compared with one another are one, and found together.
    """
    content = ModelContent(files)
    _, gathered = _gathered(content, part, messages)
    together = one_with(part, gathered)
    return _answer(content, gathered, part, (each for each in gathered.occurrences if each.part in together))


@collection_put_off()
def dependants(files: Mapping[str, str], part: ModelPart, messages: MessageRegistry | None = None) -> Usages:
    """Every place outside of a part at which it, or what goes with it, is named: what would be wrong without it."""
    content = ModelContent(files)
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


def one_with(part: ModelPart, gathered: Gathered) -> frozenset[ModelPart]:
    """The part, and those that it is one with: by texts that name both, in a type of resources or as values of two
    enumerations, by the field of a message that a topic of a type has for both, and for a value by comparisons.
    """
    together = {part}
    links = shared(gathered) | (gathered.links if part.kind == "value" else _fed_together(gathered))
    while more := {other for link in links if link & together for other in link} - together:
        together |= more
    return frozenset(together)


def shared(gathered: Gathered) -> set[frozenset[ModelPart]]:
    """Parts that one and the same text names: in a type of resources, or values by an anchor with its aliases."""
    found: dict[tuple[str, int, int, int], set[ModelPart]] = {}
    for each in gathered.occurrences:
        if each.text is not None and (each.part.kind == "value" or each.home is not None):
            place = each.text.place
            found.setdefault((place.file, place.line, place.column, each.span.start), set()).add(each.part)
    return {frozenset(parts) for parts in found.values() if len(parts) > 1}


def _fed_together(gathered: Gathered) -> set[frozenset[ModelPart]]:
    """Variables of several instances that are one field, since their names are that of it, in a topic of their type."""
    found: dict[tuple[str, EntryPath, str], set[ModelPart]] = {}
    for part, bindings in gathered.bindings.items():
        for each in bindings:
            found.setdefault((each.file, each.path, each.field), set()).add(part)
    return {frozenset(parts) for parts in found.values() if len(parts) > 1}


def _gathered(content: ModelContent, part: ModelPart, messages: MessageRegistry | None) -> tuple[object, Gathered]:
    # What a value is one with shows in expressions that do not name it.
    return gather(content, messages, None if part.kind == "value" else part.name)


def _is_within(inner: Occurrence, home: Occurrence) -> bool:
    path = home.where.path
    return inner.where.file == home.where.file and inner.where.path[: len(path)] == path


def _answer(content: ModelContent, gathered: Gathered, part: ModelPart, found: Iterable[Occurrence]) -> Usages:
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
    """Return where entries of files are declared, by file and path."""
    return {(each.where.file, each.where.path): usage_of(each) for each in gathered.occurrences if each.declares}


def usage_of(found: Occurrence) -> Usage:
    """A place as people see it."""
    where, span = found.where, found.span
    if found.text is None:
        return Usage(found.part, found.home_file, (), 1, 1, 0, found.part.name, where.said, found.declares)
    place = found.text.at(span)
    written = found.text[span.start : span.end]
    length = span.end - span.start
    return Usage(
        found.part,
        found.home_file,
        found.home_path,
        place.line,
        place.column,
        length,
        written,
        where.said,
        found.declares,
    )


# Why a part cannot be called so: its new name is none, or taken, or not the model's alone.

# Which have no names in common, of a resource or of the station.
_SHARING = (("variable", "ability", "predicate", "relation", "map"), ("enumeration", "set"), ("operation", "sequence"))


def require_name(part: ModelPart, name: str) -> None:
    """Raises `EditError` for what is no name of such a part."""
    if part.kind == "message":
        raise EditError(f"{part} is known to all nodes by this name, which is a part of what ROS 2 compares: keep it")
    if part.kind in ROS_KINDS:
        try:
            check_topic(name)
        except ValueError as error:
            raise EditError(str(error).replace("'", "`")) from error
        return
    if (fault := fault_of_name(name, part.kind)) is not None:
        raise EditError(fault)
    if scalar(name) != name:
        raise EditError(f"`{name}` is no name that YAML would read as a text: choose another")
    if part.kind == "value" and name == ANY:
        raise EditError(f"`{ANY}` stands for every value in the rows of a table: choose another name")


def require_free(new: ModelPart, declared: Declared, gathered: Gathered, content: ModelContent) -> None:
    """Raises `EditError` if something is called so already, or is meant to be."""
    taken = {*declared.parts, *_undeclared(declared)}
    found = next((each for each in _rivals(new) if each in taken), None)
    if found is not None:
        raise EditError(f"{found} is there already: choose another name")
    if new.kind == "value":
        owners = (name for name, homes in declared.homes.items() if new.owner in homes.values() and new.name in homes)
        if (owner := next(owners, None)) is not None:
            raise EditError(f"{declared.value(owner, new.name)} is one of `{owner}` already: choose another name")
    rivals = set(_rivals(new))
    if (used := next((each for each in gathered.occurrences if each.part in rivals), None)) is not None:
        raise EditError(f"{new} is named already, by {used.where.said}: choose another name")
    if new.kind in ("resource", "type") and (file := file_of_part(new)) in content.texts:
        raise EditError(f"the file {file} is there already: choose another name")


def _rivals(new: ModelPart) -> Iterator[ModelPart]:
    yield new
    for kinds in _SHARING:
        yield from (new._replace(kind=kind) for kind in kinds if new.kind in kinds and kind != new.kind)


def _undeclared(declared: Declared) -> Iterator[ModelPart]:
    for full in declared.variables:
        owner, _, name = full.rpartition(".")
        yield variable_of(owner or None, name)


def require_known(part: ModelPart, declared: Declared, gathered: Gathered) -> None:
    """Raises `EditError` for a part that there is not."""
    if part.kind == "word" and any(each.part == part for each in gathered.occurrences):
        return
    if part not in declared.parts and not (part.kind == "variable" and part.full in declared.variables):
        raise EditError(f"{part} is declared nowhere, so it cannot be given another name")


def require_unbound(parts: Iterable[ModelPart], gathered: Gathered, content: ModelContent) -> None:
    """Raises `EditError` if some place cannot be written otherwise, or may be missed."""
    for part in sorted(parts):
        if (why := gathered.ties.get(part)) is not None:
            raise EditError(f"{part} cannot be given another name in the model alone: {why}")
        word = re.compile(rf"(?<!\w){re.escape(part.name)}(?!\w)")
        for where, text in gathered.unread:
            if word.search(text):
                raise EditError(
                    f"{text.place}: this cannot be read, and may name {part} ({where.said}): put it right first"
                )
        for finding in content.skipped:
            if word.search(content.texts[finding.place.file]):
                raise EditError(f"{finding.place}: this file cannot be read, and may name {part}: put it right first")


def hiding(declared: Declared, gathered: Gathered) -> set[tuple[ModelPart, ModelPart]]:
    """Parts that stand in the way of others: parameters of values and variables, variables of values beside them."""
    found = set(gathered.hidden)
    zones = _zones(gathered)
    for part in declared.parts:
        if part.kind != "parameter" or part.owner is None:
            continue
        found |= {(part, ModelPart("value", each, part.name)) for each in declared.values.get(part.name, ())}
        resource = part.owner.partition(".")[0] if "." in part.owner else None
        for owner in {resource, None, *zones.get(part.owner, ())}:
            variable = variable_of(owner, part.name)
            if variable.full in declared.variables:
                found.add((part, variable))
    return found


def _zones(gathered: Gathered) -> dict[str, set[str]]:
    """The resources in whose names a specification is written, by what its parameters belong to."""
    found: dict[str, set[str]] = {}
    for each in gathered.occurrences:
        if each.part.kind == "resource" and "zone" in each.where.path:
            found.setdefault(each.where.around.holder, set()).add(each.part.name)
    return found


# Names written otherwise in the text of a file, while every other byte of it stays.

# What is written at spans of a text.
_Changes = dict[Span, str]


def rewritten(text: str, content: object, changes: Iterable[tuple[Occurrence, str]]) -> str:
    """`text`, whose content is `content`, with other names at these places. Raises `EditError`."""
    by_place: dict[Place, tuple[SourceText, _Changes]] = {}
    for occurrence, name in changes:
        if occurrence.text is not None:
            by_place.setdefault(occurrence.text.place, (occurrence.text, {}))[1][occurrence.span] = name
    starts = _line_starts(text)
    pieces: list[tuple[int, int, str]] = []
    for place, (written, spans) in by_place.items():
        begin = starts[place.line - 1] + place.column - 1
        if not text.startswith(written.raw, begin):
            raise _cannot(place, "this text cannot be found again in the file")
        for span, name in spans.items():
            start, end = written.written(span)
            pieces.append((begin + start, begin + end, name))
    new = "".join(_joined(text, sorted(pieces)))
    _verify(new, content, {place: _put(written, spans) for place, (written, spans) in by_place.items()})
    return new


def _joined(text: str, pieces: list[tuple[int, int, str]]) -> Iterator[str]:
    at = 0
    for start, end, name in pieces:
        yield text[at:start]
        yield name
        at = end
    yield text[at:]


def _line_starts(text: str) -> list[int]:
    starts = [0]
    while (end := text.find("\n", starts[-1])) >= 0:
        starts.append(end + 1)
    return starts


def _put(text: SourceText, spans: _Changes) -> str:
    return "".join(_joined(str(text), sorted((span.start, span.end, name) for span, name in spans.items())))


def _verify(new: str, content: object, changed: Mapping[Place, str]) -> None:
    """Check whether the new text is read as the old content with these changes and no others."""
    first = min(changed)
    try:
        found = read_text(new, first.file).content
    except ModelError as error:
        raise _cannot(first, f"it could not be read afterwards: {error.findings[0].message}") from error
    if not same(_changed(content, changed), found):
        raise _cannot(first, "something else would change with it")


def _changed(content: object, changed: Mapping[Place, str]) -> object:
    match content:
        case SourceText():
            return changed.get(content.place, str(content))
        case dict():
            return {_changed(key, changed): _changed(value, changed) for key, value in content.items()}
        case list():
            return [_changed(each, changed) for each in content]
    return content


def _cannot(place: Place, why: str) -> EditError:
    return EditError(f"the name at {place} cannot be written otherwise here: {why}; nothing was changed")


def file_of_part(part: ModelPart) -> str:
    """The file whose name is that of a resource or a type."""
    if part.kind == "resource":
        return file_of(part.name)
    return f"types/{part.name}.yaml" if part.owner is None else f"packages/{part.owner}/types/{part.name}.yaml"


def by_file(changes: Iterable[tuple[Occurrence, str]]) -> dict[str, list[tuple[Occurrence, str]]]:
    """Changes by the file in which they are."""
    found: dict[str, list[tuple[Occurrence, str]]] = defaultdict(list)
    for occurrence, name in changes:
        if occurrence.text is not None:
            found[occurrence.home_file].append((occurrence, name))
    return found


# Giving a part of a model another name: all that names it follows, and nothing else means anything else by it.

_Called = Callable[[ModelPart], ModelPart]


@collection_put_off()
def renamed(
    files: Mapping[str, str], part: ModelPart, new_name: str, messages: MessageRegistry | None = None
) -> dict[str, str | None]:
    """The files that change when a part gets another name, with their new texts; None for one that is there no more.

    A value that is one with values of other enumerations, because they are compared, is renamed in all of them.
    A variable that is a field of a message because of its name gets a `rename` stage that says so, and loses one that
    its new name makes needless. Comments, order, quoting and all other bytes stay. The outcome is read again before it
    is returned: every name in it names what it did. Raises `EditError` where that cannot be, and then nothing changes.
    """
    require_name(part, new_name)
    content = ModelContent(files)
    declared, gathered = gather(content, messages)
    require_known(part, declared, gathered)
    if new_name == part.name:
        return {}
    before = dict(files)
    if bindings := gathered.bindings.get(part):
        before |= said(files, bindings)
        content = ModelContent(before)
        declared, gathered = gather(content, messages)
        if part in gathered.bindings:
            raise EditError(f"{gathered.bindings[part][0].why}, and no `rename` stage can say so: change it by hand")
    together = one_with(part, gathered)
    for each in sorted(together):
        require_free(each._replace(name=new_name), declared, gathered, content)
    require_unbound(together, gathered, content)
    new = _written(content, gathered, together, new_name)
    after = {file: text for file, text in {**before, **new}.items() if text is not None}
    result = ModelContent(after)
    _require_same((content, declared, gathered), (result, *gather(result, messages)), part, together, new_name)
    if part.kind == "variable" and part.owner is not None:
        new |= unsaid(after, part._replace(name=new_name), messages)
    return {file: text for file, text in {**before, **new}.items() if text != files.get(file)}


def _written(
    content: ModelContent, gathered: Gathered, parts: frozenset[ModelPart], name: str
) -> dict[str, str | None]:
    new: dict[str, str | None] = {}
    changes = by_file((each, name) for each in gathered.occurrences if each.part in parts)
    for file, found in changes.items():
        new[file] = rewritten(content.texts[file], content[file], found)
    for part in parts:
        if part.kind in ("resource", "type"):
            old, file = file_of_part(part), file_of_part(part._replace(name=name))
            new[file] = new.get(old) or content.texts[old]
            new[old] = None
    return new


class _Meaning(NamedTuple):
    """The things that a model names, in the order of its files."""

    names: Mapping[str, list[tuple[ModelPart, bool]]]
    parts: Counter[ModelPart]
    links: frozenset[frozenset[ModelPart]]
    bound: frozenset[ModelPart]
    unread: int


def _require_same(
    before: tuple[ModelContent, Declared, Gathered],
    after: tuple[ModelContent, Declared, Gathered],
    part: ModelPart,
    together: frozenset[ModelPart],
    name: str,
) -> None:
    """Raises `EditError` unless everything names after the change what it did before, by its new name."""

    def called(each: ModelPart) -> ModelPart:
        for old in together:
            each = following(each, old, old._replace(name=name))
        return each

    hidden = {(called(one), called(other)) for one, other in hiding(before[1], before[2])}
    for one, other in sorted(hiding(after[1], after[2]) - hidden):
        raise EditError(f"{part} cannot be called `{name}`: {one} would hide {other}")
    old, new = _meaning(*before, called), _meaning(*after, lambda each: each)
    for bound in sorted(new.bound - old.bound, key=lambda each: (each.kind == "value", each)):
        why = after[2].ties.get(bound) or after[2].bindings[bound][0].why
        raise EditError(f"{part} cannot be called `{name}`: {why}")
    for values in sorted(map(sorted, new.links - old.links)):
        both = " and ".join(map(str, values))
        raise EditError(f"{part} cannot be called `{name}`: {both} are compared, and would become one")
    for file, names in old.names.items():
        for (was, _), (is_, _) in zip(names, new.names.get(file, []), strict=False):
            if was != is_:
                raise EditError(f"{part} cannot be called `{name}`: in {file}, `{was.name}` would name {is_}")
    if old != new:
        raise EditError(f"{part} cannot be called `{name}`: something in the model would mean something else")


def _meaning(content: ModelContent, declared: Declared, gathered: Gathered, called: _Called) -> _Meaning:
    found: dict[str, dict[tuple[int, int, int, ModelPart], bool]] = {}
    for each in gathered.occurrences:
        if each.text is not None:
            part = _by_number(called(each.part))
            file = each.home_file
            place = each.text.place
            found.setdefault(file, {}).setdefault((place.line, place.column, each.span.start, part), each.declares)
    movable = [each for each in declared.parts if each.kind in ("resource", "type")]
    moved = {file_of_part(each): file_of_part(called(each)) for each in movable}
    return _Meaning(
        {moved.get(file, file): _in_order(places) for file, places in found.items()},
        Counter(map(called, declared.parts)),
        frozenset(frozenset(map(called, link)) for link in gathered.links | shared(gathered)),
        frozenset(map(called, (*gathered.ties, *gathered.bindings))),
        len(gathered.unread),
    )


def _by_number(part: ModelPart) -> ModelPart:
    """The word of a quantifier by the number of that within its text: what is around the text may be renamed."""
    return part._replace(owner=(part.owner or "").rpartition("#")[2]) if part.kind == "word" else part


def _in_order(places: Mapping[tuple[int, int, int, ModelPart], bool]) -> list[tuple[ModelPart, bool]]:
    return [(part, declares) for (_, _, _, part), declares in sorted(places.items(), key=lambda each: _key(each[0]))]


def _key(place: tuple[int, int, int, ModelPart]) -> tuple[int, int, int, str]:
    return (*place[:3], place[3].id)
