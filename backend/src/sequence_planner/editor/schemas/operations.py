"""The operations of a draft, and how they are put in order."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.lifting.sentences import Sentences, sentences_of
from sequence_planner.automaton.sequences.order import OperationLink, OperationReason, lanes_of, links_of
from sequence_planner.editor.schemas.draft import (
    DraftOperationsView,
    DraftOperationView,
    DraftWorkMasterView,
    OperationConditionView,
    OperationGroupView,
    OperationLinkView,
    OperationReasonView,
)
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import Constant, Expression, conjuncts
from sequence_planner.texts.message import message


def operations_view(number: int, automaton: Automaton | None, *, usable: bool) -> DraftOperationsView:
    """The operations of an automaton; `number` is the change of the draft that it was made from."""
    if automaton is None:
        return DraftOperationsView(
            number=number, usable=usable, operations={}, links=[], groups=[], lanes={}, masters={}
        )
    sentences, lanes = sentences_of(automaton), lanes_of(automaton)
    return DraftOperationsView(
        number=number,
        usable=usable,
        operations=dict(_operations(automaton, sentences, lanes)),
        links=[_link(sentences, link) for link in links_of(automaton)],
        groups=[
            OperationGroupView(
                kind=group.kind, operations=list(group.operations), name=group.name, for_jobs=group.for_jobs
            )
            for group in automaton.groups
        ],
        lanes=dict(automaton.resources),
        masters={
            name: DraftWorkMasterView(title=master.title, operations=list(master.operations))
            for name, master in automaton.work_masters.items()
        },
    )


def _operations(
    automaton: Automaton, sentences: Sentences, lanes: dict[str, str | None]
) -> Iterator[tuple[str, DraftOperationView]]:
    for name, operation in automaton.operations.items():
        entry, _, arguments = name.partition("(")
        place = automaton.places[f"operation.{name}"]
        yield (
            name,
            DraftOperationView(
                title=operation.title,
                entry=entry,
                arguments=[each.strip() for each in arguments.removesuffix(")").split(",") if each],
                lane=lanes[name],
                begins=_conditions(sentences, operation.written or operation.precondition),
                turns=[part for turn in operation.turns.values() for part in _conditions(sentences, turn.condition)],
                goal=_conditions(sentences, operation.goal),
                repeat=operation.repeat,
                file=place.file,
                line=place.line,
            ),
        )


def _conditions(sentences: Sentences, condition: Expression) -> list[OperationConditionView]:
    parts = () if isinstance(condition, Constant) else conjuncts(condition)
    return [_condition(sentences, part) for part in parts]


def _condition(sentences: Sentences, part: Expression) -> OperationConditionView:
    written = print_expression(part)
    told = message("sentence.so", condition=sentences.tell_so((part,), written))
    return OperationConditionView(text=written, sentence=told)


def _link(sentences: Sentences, link: OperationLink) -> OperationLinkView:
    def view(reason: OperationReason) -> OperationReasonView:
        condition = None if reason.condition is None else _condition(sentences, reason.condition)
        return OperationReasonView(kind=reason.kind, name=reason.name, condition=condition)

    return OperationLinkView(
        before=link.before, after=link.after, reasons=[view(each) for each in link.reasons], again=link.again
    )
