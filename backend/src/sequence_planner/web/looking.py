"""The documents that are shown only to who looks: the ROS graph, and what passes the pipelines."""

from __future__ import annotations

import asyncio

from sequence_planner.control.asks import AboutFlows
from sequence_planner.control.commands import CommandRefused
from sequence_planner.control.network_view import NetworkView
from sequence_planner.control.pipeline_view import FlowsView
from sequence_planner.web.controller_client import ControllerClient
from sequence_planner.web.latest import Latest
from sequence_planner.web.looking_messages import FlowsSnapshot, NetworkSnapshot, Silence
from sequence_planner.web.settings import StreamLimits
from sequence_planner.web.stream_messages import ControllerState

LOOK_EVERY = 0.5  # seconds between two questions what has passed the pipelines
NOTICE_EVERY = 0.1  # seconds between looks at whether the controller is still heard


class NetworkShow:
    """The ROS graph: told whenever it has changed; `run` notices when the controller falls silent."""

    def __init__(self, controller: ControllerClient, limits: StreamLimits) -> None:
        self.latest = Latest(self._present, limits)
        self._controller = controller
        self._encoded: str | None = None
        self._is_heard = False
        controller.listen_to_network(self._changed)

    async def run(self) -> None:
        """Watch the controller until cancelled."""
        while True:
            await asyncio.sleep(NOTICE_EVERY)
            if self._is_heard != (is_heard := self._controller.heard and self._controller.network is not None):
                self._is_heard = is_heard
                self._forget()

    def _changed(self, network: NetworkView) -> None:
        self._is_heard = self._controller.heard
        self._forget()

    def _forget(self) -> None:
        self._encoded = None
        self.latest.tell()

    def _present(self) -> str:
        network = self._controller.network
        if network is None or not self._controller.heard:
            return Silence(kind="link", controller=_state(self._controller)).model_dump_json()
        if self._encoded is None:
            self._encoded = NetworkSnapshot(kind="network", network=network).model_dump_json()
        return self._encoded


class FlowsShow:
    """What passes the pipelines: the controller is asked twice a second, as long as somebody looks."""

    def __init__(self, controller: ControllerClient, limits: StreamLimits) -> None:
        self.latest = Latest(self._present, limits)
        self._controller = controller
        self._encoded: str | None = None

    async def run(self) -> None:
        """Ask until cancelled."""
        while True:
            if not self.latest.somebody.is_set():
                self._encoded = None
                await self.latest.somebody.wait()
            self._encode(await self._asked())
            await asyncio.sleep(LOOK_EVERY)

    async def _asked(self) -> FlowsView | None:
        try:
            return await self._controller.ask(AboutFlows())
        except CommandRefused:
            return None

    def _encode(self, flows: FlowsView | None) -> None:
        before = self._encoded
        self._encoded = None if flows is None else FlowsSnapshot(kind="flows", flows=flows).model_dump_json()
        if self._encoded != before:
            self.latest.tell()

    def _present(self) -> str:
        return self._encoded or Silence(kind="link", controller=_state(self._controller)).model_dump_json()


def _state(controller: ControllerClient) -> ControllerState:
    return ControllerState.HEARD if controller.heard else ControllerState.LOST
