"""Where nothing is asked of a station: what has to come back so that an operation can begin."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from sequence_planner.expressions.evaluation import evaluate, holds
from sequence_planner.immutable import replace
from sequence_planner.planning.advice.changes import MOST_ACTS, Acts, Changes, is_possible, sets
from sequence_planner.planning.advice.consultation import Consultation
from sequence_planner.planning.advice.offer import Offer, OfferKind
from sequence_planner.planning.advice.options import Act, ActKind
from sequence_planner.planning.advice.request import Pairing
from sequence_planner.planning.advice.situation import Situation
from sequence_planner.planning.goals.pursuit import Goals


def beginnings(
    consultation: Consultation,
    changes: Changes,
    acts: Collection[Act],
    waiting: Goals,
    impossible: frozenset[Pairing],
) -> Iterator[Offer]:
    """The returns among `acts` after which some of the operations with the goals `waiting` become active and can be
    completed: of each set of resources the most plausible one, and of those that need another no larger one.
    """
    back = [act for act in acts if act.kind is ActKind.RETURN]
    found: list[frozenset[str]] = []
    for size in range(1, MOST_ACTS + 1):
        for each in sets(back, size):
            resources = frozenset(act.name for act in each)
            if not any(fewer <= resources for fewer in found):
                offer = _offer(consultation, changes, each, waiting, impossible)
                if offer is not None:
                    found.append(resources)
                    yield offer


def _offer(
    consultation: Consultation, changes: Changes, acts: Acts, waiting: Goals, impossible: frozenset[Pairing]
) -> Offer | None:
    after = changes.applied(consultation.here, acts)
    after = replace(after, goals=_begun(consultation, after, waiting))
    prover = consultation.prover
    if not after.goals or not is_possible(consultation.here, after, impossible) or not prover.is_safe(after.state):
        return None
    plan = consultation.find(after.production()).plan
    if plan is not None:
        return consultation.making.offer(OfferKind.PHYSICAL, after, plan, acts, begun=after.goals)
    if (some := consultation.some(after)) is None or not some[2].goals:
        return None
    plan, left_out, _ = some
    return consultation.making.offer(OfferKind.PHYSICAL, after, plan, acts, left_out=left_out, begun=after.goals)


def _begun(consultation: Consultation, after: Situation, waiting: Goals) -> Goals:
    """The goals of the operations that are active then."""
    operations, state = consultation.prover.automaton.operations, after.state
    return tuple(
        goal
        for goal in waiting
        if holds(operations[goal.name].precondition, state) and evaluate(goal.predicate, state) is False
    )
