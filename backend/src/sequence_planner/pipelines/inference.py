"""Variables inferred from message types: what a topic's fields are, a resource need not say again.

A field of truth values, or of integers with few values, is a variable of its name (or of the one that `rename` gives
it). What is written in the resource refines it: a narrower type, an initial value. A field of texts or of many numbers
is a variable only where the resource says of which type.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from sequence_planner.automaton.grounding.declarations import FLAGS
from sequence_planner.model.documents import ResourceDocument, TopicDocument, VariableDocument
from sequence_planner.model.loading import Station
from sequence_planner.model.source import Finding, ModelError, SourceText
from sequence_planner.ros.errors import UnknownMessageTypeError
from sequence_planner.ros.fields import FieldType
from sequence_planner.ros.messages import MessageRegistry

MOST_VALUES = 256  # of an integer that becomes a variable by itself: those of eight bits


def with_inferred_variables(station: Station, registry: MessageRegistry) -> Station:
    """`station` with its variables completed. Raises `ModelError` for topics of unknown message types."""
    findings: list[Finding] = []
    resources = {name: _completed(document, registry, findings) for name, document in station.resources.items()}
    if findings:
        raise ModelError(findings)
    return replace(station, resources=resources)


def _completed(document: ResourceDocument, registry: MessageRegistry, findings: list[Finding]) -> ResourceDocument:
    sections = {"measured": dict(document.measured), "output": dict(document.output)}
    for name, topic in document.topics.items():
        kind, other = ("measured", "output") if topic.direction == "in" else ("output", "measured")
        section = sections[kind]
        try:
            fields = registry.fields(topic.type)
        except UnknownMessageTypeError as error:
            near = f"; did you mean `{error.suggestion}`?" if error.suggestion else ""
            findings.append(Finding(topic.type.place, f"no message type `{topic.type}` is known{near}"))
            continue
        for field, variable, type_ in _mapped(name, topic, fields):
            text = _type(type_, variable)
            declared = section.get(variable)
            if declared is not None:
                if declared.type is None:
                    section[variable] = declared.model_copy(update={"type": text})
            elif text is not None and variable not in document.estimated and variable not in getattr(document, other):
                if clash := _clash(document, variable, sections[other]):
                    remedy = f"leave it out with `ignore: [{field}]`, or `rename` it"
                    message = (
                        f"the field `{field}` of `{topic.type}` would be a variable `{variable}`, and {clash}: {remedy}"
                    )
                    findings.append(Finding(variable.place, message))
                else:
                    section[variable] = VariableDocument(type=text)
    return document.model_copy(update=sections)


def _clash(document: ResourceDocument, name: SourceText, other: Mapping[SourceText, VariableDocument]) -> str | None:
    """What bears the name already that a field would give to a variable."""
    if name in FLAGS:
        return "that is a flag of every ability"
    if name in document.abilities:
        return "an ability has that name"
    return "a field of a topic in the other direction is one already" if name in other else None


def _mapped(
    topic: SourceText, document: TopicDocument, fields: Mapping[str, FieldType]
) -> Iterator[tuple[str, SourceText, FieldType]]:
    """The fields that no stage uses and none is to be ignored, each with the name of its variable."""
    names: dict[str, SourceText] = {}
    used = set(map(str, document.ignore))
    for stage in document.pipeline:
        names |= {str(field): variable for field, variable in (stage.rename or {}).items()}
        used |= set(map(str, stage.constant or ()))
        used |= {str(each.field) for each in (stage.discretise, stage.undiscretise) if each is not None}
    for field, type_ in fields.items():
        if field not in used:
            yield field, names.get(field) or SourceText(field, topic.place, field), type_


def _type(field: FieldType, variable: SourceText) -> SourceText | None:
    """The type of a variable for `field`, written at the place of `variable`."""
    text = None
    if field.array is None and field.kind == "bool":
        text = "bool"
    elif field.array is None and field.range is not None:
        low, high = field.range
        text = f"{low}..{high}" if high - low < MOST_VALUES else None
    return None if text is None else SourceText(text, variable.place, text)
