"""Variables inferred from message types: what a topic's fields are, a resource need not say again.

A field of truth values, or of integers with few values, is a variable of its name (or of the one that `rename` gives
it). What is written in the resource refines it: a narrower type, an initial value. A field of texts or of many numbers
is a variable only where the resource says of which type, and one within another message only where `rename` says so.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from sequence_planner.automaton.declarations import FLAGS
from sequence_planner.language.records.field_paths import NoFieldError, find_field
from sequence_planner.language.records.record import FieldType, RecordType
from sequence_planner.language.types import BooleanType, IntegerRange
from sequence_planner.model.documents import ResourceDocument, TopicDocument, VariableDocument
from sequence_planner.model.loader import Station
from sequence_planner.model.source import Finding, ModelError, SourceText
from sequence_planner.model.stages.marks import NameUse
from sequence_planner.model.stages.rename import RenameDocument
from sequence_planner.model.types.names import depends_on_arguments, unknown_names
from sequence_planner.pipelines.client_builder import (
    client_findings,
    parts,
    with_client_variables,
    with_goal_states,
)
from sequence_planner.pipelines.message_types import message_fields
from sequence_planner.ros.types.errors import UnknownMessageTypeError
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.texts.message import message

MOST_VALUES = 256  # of an integer that becomes a variable by itself: those of eight bits


def with_inferred_variables(station: Station, registry: MessageRegistry) -> Station:
    """`station` with its variables completed. Raises `ModelError` for topics of unknown message types."""
    completed, findings = variables_inferred(station, registry)
    if findings:
        raise ModelError(findings)
    return completed


def variables_inferred(station: Station, registry: MessageRegistry) -> tuple[Station, list[Finding]]:
    """`station` with its variables completed as far as they can be, and what is wrong with its topics."""
    findings: list[Finding] = []
    for document in station.resources.values():
        findings += client_findings(document, registry)
    resources = {name: _completed(document, registry, findings) for name, document in station.resources.items()}
    return with_goal_states(replace(station, resources=resources)), findings


def wrong_in_unused_types(station: Station, registry: MessageRegistry) -> list[Finding]:
    """What is wrong with the names in conditions and actions of types that no instance has, and with the messages that
    some of these follow from; `station` is as it was written, and nothing is wrong with its topics.
    """
    found: dict[Finding, None] = {}
    for name, unused in station.unused.items():
        if depends_on_arguments(unused.document):
            continue
        called = next(each for each in (name, f"{name} of the type") if each not in station.resources)
        resources = {**station.resources, called: unused.document}
        completed, wrong = variables_inferred(replace(station, resources=resources), registry)
        if not wrong:
            wrong = unknown_names(unused, completed.resources[called], completed)
        elif unused.package:  # a station that has the messages may use it
            wrong = []
        found |= dict.fromkeys(wrong)
    return list(found)


def _completed(document: ResourceDocument, registry: MessageRegistry, findings: list[Finding]) -> ResourceDocument:
    sections = {"measured": dict(document.measured), "output": dict(document.output)}
    for name, topic in (*document.topics.items(), *parts(document, registry).items()):
        kind, other = ("measured", "output") if topic.direction == "in" else ("output", "measured")
        section = sections[kind]
        try:
            fields = message_fields(registry, topic.type)
        except UnknownMessageTypeError as error:
            near = message("hint.meant", name=error.suggestion) if error.suggestion else ""
            findings.append(
                Finding(topic.type.place, message("wrong.no-message-type", name=str(topic.type), hint=near))
            )
            continue
        for field, variable, type_ in _mapped(name, topic, fields):
            text = _type(type_, variable)
            declared = section.get(variable)
            if declared is not None:
                if declared.type is None:
                    section[variable] = declared.model_copy(update={"type": text})
            elif text is not None and variable not in document.estimated and variable not in getattr(document, other):
                if clash := _clash(document, variable, sections[other]):
                    said = message(
                        f"wrong.field-clashes.{clash}", field=field, type=str(topic.type), variable=str(variable)
                    )
                    findings.append(Finding(variable.place, said))
                else:
                    section[variable] = VariableDocument(type=text)
    return with_client_variables(document.model_copy(update=sections))


def _clash(document: ResourceDocument, name: SourceText, other: Mapping[SourceText, VariableDocument]) -> str | None:
    """Return what bears the name already that a field would give to a variable, as texts are named for it."""
    if name in FLAGS:
        return "flag"
    if name in document.abilities:
        return "ability"
    return "direction" if name in other else None


def _mapped(
    topic: SourceText, document: TopicDocument, fields: RecordType
) -> Iterator[tuple[str, SourceText, FieldType]]:
    """The fields that no stage uses up and none is to be ignored, each with the name of its variable."""
    renamed: dict[SourceText, SourceText] = {}
    used = set(map(str, document.ignore))
    for stage in document.pipeline:
        content = stage.content
        if isinstance(content, RenameDocument):
            renamed |= content.names
            used |= set(map(str, content.names))
        else:
            names = stage.named(document.direction == "in", NameUse.CONSUMED, NameUse.COMBINED, NameUse.GIVEN)
            used |= set(map(str, names))
    for field, variable in renamed.items():
        try:
            yield str(field), variable, find_field(fields, field)[1]
        except NoFieldError:
            continue  # the stage says so
    for name, type_ in fields.items():
        if name not in used:
            yield name, SourceText(name, topic.place, name), type_


def _type(field: FieldType, variable: SourceText) -> SourceText | None:
    """The type of a variable for `field`, written at the place of `variable`."""
    text = None
    match field:
        case BooleanType():
            text = "bool"
        case IntegerRange(low, high) if high - low < MOST_VALUES:
            text = f"{low}..{high}"
    return None if text is None else SourceText(text, variable.place, text)
