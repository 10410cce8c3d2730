"""Ground operations, and the work masters that put them into jobs."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from graphlib import CycleError, TopologicalSorter

from sequence_planner.automaton.grounding.declarations import OPERATION
from sequence_planner.automaton.grounding.findings import instance_name, readable
from sequence_planner.automaton.grounding.meaning import Meaning, Writing
from sequence_planner.automaton.structure import Kind, Operation, WorkMaster, target
from sequence_planner.expressions.place import Place
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.expressions.syntax import TRUE, Assignment, Constant
from sequence_planner.model.documents import OperationDocument, Predicate, WorkMasterDocument
from sequence_planner.model.source import SourceText

BROUGHT = Writing("a new product", (Kind.ESTIMATED,))
Steps = Mapping[SourceText, tuple[SourceText, ...]]


def ground_operations(meaning: Meaning, documents: Mapping[SourceText, OperationDocument]) -> dict[str, Operation]:
    """All operations by name."""
    return {operation.name: operation for operation in _operations(meaning, documents)}


def ground_work_masters(
    meaning: Meaning, documents: Mapping[SourceText, WorkMasterDocument], operations: Mapping[str, Operation]
) -> dict[str, WorkMaster]:
    """All work masters by name."""
    masters: dict[str, WorkMaster] = {}
    for name, document in documents.items():
        meaning.declarations.check_name(name)
        steps = steps_of(document)
        check_steps(meaning, steps, operations)
        masters[str(name)] = WorkMaster(
            str(name),
            readable(document.title, name, {}),
            {str(step): frozenset(map(str, before)) for step, before in steps.items()},
            brought_by(meaning, document.brings),
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
                places[f"{OPERATION}.{full}.local"] = _place(document.local, name)
            yield Operation(
                full,
                readable(document.title, name, binding),
                meaning.predicate(document.precondition, scope),
                meaning.predicate(document.goal, scope),
                document.priority,
                None if document.local is None else meaning.formula(document.local, scope),
                document.repeat,
            )


def _place(text: Predicate, otherwise: SourceText) -> Place:
    return text.place if isinstance(text, SourceText) else otherwise.place


def steps_of(document: WorkMasterDocument) -> Steps:
    """The operations of a job, each with those before it."""
    return {
        step: () if step_document is None else tuple(step_document.after)
        for step, step_document in document.operations.items()
    }


def check_steps(meaning: Meaning, steps: Steps, operations: Collection[str]) -> None:
    """Note steps that are none of the `operations`, and those that come before themselves."""
    findings = meaning.findings
    for step, before in steps.items():
        if step not in operations:
            findings.add(step, f"there is no operation `{step}`{suggestion(step, operations)}")
        for each in before:
            if each not in steps:
                findings.add(each, f"`{each}` is no operation of this job{suggestion(each, map(str, steps))}")
    try:
        TopologicalSorter({str(step): map(str, before) for step, before in steps.items()}).prepare()
    except CycleError as error:
        circle = [str(name) for name in reversed(error.args[1])]
        first = next(step for step in steps if step == circle[0])
        findings.add(first, f"each of these would have to come before the next: {' → '.join(circle)}")


def brought_by(meaning: Meaning, texts: Iterable[SourceText]) -> tuple[Assignment, ...]:
    """What a new product brings: it is known beforehand, so the values are constants."""
    brought: dict[str, Assignment] = {}
    for text in texts:
        for action in meaning.actions([text], meaning.scope({}), TRUE, BROUGHT):
            if not isinstance(action.value, Constant) or action.condition is not None:
                meaning.findings.add(text, "a new product brings certain values: write `variable := value`")
            if target(action) in brought:
                meaning.findings.add(text, f"`{target(action)}` is brought twice")
            brought[target(action)] = action
    return tuple(brought.values())
