"""The contents that the stages of a pipeline may hold, one document for each kind."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import Field, ModelWrapValidatorHandler, PrivateAttr, model_validator

from sequence_planner.language.types import Place
from sequence_planner.model.fields import DocumentPart, Given, Predicate
from sequence_planner.model.source import SourceText

Period = Annotated[float, Field(gt=0, le=86_400)]
Scalar = SourceText | bool | int | float
Coordinates = dict[SourceText, Annotated[list[float], Field(min_length=1)]]
Bound = float | None
Fields = Annotated[list[SourceText], Field(min_length=1)]


class DiscretiseDocument(DocumentPart):
    """Numbers become the value whose coordinates are within `tolerance` of each, else `otherwise`."""

    field: SourceText
    """An array of numbers in the message, or a single number."""
    variable: SourceText
    """What gets the name of the point."""
    values: Given[Coordinates] = None
    """The coordinates of each named point."""
    ranges: Given[dict[SourceText, Annotated[tuple[Bound, Bound], Field(strict=False)]]] = None
    """For a single number: the least and the greatest of each value, `null` where there is no bound."""
    tolerance: Given[Annotated[float, Field(gt=0)]] = None
    """How far from a point each number may be."""
    otherwise: Given[SourceText] = None
    """The value between points or ranges."""
    hysteresis: Annotated[float, Field(ge=0)] = 0.0
    """How much further than that a number must go for the value to be left again."""

    @model_validator(mode="after")
    def _points_or_ranges(self) -> DiscretiseDocument:
        if (self.values is None) == (self.ranges is None):
            raise ValueError("write either `values`, the points with their coordinates, or `ranges` of a single number")
        if self.values is not None and (self.tolerance is None or self.otherwise is None):
            raise ValueError("`values` need a `tolerance`, and the value `otherwise` for what lies between them")
        if self.ranges is not None and self.tolerance is not None:
            raise ValueError("`ranges` have their bounds; `tolerance` belongs to `values`")
        return self


class UndiscretiseDocument(DocumentPart):
    """A value becomes its coordinates."""

    variable: SourceText
    """The variable whose value names a point."""
    field: SourceText
    """The array of numbers in the message."""
    values: Coordinates
    """The coordinates of every value."""


class MapDocument(DocumentPart):
    """Each value becomes another."""

    field: SourceText
    """The field of the message."""
    variable: SourceText
    """The variable that corresponds to it."""
    values: Annotated[dict[SourceText, Scalar], Field(min_length=1)]
    """What each value of the message means; for an outgoing topic, what is sent for each value of the variable."""
    otherwise: Given[Scalar] = None
    """What all other values become; without it they are unknown."""


class TableRowDocument(DocumentPart):
    """One row of a table."""

    when: Annotated[list[Scalar], Field(min_length=1)]
    """A value for each of `fields`; `any` fits everything."""
    gives: Annotated[list[Scalar], Field(min_length=1)]
    """A value for each of `variables`."""


class TableDocument(DocumentPart):
    """The first row that fits says what the variables are."""

    fields: Fields
    """What is looked at."""
    variables: Fields
    """What it gives."""
    rows: Annotated[list[TableRowDocument], Field(min_length=1)]
    """The rows, in order."""
    otherwise: Given[list[Scalar]] = None
    """What it gives when no row fits; without it the variables are unknown."""


class MatchDocument(DocumentPart):
    """Texts are recognised: one kind of text makes a truth value, several make an enumeration."""

    field: SourceText
    """A text of the message."""
    variable: SourceText
    """What becomes of it."""
    contains: Given[SourceText] = None
    """True for texts that contain this."""
    begins: Given[SourceText] = None
    """True for texts that begin so."""
    ends: Given[SourceText] = None
    """True for texts that end so."""
    equals: Given[SourceText] = None
    """True for exactly this text."""
    values: Given[Annotated[dict[SourceText, list[SourceText]], Field(min_length=1)]] = None
    """The texts that mean each value."""
    otherwise: Given[SourceText] = None
    """The value of all other texts; without it they are unknown."""

    @model_validator(mode="after")
    def _one_way(self) -> MatchDocument:
        ways = (self.contains, self.begins, self.ends, self.equals, self.values)
        if sum(way is not None for way in ways) != 1:
            raise ValueError("`match` has exactly one of contains, begins, ends, equals, values")
        if self.values is None and self.otherwise is not None:
            raise ValueError("`otherwise` belongs to `values`: any other match is true or false")
        return self


class MemberDocument(DocumentPart):
    """Whether a list contains an item."""

    field: SourceText
    """A list of the message."""
    item: Scalar
    """What is looked for."""
    variable: SourceText
    """True when it is there."""


class RememberDocument(DocumentPart):
    """A variable keeps the last value of another, but for the values in `except`."""

    variable: SourceText
    """The variable that keeps the value."""
    of: SourceText
    """The field or variable, of the same pipeline, whose value is kept."""
    ignored: list[SourceText] = Field(default_factory=list, alias="except")
    """Values that are not kept."""


class DebounceDocument(DocumentPart):
    """A new value counts when it has been there for some time; until then the old one does."""

    fields: Fields
    """The fields, which change together."""
    seconds: Period
    """How long it must have been there."""


class EveryDocument(DocumentPart):
    """A period."""

    every: Period
    """Seconds between two records."""


class BoundsDocument(DocumentPart):
    """Which values a person may give to a field."""

    between: Given[Annotated[tuple[float, float], Field(strict=False)]] = None
    """The least and the greatest number."""
    among: Given[Annotated[list[Scalar], Field(min_length=1)]] = Field(default=None, alias="in")
    """The values themselves."""

    @model_validator(mode="after")
    def _one_kind(self) -> BoundsDocument:
        if (self.between is None) == (self.among is None):
            raise ValueError("write either `between: [least, greatest]` or `in: [values]`")
        if self.between is not None and self.between[0] > self.between[1]:
            raise ValueError("`between` has the least number first")
        return self


class OverrideDocument(DocumentPart):
    """A person's live values for some fields, within bounds, for a while."""

    name: SourceText
    """What it is called where it is set."""
    fields: Annotated[dict[SourceText, BoundsDocument], Field(min_length=1)]
    """The fields, each with the values allowed."""
    expires: Period
    """Seconds after which it is gone."""


