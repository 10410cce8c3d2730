"""The meaning of sequences: parts of preconditions, and the steps of jobs.

`docs/semantics.md` ("Sequences") is the definition.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from sequence_planner.automaton.automaton import Branches, GroupKind, Operation, OperationGroup, Turn
from sequence_planner.automaton.declarations import OPERATION, Declarations
from sequence_planner.automaton.findings import Findings
from sequence_planner.automaton.sequences.reading import (
    SequenceReader,
    SequenceTerm,
    orders_within,
    read_sequences,
    terms_within,
)
from sequence_planner.core.immutable import replace
from sequence_planner.language.simplifier import simplify
from sequence_planner.language.syntax import Expression, Not, Or, Variable, conjunction, conjuncts
from sequence_planner.language.types import BOOLEAN
from sequence_planner.model.documents import WorkMasterDocument
from sequence_planner.model.loader import Station
from sequence_planner.model.sequences import SequenceKind
from sequence_planner.model.source import SourceText

# What a sequence adds to preconditions.
#
#     done(o)            the goal of o
#     done([a, ..., z])  sequence: done(z); parallel, arbitrary: done of each; alternative: done of one
#     begun(t)           an operation of t is active, or its goal holds
#     under way(t)       an operation of t is active; or t is of several, the goal of one holds, and t is not done
#     wants(t)           no goal of t holds, and one of its first operations could be active as far as orders say
#
# Where t stands behind s in a sequence, each first operation of t waits for done(s). A first operation of a branch of
# an alternative waits while another branch has begun, one of an arbitrary order while another is under way; and in
# both while a branch before its own wants to begin: of two that could become active in one tick the first does.


Waits = dict[str, tuple[list[Expression], list[str]]]
"""By operation, what it waits for in a sequence, and the operations that have to do with that."""


class _Expansion:
    """What one sequence adds; `orders` has what others say of the order of operations."""

    def __init__(self, operations: Mapping[str, Operation], orders: Mapping[str, Sequence[Expression]]) -> None:
        self._operations = operations
        self._orders = orders

    def orders(self, term: SequenceTerm) -> Waits:
        """What must be done before each operation."""
        return _of_operations((after, self._done(before), before.ends) for after, before in orders_within(term))

    def turns(self, term: SequenceTerm) -> Waits:
        """What must not be so while an operation of an alternative or of an arbitrary order begins."""
        return _of_operations(self._turns(term))

    def _turns(self, term: SequenceTerm) -> Iterator[tuple[SequenceTerm, Expression, Sequence[str]]]:
        for part in terms_within(term):
            if part.kind not in ("alternative", "arbitrary"):
                continue
            keeps = self._begun if part.kind == "alternative" else self._under_way
            for index, branch in enumerate(part.parts):
                if others := [other for other in part.parts if other is not branch]:
                    kept = [each for other in others for each in keeps(other)]
                    names = [each.name for other in others for each in other.operations()]
                    yield branch, Not(_any([*kept, *map(self._wants, part.parts[:index])])), names

    def _done(self, term: SequenceTerm) -> Expression:
        if term.kind is None:
            return self._operations[term.name].goal
        if term.kind == "sequence":
            return self._done(term.parts[-1])
        parts = [self._done(part) for part in term.parts]
        return _any(parts) if term.kind == "alternative" else conjunction(*parts)

    def _active(self, term: SequenceTerm) -> list[Expression]:
        return [Variable(self._operations[each.name].activity, BOOLEAN) for each in term.operations()]

    def _goals(self, term: SequenceTerm) -> list[Expression]:
        return [self._operations[each.name].goal for each in term.operations()]

    def _begun(self, term: SequenceTerm) -> list[Expression]:
        return [*self._active(term), *self._goals(term)]

    def _under_way(self, term: SequenceTerm) -> list[Expression]:
        active = self._active(term)
        return active if term.kind is None else [*active, conjunction(_any(self._goals(term)), Not(self._done(term)))]

    def _wants(self, term: SequenceTerm) -> Expression:
        could = [
            conjunction(self._operations[each.name].precondition, *self._orders.get(each.name, ()))
            for each in term.begins
        ]
        return conjunction(_any(could), Not(_any(self._goals(term))))


def _of_operations(waits: Iterable[tuple[SequenceTerm, Expression, Sequence[str]]]) -> Waits:
    found: Waits = {}
    for term, condition, names in waits:
        for each in term.begins:
            conditions, known = found.setdefault(each.name, ([], []))
            conditions.append(condition)
            known += names
    return found


def _any(parts: Sequence[Expression]) -> Expression:
    different = tuple(dict.fromkeys(parts))
    return different[0] if len(different) == 1 else Or(different)


def in_sequences(terms: Mapping[str, SequenceTerm], operations: Mapping[str, Operation]) -> dict[str, Operation]:
    """The operations, each waiting for its turn in all of these sequences."""
    orders = {name: _Expansion(operations, {}).orders(term) for name, term in terms.items()}
    found: dict[str, dict[str, Turn]] = {}
    for name, term in terms.items():
        others: dict[str, list[Expression]] = {}
        for other in (each for each in terms if each != name):
            for operation, (conditions, _) in orders[other].items():
                others.setdefault(operation, []).extend(conditions)
        turns = _Expansion(operations, others).turns(term)
        for each in dict.fromkeys((*orders[name], *turns)):
            (ordered, after), (kept, beside) = orders[name].get(each, _NOTHING), turns.get(each, _NOTHING)
            condition = simplify(conjunction(*ordered, *kept))
            found.setdefault(each, {})[name] = Turn(condition, tuple(after), tuple(dict.fromkeys(beside)))
    return {name: _waiting(operation, found.get(name, {})) for name, operation in operations.items()}


_NOTHING: tuple[list[Expression], list[str]] = ([], [])


def _waiting(operation: Operation, turns: Mapping[str, Turn]) -> Operation:
    if not turns:
        return operation
    conditions = (operation.precondition, *(each.condition for each in turns.values()))
    parts = dict.fromkeys(part for each in conditions for part in conjuncts(each))
    return replace(operation, precondition=conjunction(*parts), written=operation.precondition, turns=turns)


# What is written in one station.

Steps = Mapping[SourceText, tuple[SourceText, ...]]
"""The operations of a job, each with those before it."""


class StepOrder(NamedTuple):
    """The steps of a job, and the branches of what is alternative or in arbitrary order among them."""

    steps: Steps
    alternatives: tuple[Branches, ...] = ()
    arbitrary: tuple[Branches, ...] = ()


class StationSequences:
    """The sequences of a station over its ground operations, and those of its work masters; what is wrong is noted."""

    def __init__(
        self, declarations: Declarations, findings: Findings, station: Station, operations: Collection[str]
    ) -> None:
        self.reader = SequenceReader(declarations, findings, station, operations)
        self._places = declarations.places
        self._groups = declarations.groups

    def ordered(self, operations: Mapping[str, Operation]) -> dict[str, Operation]:
        """The operations in the order of all sequences."""
        terms = read_sequences(self.reader)
        for name, term in self.reader.terms.items():
            for each in term.operations():
                self._places[f"{OPERATION}.{each.name}.sequence.{name}"] = each.text.place
        self._groups += [group for name, term in terms.items() for group in _groups(term, name, for_jobs=False)]
        return in_sequences(terms, operations)

    def order_of(self, document: WorkMasterDocument, name: str) -> StepOrder:
        """The steps of a job: those of its sequence, and those that are written one by one; `name` is of its master."""
        written = (self.reader.term_of(each) for each in (document, *(document.orders or ())))
        terms = [term for term in written if term is not None]
        self._groups += [group for term in terms for group in _groups(term, name, for_jobs=True)]
        steps: dict[SourceText, tuple[SourceText, ...]] = {}
        for step, before in (each for term in terms for each in _steps(term).items()):
            steps[step] = (*steps.get(step, ()), *before)
        for step, step_document in (document.operations or {}).items():
            steps[step] = (*steps.get(step, ()), *(() if step_document is None else step_document.after))
        alternatives = tuple(each for term in terms for each in _branches(term, "alternative"))
        arbitrary = tuple(each for term in terms for each in _branches(term, "arbitrary"))
        return StepOrder(steps, alternatives, arbitrary)


def _steps(term: SequenceTerm) -> dict[SourceText, tuple[SourceText, ...]]:
    """The operations of a sequence, each with those right before it."""
    texts = {each.name: SourceText(each.name, each.text.place, each.text.raw) for each in term.operations()}
    steps: dict[SourceText, tuple[SourceText, ...]] = dict.fromkeys(texts.values(), ())
    for after, before in orders_within(term):
        for each in after.begins:
            steps[texts[each.name]] += tuple(texts[end] for end in before.ends)
    return steps


def _branches(term: SequenceTerm, kind: SequenceKind) -> tuple[Branches, ...]:
    """The branches of each part of this kind."""
    return tuple(
        tuple(frozenset(each.name for each in branch.operations()) for branch in part.parts)
        for part in terms_within(term)
        if part.kind == kind and len(part.parts) > 1
    )


def _groups(term: SequenceTerm, name: str, *, for_jobs: bool) -> Iterator[OperationGroup]:
    """The operations of each part that puts several beside one another."""
    for part in terms_within(term):
        if part.kind is not None and part.kind != "sequence" and len(part.parts) > 1:
            names = tuple(each.name for each in part.operations())
            yield OperationGroup(GroupKind(part.kind), names, name, for_jobs)
