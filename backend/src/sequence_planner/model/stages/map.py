"""Stages `map` and `table`: value translation of one field, or of several together."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Annotated, ClassVar

from pydantic import Discriminator, Field, Tag

from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.records.field_paths import (
    FieldPath,
    as_written,
    domain,
    is_numeric,
    is_textual,
    shown,
    written,
)
from sequence_planner.language.records.record import FieldType, ListType, Record
from sequence_planner.language.types import BOOLEAN, BooleanType, EnumerationType, Value
from sequence_planner.model.fields import DocumentPart, Given
from sequence_planner.model.source import SourceText
from sequence_planner.model.stages.base import Context, NotInvertibleError, StageDeclaration
from sequence_planner.model.stages.marks import (
    GIVEN_VALUE,
    CombinedField,
    ExampleValue,
    GivenField,
    Marked,
    MessageField,
    ModelVariable,
    NamedMap,
    NamedRelation,
    NameMark,
    NamesMark,
    NameUse,
    ReadValue,
    Scalar,
    ValueMark,
    VariableValue,
    with_names_said,
)
from sequence_planner.model.stages.suggestions import MOST_POINTS, Candidate, Spot, as_key, some_values
from sequence_planner.model.stages.support import (
    ImmediateStage,
    Passing,
    briefly,
    candidates,
    passing,
    place_of,
    solve,
    type_for,
    value_of,
    values_of,
    wanted_type,
)
from sequence_planner.texts.message import Message, message

# `map`: each value becomes another.

ValueTable = Mapping[SourceText, object]


def is_same(one: object, other: object) -> bool:
    """Return whether two values are the same; `True` is not the number 1."""
    return one == other and isinstance(one, bool) == isinstance(other, bool)


class MapDocument(StageDeclaration):
    """Each value becomes another."""

    kind: ClassVar[str] = "map"
    about: ClassVar[str] = "From each value to another."

    field: MessageField
    """The field of the message."""
    variable: ModelVariable
    """The variable that corresponds to it."""
    values: Given[NamedMap | Annotated[dict[ReadValue, Annotated[Scalar, GIVEN_VALUE]], Field(min_length=1)]] = None
    """What each value of the message means; for an outgoing topic, what is sent for each value of the variable. A named
    set among the keys stands for its values. Or the name of a map of the station, read the way round that fits. Without
    it each name is the same on both sides."""
    otherwise: Given[Annotated[Scalar, GIVEN_VALUE]] = None
    """What all other values become; without it they are unknown."""

    @classmethod
    def marked(cls, content: object) -> list[Marked]:
        """The same, and that without a table the message has the names of values."""
        return with_names_said(super().marked(content), content, "values")

    def check(self, context: Context) -> MapStage | None:
        """From field to variable for incoming topics, from variable to field for outgoing ones."""
        names = (self.field, self.variable)
        source, target = names if context.is_incoming else reversed(names)
        found = context.field(source)
        if found is None:
            return None
        path, source_type = found
        rest = [] if self.otherwise is None else [self.otherwise]
        table: ValueTable | None
        if isinstance(self.values, SourceText):
            table = table_of_map(self.values, source, source_type, target, context)
            if table is None:
                return None
        else:
            table = self.values
        target_type = type_for(context, target, [*(table or {}).values(), *rest])
        if target_type is None:
            return None
        values = self._written_out(table, source, source_type, target_type, context)
        given = values_of(context, source_type, list(values), source.place)
        meant = values_of(context, target_type, [*values.values(), *rest], target.place)
        if not values or given is None or meant is None or _are_twice(list(values), given, context):
            return None
        missing = [value for value in domain(source_type) or () if value not in given]
        if missing and self.otherwise is None and not context.is_incoming:
            context.found(source.place, message("wrong.nothing-given", values=", ".join(map(as_written, missing))))
            return None
        otherwise = None if self.otherwise is None else meant[-1]
        pairs = tuple(zip(given, meant, strict=False))
        return MapStage(context.place, path, source_type, str(target), target_type, pairs, otherwise)

    def _written_out(
        self, table: ValueTable | None, source: SourceText, of: FieldType, to: FieldType, context: Context
    ) -> ValueTable:
        """The value for each value, where sets and names that are the same stand for several; empty after a finding."""
        if table is not None:
            return {each: meant for key, meant in table.items() for each in meant_by(key, of, context)}
        names = to if context.is_incoming else of
        if not isinstance(names, EnumerationType):
            context.found(source.place, message("wrong.map-without-values"))
            return {}
        same = (SourceText(name, source.place, name) for name in names.values if name != self.otherwise)
        return {name: name for name in same}

    @classmethod
    def _suggested(cls, spot: Spot) -> Iterator[Candidate]:
        for path, type_ in spot.subjects(lambda each: is_textual(each) or domain(each) is not None or is_numeric(each)):
            given = some_values(type_)[:MOST_POINTS]
            if not given:
                continue
            if spot.is_incoming:
                first, *others = map(as_key, given[:2])
                values = {first: True, **dict.fromkeys(others, False)}
                name = spot.name(f"{path}_means")
                more = {} if domain(type_) is not None and len(given) <= len(values) else {"otherwise": False}
                yield Candidate({cls.kind: {"field": path, "variable": name, "values": values, **more}}, {name: "bool"})
                continue
            for name, wanted in spot.open.items():
                if (meant := some_values(wanted)) and not isinstance(wanted, ListType):
                    values_out = {as_key(value): meant[index % len(meant)] for index, value in enumerate(given)}
                    yield Candidate({cls.kind: {"field": name, "variable": path, "values": values_out}})

    @classmethod
    def _about(cls, name: str, spot: Spot) -> object:
        return {"field": name, "variable": spot.target, "values": {"0": 0}} if spot.open else None


def meant_by(text: SourceText, type_: FieldType, context: Context) -> list[SourceText]:
    """The values that a text stands for: itself, or those of the set that it names and that is no value itself."""
    named = context.vocabulary.domains.get(str(text))
    if named is None or written(type_, text) is not None:
        return [text]
    return [SourceText(member, text.place, member) for member in named.values]


def table_of_map(
    name: SourceText, source: SourceText, of: FieldType, target: SourceText, context: Context
) -> ValueTable | None:
    """The table of a map of the station, from the values of `source` to those of `target`: as it is declared, or the
    other way round where only that fits. None after a finding.
    """
    found = context.named(name, context.vocabulary.maps)
    if found is None:
        return None
    to = wanted_type(context, target)
    pairs = [(as_written(key), found.table[key]) for key in found.source.values if key in found.table]
    forwards = _fitting(pairs, of, to)
    backwards = _fitting([(as_written(value), key) for key, value in pairs], of, to)
    if forwards:
        return {SourceText(key, name.place, key): meant for key, meant in forwards}
    if not backwards:
        said = message(
            "wrong.map-fits-neither-way",
            name=str(name),
            source=briefly(found.source),
            target=briefly(found.target),
            types=", ".join(
                f"`{field}`: {briefly(type_)}" for field, type_ in ((source, of), (target, to)) if type_ is not None
            ),
        )
        context.found(name.place, said)
        return None
    first: dict[str, object] = {}
    for value, key in backwards:
        if (other := first.setdefault(value, key)) is not key:
            said = message("wrong.map-not-backwards", name=str(name), value=value, one=str(other), other=key)
            context.found(name.place, said)
            return None
    return {SourceText(value, name.place, value): key for value, key in backwards}


def _fitting(pairs: Iterable[tuple[str, Value]], of: FieldType, to: FieldType | None) -> list[tuple[str, Value]]:
    """The pairs whose first value the source can have; none where a second one is no value of the target."""
    known = [(key, meant) for key, meant in pairs if written(of, key) is not None]
    return known if all(to is None or written(to, meant) is not None for _, meant in known) else []


def _are_twice(written: Sequence[SourceText], values: Sequence[object], context: Context) -> bool:
    """Check whether two of the keys are the same value, such as `1` and `1.0`; a finding for each."""
    first: dict[object, SourceText] = {}
    twins = [
        (text, other)
        for text, value in zip(written, values, strict=True)
        if (other := first.setdefault(value, text)) is not text
    ]
    for text, other in twins:
        context.found(text.place, message("wrong.same-value", name=str(text), other=str(other)))
    return bool(twins)


@dataclass(frozen=True)
class MapStage(ImmediateStage):
    """Each value of `source` becomes another, all others `otherwise`; without that they are unknown."""

    source: FieldPath
    source_type: FieldType
    target: str
    target_type: FieldType
    pairs: tuple[tuple[object, object], ...]
    otherwise: object
    kind: ClassVar[str] = "map"

    @property
    def reads(self) -> frozenset[str]:
        """The field that is mapped."""
        return frozenset({self.source.text})

    @property
    def gives(self) -> Mapping[str, FieldType]:
        """The target that it is mapped to."""
        return {self.target: self.target_type}

    def apply(self, record: Record) -> None:
        """Give what the value means."""
        value = self.source.read(record.values, record.troubles)
        meaning = None if value is None else self.meaning(value)
        record.values[self.target] = meaning
        if value is not None and meaning is None:
            record.troubles.append(f"{self.source} is {shown(value)}, to which no value of {self.target} is given")

    def meaning(self, value: object) -> object:
        """Return what `value` becomes."""
        return next((meant for key, meant in self.pairs if is_same(key, value)), self.otherwise)

    def backwards(self, values: dict[str, object]) -> None:
        """The first value with that meaning, or one that is not listed."""
        wanted = values.get(self.target)
        if wanted is None:
            return
        known = values.get(self.source.text) if self.source.text != self.target else None
        tried = [known] if known is not None else candidates(self.source_type, [key for key, _ in self.pairs])
        for value in tried:
            if is_same(self.meaning(value), wanted):
                values[self.source.text] = value
                return
        raise NotInvertibleError(f"no value of `{self.source}` becomes {shown(wanted)}: add it to `values`")


# `table`: several values at once become others.

ANY = "any"


class TableCellDocument(DocumentPart):
    """What one of the fields of a table is, as a value that it gives."""

    field: Annotated[SourceText, NameMark(NameUse.COMBINED, NameUse.COMBINED), NamesMark()]
    """The field, one of `fields`."""


class TableRowDocument(DocumentPart):
    """One row of a table."""

    when: NamedRelation | Annotated[list[Annotated[Scalar, ValueMark(of_given=False, but=ANY)]], Field(min_length=1)]
    """A value for each of `fields`, or a named set of them; `any` fits everything. Or, of two fields, the name of a
    relation of the station, whose pairs fit."""
    gives: Annotated[
        list[
            Annotated[
                Annotated[Scalar, GIVEN_VALUE, Tag("value")] | Annotated[TableCellDocument, Tag("field")],
                Discriminator(lambda cell: "field" if isinstance(cell, dict) else "value"),
            ]
        ],
        Field(min_length=1),
    ]
    """A value for each of `variables`, or `{field: name}`: what this one of `fields` is."""


class TableDocument(StageDeclaration):
    """The first row that fits says what the variables are."""

    kind: ClassVar[str] = "table"
    about: ClassVar[str] = "From several values to several others, by rows."

    fields: Annotated[list[CombinedField], Field(min_length=1)]
    """The metrics."""
    variables: Annotated[list[GivenField], Field(min_length=1)]
    """What it gives."""
    rows: Annotated[list[TableRowDocument], Field(min_length=1), ExampleValue([{"when": [ANY], "gives": [0]}])]
    """The rows, in order."""
    otherwise: Given[list[Annotated[Scalar, GIVEN_VALUE]]] = None
    """What it gives when no row fits; without it the variables are unknown."""

    def check(self, context: Context) -> TableStage | None:
        """From several fields to several variables, whichever way the topic goes."""
        sources = passing(context, (each for each in self.marked(self) if each.path[0] == "fields"))
        right = [_has_cells(row, self, context) and _has_fields(row, self, context) for row in self.rows]
        if self.otherwise is not None and len(self.otherwise) != len(self.variables):
            place = place_of(self.otherwise, self.variables[0].place)
            context.found(place, _needs("otherwise", self.variables))
            right.append(False)
        twice = [name for index, name in enumerate(self.variables) if name in self.variables[:index]]
        for name in twice:
            context.found(name.place, message("wrong.given-twice", name=str(name)))
        if sources is None or not all(right) or twice:
            return None
        given: list[Sequence[object]] = [row.gives for row in self.rows]
        given += [] if self.otherwise is None else [self.otherwise]
        known_as = {source.path.text: source.type for source in sources}
        columns = [[each for cell in column for each in _can_be(cell, known_as)] for column in zip(*given, strict=True)]
        types = [type_for(context, name, column) for name, column in zip(self.variables, columns, strict=True)]
        gives = {str(name): type_ for name, type_ in zip(self.variables, types, strict=True) if type_ is not None}
        if len(gives) != len(types):
            return None
        rows = [each for row in self.rows for each in _rows(row, sources, gives, context)]
        otherwise = None if self.otherwise is None else _values(self.otherwise, list(gives.values()), context)
        known = tuple(row for row in rows if row is not None)
        if len(known) != len(rows) or (self.otherwise is not None and otherwise is None):
            return None
        paths = tuple(source.path for source in sources)
        kinds = tuple(source.type for source in sources)
        return TableStage(context.place, paths, kinds, gives, known, otherwise)

    @classmethod
    def _suggested(cls, spot: Spot) -> Iterator[Candidate]:
        for path, type_ in spot.subjects(lambda each: not isinstance(each, ListType) and bool(some_values(each))):
            when = some_values(type_)[0]
            if spot.is_incoming:
                name = spot.name(f"{path}_is_so")
                rows = [{"when": [when], "gives": [True]}]
                made = {"fields": [path], "variables": [name], "rows": rows, "otherwise": [False]}
                yield Candidate({cls.kind: made}, {name: "bool"})
                continue
            for name, wanted in spot.open.items():
                if (meant := some_values(wanted)) and not isinstance(wanted, ListType):
                    rows = [{"when": [when], "gives": [meant[0]]}]
                    yield Candidate(
                        {cls.kind: {"fields": [path], "variables": [name], "rows": rows, "otherwise": [meant[-1]]}}
                    )


def _needs(key: str, names: Sequence[SourceText]) -> Message:
    return message("wrong.cells", key=key, count=len(names), names=", ".join(names))


def _has_cells(row: TableRowDocument, document: TableDocument, context: Context) -> bool:
    place = place_of(_cells_of(row), document.fields[0].place)
    for key, cells, names in (("when", row.when, document.fields), ("gives", row.gives, document.variables)):
        if isinstance(cells, SourceText):
            if len(names) != 2:
                context.found(place, message("wrong.relation-of-two", name=str(cells), count=len(names)))
                return False
        elif len(cells) != len(names):
            context.found(place, _needs(key, names))
            return False
    return True


def _has_fields(row: TableRowDocument, document: TableDocument, context: Context) -> bool:
    """Check whether the fields whose values a row gives are some of the table, and have few values."""
    wrong = 0
    for cell in row.gives:
        if not isinstance(cell, TableCellDocument):
            continue
        if cell.field not in document.fields:
            near = suggestion(cell.field, document.fields)
            context.found(cell.field.place, message("wrong.no-field-of-table", name=str(cell.field), hint=near))
            wrong += 1
        elif (found := context.field(cell.field)) is None or domain(found[1]) is None:
            if found is not None:
                said = message("wrong.many-values", name=str(cell.field), type=str(found[1]))
                context.found(cell.field.place, said)
            wrong += 1
    return wrong == 0


def _can_be(cell: object, types: Mapping[str, FieldType]) -> Sequence[object]:
    """The values that a cell can give."""
    return domain(types[str(cell.field)]) or () if isinstance(cell, TableCellDocument) else (cell,)


def _rows(
    row: TableRowDocument, sources: Sequence[Passing], gives: Mapping[str, FieldType], context: Context
) -> Iterator[Row | None]:
    """The row for each choice of values of the sets in it; None after a finding."""
    place = place_of(_cells_of(row), context.place)
    if isinstance(row.when, SourceText):
        pairs = pairs_of_relation(row.when, sources, context)
        for pair in pairs:
            meant = _given(row, pair, sources, gives, context)
            yield None if meant is None else Row(pair, meant)
        if not pairs:
            yield None
        return
    named = {str(cell.field) for cell in row.gives if isinstance(cell, TableCellDocument)}
    columns: list[Sequence[object]] = [
        meant_by(cell, source.type, context)
        if isinstance(cell, SourceText) and cell != ANY
        else (domain(source.type) or ())
        if source.path.text in named and cell == ANY
        else [cell]
        for cell, source in zip(row.when, sources, strict=True)
    ]
    for cells in product(*columns):
        when = tuple(
            None if cell == ANY else value_of(context, source.type, cell, place)
            for cell, source in zip(cells, sources, strict=True)
        )
        wrong = any(value is None and cell != ANY for value, cell in zip(when, cells, strict=True))
        meant = None if wrong else _given(row, when, sources, gives, context)
        yield None if meant is None else Row(when, meant)


def _given(
    row: TableRowDocument,
    when: Sequence[object],
    sources: Sequence[Passing],
    gives: Mapping[str, FieldType],
    context: Context,
) -> tuple[object, ...] | None:
    """What a row gives where the fields are these; None after a finding."""
    values = {source.path.text: value for source, value in zip(sources, when, strict=True)}
    cells = [values[str(cell.field)] if isinstance(cell, TableCellDocument) else cell for cell in row.gives]
    for cell, value, type_ in zip(row.gives, cells, gives.values(), strict=True):
        if isinstance(cell, TableCellDocument) and written(type_, value) is None:
            said = message("wrong.can-be", name=str(cell.field), value=as_written(value), type=str(type_))
            context.found(cell.field.place, said)
            return None
    return _values(cells, list(gives.values()), context)


def _cells_of(row: TableRowDocument) -> list[object]:
    return [*([row.when] if isinstance(row.when, SourceText) else row.when), *row.gives]


def pairs_of_relation(name: SourceText, sources: Sequence[Passing], context: Context) -> list[tuple[object, object]]:
    """The pairs of a relation of the station that two fields can have, in order; none after a finding."""
    relation = context.named(name, context.vocabulary.relations)
    if relation is None:
        return []
    first, second = (source.type for source in sources)
    pairs = [
        (written(first, one), written(second, other))
        for one, other in product(*(type_.values for type_ in relation.types))
        if (one, other) in relation.pairs
    ]
    known = [pair for pair in pairs if None not in pair]
    if not known:
        between = [briefly(type_) for type_ in relation.types]
        fields = [f"`{source.path}`: {briefly(source.type)}" for source in sources]
        said = message("wrong.no-pair-fits", name=str(name), types=between, fields=", ".join(fields))
        context.found(name.place, said)
    return known


def _values(cells: Sequence[object], types: Sequence[FieldType], context: Context) -> tuple[object, ...] | None:
    place = place_of(cells, context.place)
    meant = tuple(value_of(context, type_, cell, place) for cell, type_ in zip(cells, types, strict=True))
    return None if None in meant else meant


@dataclass(frozen=True)
class Row:
    """One row of a table: what each field must be, where that matters, and what it gives."""

    when: tuple[object, ...]
    gives: tuple[object, ...]

    def applies(self, given: tuple[object, ...]) -> bool | None:
        """Return whether the row applies; None where that depends on something unknown. A None in `when` fits
        everything.
        """
        undetermined = False
        for wanted, value in zip(self.when, given, strict=True):
            if wanted is None:
                continue
            if value is None:
                undetermined = True
            elif not is_same(wanted, value):
                return False
        return None if undetermined else True


@dataclass(frozen=True)
class TableStage(ImmediateStage):
    """The first row that applies says what the targets are; without one `otherwise` does, or they are unknown."""

    sources: tuple[FieldPath, ...]
    source_types: tuple[FieldType, ...]
    gives: Mapping[str, FieldType]
    rows: tuple[Row, ...]
    otherwise: tuple[object, ...] | None
    kind: ClassVar[str] = "table"

    @property
    def reads(self) -> frozenset[str]:
        """The fields that are looked at."""
        return frozenset(source.text for source in self.sources)

    def apply(self, record: Record) -> None:
        """Give what the first row that applies says."""
        given = tuple(source.read(record.values, record.troubles) for source in self.sources)
        found = self.meaning(given)
        record.values.update(zip(self.gives, found or (None,) * len(self.gives), strict=True))
        if found is None and None not in given:
            names = ", ".join(map(str, self.sources))
            record.troubles.append(self._complaint(names, given))

    def _complaint(self, names: str, given: tuple[object, ...]) -> str:
        return f"no row of the table fits {shown(list(given))} for {names}"

    def meaning(self, given: tuple[object, ...]) -> tuple[object, ...] | None:
        """Return what the targets are; None where no row applies, or that depends on something unknown."""
        for row in self.rows:
            applies = row.applies(given)
            if applies is not False:
                return row.gives if applies else None
        return self.otherwise

    def backwards(self, values: dict[str, object]) -> None:
        """Values that give what is wanted, the uppermost row first."""
        wanted = [values.get(name) for name in self.gives]
        if all(value is None for value in wanted):
            return
        columns = zip(self.sources, self.source_types, zip(*(row.when for row in self.rows), strict=True), strict=True)
        tried = {source.text: candidates(type_, filter(_is_given, column)) for source, type_, column in columns}

        def agrees(given: Mapping[str, object]) -> bool:
            found = self.meaning(tuple(given[source.text] for source in self.sources))
            pairs = zip(found or (), wanted, strict=bool(found))
            return found is not None and all(value is None or is_same(meant, value) for meant, value in pairs)

        solve(tried, agrees, values, self.gives, f"no row gives {shown(wanted)} for {', '.join(self.gives)}")


def _is_given(value: object) -> bool:
    return value is not None


# `one_of`: several truth values, one of which is true.

_TRUE_OR_FALSE = message("expected.truth-value.said")


def _is_boolean(type_: FieldType) -> bool:
    return isinstance(type_, BooleanType)


class OneOfDocument(StageDeclaration):
    """Which of several truth values is true: each of them stands for a value."""

    kind: ClassVar[str] = "one_of"
    about: ClassVar[str] = "Of several truth values the one that is true: each stands for a value."

    variable: ModelVariable
    """The variable that has one of the values."""
    fields: Annotated[
        dict[
            VariableValue,
            Annotated[SourceText, NameMark(NameUse.CONSUMED, NameUse.GIVEN, fits=_is_boolean, what=_TRUE_OR_FALSE)],
        ],
        Field(min_length=2),
        ExampleValue({"one": "first", "other": "second"}),
    ]
    """The field that is true for each value."""
    otherwise: Given[Annotated[Scalar, GIVEN_VALUE]] = None
    """For an incoming topic: the value where none of the fields is true, or several are; without it the variable is
    unknown then. For an outgoing one no field is true for a value that is not listed."""

    def check(self, context: Context) -> OneOfStage | None:
        """From fields to the variable for incoming topics, from the variable to fields for outgoing ones."""
        first: dict[str, SourceText] = {}
        twice = [name for name in self.fields.values() if first.setdefault(str(name), name) is not name]
        for name in twice:
            context.found(name.place, message("wrong.two-values", name=str(name)))
        sources = passing(context, self.marked(self))
        if sources is None or twice:
            return None
        return self._incoming(sources, context) if context.is_incoming else self._outgoing(sources, context)

    def _incoming(self, sources: Sequence[Passing], context: Context) -> OneOfStage | None:
        rest = [] if self.otherwise is None else [self.otherwise]
        type_ = type_for(context, self.variable, [*self.fields, *rest])
        if type_ is None:
            return None
        meant = values_of(context, type_, [*self.fields, *rest], self.variable.place)
        if meant is None:
            return None
        paths, kinds = (tuple(part) for part in zip(*((each.path, each.type) for each in sources), strict=True))
        rows = tuple(
            Row(tuple(other is name for other in self.fields.values()), (value,))
            for name, value in zip(self.fields.values(), meant, strict=False)
        )
        otherwise = None if self.otherwise is None else (meant[-1],)
        return OneOfStage(context.place, paths, kinds, {str(self.variable): type_}, rows, otherwise)

    def _outgoing(self, sources: Sequence[Passing], context: Context) -> OneOfStage | None:
        (variable,) = sources
        if self.otherwise is not None:
            place = place_of([self.otherwise], self.variable.place)
            context.found(place, message("wrong.otherwise-incoming"))
            return None
        values = values_of(context, variable.type, list(self.fields), self.variable.place)
        wrong = [
            (name, type_)
            for name in self.fields.values()
            if not _is_boolean(type_ := wanted_type(context, name) or BOOLEAN)
        ]
        for name, type_ in wrong:
            context.found(name.place, message("wrong.must-be", name=str(name), what=_TRUE_OR_FALSE, type=str(type_)))
        if values is None or wrong:
            return None
        names = [str(name) for name in self.fields.values()]
        rows = tuple(
            Row((value,), tuple(name == own for name in names)) for value, own in zip(values, names, strict=True)
        )
        gives: dict[str, FieldType] = dict.fromkeys(names, BOOLEAN)
        return OneOfStage(context.place, (variable.path,), (variable.type,), gives, rows, (False,) * len(names))

    @classmethod
    def _suggested(cls, spot: Spot) -> Iterator[Candidate]:
        if spot.is_incoming:
            bits = [path for path, _ in spot.subjects(_is_boolean)]
            for name, wanted in spot.open.items():
                if isinstance(wanted, EnumerationType) and 1 < len(wanted.values) <= len(bits):
                    fields = dict(zip(wanted.values, bits, strict=False))
                    yield Candidate({cls.kind: {"variable": name, "fields": fields}})
            return
        bits = [name for name, wanted in spot.open.items() if _is_boolean(wanted)]
        for path, type_ in spot.subjects(lambda each: isinstance(each, EnumerationType)):
            if isinstance(type_, EnumerationType) and min(len(type_.values), len(bits)) > 1:
                yield Candidate({cls.kind: {"variable": path, "fields": dict(zip(type_.values, bits, strict=False))}})

    @classmethod
    def _about(cls, name: str, spot: Spot) -> object:
        if spot.is_incoming:
            return {"variable": spot.name(f"{name}_is"), "fields": {"one": name, "other": f"{name}_2"}}
        return {"variable": name, "fields": {"one": spot.target, "other": f"{spot.target}_2"}} if spot.open else None


@dataclass(frozen=True)
class OneOfStage(TableStage):
    """A table in which one field is true in each row."""

    kind: ClassVar[str] = "one_of"

    def _complaint(self, names: str, given: tuple[object, ...]) -> str:
        return f"not exactly one is true, but {shown(list(given))} for {names}"
