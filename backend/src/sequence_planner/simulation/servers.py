"""Emulated servers: what a device answers to the services and actions that the station uses, from its own state.

A service that is called for a rise answers when the effects which its request has brought about are done; another one
answers at once. The goal of an action ends as the effects on its `status` say, and by hand as somebody says.
"""

from __future__ import annotations

import asyncio
import time

import structlog

from sequence_planner.language.types import Value
from sequence_planner.pipelines.graph import ActionUse, GoalState, ServiceUse
from sequence_planner.ros.actions import ActionServer, GoalOutcome, GoalStatus, GoalWork, cancelled
from sequence_planner.ros.transport import Transport
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.simulation.devices import EmulatedDevices
from sequence_planner.station import ReadyStation

LOG = structlog.get_logger(__name__)

LOOK_EVERY = 0.02  # seconds between two looks at what has become of a request

_ENDS: dict[Value | None, GoalStatus] = {
    GoalState.SUCCEEDED.value: GoalStatus.SUCCEEDED,
    GoalState.CANCELED.value: GoalStatus.CANCELED,
    GoalState.ABORTED.value: GoalStatus.ABORTED,
    GoalState.REJECTED.value: GoalStatus.ABORTED,
    GoalState.LOST.value: GoalStatus.ABORTED,
}


def serve_clients(station: ReadyStation, devices: EmulatedDevices, transport: Transport) -> None:
    """Serve all services and actions of devices that are emulated, until the transport is closed."""
    services, actions = station.pipelines.services.values(), station.pipelines.actions.values()
    for service in (each for each in services if devices.emulates(each.request.topic.resource)):
        server = _Service(service, devices, station.registry)
        transport.serve(service.name, service.type_name, server.answer)
    for action in (each for each in actions if devices.emulates(each.goal.topic.resource)):
        device = _Action(action, devices, station.registry)
        ActionServer(transport, station.registry, action.name, action.type_name, device.execute, device.accepts)


class _Service:
    def __init__(self, use: ServiceUse, devices: EmulatedDevices, registry: MessageRegistry) -> None:
        self._use = use
        self._devices = devices
        self._registry = registry

    async def answer(self, request: bytes) -> bytes:
        """Answer a request."""
        use, devices = self._use, self._devices
        asked = self._registry.decode(use.request.topic.type_name, request)
        _command(devices, use.request.topic.name, asked)
        if use.when is not None and use.every is None:
            devices.want(use.when, True)
            devices.advance(time.monotonic())
            while devices.is_underway(use.response.variables):
                await asyncio.sleep(LOOK_EVERY)
                devices.advance(time.monotonic())
            devices.want(use.when, False)
        return self._registry.encode(use.response.topic.type_name, devices.report(use.response.name))


class _Action:
    def __init__(self, use: ActionUse, devices: EmulatedDevices, registry: MessageRegistry) -> None:
        self._use = use
        self._devices = devices
        (self._status,) = use.status.variables
        self._is_busy = False

    def accepts(self, goal: object) -> bool:
        """One goal at a time."""
        return not self._is_busy

    async def execute(self, work: GoalWork) -> GoalOutcome:
        """Carry out a goal."""
        use, devices = self._use, self._devices
        self._is_busy = True
        try:
            _command(devices, use.goal.topic.name, dict(work.goal))
            devices.set_value(self._status, GoalState.IDLE.value)
            devices.want(use.when, True)
            while (end := _ENDS.get(devices.state[self._status])) is None:
                work.feedback(devices.report(use.feedback.name))
                if await cancelled(work.cancel_wanted, LOOK_EVERY):
                    devices.set_value(self._status, GoalState.CANCELED.value)
                devices.advance(time.monotonic())
            work.feedback(devices.report(use.feedback.name))
            return GoalOutcome(end, devices.report(use.result.name))
        finally:
            devices.want(use.when, False)
            self._is_busy = False


def _command(devices: EmulatedDevices, name: str, message: dict[str, object]) -> None:
    if troubles := devices.command(name, message):
        LOG.warning("request not understood", of=name, troubles=troubles)
