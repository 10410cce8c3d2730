"""Which edges of what runs those of a draft are: what has not been changed is found again, wherever it stands now."""

from __future__ import annotations

import json
from collections.abc import Mapping
from difflib import SequenceMatcher

from sequence_planner.workshop.pipelines.view import DraftPipelineView, LiveEdgeView

Pipelines = Mapping[str, DraftPipelineView]


def with_live_edges(pipelines: Pipelines, running: Pipelines) -> dict[str, DraftPipelineView]:
    """The pipelines of a draft, whose edges name those of the `running` model; sources stand before what reads them."""
    found: dict[str, DraftPipelineView] = {}
    for id_, view in pipelines.items():
        other = running.get(id_)
        found[id_] = view if other is None else _with_live_edges(view, other, found)
    return found


def _with_live_edges(
    view: DraftPipelineView, other: DraftPipelineView, above: Mapping[str, DraftPipelineView]
) -> DraftPipelineView:
    begins = _beginning(view) == _beginning(other)
    if not begins and (view.role != other.role or view.message != other.message):
        return view
    here, there = (
        [_stage(view, index) for index in range(len(view.stages))],
        [_stage(other, index) for index in range(len(other.stages))],
    )
    edges: dict[int, int] = {0: 0}
    for block in SequenceMatcher(None, here, there, autojunk=False).get_matching_blocks():
        edges |= {block.a + offset + 1: block.b + offset + 1 for offset in range(block.size)}
    same = begins and all(_is_same(above.get(each.pipeline or "")) for each in view.sources)
    live = []
    for index, edge in enumerate(view.edges):
        same = same and edges.get(index) == index
        found = edges.get(index)
        named = None if found is None else LiveEdgeView(pipeline=other.id, edge=found, same=same)
        live.append(edge.model_copy(update={"live": named}))
    return view.model_copy(update={"edges": live})


def _is_same(view: DraftPipelineView | None) -> bool:
    """Whether what comes out of a pipeline runs as the draft has it."""
    return view is not None and view.edges[-1].live is not None and view.edges[-1].live.same


def _beginning(view: DraftPipelineView) -> tuple[object, ...]:
    return view.role, view.message, view.joining, tuple((each.alias, each.written) for each in view.sources)


def _stage(view: DraftPipelineView, index: int) -> str:
    """What a stage does, as a text that is another one as soon as it does something else."""
    stage = view.stages[index]
    what = (stage.reads, stage.gives) if stage.written is None else stage.written
    return json.dumps([stage.kind, what])
