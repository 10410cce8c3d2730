"""Ground operations, and the work masters that put them into jobs."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter

from sequence_planner.automaton.automaton import Kind, Operation, WorkMaster, target
from sequence_planner.automaton.declarations import OPERATION
from sequence_planner.automaton.findings import instance_name, title_of
from sequence_planner.automaton.grounding.meaning import Meaning, Writing
from sequence_planner.automaton.sequences.expansion import StationSequences, Steps
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.syntax import TRUE, Assignment, Constant, variables
from sequence_planner.language.types import Place
from sequence_planner.model.documents import OperationDocument
from sequence_planner.model.fields import Predicate
from sequence_planner.model.loader import Station
from sequence_planner.model.source import SourceText
from sequence_planner.texts.message import message

BROUGHT = Writing("product", (Kind.ESTIMATED,))


def ground_operations(meaning: Meaning, station: Station) -> dict[str, Operation]:
    """All operations by name, in the order of the sequences."""
    operations = {operation.name: operation for operation in _operations(meaning, station.operations)}
    for name in station.sequences:
        meaning.declarations.check_name(name, "sequence")
    ordered = station_sequences(meaning, station, operations).ordered(operations)
    read = (
        each
        for operation in ordered.values()
        for turn in operation.turns.values()
        for each in variables(turn.condition)
    )
    meaning.take((), (each for each in read if each.startswith(f"{OPERATION}.")))
    return ordered


def station_sequences(meaning: Meaning, station: Station, operations: Collection[str]) -> StationSequences:
    """The sequences over these ground operations; what is wrong is noted."""
    return StationSequences(meaning.declarations, meaning.findings, station, operations)


def ground_work_masters(
    meaning: Meaning, station: Station, operations: Mapping[str, Operation]
) -> dict[str, WorkMaster]:
    """All work masters by name."""
    masters: dict[str, WorkMaster] = {}
    sequences = station_sequences(meaning, station, operations)
    ordered = {
        name: [each for turn in operation.turns.values() for each in turn.after]
        for name, operation in operations.items()
    }
    for name, document in station.work_masters.items():
        meaning.declarations.check_name(name, "work_master")
        if document.brings:
            meaning.declarations.places[f"work_master.{name}.brings"] = document.brings[0].place
        order = sequences.order_of(document, str(name))
        check_steps(meaning, order.steps, operations, ordered, name)
        masters[str(name)] = WorkMaster(
            str(name),
            title_of(document.title, name, {}),
            {str(step): frozenset(map(str, before)) for step, before in order.steps.items()},
            brought_by(meaning, document.brings),
            order.alternatives,
            order.arbitrary,
        )
    return masters


def _operations(meaning: Meaning, documents: Mapping[SourceText, OperationDocument]) -> Iterator[Operation]:
    for name, document in documents.items():
        for binding in meaning.declarations.bindings(document.parameters):
            full = instance_name(name, binding)
            scope = meaning.scope(binding)
            places = meaning.declarations.places
            places[f"{OPERATION}.{full}"] = name.place
            if document.local is not None:
                places[f"{OPERATION}.{full}.local"] = _operation_place(document.local, name)
            yield Operation(
                full,
                title_of(document.title, name, binding, meaning.declarations.titles),
                meaning.predicate(document.precondition, scope),
                meaning.predicate(document.goal, scope),
                document.priority,
                None if document.local is None else meaning.formula(document.local, scope),
                document.repeat,
            )


def _operation_place(text: Predicate, otherwise: SourceText) -> Place:
    return text.place if isinstance(text, SourceText) else otherwise.place


def check_steps(
    meaning: Meaning,
    steps: Steps,
    operations: Collection[str],
    ordered: Mapping[str, Sequence[str]] | None = None,
    master: SourceText | None = None,
) -> None:
    """Note steps that are none of the `operations`, and those that come before themselves, by way of what sequences
    have `ordered` too. That is told where the work master writes one of them, or else at its name `master`.
    """
    findings, ordered = meaning.findings, ordered or {}
    for step, before in steps.items():
        if step not in operations:
            hint = suggestion(step, operations)
            findings.add(step, message("wrong.no-operation", name=str(step), hint=hint))
        for each in before:
            if each not in steps:
                findings.add(each, message("wrong.not-of-job", name=str(each), hint=suggestion(each, map(str, steps))))
    graph = {str(step): [*map(str, before), *ordered.get(step, ())] for step, before in steps.items()}
    others = {name: before for name, before in ordered.items() if name not in graph}
    try:
        TopologicalSorter({**graph, **others}).prepare()
    except CycleError as error:
        circle: list[str] = error.args[1]
        texts = [each for step, before in steps.items() if step in circle for each in (step, *before) if each in circle]
        own = [each for each in texts if master is None or each.place.file == master.place.file]
        findings.add(own[0] if own else master or texts[0], message("wrong.circle", names=" → ".join(circle)))


def brought_by(meaning: Meaning, texts: Iterable[SourceText]) -> tuple[Assignment, ...]:
    """Return what a new product brings: it is known beforehand, so the values are constants."""
    brought: dict[str, Assignment] = {}
    for text in texts:
        for action in meaning.actions([text], meaning.scope({}), TRUE, BROUGHT):
            if not isinstance(action.value, Constant) or action.condition is not None:
                meaning.findings.add(text, message("wrong.brings-constants"))
            if target(action) in brought:
                meaning.findings.add(text, message("wrong.brought-twice", name=target(action)))
            brought[target(action)] = action
    return tuple(brought.values())
