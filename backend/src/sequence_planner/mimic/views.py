"""View schemas of a station's live picture: what is drawn where, and which variables it follows."""

from __future__ import annotations

from typing import Literal

from sequence_planner.core.data_models import DataModel
from sequence_planner.model.mimic.documents import ColourRole, Look, SymbolKind

Value = bool | int | str


class Box(DataModel):
    """A rectangle in the units of the drawing."""

    x: float
    y: float
    width: float
    height: float


class MimicTest(DataModel):
    """A variable that has to have one of these values."""

    variable: str
    values: list[Value]


class MimicText(DataModel):
    """A text by language, under "" that of no language in particular, said while all tests hold. `{variable}` in it
    stands for a value.
    """

    text: dict[str, str]
    when: list[MimicTest]


class MimicStop(DataModel):
    """Where a thing is drawn while its variable has this value. A `branch` is off the main line; the title has so much
    `room`.
    """

    value: str
    title: dict[str, str]  # without one of its own that of the value; empty: the value in plain words
    x: float
    y: float
    label: Literal["above", "below", "left", "right", "none"]
    room: float
    branch: bool


class MimicTrack(DataModel):
    """Stops and the ways between them, on which a thing moves.

    `position` says where it is, `target` where it was sent, `previous` where it was last. A value of `position` that is
    no stop is between them.
    """

    position: str
    target: str | None
    previous: str | None
    stops: list[MimicStop]
    ways: list[tuple[str, str]]


class MimicPart(DataModel):
    """A part of the product; each of `marks` is drawn, `size` wide, as the value of its variable `looks`."""

    variable: str
    title: dict[str, str]  # empty: the name in plain words
    label: str  # beside the marks
    label_x: float
    label_y: float
    marks: list[tuple[float, float]]
    size: float
    looks: dict[str, Look]  # by values as text
    titles: dict[str, dict[str, str]]  # of values that have some, by values as text


class MimicElement(DataModel):
    """An element of a drawing, or a piece of text where it has no name. It stands `inside` an earlier one, by the
    number of that; null: at the top.
    """

    inside: int | None
    name: str
    attributes: dict[str, str]
    text: str


class MimicBound(DataModel):
    """What an element of a drawing follows: it is drawn while all of `visible` are so, in the colour of its `role`
    while all of `when` are so, and says `text`.
    """

    element: str
    visible: list[MimicTest]
    role: ColourRole | None
    when: list[MimicTest]
    text: dict[str, str]  # empty: its own


class MimicDrawing(DataModel):
    """A drawing of the station's own, without anything that runs or that loads something. It shows a rectangle of its
    own units.
    """

    file: str
    x: float
    y: float
    width: float
    height: float
    elements: list[MimicElement]
    bound: list[MimicBound]


class MimicSlot(DataModel):
    """A place whose thing is drawn while all of `holds` are so."""

    box: Box
    title: dict[str, str]
    symbol: SymbolKind
    drawing: MimicDrawing | None  # in place of the symbol
    holds: list[MimicTest]


class MimicLevel(DataModel):
    """A variable that is drawn as a level between two numbers."""

    variable: str
    lowest: int
    highest: int


class MimicSymbol(DataModel):
    """A thing in the picture. Without `title` it is called as its `resource`, or is the product."""

    name: str
    symbol: SymbolKind
    resource: str | None
    title: dict[str, str]
    box: Box
    texts: list[MimicText]
    active: list[MimicTest]
    visible: list[MimicTest]
    level: MimicLevel | None
    drawing: MimicDrawing | None
    track: MimicTrack | None
    slots: list[MimicSlot]
    parts: list[MimicPart]


class MimicFinding(DataModel):
    """Something in `mimic.yaml` that cannot be drawn, and where it is written; the rest is drawn."""

    file: str
    line: int
    column: int
    message: str


class MimicView(DataModel):
    """The live picture of the station, in a drawing `width` by `height`.

    It was made from the `model`, or is that of the `file` mimic.yaml. Symbols are in order from the back to the front.
    """

    made_from: Literal["model", "file"]
    width: float
    height: float
    symbols: list[MimicSymbol]
    findings: list[MimicFinding]
