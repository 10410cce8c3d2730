"""Builder of service and action clients: their parts as topics, and their required variables."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial

from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.types import Place
from sequence_planner.model.documents import (
    ActionDocument,
    ResourceDocument,
    ServiceDocument,
    TopicDocument,
    VariableDocument,
)
from sequence_planner.model.loader import Station
from sequence_planner.model.source import Finding, SourceText
from sequence_planner.model.stages.registry import StageDocument
from sequence_planner.pipelines.graph import GOAL_STATE, STATUS_FIELD, STATUS_TYPE, GoalState
from sequence_planner.ros.types.errors import UnknownMessageTypeError
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.texts.message import message

# The parts of services and actions, each written as the topic it is like.
#
# A request or a goal is made of variables as an outgoing message is, and an answer is read as an incoming one. Their
# names, such as `/mir/state request`, are none that a topic can have.

Topics = Mapping[SourceText, TopicDocument]


def is_part(name: str) -> bool:
    """Return whether a pipeline is not that of a topic."""
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
        near = message("hint.meant", name=error.suggestion) if error.suggestion else ""
        yield Finding(document.type.place, message(f"wrong.no-{kind}-type", name=str(document.type), hint=near))
        return
    for field in document.ignore:
        if field not in fields:
            yield Finding(
                field.place, message(f"wrong.no-{kind}-field", name=str(field), hint=suggestion(field, fields))
            )


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


# The variables that services and actions need: outputs that want something, and states of goals.


def with_client_variables(document: ResourceDocument) -> ResourceDocument:
    """The resource with each `when` as an output and each `status` as a measured variable, unless the name is taken."""
    output, measured = dict(document.output), dict(document.measured)
    declared = {*document.output, *document.measured, *document.estimated}
    called = [service.when for service in document.services.values() if service.when is not None]
    for name in (*called, *(action.when for action in document.actions.values())):
        if name not in declared:
            output[name] = _typed("bool", name.place)
    for action in document.actions.values():
        written = measured.get(action.status)
        if written is not None and written.type is None:
            type_ = _typed(GOAL_STATE, action.status.place).type
            measured[action.status] = written.model_copy(update={"type": type_})
        elif action.status not in declared:
            measured[action.status] = _typed(GOAL_STATE, action.status.place)
    return document.model_copy(update={"output": output, "measured": measured})


def with_goal_states(station: Station) -> Station:
    """The station with the enumeration of the states of goals, if it has an action and none of that name."""
    enumerations = station.station.enumerations
    places = [action.status.place for each in station.resources.values() for action in each.actions.values()]
    if not places or GOAL_STATE in enumerations:
        return station
    values = [SourceText(state, places[0], state) for state in GoalState]
    added = {**enumerations, SourceText(GOAL_STATE, places[0], GOAL_STATE): values}
    return replace(station, station=station.station.model_copy(update={"enumerations": added}))


def _typed(type_: str, place: Place) -> VariableDocument:
    return VariableDocument(type=SourceText(type_, place, type_))
