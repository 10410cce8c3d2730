"""Stages `match` and `member`: pattern recognition in texts, and membership tests on lists."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal, get_args

from pydantic import Field, model_validator

from sequence_planner.language.records.field_paths import TEXT, FieldPath, is_number, is_textual, shown
from sequence_planner.language.records.record import FieldType, ListType, RealType, Record
from sequence_planner.language.types import BOOLEAN, EnumerationType
from sequence_planner.model.fields import Given
from sequence_planner.model.source import SourceText
from sequence_planner.model.stages.base import Context, NotInvertibleError, StageDeclaration
from sequence_planner.model.stages.map import is_same
from sequence_planner.model.stages.marks import (
    GIVEN_VALUE,
    ExampleValue,
    GivenValue,
    Marked,
    MessageField,
    ModelVariable,
    Scalar,
    with_names_said,
)
from sequence_planner.model.stages.suggestions import Candidate, Spot, some_values
from sequence_planner.model.stages.support import (
    ImmediateStage,
    candidates,
    solve,
    type_for,
    value_of,
    values_of,
    wanted_type,
)
from sequence_planner.texts.message import message

# `match`: texts that are recognised.

Way = Literal["contains", "begins", "ends", "equals"]

_RECOGNISES: Mapping[Way, Callable[[str, str], bool]] = {
    "contains": str.__contains__,
    "begins": str.startswith,
    "ends": str.endswith,
    "equals": str.__eq__,
}


class MatchDocument(StageDeclaration):
    """Texts are recognised: one kind of text makes a truth value, several make an enumeration."""

    kind: ClassVar[str] = "match"
    about: ClassVar[str] = "From texts to truth values or names; for incoming topics."
    direction: ClassVar = "incoming"

    field: MessageField
    """A text of the message."""
    variable: ModelVariable
    """What becomes of it."""
    contains: Given[SourceText] = None
    """True for texts that contain this."""
    begins: Given[SourceText] = None
    """True for texts that begin so."""
    ends: Given[SourceText] = None
    """True for texts that end so."""
    equals: Annotated[Given[SourceText], ExampleValue("ready")] = None
    """True for exactly this text."""
    values: Given[Annotated[dict[GivenValue, list[SourceText]], Field(min_length=1)]] = None
    """The texts that mean each value."""
    otherwise: Given[GivenValue] = None
    """The value of all other texts; without it they are unknown."""

    @model_validator(mode="after")
    def _one_way(self) -> MatchDocument:
        ways = (self.contains, self.begins, self.ends, self.equals, self.values)
        if sum(way is not None for way in ways) != 1:
            raise ValueError(message("form.match"))
        if self.values is None and self.otherwise is not None:
            raise ValueError(message("form.match-otherwise"))
        return self

    def check(self, context: Context) -> MatchStage | MatchNamesStage | None:
        """Texts recognised in one way, or listed by what they mean."""
        if not self.is_for(context):
            return None
        found = context.field(self.field)
        if found is None:
            return None
        path, type_ = found
        if not is_textual(type_):
            context.found(self.field.place, message("wrong.match-text", name=str(self.field), type=str(type_)))
            return None
        if self.values is not None:
            return _names(self, self.values, path, context)
        ways: tuple[Way, ...] = get_args(Way)
        way, text = next((way, text) for way in ways if (text := getattr(self, way)) is not None)
        return MatchStage(context.place, path, str(self.variable), way, str(text))

    @classmethod
    def _suggested(cls, spot: Spot) -> Iterator[Candidate]:
        for path, _ in spot.subjects(is_textual):
            name = spot.name(f"{path}_is_ready")
            yield Candidate({cls.kind: {"field": path, "variable": name, "equals": "ready"}}, {name: "bool"})


def _names(
    document: MatchDocument, values: Mapping[SourceText, Sequence[SourceText]], path: FieldPath, context: Context
) -> MatchNamesStage | None:
    names = [*values, *([] if document.otherwise is None else [document.otherwise])]
    type_ = type_for(context, document.variable, names)
    meant = None if type_ is None else values_of(context, type_, names, document.variable.place)
    twice = _texts_with_two_meanings(values)
    for text, other in twice:
        context.found(text.place, message("wrong.means-already", name=str(text), other=str(other)))
    if type_ is None or meant is None or twice:
        return None
    meanings = {str(text): name for name, texts in zip(meant, values.values(), strict=False) for text in texts}
    otherwise = None if document.otherwise is None else meant[-1]
    return MatchNamesStage(context.place, path, str(document.variable), type_, meanings, otherwise)


def _texts_with_two_meanings(
    values: Mapping[SourceText, Sequence[SourceText]],
) -> list[tuple[SourceText, SourceText]]:
    first: dict[SourceText, SourceText] = {}
    listed = [(text, name) for name, texts in values.items() for text in texts]
    return [(text, other) for text, name in listed if (other := first.setdefault(text, name)) is not name]


@dataclass(frozen=True)
class MatchStage(ImmediateStage):
    """A test whether a text contains, begins with, ends with or equals another; letters count as written."""

    field: FieldPath
    variable: str
    way: Way
    text: str
    kind: ClassVar[str] = "match"

    @property
    def reads(self) -> frozenset[str]:
        """The text."""
        return frozenset({self.field.text})

    @property
    def gives(self) -> Mapping[str, FieldType]:
        """The variable that says whether it is recognised."""
        return {self.variable: BOOLEAN}

    def apply(self, record: Record) -> None:
        """Give whether the text is recognised."""
        record.values[self.variable] = self._recognises(self.field.get(record.values))

    def _recognises(self, text: object) -> bool | None:
        return _RECOGNISES[self.way](text, self.text) if isinstance(text, str) else None

    def backwards(self, values: dict[str, object]) -> None:
        """The text itself, or another one."""
        wanted = values.get(self.variable)
        if wanted is None:
            return
        tried = {self.field.text: candidates(TEXT, [self.text])}
        complaint = f"no text of `{self.field}` makes `{self.variable}` {shown(wanted)} together with what it says else"
        solve(tried, lambda given: self._recognises(given[self.field.text]) is wanted, values, self.gives, complaint)


@dataclass(frozen=True)
class MatchNamesStage(ImmediateStage):
    """Texts become the name under which they are listed, all others `otherwise`, without that they are unknown."""

    field: FieldPath
    variable: str
    type: FieldType
    names: Mapping[str, object]
    otherwise: object
    kind: ClassVar[str] = "match"

    @property
    def reads(self) -> frozenset[str]:
        """The text."""
        return frozenset({self.field.text})

    @property
    def gives(self) -> Mapping[str, FieldType]:
        """The name."""
        return {self.variable: self.type}

    def apply(self, record: Record) -> None:
        """Give the name of the text."""
        text = self.field.get(record.values)
        name = self.names.get(text, self.otherwise) if isinstance(text, str) else None
        record.values[self.variable] = name
        if text is not None and name is None:
            record.troubles.append(f"{self.field} is {shown(text)}, which is no value of {self.variable}")

    def backwards(self, values: dict[str, object]) -> None:
        """The first text with that name, or one that is not listed."""
        wanted = values.get(self.variable)
        if wanted is None:
            return
        tried = {self.field.text: candidates(TEXT, self.names)}

        def agrees(given: Mapping[str, object]) -> bool:
            return is_same(self.names.get(str(given[self.field.text]), self.otherwise), wanted)

        solve(
            tried, agrees, values, self.gives, f"no text of `{self.field}` means {shown(wanted)}: add one to `values`"
        )


# `member`: lists that contain something.


class MemberDocument(StageDeclaration):
    """Whether a list contains an item, or which of the names of a variable it contains."""

    kind: ClassVar[str] = "member"
    about: ClassVar[str] = "Whether a list contains an item, or which of several; for incoming topics."
    direction: ClassVar = "incoming"

    field: MessageField
    """A list of the message."""
    item: Annotated[Given[Scalar], ExampleValue(0)] = None
    """What is looked for. Without it: whatever name a value of the variable has."""
    variable: ModelVariable
    """True when the item is there. Without `item`: the value whose name alone is there; unknown where several are."""
    if_none: Given[Annotated[Scalar, GIVEN_VALUE]] = None
    """Without `item`: the value where none of the others is there."""

    @model_validator(mode="after")
    def _names_or_one(self) -> MemberDocument:
        if self.item is not None and self.if_none is not None:
            raise ValueError(message("form.member"))
        return self

    @classmethod
    def marked(cls, content: object) -> list[Marked]:
        """The same, and that without an item the message has the names of values."""
        return with_names_said(super().marked(content), content, "item")

    def check(self, context: Context) -> MemberStage | MemberNamesStage | None:
        """Whether a list contains an item, or which of several."""
        if not self.is_for(context):
            return None
        found = context.field(self.field)
        if found is None:
            return None
        path, type_ = found
        if not isinstance(type_, ListType):
            context.found(self.field.place, message("wrong.no-list", name=str(self.field), type=str(type_)))
            return None
        if self.item is None:
            return self._of_names(path, type_, context)
        item = value_of(context, type_.element, self.item, self.field.place)
        return None if item is None else MemberStage(context.place, path, type_, item, str(self.variable))

    def _of_names(self, path: FieldPath, type_: ListType, context: Context) -> MemberNamesStage | None:
        wanted = wanted_type(context, self.variable)
        if not isinstance(wanted, EnumerationType):
            context.found(self.variable.place, message("wrong.list-of-names"))
            return None
        if not is_textual(type_.element):
            context.found(self.field.place, message("wrong.list-of-texts", name=str(self.field), type=str(type_)))
            return None
        empty = None if self.if_none is None else value_of(context, wanted, self.if_none, self.variable.place)
        if self.if_none is not None and empty is None:
            return None
        names = tuple(name for name in wanted.values if name != empty)
        return MemberNamesStage(context.place, path, type_, str(self.variable), wanted, names, empty)

    @classmethod
    def _suggested(cls, spot: Spot) -> Iterator[Candidate]:
        for path, type_ in spot.subjects(lambda each: isinstance(each, ListType)):
            assert isinstance(type_, ListType)
            for item in some_values(type_.element)[:1]:
                name = spot.name(f"has_{path}")
                yield Candidate({cls.kind: {"field": path, "item": item, "variable": name}}, {name: "bool"})


@dataclass(frozen=True)
class MemberStage(ImmediateStage):
    """Whether a list contains an item."""

    field: FieldPath
    type: ListType
    item: object
    variable: str
    kind: ClassVar[str] = "member"

    @property
    def reads(self) -> frozenset[str]:
        """The list."""
        return frozenset({self.field.text})

    @property
    def gives(self) -> Mapping[str, FieldType]:
        """The variable that says whether it contains the item."""
        return {self.variable: BOOLEAN}

    def apply(self, record: Record) -> None:
        """Give whether the item is there; where one that is no number might be it, that is unknown."""
        items = self.field.get(record.values)
        contains = None
        if isinstance(items, list):
            contains = self._contains(items)
            if not contains and isinstance(self.type.element, RealType) and not all(map(is_number, items)):
                record.troubles.append(f"{self.field} is {shown(items)}, with an item that is no number")
                contains = None
        record.values[self.variable] = contains

    def _contains(self, items: list[object]) -> bool:
        return any(is_same(item, self.item) for item in items)

    def backwards(self, values: dict[str, object]) -> None:
        """The list that there is, with the item or without it; one of a fixed length has nothing else in it."""
        wanted, items = values.get(self.variable), values.get(self.field.text)
        if wanted is None:
            return
        known = list(items) if isinstance(items, list) else []
        if self._contains(known) is not wanted or self.type.length not in (None, len(known)):
            others = [item for item in candidates(self.type.element, [self.item]) if not is_same(item, self.item)]
            filling = self.item if wanted is True else next(iter(others), None)
            if self.type.length is not None:
                known = [filling] * self.type.length
            else:
                known = [item for item in known if not is_same(item, self.item)] + [self.item] * (wanted is True)
        values[self.field.text] = known


@dataclass(frozen=True)
class MemberNamesStage(ImmediateStage):
    """The one of some names that a list contains, `if_none` where that is none; unknown where it is several."""

    field: FieldPath
    type: ListType
    variable: str
    variable_type: EnumerationType
    names: tuple[str, ...]
    if_none: object
    kind: ClassVar[str] = "member"

    @property
    def reads(self) -> frozenset[str]:
        """The list."""
        return frozenset({self.field.text})

    @property
    def gives(self) -> Mapping[str, FieldType]:
        """The variable that has the name."""
        return {self.variable: self.variable_type}

    def apply(self, record: Record) -> None:
        """Give the name that is there."""
        items = self.field.get(record.values)
        found = [name for name in self.names if name in items] if isinstance(items, list) else None
        record.values[self.variable] = None
        if found is not None and len(found) <= 1:
            record.values[self.variable] = found[0] if found else self.if_none
        if found is not None and record.values[self.variable] is None:
            what = f"{' and '.join(found)} at once" if found else f"none of {', '.join(self.names)}"
            record.troubles.append(f"{self.field} is {shown(items)}, with {what}, which is no value of {self.variable}")

    def backwards(self, values: dict[str, object]) -> None:
        """The list that there is, with this name alone of all; one of a fixed length has nothing else in it."""
        wanted, items = values.get(self.variable), values.get(self.field.text)
        if wanted is None:
            return
        if wanted not in self.names and wanted != self.if_none:
            raise NotInvertibleError(f"no list `{self.field}` means {shown(wanted)}")
        known = [item for item in items if item not in self.names] if isinstance(items, list) else []
        own = [] if wanted == self.if_none else [wanted]
        if self.type.length is not None:
            known, own = [], (own or [""]) * self.type.length
        values[self.field.text] = [*known, *own]
