"""The check whether others can do whatever some steps can: then all that the former lead to, the latter do, too."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from oxidd.util import BooleanOperator

from sequence_planner.synthesis.bdd import Diagrams, Function
from sequence_planner.synthesis.transition_relation import (
    BitUpdate,
    Flip,
    Reaction,
    Stutter,
    TransitionRelation,
    TransitionStep,
    same,
)


def included(
    diagrams: Diagrams, some: Iterable[TransitionStep], others: Sequence[TransitionStep], states: Function
) -> bool:
    """Return whether each of `some`, taken from any of `states`, is one of `others` as well.

    False also where that is only not seen: a step is looked for among those of its kind that write the same.
    """
    begun = (_begun(diagrams, step, others, states) for step in some)
    return all(each is not None and not each.satisfiable() for each in begun)


def lost(
    diagrams: Diagrams, some: Iterable[TransitionStep], others: Sequence[TransitionStep], states: Function
) -> Function | None:
    """Return those of `states` in which some can be taken that is none of `others`, and perhaps more; None where that
    cannot be told.
    """
    found = diagrams.false
    for step in some:
        if (begun := _begun(diagrams, step, others, states)) is None:
            return None
        found |= begun
    return found


def _begun(
    diagrams: Diagrams, step: TransitionStep, others: Sequence[TransitionStep], states: Function
) -> Function | None:
    match step:
        case Stutter():
            return diagrams.false  # it leads nowhere else
        case BitUpdate(guard, values, written):
            alike = (e.guard for e in others if isinstance(e, BitUpdate) and (e.values, e.written) == (values, written))
            return states & guard & ~diagrams.disjunction(alike)
        case TransitionRelation(relation, now, afterwards):
            found = [
                e for e in others if isinstance(e, TransitionRelation) and (e.now, e.afterwards) == (now, afterwards)
            ]
            other = diagrams.disjunction(e.relation for e in found)
            return states.apply_exists(BooleanOperator.AND, relation & ~other, afterwards)
        case Flip() if any(isinstance(each, Flip) and each.top == step.top for each in others):
            return diagrams.false
        case Reaction() if any(isinstance(each, Reaction) and _reacts(diagrams, step, each, states) for each in others):
            return diagrams.false
    return None


def _reacts(diagrams: Diagrams, one: Reaction, other: Reaction, states: Function) -> bool:
    """Return whether `other` can bring about whatever `one` can; what a reaction says nothing of stays as it is."""
    parts = {part.decides: part.relation for part in one.parts}
    wanted = {part.decides: part.relation for part in other.parts}
    if not parts.keys() <= wanted.keys():
        return False
    sensed = one.sensed(states)
    for decides, relation in wanted.items():
        if decides in parts:
            brought = parts[decides]
        else:
            if not set(decides).isdisjoint(one.changed):
                return False
            brought = diagrams.conjunction(
                same(diagrams, diagrams.values(name), diagrams.values_after(name)) for name in decides
            )
        if brought != relation and (sensed & brought & ~relation).satisfiable():
            return False
    return True
