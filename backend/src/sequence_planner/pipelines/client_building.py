"""Services and actions as the station uses them, from their documents and the pipelines of their parts."""

from __future__ import annotations

from collections.abc import Mapping

from sequence_planner.automaton.structure import Automaton, Kind
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.expressions.types import BooleanType, EnumerationType
from sequence_planner.model.documents import ResourceDocument
from sequence_planner.model.source import SourceText
from sequence_planner.pipelines.chains import Findings
from sequence_planner.pipelines.goal_states import GoalState
from sequence_planner.pipelines.graph import ActionUse, IncomingPipeline, OutgoingPipeline, ServiceUse


class ClientBuilding:
    """The services and actions of a station; what is wrong with them is in `findings`."""

    def __init__(self, automaton: Automaton, findings: Findings) -> None:
        self._automaton = automaton
        self._findings = findings
        self.services: dict[str, ServiceUse] = {}
        self.actions: dict[str, ActionUse] = {}

    def add(
        self,
        resource: str,
        document: ResourceDocument,
        incoming: Mapping[str, IncomingPipeline],
        outgoing: Mapping[str, OutgoingPipeline],
    ) -> None:
        """Add those of a resource; the pipelines have all their parts, but for parts with findings."""
        for name, service in document.services.items():
            when = None if service.when is None else self._wanting(resource, service.when)
            request, response = outgoing.get(f"{name} request"), incoming.get(f"{name} response")
            if request is not None and response is not None:
                self.services[str(name)] = ServiceUse(
                    str(name), str(service.type), when, service.every, service.deadline, request, response
                )
        for name, action in document.actions.items():
            when = self._wanting(resource, action.when)
            self._check_status(resource, action.status)
            goal, status = outgoing.get(f"{name} goal"), incoming.get(f"{name} status")
            feedback, result = incoming.get(f"{name} feedback"), incoming.get(f"{name} result")
            if goal is not None and feedback is not None and result is not None and status is not None:
                self.actions[str(name)] = ActionUse(
                    str(name), str(action.type), when, action.deadline, goal, feedback, result, status
                )

    def _wanting(self, resource: str, name: SourceText) -> str:
        """The output that wants something of a device, or a finding."""
        full = f"{resource}.{name}"
        variable = self._automaton.variables.get(full)
        if variable is None:
            own = [v.name.removeprefix(f"{resource}.") for v in self._automaton.variables.values()]
            self._findings.add(name.place, f"`{resource}` has no output `{name}`{suggestion(name, own)}")
        elif variable.kind is not Kind.OUTPUT or not isinstance(variable.type, BooleanType):
            said = f"{variable.kind.value} and {variable.type}"
            self._findings.add(name.place, f"`when` is an output of type bool, and `{full}` is {said}")
        return full

    def _check_status(self, resource: str, name: SourceText) -> None:
        """Whether the variable can say all that may become of a goal."""
        full = f"{resource}.{name}"
        variable = self._automaton.variables.get(full)
        if variable is None or variable.kind is not Kind.MEASURED:
            kind = "not there" if variable is None else variable.kind.value
            self._findings.add(name.place, f"`status` is a measured variable, and `{full}` is {kind}")
        elif not isinstance(variable.type, EnumerationType) or set(variable.type.values) != {*map(str, GoalState)}:
            states = ", ".join(GoalState)
            self._findings.add(
                name.place,
                f"`{full}` says what has become of a goal: it ranges over {{{states}}}, and not {variable.type}; "
                "without a type it does so by itself",
            )
