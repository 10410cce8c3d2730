"""`map` and `table`: each value, or several at once, become others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from sequence_planner.pipelines.paths import FieldPath
from sequence_planner.pipelines.record import FieldType, Record
from sequence_planner.pipelines.stage import NotInvertibleError
from sequence_planner.pipelines.stages.immediate import ImmediateStage
from sequence_planner.pipelines.stages.inversion import candidates, solve
from sequence_planner.pipelines.stages.values import shown


def is_same(one: object, other: object) -> bool:
    """Whether two values are the same; `True` is not the number 1."""
    return one == other and isinstance(one, bool) == isinstance(other, bool)


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
        """What it is mapped to."""
        return {self.target: self.target_type}

    def apply(self, record: Record) -> None:
        """Give what the value means."""
        value = self.source.read(record.values, record.troubles)
        meaning = None if value is None else self.meaning(value)
        record.values[self.target] = meaning
        if value is not None and meaning is None:
            record.troubles.append(f"{self.source} is {shown(value)}, to which no value of {self.target} is given")

    def meaning(self, value: object) -> object:
        """What `value` becomes."""
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


@dataclass(frozen=True)
class Row:
    """One row of a table: what each field must be, where that matters, and what it gives."""

    when: tuple[object, ...]
    gives: tuple[object, ...]

    def applies(self, given: tuple[object, ...]) -> bool | None:
        """Whether the row applies; None where that depends on something unknown. A None in `when` fits everything."""
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
            record.troubles.append(f"no row of the table fits {shown(list(given))} for {names}")

    def meaning(self, given: tuple[object, ...]) -> tuple[object, ...] | None:
        """What the targets are; None where no row applies, or that depends on something unknown."""
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
