"""`map` and `table` from documents."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from sequence_planner.model.source import SourceText
from sequence_planner.model.stage_documents import MapDocument, TableDocument, TableRowDocument
from sequence_planner.pipelines.context import Context
from sequence_planner.pipelines.record import FieldType
from sequence_planner.pipelines.stages.builders.common import (
    passing,
    place_of,
    type_for,
    value_of,
    values_of,
)
from sequence_planner.pipelines.stages.mapping import MapStage, Row, TableStage
from sequence_planner.pipelines.stages.transparent import Passing
from sequence_planner.pipelines.stages.values import as_written, domain

ANY = "any"


def build_map(document: MapDocument, context: Context) -> MapStage | None:
    """From field to variable for incoming topics, from variable to field for outgoing ones."""
    names = (document.field, document.variable)
    source, target = names if context.is_incoming else reversed(names)
    found = context.field(source)
    meanings = [*document.values.values(), *([] if document.otherwise is None else [document.otherwise])]
    target_type = type_for(context, target, meanings)
    if found is None or target_type is None:
        return None
    path, source_type = found
    given = values_of(context, source_type, list(document.values), source.place)
    meant = values_of(context, target_type, meanings, target.place)
    if given is None or meant is None or _are_twice(list(document.values), given, context):
        return None
    missing = [value for value in domain(source_type) or () if value not in given]
    if missing and document.otherwise is None and not context.is_incoming:
        context.found(source.place, f"nothing is given for {', '.join(map(as_written, missing))}")
        return None
    otherwise = None if document.otherwise is None else meant[-1]
    pairs = tuple(zip(given, meant, strict=False))
    return MapStage(context.place, path, source_type, str(target), target_type, pairs, otherwise)


def _are_twice(written: Sequence[SourceText], values: Sequence[object], context: Context) -> bool:
    """Whether two of the keys are the same value, such as `1` and `1.0`; a finding for each."""
    first: dict[object, SourceText] = {}
    twins = [
        (text, other)
        for text, value in zip(written, values, strict=True)
        if (other := first.setdefault(value, text)) is not text
    ]
    for text, other in twins:
        context.found(text.place, f"`{text}` is the same as `{other}`, for which there is a value already")
    return bool(twins)


def build_table(document: TableDocument, context: Context) -> TableStage | None:
    """From several fields to several variables, whichever way the topic goes."""
    sources = passing(context, document.fields)
    right = [_has_cells(row, document, context) for row in document.rows]
    if document.otherwise is not None and len(document.otherwise) != len(document.variables):
        place = place_of(document.otherwise, document.variables[0].place)
        context.found(place, f"`otherwise` needs {_cells(document.variables)}")
        right.append(False)
    twice = [name for index, name in enumerate(document.variables) if name in document.variables[:index]]
    for name in twice:
        context.found(name.place, f"`{name}` is given twice here")
    if sources is None or not all(right) or twice:
        return None
    given = [row.gives for row in document.rows] + ([] if document.otherwise is None else [document.otherwise])
    types = [
        type_for(context, name, column)
        for name, column in zip(document.variables, zip(*given, strict=True), strict=True)
    ]
    gives = {str(name): type_ for name, type_ in zip(document.variables, types, strict=True) if type_ is not None}
    if len(gives) != len(types):
        return None
    rows = [_row(row, sources, gives, context) for row in document.rows]
    otherwise = None if document.otherwise is None else _values(document.otherwise, list(gives.values()), context)
    known = tuple(row for row in rows if row is not None)
    if len(known) != len(rows) or (document.otherwise is not None and otherwise is None):
        return None
    paths = tuple(source.path for source in sources)
    kinds = tuple(source.type for source in sources)
    return TableStage(context.place, paths, kinds, gives, known, otherwise)


def _cells(names: Sequence[SourceText]) -> str:
    return f"{len(names)} value{'s' if len(names) > 1 else ''}: for {', '.join(names)}"


def _has_cells(row: TableRowDocument, document: TableDocument, context: Context) -> bool:
    place = place_of([*row.when, *row.gives], document.fields[0].place)
    for key, cells, names in (("when", row.when, document.fields), ("gives", row.gives, document.variables)):
        if len(cells) != len(names):
            context.found(place, f"`{key}` needs {_cells(names)}")
            return False
    return True


def _row(
    row: TableRowDocument, sources: Sequence[Passing], gives: Mapping[str, FieldType], context: Context
) -> Row | None:
    place = place_of([*row.when, *row.gives], context.place)
    when = [
        None if cell == ANY else value_of(context, source.type, cell, place)
        for cell, source in zip(row.when, sources, strict=True)
    ]
    meant = _values(row.gives, list(gives.values()), context)
    wrong = any(value is None and cell != ANY for value, cell in zip(when, row.when, strict=True))
    return None if wrong or meant is None else Row(tuple(when), meant)


def _values(cells: Sequence[object], types: Sequence[FieldType], context: Context) -> tuple[object, ...] | None:
    place = place_of(cells, context.place)
    meant = tuple(value_of(context, type_, cell, place) for cell, type_ in zip(cells, types, strict=True))
    return None if None in meant else meant
