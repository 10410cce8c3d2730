"""Plans for people: time runs down, and each resource has a lane."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.planning.plan import PlanTick
from sequence_planner.planning.replaying.timeline import Activity, timeline

_RUNS, _DONE, _EXPECTED = "│", "└ done", "~ "
_GAP = "  "


def lanes(automaton: Automaton, state: State, ticks: Sequence[PlanTick], effects: bool, width: int) -> Iterator[str]:
    """The lines of a plan: in each tick what starts, runs and is done, and with `effects` what is expected before.

    Lanes that do not fit beside each other into `width` columns become one, with the resource before each ability.
    """
    activities = timeline(automaton, state, ticks)
    resource = {name: ability.resource for name, ability in automaton.abilities.items()}
    resource |= {effect.name: effect.resource for effect in automaton.effects}
    cells = [_cells(number, tick, activities, resource, effects) for number, tick in enumerate(ticks, start=1)]
    used = [name for name in automaton.resources if any(name in row for row in cells)]
    rows = [[_short(row.get(name, []), name) for name in used] for row in cells]
    widths = [max(len(name), *(len(text) for row in rows for text in row[lane])) for lane, name in enumerate(used)]
    if sum(widths) + len(_GAP) * len(widths) + 4 > width:
        yield from _one_lane(ticks, activities, effects)
        return
    yield _line("tick", used, widths)
    for number, row in enumerate(rows, start=1):
        for place in range(max(1, *(len(texts) for texts in row)) if row else 1):
            texts = [texts[place] if place < len(texts) else "" for texts in row]
            yield _line("" if place else str(number), texts, widths)


Cells = Mapping[str, list[str]]  # what is written of each resource in one tick


def _cells(
    number: int, tick: PlanTick, activities: Sequence[Activity], resource: Mapping[str, str], effects: bool
) -> Cells:
    cells: dict[str, list[str]] = {}
    for name in tick.effects if effects else ():
        cells.setdefault(resource[name], []).append(f"{_EXPECTED}{name}")
    for each in activities:
        lane = cells.setdefault(resource[each.ability], [])
        if each.started < number and (each.finished is None or number < each.finished):
            lane.append(_RUNS)
        elif each.started < number and each.finished == number:
            lane.append(_DONE)
    for name in tick.starts:
        cells[resource[name]].append(name)
    return {name: texts for name, texts in cells.items() if texts}


def _short(texts: Sequence[str], resource: str) -> list[str]:
    """Without the resource's name, which stands above."""
    return [text.replace(f"{resource}.", "", 1) for text in texts]


def _line(tick: str, texts: Sequence[str], widths: Sequence[int]) -> str:
    padded = (f"{text:<{wide}}" for text, wide in zip(texts, widths, strict=True))
    return _GAP.join((f"{tick:>4}", *padded)).rstrip()


def _one_lane(ticks: Sequence[PlanTick], activities: Sequence[Activity], effects: bool) -> Iterator[str]:
    for number, tick in enumerate(ticks, start=1):
        texts = [f"{_EXPECTED}{name}" for name in tick.effects] if effects else []
        texts += [f"{_DONE} {each.ability}" for each in activities if each.started < number == each.finished]
        texts += tick.starts
        for place, text in enumerate(texts or [_RUNS]):
            yield f"{'' if place else number:>4}{_GAP}{text}"
