"""The documents that are shown only to who looks: the ROS graph, and what passes the pipelines."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from functools import partial

from sequence_planner.control.asks import AboutFlows
from sequence_planner.control.commands import CommandRefused
from sequence_planner.control.network_view import NetworkView
from sequence_planner.control.pipeline_view import FlowsView
from sequence_planner.web.broadcast import Subscriber
from sequence_planner.web.controller_client import ControllerClient
from sequence_planner.web.latest import Latest
from sequence_planner.web.looking_messages import FlowsSnapshot, NetworkSnapshot, Silence
from sequence_planner.web.settings import StreamLimits
from sequence_planner.web.stream_messages import ControllerState

# Pipelines that somebody looks at; none is all.
Names = frozenset[str] | None

LOOK_EVERY = 0.5  # seconds between two questions what has passed the pipelines


class NetworkShow:
    """The ROS graph: told whenever it has changed, and when the controller falls silent."""

    def __init__(self, controller: ControllerClient, limits: StreamLimits) -> None:
        self.latest = Latest(self._present, limits)
        self._controller = controller
        self._encoded: str | None = None
        self._is_heard = False
        controller.listen_to_network(self._changed)
        controller.listen(lambda view: self._look())
        controller.listen_to_silence(self._look)

    def _look(self) -> None:
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
    """What passes the pipelines: the controller is asked twice a second for those that somebody looks at."""

    def __init__(self, controller: ControllerClient, limits: StreamLimits) -> None:
        self.latest = Latest(partial(self._present, None), limits)
        self._controller = controller
        self._looked_at: list[Names] = []  # of each who looks; none is all
        self._flows: FlowsView | None = None
        self._encoded: dict[Names, str] = {}

    def of(self, names: Names) -> Part:
        """What passes these pipelines, or all."""
        return Part(self, names)

    @contextmanager
    def looking(self, names: Names) -> Iterator[Subscriber | None]:
        """A subscriber to these pipelines for as long as the block lasts; None when there are too many already."""
        self._looked_at.append(names)
        try:
            with self.latest.subscription(partial(self._present, names)) as subscriber:
                yield subscriber
        finally:
            self._looked_at.remove(names)

    async def run(self) -> None:
        """Ask until cancelled."""
        while True:
            if not self.latest.somebody.is_set():
                self._take(None)
                await self.latest.somebody.wait()
            self._take(await self._asked())
            await asyncio.sleep(LOOK_EVERY)

    async def _asked(self) -> FlowsView | None:
        wanted = [names for names in self._looked_at if names is not None]
        among = None if len(wanted) < len(self._looked_at) else frozenset().union(*wanted)
        try:
            return await self._controller.ask(AboutFlows(among=among))
        except CommandRefused:
            return None

    def _take(self, flows: FlowsView | None) -> None:
        is_news = flows != self._flows
        self._flows, self._encoded = flows, {}
        if is_news:
            self.latest.tell()

    def _present(self, names: Names) -> str:
        if self._flows is None:
            return Silence(kind="link", controller=_state(self._controller)).model_dump_json()
        if names not in self._encoded:
            chosen = {name: view for name, view in self._flows.pipelines.items() if names is None or name in names}
            shown = self._flows.model_copy(update={"pipelines": chosen})
            self._encoded[names] = FlowsSnapshot(kind="flows", flows=shown).model_dump_json()
        return self._encoded[names]


class Part:
    """What passes some pipelines, as clients subscribe to it."""

    def __init__(self, show: FlowsShow, names: Names) -> None:
        self.limits = show.latest.limits
        self._show = show
        self._names = names

    def subscription(self) -> AbstractContextManager[Subscriber | None]:
        """A subscriber for as long as the block lasts; None when there are too many already."""
        return self._show.looking(self._names)


def _state(controller: ControllerClient) -> ControllerState:
    return ControllerState.HEARD if controller.heard else ControllerState.LOST
