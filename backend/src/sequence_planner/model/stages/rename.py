"""Stages `rename` and `constant`: renamed fields, and fields with fixed values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.records.field_paths import FieldPath, common_type, feeds, fills, fits, shown
from sequence_planner.language.records.record import FieldType, Record
from sequence_planner.language.types import Type
from sequence_planner.model.source import SourceText
from sequence_planner.model.stages.base import Context, StageDeclaration
from sequence_planner.model.stages.marks import NameMark, NameUse
from sequence_planner.model.stages.suggestions import Candidate, Spot, some_values
from sequence_planner.model.stages.support import ImmediateStage, plain, wanted_type
from sequence_planner.texts.message import message

# `rename`: fields under other names.


class RenameDocument(StageDeclaration):
    """Fields also under other names."""

    kind: ClassVar[str] = "rename"
    about: ClassVar[str] = "Which field is which variable, where their names differ: `{field: variable}`."
    is_bare: ClassVar[bool] = True

    names: dict[
        Annotated[SourceText, NameMark(NameUse.RENAMED, NameUse.GIVEN, alike=True)],
        Annotated[SourceText, NameMark(NameUse.GIVEN, NameUse.RENAMED, alike=True)],
    ]

    def check(self, context: Context) -> RenameStage | None:
        """`{field: variable}`: the variable is given for incoming topics, and read for outgoing ones."""
        pairs = [
            (field, variable) if context.is_incoming else (variable, field) for field, variable in self.names.items()
        ]
        seen: set[str] = set()
        for _, target in pairs:
            if target in seen:
                context.found(target.place, message("wrong.given-twice", name=str(target)))
            seen.add(target)
        found = [(context.field(source), target) for source, target in pairs]
        renamings = [Renaming(field[0], str(target), field[1]) for field, target in found if field is not None]
        complete = len(renamings) == len(seen) == len(pairs)
        return RenameStage(context.place, tuple(renamings)) if complete else None

    @classmethod
    def _suggested(cls, spot: Spot) -> Iterator[Candidate]:
        for path, type_ in spot.subjects():
            if spot.is_incoming:
                for name, wanted in spot.open.items():
                    if name != path and isinstance(wanted, Type) and feeds(type_, wanted):
                        yield Candidate({cls.kind: {path: name}})
                if (written := spot.type_name(type_)) is not None:
                    name = spot.name(path.replace(".", "_"))
                    yield Candidate({cls.kind: {path: name}}, {name: written})
            else:
                for name, wanted in spot.open.items():
                    if name != path and fills(type_, wanted):
                        yield Candidate({cls.kind: {name: path}})

    @classmethod
    def _about(cls, name: str, spot: Spot) -> object:
        if not spot.open:
            return None
        return {name: spot.target} if spot.is_incoming else {spot.target: name}


@dataclass(frozen=True)
class Renaming:
    """A field under another name."""

    source: FieldPath
    target: str
    type: FieldType


@dataclass(frozen=True)
class RenameStage(ImmediateStage):
    """Fields also under other names; all are read before one is given, so that two can change places."""

    kind: ClassVar[str] = "rename"
    renamings: tuple[Renaming, ...]

    @property
    def reads(self) -> frozenset[str]:
        """The old names."""
        return frozenset(renaming.source.text for renaming in self.renamings)

    @property
    def gives(self) -> Mapping[str, FieldType]:
        """The new names."""
        return {renaming.target: renaming.type for renaming in self.renamings}

    def apply(self, record: Record) -> None:
        """Give each field its other name."""
        values = record.values
        values |= {renaming.target: renaming.source.get(values) for renaming in self.renamings}

    def backwards(self, values: dict[str, object]) -> None:
        """Give each its old name."""
        values |= {
            renaming.source.text: values[renaming.target]
            for renaming in self.renamings
            if values.get(renaming.target) is not None
        }


# `constant`: fields that never change.


class ConstantDocument(StageDeclaration):
    """Fields with a fixed value."""

    kind: ClassVar[str] = "constant"
    about: ClassVar[str] = "Fields with a fixed value; for outgoing topics."
    is_bare: ClassVar[bool] = True
    direction: ClassVar = "outgoing"

    fields: Mapping[Annotated[SourceText, NameMark(None, NameUse.GIVEN)], Any]

    def check(self, context: Context) -> ConstantStage | None:
        """Fixed values, each of the type of its field in the message."""
        if not self.is_for(context):
            return None
        types = {str(name): _type(context, name, plain(value)) for name, value in self.fields.items()}
        known = {name: type_ for name, type_ in types.items() if type_ is not None}
        values = {str(name): plain(value) for name, value in self.fields.items()}
        return ConstantStage(context.place, values, known) if len(known) == len(types) else None

    def is_for(self, context: Context) -> bool:
        """Say of each field of an incoming topic that the message has its own."""
        for name in self.fields if context.is_incoming else ():
            context.found(name.place, message("wrong.constant-outgoing"))
        return not context.is_incoming

    @classmethod
    def _suggested(cls, spot: Spot) -> Iterator[Candidate]:
        for name, type_ in spot.open.items():
            yield from (Candidate({cls.kind: {name: value}}) for value in some_values(type_)[:1])

    @classmethod
    def _about(cls, name: str, spot: Spot) -> object:
        return {spot.target: 0} if spot.open or spot.is_incoming else None


def _type(context: Context, name: SourceText, value: object) -> FieldType | None:
    type_ = wanted_type(context, name)
    if type_ is None:
        type_ = None if isinstance(value, list | dict) else common_type([value])
        if type_ is None:
            context.found(
                name.place, message("wrong.no-message-field", name=str(name), hint=suggestion(name, context.wanted))
            )
    elif not fits(type_, value):
        context.found(
            name.place, message("wrong.no-value-of-type", name=str(name), type=str(type_), value=str(shown(value)))
        )
        return None
    return type_


@dataclass(frozen=True)
class ConstantStage(ImmediateStage):
    """Fields that never change."""

    kind: ClassVar[str] = "constant"
    fields: Mapping[str, object]
    gives: Mapping[str, FieldType]

    @property
    def reads(self) -> frozenset[str]:
        """Nothing."""
        return frozenset()

    def apply(self, record: Record) -> None:
        """Set them."""
        record.values.update(self.fields)

    def backwards(self, values: dict[str, object]) -> None:
        """They say nothing about other fields."""
