"""The fields of sequences and of work masters: names of operations, and of sequences, in an order."""

from __future__ import annotations

from collections.abc import Collection

from sequence_planner.automaton.findings import with_arguments
from sequence_planner.automaton.grounding.meaning import Meaning
from sequence_planner.automaton.grounding.operations import BROUGHT, brought_by, check_steps, station_sequences
from sequence_planner.automaton.sequences.expansion import Steps
from sequence_planner.editor.language.field import FieldKind, TextField, field_of_parameter, placed, with_text
from sequence_planner.language.names.scope import NameScope
from sequence_planner.model.documents import Parameters, WorkMasterDocument
from sequence_planner.model.loader import Station
from sequence_planner.model.sequences import KINDS, SequencePart
from sequence_planner.model.source import SourceText
from sequence_planner.model.yaml.reader import EntryPath


def field_of_sequence(station: Station, path: EntryPath, operations: Collection[str]) -> TextField | None:
    """The field at `path` of a sequence in `operations.yaml`; None where an operation stands there."""
    match path:
        case (str(name), str(key), *rest) if key in (*KINDS, "for"):
            return _of_part(station, station.sequences.get(placed(name)), (key, *rest), operations, (name,))
    return None


def _of_part(
    station: Station, part: SequencePart | None, path: EntryPath, operations: Collection[str], names: tuple[str, ...]
) -> TextField | None:
    parameters: Parameters = {}
    while True:
        parameters = {**parameters, **({} if part is None else part.each)}
        match path:
            case ("for", str(parameter)):
                return field_of_parameter(parameter)
            case (str(), int()) | (str(),) if path[0] in KINDS:
                return _of_branch(station, parameters, operations, names)
            case (str(), int(index), *rest):
                branches = [] if part is None else part.branches
                inner = branches[index] if index < len(branches) else None
            case (str(), *rest):
                inner = part and part.branches[0]
            case _:
                return None
        part, path = inner if isinstance(inner, SequencePart) else None, tuple(rest)


def _of_branch(
    station: Station, parameters: Parameters, operations: Collection[str], names: tuple[str, ...]
) -> TextField:
    """An operation with its arguments, or another sequence."""

    def branch(meaning: Meaning, text: SourceText, scope: NameScope) -> None:
        station_sequences(meaning, station, operations).reader.branch(text, scope.parameters, names)

    written = {str(parameter): str(enumeration) for parameter, enumeration in parameters.items()}
    over = [
        with_arguments(str(name), own)
        for name, document in station.operations.items()
        if document.parameters and (own := _fitting(document.parameters, written)) is not None
    ]
    others = [str(each) for each in station.sequences if each not in names]
    return TextField(FieldKind.OPERATION, branch, parameters, choices=(*over, *operations, *others))


def _fitting(wanted: Parameters, written: dict[str, str]) -> list[str] | None:
    """Parameters that can be the arguments of an operation, or None where there are not enough."""
    found = [next((name for name, own in written.items() if own == each), None) for each in wanted.values()]
    return None if None in found else [str(each) for each in found]


def field_of_work_master(
    station: Station, path: EntryPath, operations: Collection[str], meaning: Meaning
) -> TextField | None:
    """The field at `path` of `work_masters.yaml`. An operation of the job is the name of its entry."""
    match path:
        case (str(name), *rest):
            document = station.work_masters.get(placed(name))
            if rest and rest[0] in (*KINDS, "for"):
                return _of_part(station, document, tuple(rest), operations, ())
            if rest and rest[0] == "orders":
                orders = [] if document is None else document.orders or []
                match rest[1:]:
                    case (int(index), *inner):
                        part = orders[index] if index < len(orders) else None
                        return _of_part(station, part, tuple(inner), operations, ())
                return None
            steps: Steps = {}
            if document is not None:
                steps = station_sequences(meaning, station, operations).order_of(document, name).steps
            return _of_work_master(document, steps, tuple(rest), operations)
    return None


def _of_work_master(
    document: WorkMasterDocument | None, steps: Steps, path: EntryPath, operations: Collection[str]
) -> TextField | None:
    match path:
        case ("brings", int(index)):
            texts = [] if document is None else document.brings

            def bring(meaning: Meaning, text: SourceText, scope: NameScope) -> object:
                return brought_by(meaning, with_text(texts, index, text))

            return TextField(FieldKind.ACTION, bring, writing=BROUGHT)
        case ("operations", str(name)):

            def step(meaning: Meaning, text: SourceText, scope: NameScope) -> None:
                renamed = {text if each == name else each: before for each, before in steps.items()}
                check_steps(meaning, renamed if name in steps else {**steps, text: ()}, operations)

            return TextField(FieldKind.OPERATION, step, choices=tuple(operations))
        case ("operations", str(name), "after", int(index)):

            def before(meaning: Meaning, text: SourceText, scope: NameScope) -> None:
                key = placed(name)
                others = with_text(steps.get(key, ()), index, text)
                check_steps(meaning, {**steps, key: tuple(others)}, operations)

            choices = tuple(str(each) for each in steps if each != name)
            return TextField(FieldKind.OPERATION, before, choices=choices)
    return None