class TimeoutDocument(DocumentPart):
    """Fields are unknown when no record has come for some time."""

    fields: Fields
    """The fields."""
    seconds: Period
    """How long they count."""


class PythonDocument(DocumentPart):
    """A function of the station's own, in a file of its folder `stages`."""

    file: SourceText
    """The file, as in `stages/force.py`."""
    function: SourceText
    """The function's name. It is called with the fields it reads, and returns a dict of what it gives."""
    reads: dict[SourceText, SourceText]
    """The fields it is called with, and their types: `bool`, `0..9`, `{a, b}`, `real`, `text`."""
    gives: Annotated[dict[SourceText, SourceText], Field(min_length=1)]
    """What it returns, and the types."""
    deadline: Annotated[float, Field(gt=0, le=60)] = 0.05
    """Seconds within which it answers."""


class StageDocument(DocumentPart):
    """One stage of a pipeline: exactly one kind. Fields and variables of one name are mapped without being asked."""

    rename: Given[dict[SourceText, SourceText]] = None
    """Which field is which variable, where their names differ: `{field: variable}`."""
    constant: Given[Mapping[SourceText, Any]] = None
    """Fields with a fixed value; for outgoing topics."""
    expression: Given[dict[SourceText, Scalar]] = None
    """Values computed from others: `{name: expression}`."""
    discretise: Given[DiscretiseDocument] = None
    """From numbers to the name of a point; for incoming topics."""
    undiscretise: Given[UndiscretiseDocument] = None
    """From the name of a point to its numbers; for outgoing topics."""
    map: Given[MapDocument] = None
    """From each value to another."""
    table: Given[TableDocument] = None
    """From several values to several others, by rows."""
    match: Given[MatchDocument] = None
    """From texts to truth values or names; for incoming topics."""
    member: Given[MemberDocument] = None
    """Whether a list contains an item; for incoming topics."""
    remember: Given[RememberDocument] = None
    """Keep the last value of another variable; for incoming topics."""
    filter: Given[Predicate] = None
    """Only records for which this holds go on."""
    debounce: Given[DebounceDocument] = None
    """A new value counts when it has been there for some time; for incoming topics."""
    limit: Given[EveryDocument] = None
    """At most one record per time, the newest."""
    tick: Given[EveryDocument] = None
    """The last record again, every so often."""
    override: Given[OverrideDocument] = None
    """A person's live values, within bounds."""
    fold: Given[list[SourceText]] = None
    """Fields that are unknown keep their last value; an empty list means all."""
    timeout: Given[TimeoutDocument] = None
    """Fields are unknown when no record has come for some time; for incoming topics."""
    python: Given[PythonDocument] = None
    """A function of the station's own."""

    _place: Place = PrivateAttr(default=Place("", 1, 1))

    @model_validator(mode="wrap")
    @classmethod
    def _one_kind(cls, written: object, handler: ModelWrapValidatorHandler[StageDocument]) -> StageDocument:
        """Exactly one key, whose place is that of the stage."""
        stage = handler(written)
        if len(stage.model_fields_set) != 1:
            raise ValueError(f"a stage is exactly one of {', '.join(cls.model_fields)}")
        if isinstance(written, dict) and isinstance(key := next(iter(written)), SourceText):
            stage._place = key.place
        return stage

    @property
    def kind(self) -> str:
        """The key, such as `discretise`."""
        return next(iter(self.model_fields_set))

    @property
    def place(self) -> Place:
        """The place where the key was written."""
        return self._place
