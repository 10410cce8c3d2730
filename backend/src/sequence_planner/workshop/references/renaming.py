"""Giving a part of a model another name: all that names it follows, and nothing else means anything else by it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from typing import NamedTuple

from sequence_planner.collection import collection_put_off
from sequence_planner.model.paths import EditError
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.workshop.references.declared import Declared
from sequence_planner.workshop.references.explicit import said, unsaid
from sequence_planner.workshop.references.finding import one_with, shared
from sequence_planner.workshop.references.occurrences import Gathered
from sequence_planner.workshop.references.parts import Part, following
from sequence_planner.workshop.references.refusing import (
    hiding,
    require_free,
    require_known,
    require_name,
    require_unbound,
)
from sequence_planner.workshop.references.rewriting import by_file, rewritten
from sequence_planner.workshop.references.texts import Content, file_of
from sequence_planner.workshop.references.walking import gather

_Called = Callable[[Part], Part]


@collection_put_off()
def renamed(
    files: Mapping[str, str], part: Part, new_name: str, messages: MessageRegistry | None = None
) -> dict[str, str | None]:
    """The files that change when a part gets another name, with their new texts; None for one that is there no more.

    A value that is one with values of other enumerations, because they are compared, is renamed in all of them.
    A variable that is a field of a message because of its name gets a `rename` stage that says so, and loses one that
    its new name makes needless. Comments, order, quoting and all other bytes stay. The outcome is read again before it
    is returned: every name in it names what it did. Raises `EditError` where that cannot be, and then nothing changes.
    """
    require_name(part, new_name)
    content = Content(files)
    declared, gathered = gather(content, messages)
    require_known(part, declared)
    if new_name == part.name:
        return {}
    before = dict(files)
    if bindings := gathered.bindings.get(part):
        before |= said(files, bindings)
        content = Content(before)
        declared, gathered = gather(content, messages)
        if part in gathered.bindings:
            raise EditError(f"{gathered.bindings[part][0].why}, and no `rename` stage can say so: change it by hand")
    together = one_with(part, gathered)
    for each in sorted(together):
        require_free(each._replace(name=new_name), declared, gathered, content)
    require_unbound(together, gathered, content)
    new = _written(content, gathered, together, new_name)
    after = {file: text for file, text in {**before, **new}.items() if text is not None}
    result = Content(after)
    _require_same((content, declared, gathered), (result, *gather(result, messages)), part, together, new_name)
    if part.kind == "variable" and part.owner is not None:
        new |= unsaid(after, part._replace(name=new_name), messages)
    return {file: text for file, text in {**before, **new}.items() if text != files.get(file)}


def _written(content: Content, gathered: Gathered, parts: frozenset[Part], name: str) -> dict[str, str | None]:
    new: dict[str, str | None] = {}
    changes = by_file((each, name) for each in gathered.occurrences if each.part in parts)
    for file, found in changes.items():
        new[file] = rewritten(content.texts[file], content[file], found)
    for part in parts:
        if part.kind == "resource":
            old, file = file_of(part.name), file_of(name)
            new[file] = new.get(old) or content.texts[old]
            new[old] = None
    return new


class _Meaning(NamedTuple):
    """What a model names, in the order of its files."""

    names: Mapping[str, list[tuple[Part, bool]]]
    parts: Counter[Part]
    links: frozenset[frozenset[Part]]
    bound: frozenset[Part]
    unread: int


def _require_same(
    before: tuple[Content, Declared, Gathered],
    after: tuple[Content, Declared, Gathered],
    part: Part,
    together: frozenset[Part],
    name: str,
) -> None:
    """Raises `EditError` unless everything names after the change what it did before, by its new name."""

    def called(each: Part) -> Part:
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


def _meaning(content: Content, declared: Declared, gathered: Gathered, called: _Called) -> _Meaning:
    found: dict[str, dict[tuple[int, int, int, Part], bool]] = {}
    for each in gathered.occurrences:
        if each.text is not None:
            part = called(each.part)
            file = each.where.file
            place = each.text.place
            found.setdefault(file, {}).setdefault((place.line, place.column, each.span.start, part), each.declares)
    moved = {file_of(name): file_of(called(Part("resource", None, name)).name) for name in declared.resources}
    return _Meaning(
        {moved.get(file, file): _in_order(places) for file, places in found.items()},
        Counter(map(called, declared.parts)),
        frozenset(frozenset(map(called, link)) for link in gathered.links | shared(gathered)),
        frozenset(map(called, (*gathered.ties, *gathered.bindings))),
        len(gathered.unread),
    )


def _in_order(places: Mapping[tuple[int, int, int, Part], bool]) -> list[tuple[Part, bool]]:
    return [(part, declares) for (_, _, _, part), declares in sorted(places.items(), key=lambda each: _key(each[0]))]


def _key(place: tuple[int, int, int, Part]) -> tuple[int, int, int, str]:
    return (*place[:3], place[3].id)
