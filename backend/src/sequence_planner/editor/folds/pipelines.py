"""Folds in pipelines: lists of names that are the same on both sides, and rows of a table that differ in one value."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from math import prod

from sequence_planner.editor.draft import Edit, RemoveEntry, SetEntry
from sequence_planner.editor.folds.proposal import FoldProposal, WrittenPlace, place_between
from sequence_planner.editor.folds.sameness import MOST_STATES
from sequence_planner.editor.folds.texts import FoldableStation
from sequence_planner.editor.schemas.draft import FoldKind
from sequence_planner.language.records.field_paths import domain
from sequence_planner.model.source import SourceText
from sequence_planner.model.stages.base import Stage
from sequence_planner.model.stages.map import MapStage, TableStage
from sequence_planner.model.yaml.content import plain
from sequence_planner.model.yaml.reader import EntryPath
from sequence_planner.pipelines.builder import build_what_is_sound
from sequence_planner.station import MeantStation

_FEWEST_ROWS = 2


def list_proposals(station: FoldableStation) -> Iterator[FoldProposal]:
    """A proposal for each list of a `map` that says nothing, and for rows of a `table` that are one for a set."""
    for file in station.content:
        for path, kind, content in _stages(station.content[file], ()):
            if kind == "map":
                yield from _without_list(file, path, content)
            elif kind == "table":
                yield from _with_sets(station, file, path, content)


def _stages(content: object, path: EntryPath) -> Iterator[tuple[EntryPath, str, dict[object, object]]]:
    """The stages `map` and `table` anywhere in a document."""
    if isinstance(content, list):
        for index, each in enumerate(content):
            yield from _stages(each, (*path, index))
    elif isinstance(content, dict):
        for key, each in content.items():
            if key in ("map", "table") and isinstance(each, dict) and path and isinstance(path[-1], int):
                yield (*path, str(key)), str(key), each
            else:
                yield from _stages(each, (*path, str(key)))


def _without_list(file: str, path: EntryPath, content: dict[object, object]) -> Iterator[FoldProposal]:
    values = content.get("values")
    if not isinstance(values, dict) or any(str(key) != str(value) for key, value in values.items()):
        return
    first, last = next(iter(values), None), next(reversed(values), None)
    if isinstance(first, SourceText) and isinstance(last, SourceText):
        edit = RemoveEntry(file=file, path=[*path, "values"], was=plain(values))
        place = place_between(file, first, last, f"{len(values)} names", "")
        title = f"Leave out the list of `{content.get('variable')}`: its names are the same on both sides"
        yield FoldProposal(FoldKind.MAP, title, entries=((edit, place),))


def _with_sets(
    station: FoldableStation, file: str, path: EntryPath, content: dict[object, object]
) -> Iterator[FoldProposal]:
    """All rows that can be one, in one proposal for the table."""
    rows = content.get("rows")
    if not isinstance(rows, list):
        return
    edits: list[tuple[Edit, WrittenPlace]] = []
    removals: list[tuple[Edit, WrittenPlace]] = []
    first = 0
    while first < len(rows):
        last, column, name = _folded(station, rows, first)
        for index in range(first, last + 1 if name is not None else first):
            cell = _when(rows[index])[column]
            assert isinstance(cell, SourceText), "it is a value of an enumeration"
            if index == first:
                edit = SetEntry(file=file, path=[*path, "rows", first, "when", column], was=str(cell), value=name)
                edits.append((edit, place_between(file, cell, cell, f"{last - first + 1} rows", str(name))))
            else:
                removal = RemoveEntry(file=file, path=[*path, "rows", index], was=plain(rows[index]))
                removals.insert(0, (removal, place_between(file, cell, cell, "a row", "")))
        first = last + 1
    if edits:
        title = f"Write one row of the table for each set, in place of {len(edits) + len(removals)}"
        yield FoldProposal(FoldKind.ROWS, title, entries=(*edits, *removals))


def _when(row: object) -> list[object]:
    found = row.get("when") if isinstance(row, dict) else None
    return found if isinstance(found, list) else []


def _folded(station: FoldableStation, rows: list[object], first: int) -> tuple[int, int, str | None]:
    """The last row that can be one with the row `first`, in which column they differ, and the set of these values."""
    for column, cell in enumerate(_when(rows[first])):
        values, last = [str(cell)], first
        rest = _without(rows[first], column)[1]
        for row in rows[first + 1 :] if isinstance(cell, SourceText) else ():
            value, others = _without(row, column)
            if not isinstance(value, SourceText) or value in values or others != rest:
                break
            values.append(str(value))
            last += 1
        for length in range(len(values), _FEWEST_ROWS - 1, -1):
            for name in station.with_values(values[:length]):
                return first + length - 1, column, name
    return first, 0, None


def _without(row: object, column: int) -> tuple[object, object]:
    """The value of a column of a row, and all else."""
    when = _when(row)
    if column >= len(when) or not isinstance(row, dict):
        return None, None
    return when[column], (when[:column], when[column + 1 :], row.get("gives"))


# Comparison


def pipeline_difference(one: MeantStation, other: MeantStation) -> str | None:
    """Where the pipelines of two stations differ, or may do; None where each stage does the same."""
    if _written_stages(one) == _written_stages(other):
        return None
    before, now = (build_what_is_sound(each.station, each.automaton, each.registry) for each in (one, other))
    if before.chains.keys() != now.chains.keys() or len(before.findings) != len(now.findings):
        return "pipelines"
    for name, chain in before.chains.items():
        stages = now.chains[name].stages
        if len(chain.stages) != len(stages) or not all(map(_does_the_same, chain.stages, stages)):
            return str(name)
    return None


def _written_stages(meant: MeantStation) -> Mapping[str, object]:
    """What is written of pipelines, by resource."""
    return {
        name: (each.topics, each.flows, each.services, each.actions) for name, each in meant.station.resources.items()
    }


def _does_the_same(one: Stage, other: Stage) -> bool:
    if type(one) is not type(other) or one.reads != other.reads or one.gives.keys() != other.gives.keys():
        return False
    if isinstance(one, MapStage) and isinstance(other, MapStage):
        same = (one.source, one.source_type, one.target, one.target_type, one.otherwise)
        return dict(one.pairs) == dict(other.pairs) and same == (
            other.source,
            other.source_type,
            other.target,
            other.target_type,
            other.otherwise,
        )
    if isinstance(one, TableStage) and isinstance(other, TableStage):
        same_types = (one.sources, one.source_types, dict(one.gives)) == (
            other.sources,
            other.source_types,
            dict(other.gives),
        )
        return same_types and (
            (one.rows, one.otherwise) == (other.rows, other.otherwise) or _gives_the_same(one, other)
        )
    return True


def _gives_the_same(one: TableStage, other: TableStage) -> bool:
    domains: list[Sequence[object]] = [(*(domain(type_) or ()), None) for type_ in one.source_types]
    if prod(map(len, domains)) > MOST_STATES or any(len(each) == 1 for each in domains):
        return False
    return all(one.meaning(given) == other.meaning(given) for given in product(*domains))
