"""All that could be said shorter in a station, of every kind."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.editor.folds.conditions.actions import action_proposals
from sequence_planner.editor.folds.conditions.predicates import predicate_proposals
from sequence_planner.editor.folds.conditions.quantifiers import quantifier_proposals
from sequence_planner.editor.folds.conditions.relations import relation_proposals
from sequence_planner.editor.folds.conditions.sets import include_proposals, set_proposals
from sequence_planner.editor.folds.pipelines import list_proposals
from sequence_planner.editor.folds.proposal import FoldProposal
from sequence_planner.editor.folds.texts import FoldableStation
from sequence_planner.editor.folds.types.proposals import type_proposals

_PROPOSALS = (
    relation_proposals,
    quantifier_proposals,
    action_proposals,
    include_proposals,
    list_proposals,
    set_proposals,
    predicate_proposals,
    type_proposals,
)


def all_proposals(station: FoldableStation) -> Iterator[FoldProposal]:
    """What may be said shorter, before it is known whether that means the same."""
    for find in _PROPOSALS:
        yield from find(station)
