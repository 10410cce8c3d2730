"""A picture that was made from the model, as `mimic.yaml` would say it: for who goes on drawing from there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from typing import Final

from sequence_planner.automaton.findings import without_arguments
from sequence_planner.mimic.views import MimicPart, MimicStop, MimicSymbol, MimicTrack, MimicView
from sequence_planner.model.mimic.documents import ROOM, PartDocument
from sequence_planner.model.yaml.editor import in_brackets, scalar

_HEAD: Final = "# The live picture of the station, as it was made from the model."
_STEP, _SIZE = (PartDocument.model_fields[name].get_default(call_default_factory=True) for name in ("step", "size"))

Value = float | str | bool | list[float] | dict[str, str]


def picture_file(view: MimicView) -> str:
    """Text of a `mimic.yaml` that draws the picture `view`, which was made from the model."""
    lines = [_HEAD, f"size: {in_brackets(_numbers(view.width, view.height))}", "symbols:"]
    for number, symbol in enumerate(view.symbols):
        lines += ([""] if number else []) + [f"  {line}" for line in _symbol(symbol)]
    return "\n".join(lines) + "\n"


def _symbol(symbol: MimicSymbol) -> Iterator[str]:
    box = symbol.box
    yield f"{scalar(symbol.name)}:"
    values: dict[str, Value | None] = {
        "symbol": symbol.symbol,
        "at": _numbers(box.x, box.y),
        "size": _numbers(box.width, box.height),
        "title": dict(symbol.title) or None,
        "resource": symbol.resource,
        "level": None if symbol.level is None else symbol.level.variable,
    }
    yield from (f"  {key}: {in_brackets(value)}" for key, value in values.items() if value is not None)
    if symbol.track is not None:
        yield from (f"  {line}" for line in _track(symbol.track))
    if symbol.parts:
        yield "  parts:"
        for _, members in groupby(symbol.parts, lambda part: (without_arguments(part.variable), bool(part.label))):
            yield f"    - {in_brackets(_part(list(members)))}"


def _track(track: MimicTrack) -> Iterator[str]:
    """The ways are not said: they follow from the abilities, as they did."""
    yield "track:"
    named = {"of": track.position, "to": track.target, "previous": track.previous}
    yield from (f"  {key}: {scalar(value)}" for key, value in named.items() if value is not None)
    yield "  stops:"
    yield from (f"    {scalar(stop.value)}: {in_brackets(_stop(stop))}" for stop in track.stops)


def _stop(stop: MimicStop) -> Mapping[str, Value]:
    written: dict[str, Value] = {"at": _numbers(stop.x, stop.y)}
    if stop.label != "above":
        written["label"] = stop.label
    if stop.room != ROOM:
        written["room"] = _number(stop.room)
    if stop.branch:
        written["branch"] = True
    return written


def _part(members: Sequence[MimicPart]) -> Mapping[str, Value]:
    """The parts of one variable, in rows; or one that has no index."""
    first = members[0]
    (x, y), columns = first.marks[0], _across(members)
    written: dict[str, Value] = {
        "of": without_arguments(first.variable) if first.label else first.variable,
        "at": _numbers(x, y),
    }
    if columns > 1 and (step := members[1].marks[0][0] - x) != _STEP[0]:
        written["step"] = _numbers(step, 0)
    if columns < len(members):
        written["columns"] = columns
        written["row"] = _numbers(0, members[columns].marks[0][1] - y)
    if first.size != _SIZE:
        written["size"] = _number(first.size)
    if not first.label:
        written["label"] = "right"
    return written


def _across(members: Sequence[MimicPart]) -> int:
    """The number in the first row."""
    return sum(each.marks[0][1] == members[0].marks[0][1] for each in members)


def _numbers(*numbers: float) -> list[float]:
    return [_number(each) for each in numbers]


def _number(number: float) -> float:
    return int(number) if number == int(number) else number
