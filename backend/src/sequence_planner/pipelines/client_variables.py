"""The variables that services and actions need: outputs that want something, and states of goals."""

from __future__ import annotations

from dataclasses import replace

from sequence_planner.expressions.place import Place
from sequence_planner.model.documents import ResourceDocument, VariableDocument
from sequence_planner.model.loading import Station
from sequence_planner.model.source import SourceText
from sequence_planner.pipelines.goal_states import GOAL_STATE, GoalState


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
