"""The overrides of a running station: what a person may set, what is set, and setting it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from sequence_planner.controller.commands.command import CommandRefused, handles
from sequence_planner.controller.commands.execution import ClearOverride, SetOverride
from sequence_planner.controller.io.clients import Clients
from sequence_planner.controller.io.inputs import Inputs
from sequence_planner.controller.io.outputs import Outputs
from sequence_planner.controller.views.station import OverrideFieldView, OverrideView
from sequence_planner.controller.views.wording import hint_of
from sequence_planner.core.clock import Timestamp
from sequence_planner.model.stages.base import Override, Overriding
from sequence_planner.model.stages.timing import Bounds, OverrideStage
from sequence_planner.pipelines.graph import Chain, IncomingPipeline, StationPipelines
from sequence_planner.pipelines.runtime import RunningPipelines
from sequence_planner.texts.message import message


@dataclass(frozen=True)
class _Known:
    """An override as the model has it, and the pipeline it stands in."""

    pipeline: str
    resource: str
    is_outgoing: bool
    stage: OverrideStage


class Overrides:
    """All overrides, by resource and name as in `ur10.speed`."""

    def __init__(self, pipelines: StationPipelines, feeds: Inputs, commander: Outputs, clients: Clients) -> None:
        self._feeds = feeds
        self._commander = commander
        self._clients = clients
        self._known: dict[str, _Known] = {}
        self._until: dict[str, tuple[Override, float]] = {}  # seconds since the epoch, told the same each time
        for node in pipelines.nodes:
            resource = node.topic.resource if isinstance(node, IncomingPipeline) else node.resource
            self._add(node.name, resource, False, node.chain)
        for name, outgoing in {**pipelines.outgoing, **pipelines.requests}.items():
            self._add(name, outgoing.topic.resource, True, outgoing.chain)

    def _add(self, pipeline: str, resource: str, is_outgoing: bool, chain: Chain) -> None:
        for stage in chain.stages:
            if isinstance(stage, OverrideStage):
                self._known[f"{resource}.{stage.name}"] = _Known(pipeline, resource, is_outgoing, stage)

    @handles(SetOverride)
    def set(self, command: SetOverride, moment: Timestamp) -> None:
        """Set the fields within their bounds."""
        known = self._find(command.name)
        change = self._holder(known).set_override
        try:
            change(known.pipeline, known.stage.name, command.fields, moment.monotonic, command.actor.name)
        except ValueError as error:
            raise CommandRefused(
                "out-of-bounds", message("refused.out-of-bounds.why", name=command.name, why=str(error)), 422
            ) from error

    @handles(ClearOverride)
    def clear(self, command: ClearOverride, moment: Timestamp) -> None:
        """Take back what is set, if anything is."""
        known = self._find(command.name)
        self._holder(known).clear_override(known.pipeline, known.stage.name, moment.monotonic)

    def _holder(self, known: _Known) -> Outputs | Clients | RunningPipelines:
        """Return where the pipeline runs."""
        if known.pipeline in self._clients.requests:
            return self._clients
        return self._commander if known.is_outgoing else self._feeds.running

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        return {"overrides": self.view(moment)}

    def view(self, moment: Timestamp) -> dict[str, OverrideView]:
        """All overrides as they are now."""
        return {name: self._view(name, known, moment) for name, known in self._known.items()}

    def _view(self, name: str, known: _Known, moment: Timestamp) -> OverrideView:
        override = self._set_now(known)
        if override is None or override.until <= moment.monotonic:
            return _view(known, None, None)  # it has expired, though time has not been let pass in its pipeline since
        if name not in self._until or self._until[name][0] is not override:
            self._until[name] = (override, moment.epoch + override.until - moment.monotonic)
        return _view(known, *self._until[name])

    def _set_now(self, known: _Known) -> Override | None:
        courses: Mapping[str, Overriding]
        if known.pipeline in self._clients.requests:
            courses = self._clients.requests[known.pipeline].chain.overrides
        elif known.is_outgoing:
            courses = self._commander.topics[known.pipeline].running.chain.overrides
        else:
            courses = self._feeds.running.overrides(known.pipeline)
        return courses[known.stage.name].override

    def _find(self, name: str) -> _Known:
        if name not in self._known:
            raise CommandRefused(
                "no-override",
                message(
                    "refused.no-override.name", name=name, hint=hint_of(name, self._known, message("hint.none-such"))
                ),
                404,
            )
        return self._known[name]


def _view(known: _Known, override: Override | None, until: float | None) -> OverrideView:
    values = {} if override is None else override.fields
    return OverrideView(
        pipeline=known.pipeline,
        resource=known.resource,
        expires=known.stage.expires,
        fields={
            name: _field(str(known.stage.gives[name]), bounds, values.get(name))
            for name, bounds in known.stage.bounds.items()
        },
        actor=None if override is None else override.actor,
        until=until,
    )


def _field(type_: str, bounds: Bounds, value: object) -> OverrideFieldView:
    return OverrideFieldView(
        type=type_,
        between=bounds.between,
        among=[each for each in bounds.among if isinstance(each, bool | int | float | str)] if bounds.among else None,
        value=value if isinstance(value, bool | int | float | str) else None,
    )
