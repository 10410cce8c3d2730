"""Document schema of `mimic.yaml`: the live picture of a station, drawn by hand."""

from __future__ import annotations

from typing import Annotated, Final, Literal

from pydantic import Field

from sequence_planner.model.fields import DocumentPart, Given, Words
from sequence_planner.model.source import SourceText

SymbolKind = Literal[
    "arm",
    "gripper",
    "tool",
    "dock",
    "agv",
    "conveyor",
    "workpiece",
    "camera",
    "person",
    "light",
    "door",
    "tank",
    "device",
]
Look = Literal["empty", "placed", "done"]
ColourRole = Literal["accent", "high", "medium", "low", "quiet"]

ROOM: Final = 120.0  # for the title of a stop, where nothing else is said
Coordinate = Annotated[float, Field(ge=-100_000, le=100_000)]
Length = Annotated[float, Field(ge=4, le=100_000)]
Point = Annotated[list[Coordinate], Field(min_length=2, max_length=2)]
Size = Annotated[list[Length], Field(min_length=2, max_length=2)]
SingleValue = bool | int | SourceText
# A value for each variable, or several of which it has one; all of them have to be so.
Values = dict[SourceText, SingleValue | list[SingleValue]]


class MimicTextDocument(DocumentPart):
    """A line of text, shown while its condition holds."""

    say: Words
    """The text; `{variable}` is replaced by its value."""
    when: Values = Field(default_factory=dict)
    """The values that variables have while it is said; without it always."""


class StopDocument(DocumentPart):
    """A stop of a track: where the thing is drawn while its variable has this value."""

    at: Point
    """Its place, `[x, y]`."""
    title: Given[Words] = None
    """For people; without it the value in plain words."""
    label: Literal["above", "below", "left", "right", "none"] = "above"
    """On which side of the stop its title stands."""
    room: Length = ROOM
    """The width there is for its title."""
    branch: bool = False
    """A place off the main line, drawn smaller."""


class TrackDocument(DocumentPart):
    """The stops between which a thing moves, and the ways between these."""

    of: SourceText
    """The variable that says at which stop it is."""
    to: Given[SourceText] = None
    """The variable that says where it was sent."""
    previous: Given[SourceText] = None
    """The variable that says at which stop it was last."""
    stops: dict[SourceText, StopDocument] = Field(min_length=1)
    """The stops, each by the value of the variable."""
    ways: Given[list[Annotated[list[SourceText], Field(min_length=2, max_length=2)]]] = None
    """Pairs of stops with a way between them; without it these follow from the abilities that move the thing."""


class PartDocument(DocumentPart):
    """Something on the product: of an indexed variable one for each of its values, in rows."""

    of: SourceText
    """The variable, without its index."""
    at: Point
    """The middle of the first, `[x, y]`."""
    step: Point = Field(default_factory=lambda: [39.0, 0.0])
    """From one to the next, `[x, y]`."""
    columns: Annotated[int, Field(ge=1, le=100)] = 100
    """The number in a row; a further row begins `row` from the first."""
    row: Point = Field(default_factory=lambda: [0.0, 40.0])
    """From one row to the next, `[x, y]`."""
    marks: Annotated[list[Point], Field(min_length=1, max_length=8)] = Field(default_factory=lambda: [[0.0, 0.0]])
    """Where each is drawn, from its place: `[[0, 0], [0, 62]]` draws it twice, as the two bolts of a pair."""
    size: Length = 16.0
    """Its width."""
    label: Literal["below", "right"] = "below"
    """On which side of it its title stands; what it is called at the right of it is followed by its value."""
    title: Given[Words] = None
    """For people; without it the name in plain words."""
    looks: dict[SourceText, Look] = Field(default_factory=dict)
    """The look of each value: `empty`, `placed` or `done`. Without it the first value is empty and the last done."""


class BindDocument(DocumentPart):
    """What an element of a drawing follows."""

    visible: Values = Field(default_factory=dict)
    """It is drawn with these values alone."""
    text: Given[Words] = None
    """The text in it; `{variable}` is replaced by its value."""
    role: Given[ColourRole] = None
    """Its colour, by what it means; without it that of the drawing."""
    when: Values = Field(default_factory=dict)
    """It has the colour of its role with these values alone."""


class SlotDocument(DocumentPart):
    """A place for a thing, which is drawn while it is there."""

    at: Point
    """Its upper left corner, `[x, y]`."""
    size: Size = Field(default_factory=lambda: [77.0, 64.0])
    """Its width and height."""
    title: Words
    """The thing, for people."""
    symbol: SymbolKind = "tool"
    """How the thing is drawn."""
    drawing: Given[SourceText] = None
    """A drawing of your own in place of the symbol: `drawings/<name>.svg`."""
    holds: Values = Field(min_length=1)
    """The values that variables have while it is there."""


class SymbolDocument(DocumentPart):
    """Something in the picture."""

    symbol: SymbolKind = "device"
    """How it is drawn."""
    at: Point
    """Its upper left corner, `[x, y]`."""
    size: Size = Field(default_factory=lambda: [163.0, 44.0])
    """Its width and height."""
    title: Given[Words] = None
    """For people; without it that of its resource."""
    resource: Given[SourceText] = None
    """The resource it stands for: with an alarm of it it lights up, and a click shows its values and abilities."""
    text: list[MimicTextDocument] = Field(default_factory=list)
    """Its second line: the first whose condition holds. While an ability of it runs, that is said instead."""
    active: Values = Field(default_factory=dict)
    """It is drawn as working with these values, too; else while an ability of it runs."""
    visible: Values = Field(default_factory=dict)
    """It is drawn with these values alone."""
    level: Given[SourceText] = None
    """A range that is drawn as a level, such as a battery."""
    drawing: Given[SourceText] = None
    """A drawing of your own, `drawings/<name>.svg`: above the name, and of a product below its parts."""
    bind: dict[SourceText, BindDocument] = Field(default_factory=dict)
    """What elements of the drawing follow, each by its `id`."""
    track: Given[TrackDocument] = None
    """The stops between which it moves."""
    slots: list[SlotDocument] = Field(default_factory=list)
    """Places for things on it."""
    parts: list[PartDocument] = Field(default_factory=list)
    """Parts on it, for a product."""


class MimicDocument(DocumentPart):
    """The live picture of a station."""

    size: Size = Field(default_factory=lambda: [872.0, 346.0])
    """Width and height of the drawing, in whose units all places are."""
    symbols: dict[SourceText, SymbolDocument] = Field(min_length=1)
    """All that is drawn, by names of your own, from the back to the front."""
