"""The names of overrides: a person sets them by resource and name, so a resource has each name once."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from sequence_planner.model.documents import ResourceDocument
from sequence_planner.model.source import SourceText
from sequence_planner.model.stage_documents import StageDocument
from sequence_planner.pipelines.chains import Findings


def check_override_names(resources: Iterable[ResourceDocument], findings: Findings) -> None:
    """Note names that a resource gives to several overrides."""
    for resource in resources:
        known: dict[str, SourceText] = {}
        for name in _names(resource):
            if name in known:
                first = known[name].place
                message = (
                    f"`{name}` is the name of another override of this resource (line {first.line}): choose another"
                )
                findings.add(name.place, message)
            known.setdefault(name, name)


def _names(resource: ResourceDocument) -> Iterator[SourceText]:
    pipelines: list[list[StageDocument]] = [topic.pipeline for topic in resource.topics.values()]
    pipelines += [flow.pipeline for flow in resource.flows.values()]
    for pipeline in pipelines:
        for stage in pipeline:
            if stage.override is not None:
                yield stage.override.name
