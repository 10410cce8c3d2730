"""Stages from their documents, whatever their kind."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from sequence_planner.model.stage_documents import StageDocument
from sequence_planner.model.stages.base import Stage
from sequence_planner.model.stages.discretise import build_discretise, build_undiscretise
from sequence_planner.model.stages.expression import build_expression, build_filter
from sequence_planner.model.stages.map import build_map, build_table
from sequence_planner.model.stages.match import build_match, build_member
from sequence_planner.model.stages.python import build_python
from sequence_planner.model.stages.rename import build_constant, build_rename
from sequence_planner.model.stages.support import Context
from sequence_planner.model.stages.timing import (
    build_debounce,
    build_fold,
    build_limit,
    build_override,
    build_remember,
    build_tick,
    build_timeout,
)

_BUILDERS: Mapping[str, Callable[[Any, Context], Stage | None]] = {
    "rename": build_rename,
    "constant": build_constant,
    "discretise": build_discretise,
    "undiscretise": build_undiscretise,
    "expression": build_expression,
    "map": build_map,
    "table": build_table,
    "match": build_match,
    "member": build_member,
    "filter": build_filter,
    "remember": build_remember,
    "debounce": build_debounce,
    "limit": build_limit,
    "tick": build_tick,
    "override": build_override,
    "fold": build_fold,
    "timeout": build_timeout,
    "python": build_python,
}


def build_stage(document: StageDocument, context: Context) -> Stage | None:
    """The checked stage of a document; None after all that is wrong with it has been noted in `context`."""
    return _BUILDERS[document.kind](getattr(document, document.kind), context)
