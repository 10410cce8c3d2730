"""The parts of services and actions, each written as the topic it is like.

A request or a goal is made of variables as an outgoing message is, and an answer is read as an incoming one. Their
names, such as `/mir/state request`, are none that a topic can have.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial

from sequence_planner.expressions.resolution import suggestion
from sequence_planner.model.client_documents import ActionDocument, ServiceDocument
from sequence_planner.model.documents import ResourceDocument, TopicDocument
from sequence_planner.model.source import Finding, SourceText
from sequence_planner.model.stage_documents import StageDocument
from sequence_planner.pipelines.goal_states import STATUS_FIELD, STATUS_TYPE
from sequence_planner.ros.errors import UnknownMessageTypeError
from sequence_planner.ros.messages import MessageRegistry

Topics = Mapping[SourceText, TopicDocument]


def is_part(name: str) -> bool:
    """Whether a pipeline is not that of a topic."""
    return " " in name


def client_of(name: str) -> str:
    """The name of the service or action of a part."""
    return name.rpartition(" ")[0]


def parts_of_service(name: SourceText, document: ServiceDocument, registry: MessageRegistry) -> Topics:
    """The request and the response of a service whose type is known."""
    type_ = registry.service(document.type)
    return {
        _named(name, "request"): _topic(document, type_.request, "out", document.request, registry),
        _named(name, "response"): _topic(document, type_.response, "in", document.response, registry),
    }


def parts_of_action(name: SourceText, document: ActionDocument, registry: MessageRegistry) -> Topics:
    """The goal, the feedback, the result and the status of an action whose type is known."""
    type_, status = registry.action(document.type), document.status
    key, field = (SourceText(text, status.place, text) for text in ("rename", STATUS_FIELD))
    told = StageDocument.model_validate({key: {field: status}})
    return {
        _named(name, "goal"): _topic(document, type_.goal, "out", document.goal, registry),
        _named(name, "feedback"): _topic(document, type_.feedback, "in", document.feedback, registry),
        _named(name, "result"): _topic(document, type_.result, "in", document.result, registry),
        _named(name, "status"): TopicDocument(
            type=SourceText(STATUS_TYPE, status.place, STATUS_TYPE), direction="in", pipeline=[told]
        ),
    }


def parts(document: ResourceDocument, registry: MessageRegistry) -> dict[SourceText, TopicDocument]:
    """The parts of all services and actions of a resource, but for those whose type is unknown."""
    found: dict[SourceText, TopicDocument] = {}
    for name, service in document.services.items():
        if service.type in registry.service_names():
            found |= parts_of_service(name, service, registry)
    for name, action in document.actions.items():
        if action.type in registry.action_names():
            found |= parts_of_action(name, action, registry)
    return found


def client_findings(document: ResourceDocument, registry: MessageRegistry) -> Iterator[Finding]:
    """The types of services and actions that nobody knows, and what is ignored and is not there."""
    for name, service in document.services.items():
        yield from _findings("service", service, partial(parts_of_service, name, service, registry), registry)
    for name, action in document.actions.items():
        yield from _findings("action", action, partial(parts_of_action, name, action, registry), registry)


def _findings(
    kind: str, document: ServiceDocument | ActionDocument, made: Callable[[], Topics], registry: MessageRegistry
) -> Iterator[Finding]:
    try:
        fields = {field for part in made().values() for field in registry.fields(part.type)}
    except UnknownMessageTypeError as error:
        near = f"; did you mean `{error.suggestion}`?" if error.suggestion else ""
        yield Finding(document.type.place, f"no {kind} type `{document.type}` is known{near}")
        return
    for field in document.ignore:
        if field not in fields:
            yield Finding(field.place, f"the {kind} has no field `{field}`{suggestion(field, fields)}")


def _named(name: SourceText, part: str) -> SourceText:
    return SourceText(f"{name} {part}", name.place, name.raw)


def _topic(
    document: ServiceDocument | ActionDocument,
    type_name: str,
    direction: str,
    stages: Sequence[StageDocument],
    registry: MessageRegistry,
) -> TopicDocument:
    fields = registry.fields(type_name)
    return TopicDocument(
        type=SourceText(type_name, document.type.place, document.type.raw),
        direction="in" if direction == "in" else "out",
        ignore=[field for field in document.ignore if field in fields],
        pipeline=list(stages),
    )
