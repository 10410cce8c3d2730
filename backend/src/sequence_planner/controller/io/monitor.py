"""The traffic on the edges of the pipelines, with rates. Nothing is kept unless somebody asks."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping

from pydantic import JsonValue

from sequence_planner.controller.views.pipelines import EdgeFlowView, FlowsView, PipelineFlowView, RecordView
from sequence_planner.core.clock import Timestamp
from sequence_planner.pipelines.graph import EdgeView, PipelineView

SHORTEST, LONGEST = 1.0, 10.0  # seconds over which a rate is taken
MOST_VALUES = 5000  # of a record that is told in full
MOST_ITEMS, LONGEST_TEXT, DEEPEST = 16, 200, 6  # of a value that is shown

Counts = tuple[int, ...]  # of a pipeline: all that came, and the records of each edge


class Observing:
    """Makes views of what was observed; remembers the counts of the last seconds in which somebody looked."""

    def __init__(self) -> None:
        self._past: dict[str, deque[tuple[float, Counts]]] = {}  # by pipeline

    def view(self, observed: Mapping[str, PipelineView], moment: Timestamp) -> FlowsView:
        """The view of what has been observed at `moment`."""
        now = moment.monotonic
        self._past = {name: past for name, past in self._past.items() if past and now - past[-1][0] <= LONGEST}
        pipelines = {}
        for name, view in observed.items():
            counts, past = _counts(view), self._past.setdefault(name, deque())
            then, before = _base(past, now) or (now, counts)
            seconds = now - then
            past.append((now, counts))
            passed = [new - old for new, old in zip(counts, before, strict=True)]
            total, *rates = [number / seconds if seconds > 0 else None for number in passed]
            edges = [_edge(edge, rate, moment) for edge, rate in zip(view.edges, rates, strict=True)]
            pipelines[name] = PipelineFlowView(edges=edges, repeated=view.repeated, rate=total)
        return FlowsView(time=moment.epoch, pipelines=pipelines)


def _base(past: deque[tuple[float, Counts]], now: float) -> tuple[float, Counts] | None:
    """The counts from which rates are taken: the newest that are old enough, else the oldest."""
    while past and now - past[0][0] > LONGEST:
        past.popleft()
    while len(past) > 1 and now - past[1][0] >= SHORTEST:
        past.popleft()
    return past[0] if past else None


def _counts(view: PipelineView) -> Counts:
    records = tuple(edge.records for edge in view.edges)
    return (records[0] + view.repeated, *records)


def _edge(edge: EdgeView, rate: float | None, moment: Timestamp) -> EdgeFlowView:
    return EdgeFlowView(
        to=edge.to,
        records=edge.records,
        held=edge.held,
        rate=rate,
        last=None if edge.last is None else {name: shown(value) for name, value in edge.last.items()},
        troubles=[each[:LONGEST_TEXT] for each in edge.troubles[:MOST_ITEMS]],
        at=moment.epoch_of(edge.at),
    )


def record_view(view: PipelineView, moment: Timestamp) -> RecordView | None:
    """The last record in full; None where there has been none. Raises ValueError for one that is too large."""
    first, last = view.edges[0], view.edges[-1]
    if first.last is None or first.at is None:
        return None
    has_come = last.last is not None and last.at is not None and last.at >= first.at
    left = [MOST_VALUES]
    return RecordView(
        first={name: _in_full(value, left) for name, value in first.last.items()},
        last={name: _in_full(value, left) for name, value in (last.last or {}).items()} if has_come else None,
        at=moment.epoch_of(first.at),
    )


def _in_full(value: object, left: list[int]) -> JsonValue:
    """A value as JSON has it; `left` is how many more there may be."""
    left[0] -= 1
    if left[0] < 0:
        raise ValueError(f"it has more than {MOST_VALUES} values")
    match value:
        case float():
            return value if math.isfinite(value) else None
        case None | bool() | int():
            return value
        case Mapping():
            return {str(name): _in_full(inner, left) for name, inner in value.items()}
        case list() | tuple():
            if len(value) > left[0]:
                raise ValueError(f"it has more than {MOST_VALUES} values")
            return [_in_full(inner, left) for inner in value]
    return str(value)


def shown(value: object, depth: int = 0) -> JsonValue:
    """A value as JSON has it, shortened; what JSON has not, such as NaN, becomes text."""
    if value is None or isinstance(value, bool | int):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else str(value)
    if depth > DEEPEST:
        return "..."
    if isinstance(value, Mapping):
        return {str(name): shown(inner, depth + 1) for name, inner in value.items()}
    if isinstance(value, list | tuple):
        kept: list[JsonValue] = [shown(inner, depth + 1) for inner in value[:MOST_ITEMS]]
        return kept if len(value) <= MOST_ITEMS else [*kept, f"and {len(value) - MOST_ITEMS} more"]
    text = str(value)
    return text if len(text) <= LONGEST_TEXT else f"{text[:LONGEST_TEXT]}..."
