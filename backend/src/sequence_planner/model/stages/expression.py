"""Stages `expression` and `filter`: computed fields, and conditional discarding of records."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

from sequence_planner.language.records.expressions import Calculation, Tables, read_calculation, read_condition
from sequence_planner.language.records.field_paths import as_written, fills, is_numeric
from sequence_planner.language.records.record import FieldType, Record, RecordType
from sequence_planner.language.syntax import ExpressionError
from sequence_planner.language.types import BooleanType, Place
from sequence_planner.model.fields import Predicate
from sequence_planner.model.source import SourceText
from sequence_planner.model.stages.base import Context, StageDeclaration, StageInstance
from sequence_planner.model.stages.map import is_same
from sequence_planner.model.stages.marks import FormulaMark, GivenField, Scalar
from sequence_planner.model.stages.suggestions import Candidate, Spot, truth
from sequence_planner.model.stages.support import ImmediateStage, candidates, put_at, solve

# `expression`: values computed from others.


class ExpressionDocument(StageDeclaration):
    """Values of expressions, all over the record as it is before the stage."""

    kind: ClassVar[str] = "expression"
    about: ClassVar[str] = "Values computed from others: `{name: expression}`."
    is_bare: ClassVar[bool] = True

    texts: dict[GivenField, Annotated[Scalar, FormulaMark()]]

    def check(self, context: Context) -> ExpressionStage | None:
        """`{name: expression}`, all over the record as it is before the stage."""
        read = {str(name): _read(read_calculation, text, name.place, context) for name, text in self.texts.items()}
        known = {name: calculation for name, calculation in read.items() if calculation is not None}
        return ExpressionStage(context.place, known) if len(known) == len(read) else None

    @classmethod
    def _suggested(cls, spot: Spot) -> Iterator[Candidate]:
        conditions = [(path, truth(path, type_)) for path, type_ in spot.subjects()]
        if spot.is_incoming:
            for path, condition in conditions:
                if condition is not None:
                    name = spot.name(f"{path}_is_so")
                    yield Candidate({cls.kind: {name: condition}}, {name: "bool"})
            return
        for name, type_ in spot.open.items():
            if isinstance(type_, BooleanType):
                yield from (Candidate({cls.kind: {name: each}}) for _, each in conditions if each is not None)
                yield Candidate({cls.kind: {name: "true"}})
            elif is_numeric(type_):
                numbers = (path for path, given in spot.subjects(is_numeric) if fills(given, type_))
                yield from (Candidate({cls.kind: {name: each}}) for each in (*numbers, "0"))

    @classmethod
    def _about(cls, name: str, spot: Spot) -> object:
        return {spot.name(f"{name}_again"): name}


@dataclass(frozen=True)
class ExpressionStage(ImmediateStage):
    """Values of expressions over the record as it came."""

    calculations: Mapping[str, Calculation]
    kind: ClassVar[str] = "expression"

    @property
    def reads(self) -> frozenset[str]:
        """The fields in the expressions."""
        return frozenset(name for calculation in self.calculations.values() for name in calculation.reads)

    @property
    def gives(self) -> Mapping[str, FieldType]:
        """The names of the expressions."""
        return {name: calculation.type for name, calculation in self.calculations.items()}

    def apply(self, record: Record) -> None:
        """Give each its value."""
        values, troubles = record.values, record.troubles
        values |= {name: calculation.value(values, troubles) for name, calculation in self.calculations.items()}

    def backwards(self, values: dict[str, object]) -> None:
        """Fields that give these values, tried from what is written in the expressions."""
        wanted = [
            (calculation, values[name])
            for name, calculation in self.calculations.items()
            if values.get(name) is not None
        ]
        _solve(
            wanted, values, self.gives, f"no values tried for {_fields(self.reads)} give {', '.join(self.calculations)}"
        )


# `filter`: records that do not go on.


class FilterDocument(StageDeclaration):
    """A condition on records."""

    kind: ClassVar[str] = "filter"
    about: ClassVar[str] = "Only records for which this holds go on."
    is_bare: ClassVar[bool] = True

    condition: Annotated[Predicate, FormulaMark()]

    def check(self, context: Context) -> FilterStage | None:
        """A condition on records."""
        condition = _read(read_condition, self.condition, context.place, context)
        return None if condition is None else FilterStage(context.place, condition)

    @classmethod
    def _suggested(cls, spot: Spot) -> Iterator[Candidate]:
        for path, type_ in spot.subjects():
            if (condition := truth(path, type_)) is not None:
                yield Candidate({cls.kind: condition})
        yield Candidate({cls.kind: True})


@dataclass(frozen=True)
class FilterStage:
    """Only records for which a condition holds go on; where it is undetermined they do not."""

    place: Place
    condition: Calculation
    kind: ClassVar[str] = "filter"
    is_timed: ClassVar[bool] = False
    gives: ClassVar[Mapping[str, FieldType]] = {}

    @property
    def reads(self) -> frozenset[str]:
        """The fields in the condition."""
        return frozenset(self.condition.reads)

    def begin(self) -> FilterCourse:
        """Its course, which has nothing to remember."""
        return FilterCourse(self.condition)

    def backwards(self, values: dict[str, object]) -> None:
        """Fields with which a record goes on."""
        _solve([(self.condition, True)], values, (), f"no values tried for {_fields(self.reads)} pass the filter")


@dataclass(frozen=True, slots=True)
class FilterCourse(StageInstance):
    """Lets go on what fulfils the condition."""

    condition: Calculation

    def take(self, record: Record, now: float) -> Record | None:
        """The record, if the condition holds for it."""
        return record if self.condition.value(record.values, record.troubles) is True else None


# What both have in common: expressions as written, and values of their fields for which they have a value.


def _read(
    reader: Callable[[str, RecordType, Tables], Calculation], text: Scalar, place: Place, context: Context
) -> Calculation | None:
    try:
        tables = Tables(context.vocabulary, (f"{context.resource}.",))
        return reader(text if isinstance(text, str) else as_written(text), context.fields, tables)
    except ExpressionError as error:
        context.found(text.at(error.span) if isinstance(text, SourceText) else place, error.message)
        return None


def _fields(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in sorted(names))


def _solve(
    wanted: Sequence[tuple[Calculation, object]], values: dict[str, object], gives: Iterable[str], complaint: str
) -> None:
    constants = [constant for calculation, _ in wanted for constant in calculation.constants]
    reads = {name: field for calculation, _ in wanted for name, field in calculation.reads.items()}
    tried = {name: candidates(type_, constants) for name, (_, type_) in reads.items()}

    def agrees(given: Mapping[str, object]) -> bool:
        record: dict[str, object] = {}
        for name, (path, _) in reads.items():
            put_at(record, (path.key, *path.steps), given[name])
        return all(is_same(calculation.value(record, []), value) for calculation, value in wanted)

    solve(tried, agrees, values, gives, complaint)
