"""Drawings of a station's own: of an SVG file only what draws is kept, so that it runs nothing and loads nothing.

What is kept stands in lists of names: an element or attribute that is in none of them is left out, whatever it means.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final
from xml.parsers import expat

from sequence_planner.automaton.findings import Findings
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.types import Place
from sequence_planner.mimic.views import MimicDrawing, MimicElement

MOST_BYTES: Final = 200_000
MOST_ELEMENTS: Final = 5_000
_DEEPEST: Final = 100
_MOST_USES: Final = 20  # of things that use things
_MOST_TOLD: Final = 20
_SVG, _XLINK = "http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"

_SHAPES = frozenset({"path", "rect", "circle", "ellipse", "line", "polyline", "polygon"})
TEXTS: Final = frozenset({"text", "tspan"})
ELEMENTS: Final = (
    _SHAPES | TEXTS | {"g", "defs", "linearGradient", "radialGradient", "stop", "clipPath", "use", "symbol"}
)
# What editors write for themselves, and what nothing is lost with: it is left out without a word.
_SILENT = frozenset({"title", "desc", "metadata"})
_SILENT_ATTRIBUTES = frozenset({"version", "baseProfile", "class", "enable-background", "role"})
_OF_ROOT = frozenset({"x", "y", "width", "height", "viewBox", "preserveAspectRatio", "overflow"})
# The tokens of the pages that a colour may name: with them a drawing is right on light and on dark grounds.
TOKENS: Final = (
    "ink", "ink-2", "ink-3", "line", "line-2", "edge", "surface", "raised", "sunken", "past", "accent", "accent-soft"
)  # fmt: skip

_NUMBERS = re.compile(r"[-+.,\d\seE%]*(?:px|pt|mm|cm|in|em)?")
_PATH = re.compile(r"[MmZzLlHhVvCcSsQqTtAa\d\s,.+eE-]*")
_WORDS = re.compile(r"[-\w\s]*")
_FONT = re.compile(r"[-\w\s,'\"]*")
_TRANSFORM = re.compile(r"(?:(?:matrix|translate|scale|rotate|skewX|skewY)\s*\([-+.,\d\seE]*\)[\s,]*)*")
_COLOUR = re.compile(rf"[A-Za-z]+|#[\da-fA-F]{{3,8}}|(?:rgba?|hsla?)\([-+.,\d\s%/]*\)|var\(--(?:{'|'.join(TOKENS)})\)")
_NAME = re.compile(r"[A-Za-z_][\w.:-]{0,99}")
_LOCAL = re.compile(r"url\(\s*['\"]?#([^'\")\s]*)['\"]?\s*\)")


def _values() -> Iterator[tuple[str, re.Pattern[str]]]:
    numbers = (
        "x y x1 y1 x2 y2 cx cy r rx ry fx fy fr dx dy width height points rotate offset opacity fill-opacity "
        "stroke-opacity stop-opacity stroke-width stroke-miterlimit stroke-dashoffset font-size letter-spacing "
        "word-spacing textLength viewBox"
    )
    words = (
        "fill-rule clip-rule stroke-linecap stroke-linejoin stroke-dasharray font-weight font-style text-anchor "
        "dominant-baseline alignment-baseline visibility display gradientUnits spreadMethod clipPathUnits lengthAdjust "
        "paint-order vector-effect shape-rendering text-rendering preserveAspectRatio"
    )
    yield from ((name, _NUMBERS) for name in numbers.split())
    yield from ((name, _WORDS) for name in words.split())
    yield from ((name, _COLOUR) for name in ("fill", "stroke", "stop-color", "color"))
    yield from ((name, _TRANSFORM) for name in ("transform", "gradientTransform"))
    yield from (("d", _PATH), ("stroke-dasharray", re.compile(r"none|[-+.,\d\seE%]*")), ("font-family", _FONT))


_VALUES: Final = dict(_values())
_PAINTS = frozenset({"fill", "stroke"})
_REFERENCES = _PAINTS | {"clip-path"}
ATTRIBUTES: Final = frozenset(_VALUES) | _REFERENCES | {"id", "href"}


class _RefusedError(Exception):
    """A file of which nothing is drawn, and where that shows."""

    def __init__(self, place: Place, message: str) -> None:
        super().__init__(message)
        self.place = place


def drawing_of(text: str, file: str, findings: Findings) -> MimicDrawing | None:
    """What `text`, the content of `file`, draws; None where nothing does. What is left out of it is noted."""
    if len(text.encode()) > MOST_BYTES:
        message = f"this drawing has {len(text.encode())} bytes, and at most {MOST_BYTES} are drawn: draw it with less"
        findings.add(Place(file, 1, 1), message)
        return None
    reader = _Reader(file)
    try:
        reader.walk(text.removeprefix("\ufeff"))
        reader.follow_references()
    except expat.ExpatError as error:
        reader.leave_out(
            Place(file, error.lineno, error.offset + 1), f"this is no SVG: {expat.ErrorString(error.code)}"
        )
        box = None
    except _RefusedError as error:
        reader.leave_out(error.place, str(error))
        box = None
    else:
        box = reader.box
        if box is None:
            reader.leave_out(Place(file, 1, 1), "nobody knows how large this is: give its `svg` a `viewBox`")
    told = sorted(set(reader.told), key=lambda each: each[0])
    for place, message in told[:_MOST_TOLD]:
        findings.add(place, message)
    if len(told) > _MOST_TOLD:
        findings.add(told[_MOST_TOLD][0], f"{len(told) - _MOST_TOLD} more things from here on are left out")
    if box is None:
        return None
    elements = [MimicElement(**vars(each)) for each in reader.elements]
    return MimicDrawing(file=file, x=box[0], y=box[1], width=box[2], height=box[3], elements=elements, bound=[])


@dataclass
class _Element:
    inside: int | None
    name: str
    attributes: dict[str, str] = field(default_factory=dict)
    text: str = ""


class _Reader:
    def __init__(self, file: str) -> None:
        self._file = file
        self.elements: list[_Element] = []
        self.box: tuple[float, float, float, float] | None = None
        self.told: list[tuple[Place, str]] = []
        self._places: list[Place] = []
        self._ids: dict[str, int] = {}
        self._open: list[int | None] = []  # the elements around, None for the root
        self._left_out = 0  # how many elements deep
        self._has_root = False
        self._parser = expat.ParserCreate(namespace_separator=" ")
        self._parser.buffer_text = True
        self._parser.StartDoctypeDeclHandler = self._doctype
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.CharacterDataHandler = self._text

    def walk(self, text: str) -> None:
        """Read the file. Raises `ExpatError` and `_RefusedError`."""
        self._parser.Parse(text, True)

    def _place(self) -> Place:
        """The place that is being read."""
        return Place(self._file, self._parser.CurrentLineNumber, self._parser.CurrentColumnNumber + 1)

    def leave_out(self, place: Place, message: str) -> None:
        """Note what is not drawn there."""
        self.told.append((place, message))

    def _doctype(self, _name: str, _system: str | None, _public: str | None, has_own: bool) -> None:
        if has_own:
            raise _RefusedError(
                self._place(), "declarations of its own are not read: take the part in `[ ]` out of the DOCTYPE"
            )

    def _start(self, name: str, attributes: Mapping[str, str]) -> None:
        namespace, _, local = name.rpartition(" ")
        if self._left_out:
            self._left_out += 1
        elif not self._has_root:
            if local != "svg" or namespace not in ("", _SVG):
                raise _RefusedError(self._place(), f"this is no SVG: it begins with `{local}`")
            self._has_root = True
            self.box = _box(attributes)
            self._root({name: value for name, value in attributes.items() if name not in _OF_ROOT})
        elif namespace not in ("", _SVG) or local in _SILENT:
            self._left_out = 1
        elif local not in ELEMENTS:
            self.leave_out(self._place(), f"`{local}` is left out: a drawing has shapes, groups, texts and gradients")
            self._left_out = 1
        else:
            self._keep(local, attributes)

    def _root(self, attributes: Mapping[str, str]) -> None:
        """Keep what a root says of all that is in it, as a group around that."""
        self._open.append(None)
        self._keep("g", attributes)
        self._open = [0]
        if not self.elements[0].attributes:
            self.elements.clear()
            self._places.clear()
            self._open = [None]

    def _end(self, _name: str) -> None:
        if self._left_out:
            self._left_out -= 1
        else:
            self._open.pop()

    def _text(self, text: str) -> None:
        around = self._open[-1] if self._open else None
        if self._left_out or around is None or self.elements[around].name not in TEXTS:
            return
        self._append(_Element(around, "", text=re.sub(r"\s+", " ", text)))

    def _append(self, element: _Element) -> None:
        if len(self.elements) == MOST_ELEMENTS:
            raise _RefusedError(self._place(), f"a drawing has at most {MOST_ELEMENTS} elements: draw it with fewer")
        self._places.append(self._place())
        self.elements.append(element)

    def _keep(self, name: str, attributes: Mapping[str, str]) -> None:
        if len(self._open) > _DEEPEST:
            raise _RefusedError(self._place(), f"elements are nested more than {_DEEPEST} deep")
        element = _Element(self._open[-1], name)
        self._open.append(len(self.elements))
        self._append(element)
        for given, value in attributes.items():
            namespace, _, attribute = given.rpartition(" ")
            if namespace not in ("", _SVG) and (namespace, attribute) != (_XLINK, "href"):
                continue
            if attribute == "style":
                self._style(element, value)
            else:
                self._attribute(element, attribute, value)

    def _style(self, element: _Element, style: str) -> None:
        """Keep what a `style` says as if it were written in attributes, without what these do not say."""
        for declaration in style.split(";"):
            name, _, value = (each.strip() for each in declaration.partition(":"))
            if name in _VALUES or name in _REFERENCES or "(" in value or "@" in name:
                self._attribute(element, name, value)

    def _attribute(self, element: _Element, name: str, value: str) -> None:
        value = value.strip()
        allowed = _VALUES.get(name)
        if name == "id":
            self._identify(value)
        elif name == "href":
            if value.startswith("#"):
                element.attributes[name] = value
            else:
                self.leave_out(
                    self._place(), "`href` is left out: it may only name an element of this drawing, as `#wheel`"
                )
        elif name in _REFERENCES and (found := _LOCAL.fullmatch(value)):
            element.attributes[name] = f"url(#{found[1]})"
        elif allowed is not None:
            if allowed.fullmatch(value):
                element.attributes[name] = value
            else:
                self.leave_out(self._place(), f"`{name}` is left out: `{_short(value)}` is not drawn")
        elif name.lower().startswith("on"):
            self.leave_out(self._place(), f"`{_short(name)}` is left out: nothing in a drawing runs")
        elif name not in _SILENT_ATTRIBUTES and not name.startswith(("data-", "aria-")):
            self.leave_out(self._place(), f"`{_short(name)}` is left out: this is not drawn")

    def _identify(self, name: str) -> None:
        at = len(self.elements) - 1
        if not _NAME.fullmatch(name):
            self.leave_out(self._place(), f"`{_short(name)}` is no name: use letters, digits, `_`, `-` and `.`")
        elif name in self._ids:
            self.leave_out(self._place(), f"two elements are called `{name}`: this one is drawn without its name")
        else:
            self._ids[name] = at
            self.elements[at].attributes["id"] = name

    # References within the drawing.

    def follow_references(self) -> None:
        """Leave out the references to what is not there, and those that would draw without end."""
        ends = self._ends()
        drawn, known = len(self.elements), dict[int, int]()
        for at, element in enumerate(self.elements):
            for name in ("href", *sorted(_REFERENCES)):
                target = _target(name, element)
                if target is None:
                    continue
                fault = None
                if target not in self._ids:
                    fault = f"there is no element `{_short(target)}`{suggestion(target, self._ids)}"
                elif name == "clip-path" or element.name == "use":
                    cost = self._cost(self._ids[target], ends, known, _MOST_USES)
                    drawn += cost or 0
                    if cost is None:
                        fault = f"`#{target}` is left out: it is drawn within itself, or in too many steps"
                    elif drawn > 2 * MOST_ELEMENTS:
                        fault = f"`#{target}` is left out: too much would be drawn"
                if fault is not None:
                    self.leave_out(self._places[at], fault)
                    del element.attributes[name]

    def _ends(self) -> list[int]:
        """Behind the last element within each."""
        ends = [at + 1 for at in range(len(self.elements))]
        for at in reversed(range(len(self.elements))):
            inside = self.elements[at].inside
            if inside is not None:
                ends[inside] = max(ends[inside], ends[at])
        return ends

    def _cost(self, at: int, ends: list[int], known: dict[int, int], steps: int) -> int | None:
        """The number of elements that are drawn where one is used; None where it is used in too many steps."""
        if at in known:
            return known[at]
        if steps == 0:
            return None
        cost = ends[at] - at
        for each in self.elements[at : ends[at]]:
            used = [_target("clip-path", each), _target("href", each) if each.name == "use" else None]
            for target in filter(None, used):
                more = self._cost(self._ids[target], ends, known, steps - 1) if target in self._ids else 0
                if more is None:
                    return None
                cost += more
        known[at] = cost
        return cost


def _target(name: str, element: _Element) -> str | None:
    """The element that an attribute names, if it names one."""
    value = element.attributes.get(name, "")
    if name == "href":
        return value[1:] or None
    found = _LOCAL.fullmatch(value)
    return None if found is None else found[1]


def _box(attributes: Mapping[str, str]) -> tuple[float, float, float, float] | None:
    """The part of the plane that a root shows."""
    given = re.split(r"[\s,]+", attributes.get("viewBox", "").strip())
    if given == [""]:
        given = ["0", "0", *(attributes.get(name, "").removesuffix("px") for name in ("width", "height"))]
    if len(given) != 4 or not all(re.fullmatch(r"-?\d{1,6}(?:\.\d{1,9})?", each) for each in given):
        return None
    x, y, width, height = map(float, given)
    return (x, y, width, height) if width > 0 and height > 0 else None


def _short(text: str) -> str:
    shown = re.sub(r"\s+", " ", text)
    return shown if len(shown) <= 40 else f"{shown[:39]}…"
