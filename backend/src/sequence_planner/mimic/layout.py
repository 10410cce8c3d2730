"""A picture made from the model: what moves at the top, the product in the middle, all else around it, people below.

The same model always gives the same picture. Numbers are units of the drawing, in which a line of text is 14 high.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import count
from typing import Final, Literal

from sequence_planner.automaton.automaton import Automaton, Kind
from sequence_planner.automaton.findings import without_arguments
from sequence_planner.language.types import IntegerRange
from sequence_planner.mimic.motion import Motion, motions
from sequence_planner.mimic.parts import MOST_PARTS, label_place, labels_of, looks_of, titles_of
from sequence_planner.mimic.views import Box, MimicLevel, MimicPart, MimicStop, MimicSymbol, MimicTrack, MimicView
from sequence_planner.model.mimic.documents import ROOM, SymbolKind

WIDTH: Final = 872.0
_MARGIN, _GAP = 22.0, 14.0
_CARD, _TRACK, _NARROWEST = 44.0, 48.0, 150.0
# Of a thing with many stops: its height, the width of its card, and where in it the line and the branches end.
_BAND, _CHIP, _LINE, _LEAF = 164.0, 200.0, 84.0, 132.0
_FEW_STOPS = 4  # of what moves within its card
_LETTER = 6.0  # wide, at most
_TELLING = 8  # letters of a word that tell something
_TEXT = 11.0  # from one line of a title to the next
_PRODUCT, _EDGE, _CELL, _LOOSE = 300.0, 24.0, 39.0, 140.0
_ROW, _LOOSE_ROW, _HEADING = 44.0, 40.0, 18.0
_MOST_COLUMNS = 12
_PRODUCT_TITLE: Final = {"en": "Product", "sv": "Produkt"}

# What a resource is, by a word of its name or its title, in English or in Swedish.
_WORDS: Final[tuple[tuple[str, SymbolKind], ...]] = (
    (r"agv|amr|mir|vehicle|shuttle|cart|truck|vagn", "agv"),
    (r"grippers?|effector|gripdon|vacuum", "gripper"),
    (r"camera|rfid|scanner|vision|reader|kamera", "camera"),
    (r"dock\w*|rack|magazine|station|docka", "dock"),
    (r"nutrunner|tool|screwdriver|drill|spindle|welder|glue\w*|press|mutterdragare|verktyg", "tool"),
    (r"robots?|arm|ur\d*|cobot|manipulator|crane", "arm"),
    (r"conveyor|belt|line|feeder|infeed|outfeed|transportör|bana", "conveyor"),
    (r"doors?|gate|fence|grind|dörr", "door"),
    (r"tank|vessel|mixer|boiler|reactor|silo", "tank"),
    (r"lights?|lamp|tower|beacon|lampa", "light"),
    (r"engine|product|part|workpiece|pallet|motor", "workpiece"),
)


def made_from(automaton: Automaton) -> MimicView:
    """The picture of a station that nobody has drawn."""
    return _Layout(automaton).view()


def symbol_of(automaton: Automaton, resource: str) -> SymbolKind:
    """What a resource looks like, as far as its abilities, its name and its title tell."""
    if any(each.human is not None for each in automaton.abilities.values() if each.resource == resource):
        return "person"
    told = f"{resource} {automaton.resources[resource]}".lower().replace("_", " ")
    found = [(match.start(), symbol) for words, symbol in _WORDS if (match := re.search(rf"\b(?:{words})\b", told))]
    return min(found, key=lambda each: each[0])[1] if found else "device"


def track_of(motion: Motion, stops: list[MimicStop]) -> MimicTrack:
    """The track of what moves so."""
    return MimicTrack(
        position=motion.position, target=motion.target, previous=motion.previous, stops=stops, ways=list(motion.ways)
    )


@dataclass(frozen=True)
class _Family:
    """Estimates of the product that are written as one: in `rows` of `columns`, or a single one."""

    name: str
    members: tuple[str, ...]
    indices: tuple[str, ...]  # the last one of each member
    columns: int

    @property
    def rows(self) -> int:
        """The number of rows."""
        return -(-len(self.members) // self.columns)


@dataclass(frozen=True)
class _Line:
    """What moves along a line across the picture: where its stops are, and the room of their titles."""

    motion: Motion
    main: frozenset[str]
    hub: str | None  # below what moves
    places: Mapping[str, float]
    rooms: Mapping[str, float]
    titles: Mapping[str, Mapping[str, str]]
    hidden: frozenset[str]  # without a title

    def _folds(self, stops: Iterable[str]) -> bool:
        named = [stop for stop in stops if stop not in self.hidden]
        return any(_longest(each, self.titles[each]) * _LETTER > self.rooms[each] for each in named)

    @property
    def line_at(self) -> float:
        """How far below the top of the band the line is: of two lines is what is written below what moves."""
        return _LINE + (_TEXT if self.hub is not None and self._folds([self.hub]) else 0.0)

    @property
    def leaves_at(self) -> float:
        """How far below the top of the band the branches end."""
        return self.line_at + _LEAF - _LINE

    @property
    def height(self) -> float:
        """The height of the band, with titles of two lines below its branches where one does."""
        return self.leaves_at + _BAND - _LEAF + (_TEXT if self._folds(set(self.titles) - self.main) else 0.0)


def _families(automaton: Automaton) -> tuple[list[_Family], list[str]]:
    """What is estimated of the product: what is indexed, and the rest."""
    members: dict[str, list[str]] = {}
    for name, variable in automaton.variables.items():
        if variable.kind is Kind.ESTIMATED and variable.resource is None:
            members.setdefault(without_arguments(name), []).append(name)
    indexed, loose = [], list[str]()
    for family, names in members.items():
        if "[" not in names[0]:
            loose += names
            continue
        names = names[:MOST_PARTS]
        indices = tuple(name[name.index("[") + 1 : -1].split(", ")[-1] for name in names)
        across = len(dict.fromkeys(indices))  # of two indices the last one goes along the row
        indexed.append(_Family(family, tuple(names), indices, min(across, _MOST_COLUMNS)))
    return indexed, loose


class _Layout:
    def __init__(self, automaton: Automaton) -> None:
        self._automaton = automaton
        self._indexed, self._loose = _families(automaton)
        moving = motions(automaton)
        self._inside = {each.resource: each for each in moving if len(each.stops) <= _FEW_STOPS}
        self._bands = [each for each in moving if len(each.stops) > _FEW_STOPS]
        self._bands.sort(key=lambda each: len(self._fan(each)))  # what goes to the product is next to it
        of_bands = {each.resource for each in self._bands}
        self._symbols = {name: symbol_of(automaton, name) for name in automaton.resources if name not in of_bands}
        self._people = [name for name, symbol in self._symbols.items() if symbol == "person"]
        self._cards = [name for name in self._symbols if name not in self._people]

    def _fan(self, motion: Motion) -> tuple[str, ...]:
        """The stops that are above a part of the product each: its variable has the stop as its index."""
        if not self._indexed or self._indexed[0].rows > 1:
            return ()
        stops = tuple(each for each in self._indexed[0].indices if each in motion.stops)
        return stops if len(stops) > 1 else ()

    def view(self) -> MimicView:
        """All of it."""
        product = self._product_box()
        last = len(self._bands) - 1
        lines = [
            self._line(motion, product, self._fan(motion) if number == last else ())
            for number, motion in enumerate(self._bands)
        ]
        top = sum(each.height for each in lines) or 10.0
        product = product and product.model_copy(update={"y": top})
        symbols: list[MimicSymbol] = []
        bottom = top
        if product is not None:
            symbols.append(self._product(product))
            bottom = product.y + product.height
        people, below_people = self._placed_people(product, bottom)
        cards = self._placed_cards(product, top, below_people)
        symbols += [self._card(name, box) for name, box in {**people, **cards}.items()]
        band = 0.0
        for line in lines:
            symbols.append(self._band(line, band))
            band += line.height
        height = max([100.0, *(each.box.y + each.box.height for each in symbols)]) + 16
        return MimicView(made_from="model", width=WIDTH, height=height, symbols=symbols, findings=[])

    # The product.

    def _product_box(self) -> Box | None:
        """The box of the product as if nothing were above it."""
        if not self._indexed and not self._loose:
            return None
        across = max((each.columns * _CELL for each in self._indexed), default=0.0)
        width = max(_PRODUCT, across + 2 * _EDGE)
        height = 2 * _EDGE + sum(each.rows * _ROW + _HEADING for each in self._indexed)
        height += -(-len(self._loose) // self._loose_columns(width)) * _LOOSE_ROW
        return Box(x=(WIDTH - width) / 2, y=0.0, width=width, height=height + _HEADING)

    @staticmethod
    def _loose_columns(width: float) -> int:
        return int((width - 2 * _EDGE) // (_LOOSE - _GAP))

    def _product(self, box: Box) -> MimicSymbol:
        parts: list[MimicPart] = []
        y = box.y + _EDGE + _HEADING
        for family in self._indexed:
            labels = labels_of(family.indices)
            for number, (name, label) in enumerate(zip(family.members, labels, strict=True)):
                x = self._cell(box, family, number % family.columns)
                middle = y + _HEADING + (number // family.columns) * _ROW
                parts.append(self._part(name, label, (x, middle), 16.0))
            y += family.rows * _ROW + _HEADING
        columns = self._loose_columns(box.width)
        for number, name in enumerate(self._loose):
            x = box.x + _EDGE + 10 + (number % columns) * (box.width - 2 * _EDGE) / columns
            middle = y + (number // columns) * _LOOSE_ROW + _LOOSE_ROW / 2
            parts.append(self._part(name, "", (_whole(x), _whole(middle)), 20.0))
        name = next(each for each in _names("product") if each not in self._automaton.resources)
        return _symbol(name, "workpiece", None, box, parts=parts).model_copy(update={"title": _PRODUCT_TITLE})

    @staticmethod
    def _cell(box: Box, family: _Family, column: int) -> float:
        return _whole(box.x + box.width / 2 + (column - (family.columns - 1) / 2) * _CELL)

    def _part(self, name: str, label: str, at: tuple[float, float], size: float) -> MimicPart:
        """A part; what has no number is called at the right of it."""
        label_x, label_y = label_place([at], size, "below" if label else "right")
        looks = looks_of(self._automaton.variables[name].type)
        return MimicPart(
            variable=name,
            title={},
            label=label,
            label_x=label_x,
            label_y=label_y,
            marks=[at],
            size=size,
            looks=looks,
            titles=titles_of(self._automaton, name),
        )

    # What has many stops: a line with branches, across the whole picture.

    def _line(self, motion: Motion, product: Box | None, fan: Sequence[str]) -> _Line:
        """Where the stops of a line and its branches are from left to right."""
        main, leaves = _main_line(motion, fan)
        hub = next((each for each in main if any(leaf in fan for leaf in leaves[each])), None)
        ordered = [each for each in main if each != hub]
        if hub is not None:  # above the product
            ordered.insert(len(ordered) // 2, hub)
        beside = {each: [leaf for leaf in leaves[each] if leaf not in fan] for each in ordered}
        places: dict[str, float] = {}
        rooms: dict[str, float] = {}
        fan_box = product if hub is not None and product is not None else None
        if fan_box is None:
            groups = [(ordered, _MARGIN, WIDTH - _MARGIN)]
        else:
            at = ordered.index(hub) if hub is not None else 0
            left, right = ordered[:at], ordered[at + 1 :]
            groups = [(left, _MARGIN, fan_box.x), (right, fan_box.x + fan_box.width, WIDTH - _MARGIN)]
        for names, start, end in groups:
            units = sum(max(1, len(beside[each])) for each in names)
            x = start
            for each in names:
                room = (end - start) / units
                count = max(1, len(beside[each]))
                places[each], rooms[each] = x + room * count / 2, room * count
                for number, leaf in enumerate(beside[each]):
                    places[leaf], rooms[leaf] = x + room * (number + 0.5), room
                x += room * count
        if fan_box is not None and hub is not None:
            family = self._indexed[0]
            places[hub], rooms[hub] = fan_box.x + fan_box.width / 2, fan_box.width / 2
            cells = {leaf: self._cell(fan_box, family, family.indices.index(leaf)) for leaf in fan}
            for leaf, x in cells.items():
                places[leaf], rooms[leaf] = x, 0.0
            for number, leaf in enumerate(beside[hub]):  # at the edge of the product
                side, order = (-1, number // 2) if number % 2 else (1, number // 2)
                edge = min(cells.values()) if side < 0 else max(cells.values())
                most = (fan_box.width - (max(cells.values()) - min(cells.values()))) / 2
                steps = -(-len(beside[hub]) // 2)
                places[leaf] = edge + side * most * (order + 1) / (steps + 1)
                rooms[leaf] = most / (steps + 1)
        titles = titles_of(self._automaton, motion.position)
        named = {stop: titles.get(stop, {}) for stop in motion.stops}
        hidden = {each for each in named if each in fan or rooms[each] < _least_room(each, named[each])}
        return _Line(motion, frozenset(main), hub, places, rooms, named, frozenset(hidden))

    def _band(self, line: _Line, top: float) -> MimicSymbol:
        """What moves along a line, whose band begins at `top`."""
        motion = line.motion
        stops = [
            _stop(
                stop,
                line.titles[stop],
                (line.places[stop], top + (line.line_at if stop in line.main else line.leaves_at)),
                "none" if stop in line.hidden else "above" if stop in line.main else "below",
                line.rooms[stop],
                branch=stop not in line.main,
            )
            for stop in motion.stops
        ]
        chip = Box(x=(WIDTH - _CHIP) / 2, y=top + 10, width=_CHIP, height=_CARD)
        symbol = symbol_of(self._automaton, motion.resource)
        return _symbol(motion.resource, symbol, motion.resource, chip, track=track_of(motion, stops))

    # Cards: a resource each.

    def _height(self, name: str) -> float:
        return _CARD + (_TRACK if name in self._inside else 0)

    def _placed_people(self, product: Box | None, top: float) -> tuple[dict[str, Box], float]:
        """People below the product, and where the room beside them ends."""
        if product is None:
            self._cards += self._people
            return {}, top
        across = max(1, int(product.width // (_NARROWEST + _GAP)))
        width = (product.width - (across - 1) * _GAP) / across
        height = max(map(self._height, self._people), default=_CARD)
        boxes = {
            name: Box(
                x=product.x + (number % across) * (width + _GAP),
                y=top + _GAP + (number // across) * (height + _GAP),
                width=width,
                height=height,
            )
            for number, name in enumerate(self._people)
        }
        return boxes, max([top, *(each.y + each.height for each in boxes.values())])

    def _placed_cards(self, product: Box | None, top: float, bottom: float) -> dict[str, Box]:
        """The other resources to the left and right of the product as far as it reaches, and the rest below."""
        columns: list[list[float]] = []  # x, y, width of each
        if product is not None:
            for start, end in ((_MARGIN, product.x - _GAP), (product.x + product.width + _GAP, WIDTH - _MARGIN)):
                columns += _columns(start, end, top)
        boxes: dict[str, Box] = {}
        waiting = list(self._cards)
        while waiting and columns:
            name = waiting[0]
            column = min(columns, key=lambda each: each[1])
            if column[1] + self._height(name) > max(bottom, top + 3 * (_CARD + _GAP)):
                break
            boxes[name] = Box(x=column[0], y=column[1], width=column[2], height=self._height(name))
            column[1] += self._height(name) + _GAP
            waiting.pop(0)
        below = max([bottom, *(each.y + each.height for each in boxes.values())]) + _GAP if product else top
        columns = _columns(_MARGIN, WIDTH - _MARGIN, below)
        for name in waiting:
            column = min(columns, key=lambda each: each[1])
            boxes[name] = Box(x=column[0], y=column[1], width=column[2], height=self._height(name))
            column[1] += self._height(name) + _GAP
        return boxes

    def _card(self, name: str, box: Box) -> MimicSymbol:
        motion = self._inside.get(name)
        track = None
        if motion is not None:
            room = box.width / len(motion.stops)
            titles = titles_of(self._automaton, motion.position)
            stops = [
                _stop(
                    stop,
                    titles.get(stop, {}),
                    (box.x + room * (number + 0.5), box.y + _CARD + _TRACK - 16),
                    "above",
                    room - 4,
                )
                for number, stop in enumerate(motion.stops)
            ]
            track = track_of(motion, stops)
        return _symbol(name, self._symbols[name], name, box, track=track, level=self._level(name))

    def _level(self, resource: str) -> MimicLevel | None:
        """The first range that is measured of a resource."""
        for name, variable in self._automaton.variables.items():
            of, is_measured = variable.type, variable.kind is Kind.MEASURED
            if variable.resource == resource and is_measured and isinstance(of, IntegerRange):
                return MimicLevel(variable=name, lowest=of.minimum, highest=of.maximum)
        return None


def _whole(number: float) -> float:
    """The nearest whole number, always in the same direction: what stands at equal distances goes on doing so."""
    return float(math.floor(number + 0.5))


def _whole_box(box: Box) -> Box:
    x, y = _whole(box.x), _whole(box.y)
    return Box(x=x, y=y, width=_whole(box.x + box.width) - x, height=_whole(box.y + box.height) - y)


def _names(name: str) -> Iterator[str]:
    """The name, and what it is called where that is taken."""
    yield name
    yield from (f"{name}_{number}" for number in count(2))


def _written(value: str, title: Mapping[str, str]) -> list[str]:
    """What a stop is called, in each language that the model has a name in."""
    return list(title.values()) or [value.replace("_", " ")]


def _longest(value: str, title: Mapping[str, str]) -> int:
    """Letters of the longest of what a stop is called."""
    return max(map(len, _written(value, title)))


def _least_room(value: str, title: Mapping[str, str]) -> float:
    """The room in which a title tells something: that of its longest word, or of what is left of a very long one."""
    words = [word for text in _written(value, title) for word in text.split()]
    return _LETTER * min(max(map(len, words), default=0), _TELLING)


def _stop(
    value: str,
    title: Mapping[str, str],
    at: tuple[float, float],
    label: Literal["above", "below", "none"],
    room: float,
    *,
    branch: bool = False,
) -> MimicStop:
    """A stop; in whole numbers, its title keeps apart from those beside it."""
    room = ROOM if label == "none" else float(math.floor(room - 1))
    return MimicStop(
        value=value, title=dict(title), x=_whole(at[0]), y=_whole(at[1]), label=label, room=room, branch=branch
    )


def _columns(start: float, end: float, top: float) -> list[list[float]]:
    """As many columns of cards as there is room for from `start` to `end`: where each begins, and its width."""
    count = int((end - start + _GAP) // (_NARROWEST + _GAP))
    width = (end - start + _GAP) / count - _GAP if count else 0.0
    return [[start + number * (width + _GAP), top, width] for number in range(count)]


def _main_line(motion: Motion, fan: Sequence[str]) -> tuple[list[str], Mapping[str, list[str]]]:
    """The stops of the main line in order, and the branches of each: stops with one way that leads there."""
    near = {stop: motion.neighbours(stop) for stop in motion.stops}
    hubs = [stop for stop in motion.stops if len(near[stop]) > 1 and stop not in fan]
    if len(hubs) < 2:  # then all else belongs to the line, but what is at the product
        hubs = [stop for stop in motion.stops if stop not in fan or not hubs]
    leaves: dict[str, list[str]] = {stop: [] for stop in hubs}
    for stop in motion.stops:
        if stop not in leaves:
            hub = next((each for each in near[stop] if each in leaves), None)
            if hub is None:
                leaves[stop] = []
            else:
                leaves[hub].append(stop)
    return list(_in_order(motion.stops, leaves)), leaves


def _in_order(stops: Sequence[str], leaves: Mapping[str, list[str]]) -> Iterator[str]:
    return (stop for stop in stops if stop in leaves)


def _symbol(
    name: str,
    symbol: SymbolKind,
    resource: str | None,
    box: Box,
    track: MimicTrack | None = None,
    parts: Sequence[MimicPart] = (),
    level: MimicLevel | None = None,
) -> MimicSymbol:
    return MimicSymbol(
        name=name,
        symbol=symbol,
        resource=resource,
        title={},
        box=_whole_box(box),
        texts=[],
        active=[],
        visible=[],
        level=level,
        drawing=None,
        track=track,
        slots=[],
        parts=list(parts),
    )
