"""Builds what only looks at a station that runs: traces of variables, the traffic on pipelines, its picture."""

from __future__ import annotations

from sequence_planner.controller.features.variables import Variables
from sequence_planner.controller.io.devices import Devices
from sequence_planner.controller.io.traffic import LivePicture, PipelineTraffic, WrittenShifts
from sequence_planner.controller.recovery.explain import ConditionContext
from sequence_planner.controller.tracing.traces import Traces
from sequence_planner.execution.executor import Executor
from sequence_planner.station import ReadyStation


def build_lookers(
    execution: Executor, station: ReadyStation, devices: Devices, variables: Variables, around: ConditionContext
) -> tuple[object, ...]:
    """Build features that answer questions, and have no commands, alarms and parts of the view."""
    return (
        Traces(execution, station.pipelines, devices, variables, around),
        PipelineTraffic(station.pipelines, devices),
        LivePicture(station),
        WrittenShifts(station),
    )
