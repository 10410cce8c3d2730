"""The things that messages say of the variables of a resource: which follow from their fields, and in which
pipelines.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from sequence_planner.editor.symbols.texts import entry, items, marked_in, named_in, pairs, text_at
from sequence_planner.language.records.field_paths import NoFieldError, find_field
from sequence_planner.language.records.record import FieldType
from sequence_planner.language.types import BooleanType, IntegerRange
from sequence_planner.model.source import SourceText
from sequence_planner.model.stages.marks import NameUse
from sequence_planner.model.stages.rename import RenameDocument
from sequence_planner.pipelines.graph import GOAL_STATE
from sequence_planner.pipelines.inference import MOST_VALUES
from sequence_planner.pipelines.message_types import message_fields
from sequence_planner.ros.types.errors import UnknownMessageTypeError
from sequence_planner.ros.types.messages import MessageRegistry


class Pipeline(NamedTuple):
    """A list of stages of a resource, of a topic or a part of a service or an action: `path` is where it stands.

    `called` is what a flow calls it. `fields` are those of the message, if it is known.
    """

    path: tuple[str, ...]
    kind: str
    called: str
    incoming: bool
    stages: object
    ignored: frozenset[str]
    fields: Mapping[str, FieldType] | None


class Inferred(NamedTuple):
    """A variable that nobody declares."""

    section: str
    type: str | None


_PARTS = {
    "services": (("request", "Request", False), ("response", "Response", True)),
    "actions": (("goal", "Goal", False), ("feedback", "Feedback", True), ("result", "Result", True)),
}


def pipelines(resource: object, messages: MessageRegistry | None) -> Iterator[Pipeline]:
    """The pipelines of a resource but for its flows."""
    for name, topic in pairs(entry(resource, "topics")):
        path, type_ = ("topics", str(name)), text_at(topic, "type")
        incoming = entry(topic, "direction") == "in"
        stages, ignored = entry(topic, "pipeline"), _ignored(topic)
        fields = _fields(messages, type_)
        yield Pipeline((*path, "pipeline"), "topic", str(name), incoming, stages, ignored, fields)
    for section, parts in _PARTS.items():
        for name, client in pairs(entry(resource, section)):
            for part, suffix, incoming in parts:
                type_ = text_at(client, "type")
                where, stages = (section, str(name), part), entry(client, part)
                fields = _fields(messages, None if type_ is None else f"{type_}_{suffix}")
                yield Pipeline(where, section[:-1], f"{name} {part}", incoming, stages, _ignored(client), fields)


def inferred(resource: object, messages: MessageRegistry | None) -> dict[str, Inferred]:
    """The variables of a resource that nobody need declare, by name."""
    found: dict[str, Inferred] = {}
    for pipeline in pipelines(resource, messages):
        section = "measured" if pipeline.incoming else "output"
        for variable, type_ in _mapped(pipeline):
            if pipeline.fields is None or _has_few_values(type_):
                found.setdefault(variable, Inferred(section, None))
    for section in ("services", "actions"):
        for _, client in pairs(entry(resource, section)):
            if (when := text_at(client, "when")) is not None:
                found.setdefault(str(when), Inferred("output", None))
    for _, client in pairs(entry(resource, "actions")):
        if (status := text_at(client, "status")) is not None:
            found[str(status)] = Inferred("measured", GOAL_STATE)
    return found


def _fields(messages: MessageRegistry | None, type_: str | None) -> Mapping[str, FieldType] | None:
    if messages is None or type_ is None:
        return None
    try:
        return message_fields(messages, type_)
    except UnknownMessageTypeError:
        return None


def _ignored(document: object) -> frozenset[str]:
    return frozenset(str(each) for each in items(entry(document, "ignore")) if isinstance(each, SourceText))


def _mapped(pipeline: Pipeline) -> Iterator[tuple[str, FieldType | None]]:
    """The names that become variables without being declared, each with the type of its field if that is known."""
    used = set(pipeline.ignored)
    renamed: list[tuple[str, str]] = []
    for stage in items(pipeline.stages):
        if moved := pairs(entry(stage, RenameDocument.kind)):
            renamed += [(str(field), str(name)) for field, name in moved]
        else:
            used |= named_in(marked_in([stage]), pipeline.incoming, NameUse.CONSUMED, NameUse.COMBINED, NameUse.GIVEN)
    used |= {field for field, _ in renamed}
    for field, variable in renamed:
        if pipeline.fields is None:
            yield variable, None
            continue
        try:
            yield variable, find_field(pipeline.fields, field)[1]
        except NoFieldError:
            continue
    for name, type_ in (pipeline.fields or {}).items():
        if name not in used:
            yield name, type_


def _has_few_values(type_: FieldType | None) -> bool:
    match type_:
        case BooleanType():
            return True
        case IntegerRange(low, high):
            return high - low < MOST_VALUES
    return False
