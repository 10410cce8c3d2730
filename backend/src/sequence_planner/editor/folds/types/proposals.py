"""Folds of resource files that differ in a few words: a type with what they have in common, and an instance of each."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import partial
from itertools import combinations, pairwise
from typing import NamedTuple

from pydantic import JsonValue

from sequence_planner.editor.draft import Edit, WriteText
from sequence_planner.editor.folds.proposal import NAME, FoldProposal, WrittenPlace
from sequence_planner.editor.folds.texts import FoldableStation
from sequence_planner.editor.folds.types.likeness import DocumentComparison, Gap, Likeness
from sequence_planner.editor.folds.types.parameters import GapKinds, Parameters, arguments_of, common_name
from sequence_planner.editor.schemas.draft import FoldKind
from sequence_planner.model.paths import EditError
from sequence_planner.model.types.expansion import DocumentShape, resource_shape
from sequence_planner.model.types.layers import OF_INSTANCES, merged_order
from sequence_planner.model.yaml.content import plain
from sequence_planner.model.yaml.editor import WIDTH, in_brackets, lines, removed, renamed, replaced
from sequence_planner.model.yaml.reader import EntryPath

_MOST_ROUNDS = 20  # in which gaps are given up
_ENOUGH_ALIKE = 0.3  # of the names of entries
_SCHEMA = "resource.schema.json"
_HEADER = re.compile(r"(?:#[^\n]*\n|[ \t]*\n)*")


class _WrittenResource(NamedTuple):
    name: str
    file: str
    text: str
    content: dict[str, object]


def type_proposals(station: FoldableStation) -> Iterator[FoldProposal]:
    """A proposal for each group of resources that have much in common."""
    written = [
        _WrittenResource(name, file, station.content.texts[file], dict(content))
        for name, file, _ in station.content.resources()
        if isinstance(content := plain(station.content[file]), dict) and OF_INSTANCES.isdisjoint(content)
    ]
    names = [name for name, _, _ in station.content.resources()]
    kinds = GapKinds(station, names)
    for group in _groups(written):
        if (found := _proposal(station, kinds, group)) is not None:
            yield found


def _groups(written: Sequence[_WrittenResource]) -> Iterator[list[_WrittenResource]]:
    """Resources of which each has names in common with another one of the group."""
    group = {each.name: [each] for each in written}
    entries = {each.name: frozenset(_entries(each.content)) for each in written}
    for one, other in combinations(written, 2):
        a, b = entries[one.name], entries[other.name]
        if len(a & b) >= _ENOUGH_ALIKE * len(a | b) > 0 and group[one.name] is not group[other.name]:
            joined = [*group[one.name], *group[other.name]]
            for each in joined:
                group[each.name] = joined
    found = {id(each): each for each in group.values() if len(each) > 1}
    yield from found.values()


def _entries(content: Mapping[str, object], path: EntryPath = ()) -> Iterator[EntryPath]:
    """The names in a document, but for those of topics."""
    for key, value in content.items():
        here = (*path, key)
        if path != ("topics",):
            yield here
        if isinstance(value, dict):
            yield from _entries(value, here)


def _proposal(station: FoldableStation, kinds: GapKinds, group: list[_WrittenResource]) -> FoldProposal | None:
    names = [each.name for each in group]
    found = _common(station, kinds, group)
    if found is None:
        return None
    likeness, parameters = found
    try:
        instances = [_instance(each, index, likeness, parameters) for index, each in enumerate(group)]
        type_ = _type(group[0], instances[0], likeness, parameters)
    except EditError:  # what an anchor shares, say
        return None
    name = common_name(names) or f"{names[0]}_like"
    while f"types/{name}.yaml" in station.content.texts:
        name += "_2"
    entries: list[tuple[Edit, WrittenPlace]] = []
    for resource, text in zip(group, instances, strict=True):
        count = resource.text.count("\n")
        place = WrittenPlace(resource.file, 1, 1, count, f"{count} lines", f"{text.count(chr(10))} lines")
        entries.append((WriteText(file=resource.file, was=resource.text, text=text), place))
    listed = f"{', '.join(f'`{each}`' for each in names[:-1])} and `{names[-1]}`"
    return FoldProposal(
        FoldKind.TYPE,
        f"Make {listed} instances of a type `{NAME}`",
        entries=tuple(entries),
        added=WriteText(file=f"types/{NAME}.yaml", was=None, text=type_),
        name=name,
    )


def _common(
    station: FoldableStation, kinds: GapKinds, group: Sequence[_WrittenResource]
) -> tuple[Likeness, Parameters] | None:
    """What a group has in common, with parameters for what differs and is worth one."""
    refused: set[Gap] = set()
    for _ in range(_MOST_ROUNDS):
        comparison = DocumentComparison(
            partial(_may_be, kinds, frozenset(refused)), frozenset(f"/{each.name}" for each in group)
        )
        likeness = comparison.of_documents([each.content for each in group], resource_shape())
        if likeness is None:
            return None
        parameters = Parameters(likeness, kinds, station.taken)
        needless = set(parameters.needless())
        if not needless:
            return likeness, parameters
        refused |= needless
    return None


def _may_be(kinds: GapKinds, refused: frozenset[Gap], gap: Gap) -> bool:
    return gap not in refused and kinds.of_gap(gap) is not None


def _type(resource: _WrittenResource, instance: str, likeness: Likeness, parameters: Parameters) -> str:
    """The text of the type, made of that of the first resource, whose `instance` says the rest."""
    header, text = _split(resource.text)
    common = dict(likeness.all_within())
    for path, each in common.items():
        if each.written:
            text = replaced(text, path, parameters.written(each.written))
    for path in _own(resource.content, common):
        text = removed(text, path)
    for path, each in sorted(common.items(), key=lambda found: -len(found[0])):
        if each.name:
            text = renamed(text, path, parameters.written(each.name))
    kept = {line.strip() for line in instance.splitlines()}
    told_there = (line.lstrip().startswith("#") and line.strip() in kept for line in text.splitlines())
    rest = (line for line, is_there in zip(text.splitlines(keepends=True), told_there, strict=True) if not is_there)
    declared = "".join(f"  {each.name}: {in_brackets(each.declared_as)}\n" for each in parameters.all)
    head = f"parameters:\n{declared}\n" if declared else ""
    return f"{header.replace(_SCHEMA, 'type.schema.json')}{head}{''.join(rest)}"


def _own(
    content: Mapping[str, object], common: Mapping[EntryPath, Likeness], path: EntryPath = ()
) -> Iterator[EntryPath]:
    """The entries of the first resource that are not common, those that hold nothing else as a whole."""
    for key, value in content.items():
        here = (*path, key)
        if here not in common:
            yield here
        elif isinstance(value, dict):
            yield from _own(value, common, here)


def _instance(resource: _WrittenResource, index: int, likeness: Likeness, parameters: Parameters) -> str:
    """The text of an instance: its own without what all have."""
    header, text = _split(resource.text)
    for path, is_named in _whole(resource.content, likeness, index, resource_shape()):
        text = replaced(text, path, {}) if is_named else removed(text, path)
    arguments: dict[str, JsonValue] = {**arguments_of(parameters.all, index)}
    head = f"type: {NAME}\n"
    if arguments:
        line = f"arguments: {in_brackets(arguments)}"
        head += "\n".join([line] if len(line) <= WIDTH else lines(arguments, "arguments:", 0)) + "\n"
    text = text.strip("\n")
    apart = "" if not text or text.startswith("title:") else "\n"
    return f"{header.replace(_SCHEMA, 'instance.schema.json')}{head}{apart}{text}".rstrip("\n") + "\n"


def _whole(
    content: Mapping[str, object], likeness: Likeness, index: int, shape: DocumentShape, path: EntryPath = ()
) -> Iterator[tuple[EntryPath, bool]]:
    """The entries in which a resource has nothing of its own, and whether they are named all the same: something of
    its own stands behind or before them.
    """
    shared = {str(each.names[index]): each for each in likeness.entries}
    partial = {key for key, each in shared.items() if index in each.partial_in}
    has_order = shape.entries is not None  # of names that are free
    named = _named_for_order(list(content), list(shared), partial) if has_order else ()
    for key, each in shared.items():
        here, within = (*path, key), content[key]
        if index not in each.partial_in:
            yield here, key in named
        elif isinstance(within, dict):
            yield from _whole(within, each, index, shape.step_into(key), here)


def _named_for_order(order: Sequence[str], shared: Sequence[str], kept: Collection[str]) -> frozenset[str]:
    """The shared entries that an instance has to name, so that what it adds stands where it stood."""
    own = [key for key in order if key in kept or key not in shared]
    if merged_order(shared, own) == order:
        return frozenset()
    neighbours = {
        one if other not in shared else other for one, other in pairwise(order) if (one in shared) != (other in shared)
    }
    return frozenset(neighbours - set(kept))


def _split(text: str) -> tuple[str, str]:
    found = _HEADER.match(text)
    end = 0 if found is None else found.end()
    return text[:end], text[end:]
