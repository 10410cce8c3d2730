"""What the supervisor adds, in the words of the model, and once for all instances of which the same is said."""

from __future__ import annotations

from collections.abc import Mapping

from sequence_planner.analysis.guard_documents import GuardDocument, LiftedGuard
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.lifting.index_folding import GroundStatement, IndexFolding, specifications_folded
from sequence_planner.automaton.lifting.wording import ModelWording, wording_of
from sequence_planner.language.parser import parse
from sequence_planner.language.resolver import resolve_predicate


def lifted_guards(automaton: Automaton, guards: Mapping[str, GuardDocument]) -> list[LiftedGuard]:
    """The guards that synthesis has found of `automaton`, in the order in which the first of each stands."""
    wording = wording_of(automaton)
    if not wording:
        return [
            LiftedGuard(name=name, index=None, **guard.model_dump(exclude={"literals"}))
            for name, guard in guards.items()
        ]
    statements = {name: _statement(wording, guard) for name, guard in guards.items()}
    found = []
    for each in IndexFolding(wording).folded(statements):
        first = guards[each.members[0]]
        guard, blocked = (None, each.conditions) if first.guard is None else (each.conditions[0], ())
        found.append(
            LiftedGuard(
                name=each.name,
                index=each.over,
                starts=[start for member in each.members for start in guards[member].starts],
                guard=guard,
                blocked=list(blocked),
                specifications=list(each.names),
                rest=first.rest,
            )
        )
    return found


def guard_in_words(automaton: Automaton, guard: GuardDocument) -> GuardDocument:
    """A guard by itself, in the words of the model; the specifications of all instances over an index are one."""
    wording = wording_of(automaton)
    told = [wording.in_words(condition) for condition in _statement(wording, guard).conditions]
    return guard.model_copy(
        update={
            "guard": None if guard.guard is None else told[0],
            "blocked": told if guard.guard is None else guard.blocked,
            "specifications": specifications_folded(wording, guard.specifications),
        }
    )


def _statement(wording: ModelWording, guard: GuardDocument) -> GroundStatement:
    texts = guard.blocked if guard.guard is None else [guard.guard]
    conditions = tuple(resolve_predicate(parse(text), wording.scope) for text in texts)
    return GroundStatement(conditions, tuple(guard.specifications), (guard.guard is None, guard.rest))
