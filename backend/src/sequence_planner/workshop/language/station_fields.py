"""The fields of the documents beside the resources: station, operations, specifications and work masters."""

from __future__ import annotations

from collections.abc import Collection

from sequence_planner.automaton.grounding.meaning import Meaning
from sequence_planner.automaton.grounding.operations import BROUGHT, Steps, brought_by, check_steps, steps_of
from sequence_planner.automaton.grounding.specifications import exclusive_abilities
from sequence_planner.automaton.structure import Kind
from sequence_planner.expressions.resolution import Scope
from sequence_planner.model.documents import Parameters, SpecificationDocument, WorkMasterDocument
from sequence_planner.model.loading import Station
from sequence_planner.model.reading import EntryPath
from sequence_planner.model.source import SourceText
from sequence_planner.workshop.language.field import Field, FieldKind, condition, with_text
from sequence_planner.workshop.language.resource_fields import field_of_parameter, field_of_variable, placed


def field_of_station(station: Station, path: EntryPath, meaning: Meaning) -> Field | None:
    """The field at `path` of `station.yaml`."""
    match path:
        case ("rest",):
            return Field(FieldKind.CONDITION, condition)
        case ("estimated", str(name), *rest):
            documents = station.station.estimated
            return field_of_variable(None, name, documents, Kind.ESTIMATED, tuple(rest), meaning)
    return None


def field_of_operation(station: Station, path: EntryPath, given: Parameters | None) -> Field | None:
    """The field at `path` of `operations.yaml`."""
    match path:
        case (str(name), "precondition" | "goal" | "local" as part):
            document = station.operations.get(placed(name))
            written = {} if document is None else document.parameters
            parameters = written if given is None else given
            if part == "local":
                return Field(FieldKind.FORMULA, Meaning.formula, parameters, operation=name)
            return Field(FieldKind.CONDITION, condition, parameters, operation=name)
        case (str(), "parameters", str(parameter)):
            return field_of_parameter(parameter)
    return None


def field_of_specification(station: Station, path: EntryPath, given: Parameters | None) -> Field | None:
    """The field at `path` of `specifications.yaml`."""
    match path:
        case (str(name), *rest):
            document = station.specifications.get(placed(name))
            written = {} if document is None else document.parameters
            parameters = written if given is None else given
            return _of_specification(station, document, tuple(rest), parameters)
    return None


def _of_specification(
    station: Station, document: SpecificationDocument | None, path: EntryPath, parameters: Parameters
) -> Field | None:
    match path:
        case ("forbidden" | "never" | "while",) | ("order", int()):
            return Field(FieldKind.CONDITION, condition, parameters)
        case ("zone", str(resource)):
            # Where the resource is none, that is found at its name, and the condition is not read.
            read = condition if resource in station.resources else _unread
            return Field(FieldKind.CONDITION, read, parameters, resource)
        case ("exclusive", int(index)):
            texts = (document and document.exclusive) or []
            return Field(
                FieldKind.ABILITY,
                lambda meaning, text, scope: exclusive_abilities(meaning, with_text(texts, index, text), scope),
                parameters,
            )
        case ("parameters", str(parameter)):
            return field_of_parameter(parameter)
    return None


def _unread(meaning: Meaning, text: SourceText, scope: Scope) -> object:
    return None


def field_of_work_master(station: Station, path: EntryPath, operations: Collection[str]) -> Field | None:
    """The field at `path` of `work_masters.yaml`. An operation of the job is the name of its entry."""
    match path:
        case (str(name), *rest):
            document = station.work_masters.get(placed(name))
            steps: Steps = {} if document is None else steps_of(document)
            return _of_work_master(document, steps, tuple(rest), operations)
    return None


def _of_work_master(
    document: WorkMasterDocument | None, steps: Steps, path: EntryPath, operations: Collection[str]
) -> Field | None:
    match path:
        case ("brings", int(index)):
            texts = [] if document is None else document.brings

            def bring(meaning: Meaning, text: SourceText, scope: Scope) -> object:
                return brought_by(meaning, with_text(texts, index, text))

            return Field(FieldKind.ACTION, bring, writing=BROUGHT)
        case ("operations", str(name)):

            def step(meaning: Meaning, text: SourceText, scope: Scope) -> None:
                renamed = {text if each == name else each: before for each, before in steps.items()}
                check_steps(meaning, renamed if name in steps else {**steps, text: ()}, operations)

            return Field(FieldKind.OPERATION, step, choices=tuple(operations))
        case ("operations", str(name), "after", int(index)):

            def before(meaning: Meaning, text: SourceText, scope: Scope) -> None:
                key = placed(name)
                others = with_text(steps.get(key, ()), index, text)
                check_steps(meaning, {**steps, key: tuple(others)}, operations)

            choices = tuple(str(each) for each in steps if each != name)
            return Field(FieldKind.OPERATION, before, choices=choices)
    return None
